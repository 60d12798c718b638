/* function.c -- functions over intervals, from their values at points and their Taylor coefficients.
**
** A function of one operand increases, so its image is enclosed by the lower bound at the lower end and the upper
** bound at the upper end, cut at the domain first. Where an end is not in the domain, the value there is a limit, and
** nothing is inside if the operand reaches no further.
*/
#include "num/function.h"
#include "num/rounding.h"

static ambit_interval cut(const ambit_described *f, ambit_interval x) {
  return ambit_interval_intersect(x, (ambit_interval) { f->facts.least, f->facts.most });
}

/* x inside the closed domain: is it just an end that is outside? */
static bool is_bare_end(const ambit_described *f, ambit_interval x) {
  return f->facts.open && (x.hi == f->facts.least || x.lo == f->facts.most);
}

static bool leaves_domain(const ambit_described *f, ambit_interval x) {
  if (f->facts.open && f->facts.least > -INFINITY && x.lo <= f->facts.least) return true;
  if (f->facts.open && f->facts.most < INFINITY && x.hi >= f->facts.most) return true;
  return x.lo < f->facts.least || x.hi > f->facts.most;
}

static AMBIT_WORKER ambit_interval image_of(const ambit_described *f, ambit_interval x) {
  x = cut(f, x);
  if (ambit_interval_is_empty(x) || is_bare_end(f, x)) return AMBIT_EMPTY;
  ambit_interval first = f->at(x.lo);
  return (ambit_interval) { first.lo, ambit_interval_is_point(x) ? first.hi : f->at(x.hi).hi };
}

static uint32_t flags_of(ambit_interval r, bool partial) {
  uint32_t flags = partial ? AMBIT_F_PARTIAL : 0;
  if (ambit_interval_is_empty(r)) return flags | AMBIT_F_EMPTY;
  return ambit_interval_is_bounded(r) ? flags : flags | AMBIT_F_UNBOUNDED;
}

static uint32_t of_one(const ambit_described *f, ambit_interval *r, ambit_interval x) {
  *r = AMBIT_EMPTY;
  if (ambit_interval_is_empty(x)) return AMBIT_F_EMPTY;
  *r = image_of(f, x);
  return flags_of(*r, leaves_domain(f, x));
}

/* the ends of x, and 0 if it is between them */
static int corners(ambit_interval x, double at[3]) {
  int n = 1;
  at[0] = x.lo;
  if (x.hi > x.lo) at[n++] = x.hi;
  if (x.lo < 0 && x.hi > 0) at[n++] = 0;
  return n;
}

static AMBIT_WORKER ambit_interval image_of_pair(const ambit_described *f, ambit_interval x, ambit_interval y) {
  double a[3], b[3];
  x = cut(f, x);
  if (ambit_interval_is_empty(x) || is_bare_end(f, x)) return AMBIT_EMPTY;
  int na = corners(x, a), nb = corners(y, b);
  ambit_interval r = AMBIT_EMPTY;
  for (int i = 0; i < na; i++)
    for (int j = 0; j < nb; j++) {
      ambit_interval corner = f->at_pair(a[i], b[j]);
      r = (ambit_interval) { fmin(r.lo, corner.lo), fmax(r.hi, corner.hi) };
    }
  return r;
}

static uint32_t of_two(const ambit_described *f, ambit_interval *r, ambit_interval x, ambit_interval y) {
  *r = AMBIT_EMPTY;
  if (ambit_interval_is_empty(x) || ambit_interval_is_empty(y)) return AMBIT_F_EMPTY;
  *r = image_of_pair(f, x, y);
  return flags_of(*r, leaves_domain(f, x));
}

uint32_t ambit_function_map(
    uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b) {
  const ambit_described *f = ambit_function_of(op);
  bool two = ambit_op_arity(op) == 2;
  uint32_t flags = 0;
  ambit_rounding old = ambit_round_nearest();
  for (size_t i = 0; i < n; i++) flags |= two ? of_two(f, &r[i], a[i], b[i]) : of_one(f, &r[i], a[i]);
  ambit_rounding_restore(old);
  return flags;
}

/* On x itself, that is at its ends too, if it holds more than one of them. */
static bool is_smooth_on(const ambit_described *f, ambit_interval x) {
  bool inner = x.lo > f->facts.least && x.hi < f->facts.most;
  return inner && ambit_interval_is_bounded(x) && (!f->is_smooth || f->is_smooth(x));
}

uint32_t ambit_function_taylor(uint32_t op, uint32_t n, ambit_interval *c, ambit_interval x) {
  const ambit_described *f = ambit_function_of(op);
  uint32_t flags = ambit_function_map(op, 1, &c[0], &x, NULL);
  if (flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY) || !is_smooth_on(f, x))
    for (uint32_t k = 1; k <= n; k++) c[k] = AMBIT_ENTIRE;
  else if (n)
    f->taylor(n, x, c);
  return flags;
}
