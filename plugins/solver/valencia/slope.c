/* slope.c -- slopes of a tape by its inputs over a box, forward through the tape.
**
** Claim, by induction over the instructions: for any two points u, v of the (convex) tube, slot(u) - slot(v) = sum_j
** s_j (u_j - v_j) for some s_j in the computed slopes. Each operation g contributes numbers with g(a, b) - g(a', b') =
** s_a (a - a') + s_b (b - b'), bounded over the ranges of its operands (Krawczyk & Neumaier 1985): by the mean value
** theorem the range of the derivative; and where there is none, of |a| any number in [-1, 1], of min and max l and 1 -
** l with l in [0, 1]. So the claim needs local Lipschitz continuity only; sqrt at 0 and atan2 across its cut have no
** bounded slopes. Directions that are structurally zero stay exact zeros.
*/
#include "valencia.h"

typedef struct slopes {
  interval a, b;
} slopes;

static const interval unbounded = { -INFINITY, INFINITY };

static interval map(const ambit_num_service *num, uint32_t op, interval a, interval b) {
  double x[2] = { a.lo, a.hi }, y[2] = { b.lo, b.hi }, r[2];
  uint32_t flags = num->map(op, 1, r, x, y, 0);
  return flags & (AMBIT_F_EMPTY | AMBIT_F_PARTIAL) ? unbounded : (interval) { r[0], r[1] };
}

static interval unary(const ambit_num_service *num, uint32_t op, interval a) { return map(num, op, a, a); }
static interval over(const ambit_num_service *num, interval a, interval b) { return map(num, AMBIT_OP_DIV, a, b); }

static slopes one(interval a) { return (slopes) { a, { 0, 0 } }; }

static interval power_slope(const ambit_num_service *num, interval a, int32_t n) {
  interval r;
  if (n == 0) return point(0);
  if (n == INT32_MIN || num->pown(&r.lo, &r.hi, a.lo, a.hi, n - 1) & AMBIT_F_PARTIAL) return unbounded;
  return scaled(r, n);
}

/* of asin, with a minus for acos */
static interval arc_slope(const ambit_num_service *num, interval a) {
  interval root = unary(num, AMBIT_OP_SQRT, minus(point(1), unary(num, AMBIT_OP_SQR, a)));
  return over(num, point(1), root);
}

/* the pair turns around (0, 0) without crossing b < 0 at a = 0 */
static slopes angle_slopes(const ambit_num_service *num, interval a, interval b) {
  if (!(b.lo > 0 || a.lo > 0 || a.hi < 0)) return (slopes) { unbounded, unbounded };
  interval r = plus(unary(num, AMBIT_OP_SQR, a), unary(num, AMBIT_OP_SQR, b));
  return (slopes) { over(num, b, r), over(num, minus(point(0), a), r) };
}

static slopes extremum_slopes(interval first, interval second) { /* first <= second: the first is chosen */
  if (first.hi < second.lo) return (slopes) { point(1), point(0) };
  if (second.hi < first.lo) return (slopes) { point(0), point(1) };
  return (slopes) { { 0, 1 }, { 0, 1 } };
}

