/* kink.c -- abs, min and max where the set crosses their kink, and tanh where the set is wide: a line in the place of
** the operation, and by how much it differs from it.
**
** d is the operand of abs, or the difference a - b of min and max, which are b + (d -+ |d|) / 2. For any slope and
** offset, |d| = slope d + offset + theta, |theta| <= miss, the largest at the ends of d's range and at 0. Off the kink
** the slope is 1 or -1 and misses nothing; across it, slope and offset of the line that misses least over the range at
** the start of the step, moved on as far as in the last step. Proof: docs/numerics/zonotope.md, section 5a.
*/
#include "kink.h"
#include "basis.h"
#include "vary.h"
#include "proof.h"

#define GRID 0x1p20 /* slopes are multiples of 1 / GRID, so that (1 + slope) / 2 and (1 - slope) / 2 are exact */

/* of tanh: */
#define SATURATED 22 /* |d| from which it is 1 or -1 to rounding, also some way further on; */
#define WIDE 0.05    /* half width of d from which a line may be better than a polynomial; */
#define STEEP 0.01   /* what a line misses from which on it is a kink that the set crosses, not a smooth function */

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

static int is_unary(uint32_t op) { return op == AMBIT_OP_ABS || op == AMBIT_OP_TANH; }

/* of order k of the operand, times scale */
static void add_operand(const zono *z, terms *sum, uint32_t i, uint32_t k, double scale) {
  const ambit_tape *t = z->program.tape;
  terms_row(&z->shape, sum, scale, coefficient(z, t->a[i], k));
  if (!is_unary(t->op[i])) terms_row(&z->shape, sum, -scale, coefficient(z, t->b[i], k));
}

/* The size of all but the constant of kinks->row. Errors are not independent: what moves both operands alike has no
** part in their difference. */
static double moving_of(zono *z) {
  const shape *s = &z->shape;
  double *row = z->kinks->row, *errors = z->kinks->errors, size = row_moving(s, row), single = row_r(s, row);
  if (!(single > 0) || z->K_max == 0) return size; /* a jump's program knows no generators: jump.c */
  memcpy(errors, row + s->eps, z->nx * sizeof *errors);
  for (uint32_t k = 0; k < z->nx; k++)
    if (errors[k] != 0 && !(z->E[k] > 0)) return size; /* eps_k stands for no error */
  double together = basis_resolve(z, errors);
  together += basis_along(z, errors);
  return smaller(size, (larger(size - single, 0) + together) * ABOVE + (8 + z->nx) * UNIT * size);
}

/* constant and the size of the rest of order 0 (plus scale times order 1) of the operand */
static double centre_of(zono *z, uint32_t i, double scale, double *moving) {
  terms sum;
  terms_clear(&sum);
  add_operand(z, &sum, i, 0, 1);
  if (scale != 0) add_operand(z, &sum, i, 1, scale);
  terms_sum(&z->shape, &sum, z->kinks->row, row_parts(&z->shape, 0));
  *moving = moving_of(z);
  return z->kinks->row[0];
}

/* sum of the sizes of all orders of both operands */
static double size_of(const zono *z, uint32_t i, double length) {
  const ambit_tape *t = z->program.tape;
  double sum = 0, power = 1;
  for (uint32_t k = 0; k <= z->K; k++, power *= length) {
    sum += row_total(&z->shape, coefficient(z, t->a[i], k)) * power;
    if (!is_unary(t->op[i])) sum += row_total(&z->shape, coefficient(z, t->b[i], k)) * power;
  }
  return sum;
}

/* of d from order 2 on: its operands may be nearly the same */
static double later_of(const zono *z, uint32_t i, double length) {
  double sum = 0;
  for (uint32_t k = z->K; k >= 2; k--) sum = (sum + z->kinks->of[i].total[k]) * length;
  return sum * length;
}

/* -- phase 1 */

static void note_total(zono *z, uint32_t i, uint32_t k) {
  terms sum;
  terms_clear(&sum);
  add_operand(z, &sum, i, k, 1);
  terms_sum(&z->shape, &sum, z->kinks->row, row_parts(&z->shape, k));
  z->kinks->of[i].total[k] = row_total(&z->shape, z->kinks->row) * ABOVE;
}

static void choose_line(zono *z, uint32_t i) {
  kink *k = &z->kinks->of[i];
  double m, c = centre_of(z, i, 0, &m), lo = c - m, hi = c + m;
  int crossed = lo < 0 && hi > 0 && z->kinks->may_cross[i];
  k->slope = c > 0 || (c == 0 && k->drift >= 0) ? 1 : -1;
  k->offset = 0;
  if (!crossed) return;
  if (k->drift > 0) hi += k->drift;
  if (k->drift < 0) lo += k->drift;
  k->slope = nearbyint((hi + lo) / (hi - lo) * GRID) / GRID;
  k->offset = -lo * (hi / (hi - lo));
}

/* About what Taylor's polynomial of degree 3 is off by: what rows drop of its square and its cube, the remainder, and
** as much again over the step. */
static double polynomial_misses(const zono *z, uint32_t i, double c, double m) {
  const double *x = row_at(z, z->program.tape->a[i], 0);
  double dropped = row_dropped(&z->shape, x, x, row_parts(&z->shape, 0)), v = tanh(c);
  return 2 * ((fabs(v) * (1 - v * v) + m / 3) * dropped + m * m * m * m / 6);
}

/* A line for tanh where Taylor's polynomial is further off, or where nothing but 1 or -1 is left of it. */
void tanh_choose(zono *z, uint32_t i) {
  kink *k = &z->kinks->of[i];
  double m, c = centre_of(z, i, 0, &m), lo = c - m, hi = c + m, drift = k->is_line ? k->drift : 0;
  tanh_line(z, k, lo, hi);
  double missed = tanh_miss(z, k, lo, hi);
  k->is_line = fabs(c) - m > SATURATED || (m > WIDE && missed < polynomial_misses(z, i, c, m));
  if (!k->is_line || missed < STEEP) return;
  double ahead = fmin(fabs(drift), m);
  tanh_line(z, k, drift < 0 ? lo - ahead : lo, drift > 0 ? hi + ahead : hi);
}

void kink_shares(const zono *z, uint32_t i, double *a, double *b) {
  double slope = z->kinks->of[i].slope;
  uint32_t op = z->program.tape->op[i];
  *a = is_unary(op) ? slope : op == AMBIT_OP_MAX ? 0.5 * (1 + slope) : 0.5 * (1 - slope);
  *b = is_unary(op) ? 0 : 1 - *a;
}

static double offset_share(uint32_t op) { return is_unary(op) ? 1 : op == AMBIT_OP_MAX ? 0.5 : -0.5; }

void kink_row(zono *z, uint32_t i, uint32_t k) {
  const ambit_tape *t = z->program.tape;
  double share_a, share_b;
  terms sum;
  if (k == 0 && is_kinked(t->op[i])) choose_line(z, i);
  note_total(z, i, k);
  kink_shares(z, i, &share_a, &share_b);
  terms_clear(&sum);
  if (has_twin(z, i)) {
    share_a = share_b = 1;
    terms_row(&z->shape, &sum, -1, coefficient(z, t->dst[z->kinks->of[i].twin], k));
  } else if (k == 0)
    sum.c = offset_share(t->op[i]) * z->kinks->of[i].offset;
  if (share_a != 0) terms_row(&z->shape, &sum, share_a, coefficient(z, t->a[i], k));
  if (share_b != 0) terms_row(&z->shape, &sum, share_b, coefficient(z, t->b[i], k));
  terms_sum(&z->shape, &sum, row_at(z, t->dst[i], k), row_parts(&z->shape, k));
}

/* -- phase 2 */

static int is_exact(const kink *k) { return !k->is_line && k->offset == 0 && fabs(k->slope) == 1; }

/* greatest | |d| - slope d - offset | over [lo, hi], or of tanh */
static double miss(const zono *z, const kink *k, double lo, double hi) {
  if (k->is_line) return tanh_miss(z, k, lo, hi);
  double most = larger(fabs(fabs(lo) - k->slope * lo - k->offset), fabs(fabs(hi) - k->slope * hi - k->offset));
  if (lo < 0 && hi > 0) most = larger(most, fabs(k->offset));
  return most > 0 || !is_exact(k) ? most + 8 * UNIT * (fabs(lo) + fabs(hi) + fabs(k->offset)) : 0;
}

/* The range of the operand: the parts of orders 0 and 1 are convex in time, so they are greatest at the ends. */
static void find_range(zono *z, uint32_t i, double length) {
  kink *k = &z->kinks->of[i];
  double h = z->h < 0 ? -length : length, from, to = 0;
  double first = centre_of(z, i, 0, &from), last = centre_of(z, i, h, &to), later = later_of(z, i, length);
  k->size = size_of(z, i, length);
  double more = later + 1e-9 * (larger(from, to) + later + fabs(last - first)) + 1e-14 * k->size;
  k->lo = smaller(first - from, last - to) - more, k->hi = larger(first + from, last + to) + more;
  k->moved = last - first;
}

double kink_defect(zono *z, uint32_t i, double rounding, double length) {
  const kink *k = &z->kinks->of[i];
  find_range(z, i, length);
  if (has_twin(z, i)) return rounding;
  double share = fabs(offset_share(z->program.tape->op[i])), off = miss(z, k, k->lo, k->hi);
  return share * (off + 4 * UNIT * fabs(k->offset)) + (is_exact(k) ? 0 : rounding);
}

double kink_second(const zono *z, uint32_t i, double distance) {
  const kink *k = &z->kinks->of[i];
  double lo = k->lo - distance, hi = k->hi + distance;
  if (!k->is_line && !z->kinks->may_cross[i] && lo <= 0 && hi >= 0) return -1;
  double share = fabs(offset_share(z->program.tape->op[i])), most = miss(z, k, lo, hi);
  z->kinks->of[i].more = larger(most - miss(z, k, k->lo, k->hi), 0);
  return share * (k->more + 4 * UNIT * most);
}