static slopes local(const ambit_num_service *num, uint32_t op, interval a, interval b, int32_t n, interval r) {
  switch (op) {
  case AMBIT_OP_ADD: return (slopes) { point(1), point(1) };
  case AMBIT_OP_SUB: return (slopes) { point(1), point(-1) };
  case AMBIT_OP_NEG: return one(point(-1));
  case AMBIT_OP_MUL: return (slopes) { b, a };
  case AMBIT_OP_SQR: return one(scaled(a, 2));
  case AMBIT_OP_POWN: return one(power_slope(num, a, n));
  /* a/b - a'/b' = (a - a')/b - (a'/b') (b - b')/b */
  case AMBIT_OP_DIV: return (slopes) { over(num, point(1), b), minus(point(0), over(num, r, b)) };
  case AMBIT_OP_SQRT: return one(over(num, point(0.5), r));
  case AMBIT_OP_EXP: return one(r);
  case AMBIT_OP_LOG: return one(over(num, point(1), a));
  case AMBIT_OP_SIN: return one(unary(num, AMBIT_OP_COS, a));
  case AMBIT_OP_COS: return one(minus(point(0), unary(num, AMBIT_OP_SIN, a)));
  case AMBIT_OP_TAN: return one(plus(point(1), unary(num, AMBIT_OP_SQR, r)));
  case AMBIT_OP_ASIN: return one(arc_slope(num, a));
  case AMBIT_OP_ACOS: return one(minus(point(0), arc_slope(num, a)));
  case AMBIT_OP_ATAN: return one(over(num, point(1), plus(point(1), unary(num, AMBIT_OP_SQR, a))));
  case AMBIT_OP_ATAN2: return angle_slopes(num, a, b);
  case AMBIT_OP_SINH: return one(unary(num, AMBIT_OP_COSH, a));
  case AMBIT_OP_COSH: return one(unary(num, AMBIT_OP_SINH, a));
  case AMBIT_OP_TANH: return one(meet(minus(point(1), unary(num, AMBIT_OP_SQR, r)), (interval) { 0, 1 }));
  case AMBIT_OP_ABS: return one(a.lo > 0 ? point(1) : a.hi < 0 ? point(-1) : (interval) { -1, 1 });
  case AMBIT_OP_MIN: return extremum_slopes(a, b);
  case AMBIT_OP_MAX: return extremum_slopes(b, a);
  default: return (slopes) { unbounded, unbounded };
  }
}

static int is_zero(interval a) { return a.lo == 0 && a.hi == 0; }

/* l sa + (1 - l) sb for the same l in [0, 1]: the hull of both */
static void choose(uint32_t n, interval *r, const interval *a, const interval *b) {
  for (uint32_t j = 0; j < n; j++) r[j] = hull_of(a[j], b[j]);
}

static void combine(uint32_t n, interval *r, slopes s, const interval *a, const interval *b) {
  for (uint32_t j = 0; j < n; j++) {
    interval left = is_zero(a[j]) ? point(0) : times(s.a, a[j]);
    r[j] = is_zero(b[j]) || is_zero(s.b) ? left : plus(left, times(s.b, b[j]));
  }
}

static int is_choice(uint32_t op, slopes s) {
  return (op == AMBIT_OP_MIN || op == AMBIT_OP_MAX) && s.a.lo == 0 && s.a.hi == 1 && s.b.lo == 0 && s.b.hi == 1;
}

int valencia_slopes(const ambit_num_service *num, const ambit_tape *t, uint32_t ndir, const double *lo,
    const double *hi, interval *slope) {
  for (uint32_t i = 0; i < t->nconst + t->nin; i++)
    for (uint32_t j = 0; j < ndir; j++) slope[(size_t)i * ndir + j] = point(i >= t->nconst && i - t->nconst == j);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t op = t->op[i], a = t->a[i], b = op == AMBIT_OP_POWN ? a : t->b[i], r = t->dst[i];
    slopes s = local(num, op, (interval) { lo[a], hi[a] }, (interval) { lo[b], hi[b] }, (int32_t)t->b[i],
        (interval) { lo[r], hi[r] });
    interval *to = slope + (size_t)r * ndir, *from_a = slope + (size_t)a * ndir, *from_b = slope + (size_t)b * ndir;
    if (is_choice(op, s))
      choose(ndir, to, from_a, from_b);
    else
      combine(ndir, to, s, from_a, from_b);
  }
  for (uint32_t i = 0; i < t->nout; i++)
    for (uint32_t j = 0; j < ndir; j++)
      if (!is_bounded(slope[(size_t)t->out[i] * ndir + j])) return 0;
  return 1;
}