/* -- the length of a step: lines are chosen at its start, so what they miss may grow only so much until its end */

#define GROWTH 1.1
#define STEADY 0.5
#define BESIDE_WIDTH 0.01 /* of d; */
#define BESIDE_STEP 1e-6  /* of what d moves in a step of the usual length: a kink between exact states; */
#define BESIDE_SIZE 1e-13 /* of what d is the difference of: the same to rounding */

void kinks_start(zono *z, double longest) {
  if (z->kinks->usual == 0) z->kinks->usual = longest;
  for (uint32_t i = 0; i < z->program.tape->ninstr; i++) {
    kink *k = &z->kinks->of[i];
    uint32_t dst = z->program.tape->dst[i];
    if (!is_line(z, i) || has_twin(z, i)) continue;
    k->missed = miss(z, k, k->lo, k->hi), k->width = 0.5 * (k->hi - k->lo);
    if (!k->is_line) continue;
    k->width = tanh_half_width(z, k->lo, k->hi);
    z->kinks->is_slot[dst] = k->missed >= STEEP;
  }
}

int kinks_fit(const zono *z, double length) {
  for (uint32_t i = 0; i < z->program.tape->ninstr; i++) {
    const kink *k = &z->kinks->of[i];
    if (!is_line(z, i) || has_twin(z, i)) continue;
    double least = length > 0 ? BESIDE_STEP * z->kinks->usual * fabs(k->moved) / length : 0;
    double allowed = BESIDE_WIDTH * k->width + least + BESIDE_SIZE * k->size;
    if (k->is_line) allowed = larger(BESIDE_WIDTH * k->width, k->missed < STEEP ? 2 * STEEP : 0);
    if (miss(z, k, k->lo, k->hi) > GROWTH * k->missed + allowed) return 0;
  }
  return 1;
}

/* Of tanh, which is bounded: distances that make a line miss much more, and so themselves larger, are those of too long
** a step. */
int kinks_steady(const zono *z) {
  for (uint32_t i = 0; i < z->program.tape->ninstr; i++) {
    const kink *k = &z->kinks->of[i];
    if (k->is_line && k->more > STEADY * k->missed + BESIDE_WIDTH * k->width) return 0;
  }
  return 1;
}

void kinks_note(zono *z) {
  double length = fabs(z->h), faded = 0.97 * z->kinks->usual;
  z->kinks->usual = length > faded ? length : faded;
  for (uint32_t i = 0; i < z->program.tape->ninstr; i++)
    if (is_line(z, i)) z->kinks->of[i].drift = z->kinks->of[i].moved;
}

/* -- memory */

static int is_pair(uint32_t op) { return op == AMBIT_OP_MIN || op == AMBIT_OP_MAX; }

/* min(a, b) + max(a, b) = a + b. A twin has none itself: its distance from the line is known by its own lump. */
static void find_twins(zono *z) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t v = 0; v < z->nvarying; v++) z->kinks->is_slot[vary_first(z) + v] = 1;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t twin = i;
    for (uint32_t j = 0; j < i && is_pair(t->op[i]) && twin == i; j++) {
      int same = t->a[i] == t->a[j] && t->b[i] == t->b[j], turned = t->a[i] == t->b[j] && t->b[i] == t->a[j];
      int is_first = is_pair(t->op[j]) && z->kinks->of[j].twin == j;
      if (is_first && t->op[j] != t->op[i] && (same || turned)) twin = j;
    }
    z->kinks->of[i].twin = twin;
    if (!z->kinks->may_cross[i]) z->kinks->may_cross[twin] = 0;
    z->kinks->is_slot[t->dst[i]] = (uint8_t)is_kinked(t->op[i]);
  }
}

int kinks_open(zono *z) {
  const ambit_host *h = z->host;
  const ambit_tape *t = z->program.tape;
  kinks *k = z->kinks = h->alloc(h, sizeof *k);
  if (!k) return 0;
  k->of = h->alloc(h, (t->ninstr + 1u) * sizeof *k->of);
  k->may_cross = h->alloc(h, t->ninstr + 1u);
  k->row = h->alloc(h, z->shape.stride * sizeof(double)), k->errors = h->alloc(h, (z->nx + 1u) * sizeof(double));
  k->is_slot = h->alloc(h, t->nslot);
  if (!k->of || !k->may_cross || !k->row || !k->errors || !k->is_slot) return 0;
  for (uint32_t i = 0; i < t->ninstr; i++)
    if ((is_kinked(t->op[i]) || t->op[i] == AMBIT_OP_TANH) &&
        !(k->of[i].total = h->alloc(h, (z->K_max + 1u) * sizeof(double))))
      return 0;
  /* equations must be affine in the unknowns that they are solved for */
  for (uint32_t i = 0; i < t->ninstr; i++) k->may_cross[i] = !z->program.needed || !z->program.needed[t->dst[i]];
  find_twins(z);
  return 1;
}
