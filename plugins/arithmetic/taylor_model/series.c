/* series.c -- Taylor coefficients at a centre c, and a coefficient for the rest over a whole range: f(x) = sum over k
** <= n of t_k (x - c)^k + R (x - c)^(n+1). Upward mode: a lower bound is the negated rounded-up bound of the negated
** set.
**
** exp, sin, cos, sinh, cosh: derivatives in closed form, R by Lagrange: f^(n+1) / (n+1)! somewhere between c and x.
** Powers x^a, q = x / c > 0: R = binomial(a, n+1) c^(a-n-1) q^a y^(-a-1) for a y between 1 and q, which follows from
** the integral form of the rest with w = (z - t) / (1 + t); it stays small up to twice the centre, where Lagrange's
** form does not. For 1/x it is exact. log is the limit: R = (-1)^n / ((n+1) c^n y), y between c and x.
** The others by their differential equations [Griewank & Walther, ch. 13]:
**   tan' = 1 + tan^2, tanh' = 1 - tanh^2;   asin' = g with (1 - x^2) g' = x g;   atan' = g with (1 + x^2) g = 1.
** Their rests:
**   asin        all derivatives at x >= 0 are nonnegative and increase (power series at 0 with coefficients >= 0, and
**               the function is odd), so the largest |x| bounds them;
**   atan        (1 + x^2) (g - sum over k < n of g_k h^k) = (1 + c^2) g_n h^n - g_(n-1) h^(n+1), integrated over h;
**   tan, tanh   are sums of 1 / (p - x) over their poles p, taken in pairs [DLMF 4.22.3, 4.36.3]; the rest of one is
**               (x - c)^(n+1) / ((p - c)^(n+1) (p - x)), and their distances grow by pi from pole to pole.
*/
#include "series.h"

#define PI_LOW 0x1.921fb54442d18p+1
#define SLACK 0x1.000000000001p0 /* more than a few roundings */

/* -- intervals in upward mode, bounded operands */

static interval point(double x) { return (interval) { x, x }; }
static interval negative(interval a) { return (interval) { -a.hi, -a.lo }; }
static interval plus(interval a, interval b) { return (interval) { -(-a.lo - b.lo), a.hi + b.hi }; }

static interval over(interval a, double n) { /* n > 0 */
  return (interval) { -(-a.lo / n), a.hi / n };
}

static double largest(interval a) { return fmax(fabs(a.lo), fabs(a.hi)); }
static double smallest(interval a) { return a.lo > 0 ? a.lo : a.hi < 0 ? -a.hi : 0; }

static interval apply(const ambit_num_service *num, uint32_t op, interval a, interval b) {
  double x[2] = { a.lo, a.hi }, y[2] = { b.lo, b.hi }, r[2];
  num->map(op, 1, r, x, y, 0);
  return (interval) { r[0], r[1] };
}

static interval of(const ambit_num_service *num, uint32_t op, interval a) { return apply(num, op, a, a); }
static interval inverse(const ambit_num_service *num, interval a) { return apply(num, AMBIT_OP_DIV, point(1), a); }

static interval power(const ambit_num_service *num, interval a, int32_t n) {
  interval r;
  num->pown(&r.lo, &r.hi, a.lo, a.hi, n);
  return r;
}

/* -- what each function needs */

typedef struct task {
  const ambit_num_service *num;
  int32_t exponent;
  double centre;
  interval range, wide;
  series *s;
} task;

static void put(const task *t, uint32_t k, interval x) {
  double mid = x.lo == x.hi ? x.lo : x.lo / 2 + x.hi / 2;
  t->s->mid[k] = mid, t->s->rad[k] = fmax(x.hi - mid, mid - x.lo);
}

static void expand_exp(const task *t) {
  uint32_t n = t->s->terms;
  interval at = of(t->num, AMBIT_OP_EXP, point(t->centre)), rest = of(t->num, AMBIT_OP_EXP, t->range);
  put(t, 0, at);
  for (uint32_t k = 1; k <= n + 1; k++) {
    rest = over(rest, k), at = over(at, k);
    if (k <= n) put(t, k, at);
  }
  t->s->rest = rest, t->s->slope = of(t->num, AMBIT_OP_EXP, t->wide).hi;
}

/* op is one of a pair whose derivatives alternate: sin, cos (odd: then minus sin, minus cos); sinh, cosh */
static void expand_pair(const task *t, uint32_t op, uint32_t first, uint32_t second, int turns) {
  uint32_t n = t->s->terms, shift = op == second;
  interval at[2] = { of(t->num, first, point(t->centre)), of(t->num, second, point(t->centre)) }, weight = point(1);
  for (uint32_t k = 0; k <= n + 1; k++) {
    uint32_t which = k + shift;
    if (k) weight = over(weight, k);
    interval x = k <= n ? at[which % 2] : of(t->num, which % 2 ? second : first, t->range);
    if (turns && which % 4 >= 2) x = negative(x);
    x = interval_times(x, weight);
    if (k <= n)
      put(t, k, x);
    else
      t->s->rest = x;
  }
  t->s->slope = largest(of(t->num, shift ? first : second, t->wide));
}

/* log: (-1)^(k-1) / (k x^k) */
static void expand_log(const task *t) {
  uint32_t n = t->s->terms;
  interval u = inverse(t->num, point(t->centre)), p = point(-1);
  put(t, 0, of(t->num, AMBIT_OP_LOG, point(t->centre)));
  for (uint32_t k = 1; k <= n; k++) p = negative(interval_times(p, u)), put(t, k, over(p, k));
  t->s->rest = over(interval_times(negative(p), inverse(t->num, t->range)), n + 1);
  t->s->slope = inverse(t->num, t->wide).hi;
}

static interval join(interval a, interval b) { return (interval) { fmin(a.lo, b.lo), fmax(a.hi, b.hi) }; }

/* q^a y^(-a-1) for q in [q.lo, q.hi], which contains 1, and y between 1 and q: monotone in y, so between q^a and 1/q */
static interval power_rest(const ambit_num_service *num, interval q, interval to_a) {
  return join(join(to_a, inverse(num, q)), point(1));
}

/* sqrt: binomial(1/2, k) x^(1/2 - k) */
static void expand_sqrt(const task *t) {
  uint32_t n = t->s->terms;
  interval u = inverse(t->num, point(t->centre)), p = of(t->num, AMBIT_OP_SQRT, point(t->centre));
  put(t, 0, p);
  for (uint32_t k = 1; k <= n + 1; k++) {
    p = interval_times(interval_times(p, u), over(point(3 - 2.0 * k), 2.0 * k));
    if (k <= n) put(t, k, p);
  }
  interval q = interval_times(t->range, u);
  t->s->rest = interval_times(p, power_rest(t->num, q, of(t->num, AMBIT_OP_SQRT, q)));
  t->s->slope = of(t->num, AMBIT_OP_SQRT, inverse(t->num, t->wide)).hi / 2;
}

static double width(interval x) { return x.hi - x.lo; }

/* Lagrange's form, or the other if that is narrower and there is one */
static interval power_remainder(const task *t, int32_t n, interval binomial) {
  int32_t k = (int32_t)t->s->terms + 1;
  if (n >= 0 && k > n) return point(0);
  interval lagrange = interval_times(binomial, power(t->num, t->range, n - k));
  if (t->centre == 0) return lagrange;
  interval q = interval_times(t->range, inverse(t->num, point(t->centre)));
  if (q.lo <= 0) return lagrange;
  interval other = interval_times(binomial, power(t->num, point(t->centre), n - k));
  other = interval_times(other, power_rest(t->num, q, power(t->num, q, n)));
  return width(other) < width(lagrange) ? other : lagrange;
}

/* x^n: binomial(n, k) x^(n - k) */
static void expand_power(const task *t, int32_t n) {
  uint32_t terms = t->s->terms;
  interval b = point(1);
  for (uint32_t k = 0; k <= terms + 1; k++) {
    interval factor = point((double)n - k + 1);
    if (k) b = over(interval_times(b, factor), k);
    if (k > terms)
      t->s->rest = power_remainder(t, n, b);
    else if (n >= 0 && k > (uint32_t)n)
      put(t, k, point(0));
    else
      put(t, k, interval_times(b, power(t->num, point(t->centre), n - (int32_t)k)));
  }
  t->s->slope = largest(interval_times(point(n), power(t->num, t->wide, n - 1)));
}

/* (k + 1) t_(k+1) = 1 (k = 0) + sign sum t_i t_(k-i) */
static interval tangent_next(const interval *t, uint32_t k, int sign) {
  interval sum = point(0);
  for (uint32_t i = 0; i <= k; i++) sum = plus(sum, interval_times(t[i], t[k - i]));
  if (sign < 0) sum = negative(sum);
  if (k == 0) sum = plus(sum, point(1));
  return over(sum, k + 1.0);
}

/* [-most, most], or one side: coefficient k of an odd function whose series at 0 has no negative coefficient */
static interval one_side(interval x, uint32_t k, double most) {
  if (k % 2 || x.lo >= 0) return (interval) { 0, most };
  return (interval) { -most, x.hi <= 0 ? 0 : most };
}

enum { POLES = 4 };

/* sum over j >= 0 of 1 / ((from + j pi)^(n+1) (to + j pi)); terms from POLES on are at most (j pi)^-(n+2), and the sum
** of these is less than the integral from POLES - 1 on */
static double pole_sum(double from, double to, uint32_t n) {
  double sum = 0, tail = SLACK / (n + 1);
  if (!(from > 0 && to > 0)) return INFINITY;
  for (int j = 0; j < POLES; j++) {
    double a = SLACK / (from + j * PI_LOW), term = SLACK / (to + j * PI_LOW);
    for (uint32_t i = 0; i <= n; i++) term *= a;
    sum += term;
  }
  for (uint32_t i = 0; i <= n; i++) tail *= SLACK / ((POLES - 1) * PI_LOW);
  return sum + tail;
}

/* x - j pi in [-pi/2, pi/2], from its tangent */
static interval reduced(const ambit_num_service *num, interval tangent) { return of(num, AMBIT_OP_ATAN, tangent); }

static void expand_tan(const task *t) {
  uint32_t n = t->s->terms;
  interval x[MONOMIALS_ORDER_MAX + 2], value = of(t->num, AMBIT_OP_TAN, t->range);
  x[0] = of(t->num, AMBIT_OP_TAN, point(t->centre));
  for (uint32_t k = 0; k < n; k++) x[k + 1] = tangent_next(x, k, 1);
  for (uint32_t k = 0; k <= n; k++) put(t, k, x[k]);
  interval c = reduced(t->num, x[0]), r = reduced(t->num, value);
  double above = pole_sum(PI_LOW / 2 - c.hi, PI_LOW / 2 - r.hi, n),
         below = pole_sum(PI_LOW / 2 + c.lo, PI_LOW / 2 + r.lo, n);
  t->s->rest = n % 2 ? (interval) { -below, above } : (interval) { 0, above + below };
  double most = largest(of(t->num, AMBIT_OP_TAN, t->wide)); /* infinite if a pole is inside */
  t->s->slope = 1 + most * most;
}

/* distance of the real number x from the poles (j + 1/2) pi i */
static double pole_distance_inverse(double x, int j) {
  double w = (j + 0.5) * PI_LOW;
  return SLACK / sqrt(x * x + w * w);
}

static double tanh_bound(double from, double to, uint32_t n) {
  double sum = 0, tail = SLACK / (n + 1);
  for (int j = 0; j < POLES; j++) {
    double a = pole_distance_inverse(from, j), term = pole_distance_inverse(to, j);
    for (uint32_t i = 0; i <= n; i++) term *= a;
    sum += term;
  }
  for (uint32_t i = 0; i <= n; i++) tail *= SLACK / ((POLES - 1) * PI_LOW);
  return 2 * (sum + tail);
}

static void expand_tanh(const task *t) {
  uint32_t n = t->s->terms;
  interval x[MONOMIALS_ORDER_MAX + 2], value[MONOMIALS_ORDER_MAX + 2];
  x[0] = of(t->num, AMBIT_OP_TANH, point(t->centre)), value[0] = of(t->num, AMBIT_OP_TANH, t->range);
  for (uint32_t k = 0; k <= n; k++) x[k + 1] = tangent_next(x, k, -1), value[k + 1] = tangent_next(value, k, -1);
  for (uint32_t k = 0; k <= n; k++) put(t, k, x[k]);
  double most = tanh_bound(fabs(t->centre), smallest(t->range), n);
  t->s->rest = (interval) { fmax(value[n + 1].lo, -most), fmin(value[n + 1].hi, most) };
  double least = smallest(of(t->num, AMBIT_OP_TANH, t->wide));
  t->s->slope = 1 + -least * least;
}

/* g_(k+1) = (x (2k + 1) g_k + k g_(k-1)) / ((k + 1) (1 - x^2)), g_0 = (1 - x^2)^(-1/2); f_(k+1) = g_k / (k + 1) */
static void asin_derivatives(const ambit_num_service *num, double x, uint32_t n, interval *g) {
  interval below = plus(point(1), point(-x)), above = plus(point(1), point(x));
  interval u = inverse(num, interval_times(below, above));
  g[0] = of(num, AMBIT_OP_SQRT, u);
  for (uint32_t k = 0; k < n; k++) {
    interval sum = interval_times(interval_times(point(x), point(2.0 * k + 1)), g[k]);
    if (k) sum = plus(sum, interval_times(point(k), g[k - 1]));
    g[k + 1] = over(interval_times(sum, u), k + 1.0);
  }
}

static void expand_asin(const task *t, uint32_t op) {
  uint32_t n = t->s->terms;
  interval g[MONOMIALS_ORDER_MAX + 2];
  int turned = op == AMBIT_OP_ACOS;
  put(t, 0, of(t->num, op, point(t->centre)));
  asin_derivatives(t->num, t->centre, n, g);
  for (uint32_t k = 1; k <= n; k++) put(t, k, over(turned ? negative(g[k - 1]) : g[k - 1], k));
  asin_derivatives(t->num, largest(t->range), n, g);
  interval rest = one_side(t->range, n + 1, over(g[n], n + 1.0).hi);
  t->s->rest = turned ? negative(rest) : rest;
  asin_derivatives(t->num, largest(t->wide), 0, g);
  t->s->slope = g[0].hi;
}

/* (1 + x^2) g_k = -2 x g_(k-1) - g_(k-2) */
static void expand_atan(const task *t) {
  uint32_t n = t->s->terms;
  interval c = point(t->centre), square = plus(point(1), interval_times(c, c)), u = inverse(t->num, square);
  interval g = u, before = point(0), twice = interval_times(point(-2), c);
  put(t, 0, of(t->num, AMBIT_OP_ATAN, c));
  for (uint32_t k = 1; k <= n; k++) { /* g is g_(k-1) */
    put(t, k, over(g, k));
    interval next = interval_times(plus(interval_times(twice, g), negative(before)), u);
    before = g, g = next;
  }
  double reach = fmax(t->range.hi - t->centre, t->centre - t->range.lo), m = smallest(t->range);
  double most = (square.hi * largest(g) + largest(before) * reach) * (SLACK / (1 + m * m)) / (n + 1);
  t->s->rest = (interval) { -most, most };
  m = smallest(t->wide), t->s->slope = SLACK / (1 + m * m);
}

static int is_bounded(const series *s) {
  double sum = fabs(s->rest.lo) + fabs(s->rest.hi) + s->slope;
  for (uint32_t k = 0; k <= s->terms; k++) sum += fabs(s->mid[k]) + s->rad[k];
  return sum < INFINITY; /* false for NaN */
}

/* a function that the kernel describes: by its derivatives, Lagrange's rest */
static int expand_described(const task *t, uint32_t op) {
  uint32_t n = t->s->terms;
  double at[2 * (MONOMIALS_ORDER_MAX + 2)], over_range[2 * (MONOMIALS_ORDER_MAX + 2)], over_wide[4];
  t->num->taylor(op, n, at, t->centre, t->centre);
  t->num->taylor(op, n + 1, over_range, t->range.lo, t->range.hi);
  t->num->taylor(op, 1, over_wide, t->wide.lo, t->wide.hi);
  for (uint32_t k = 0; k <= n; k++) put(t, k, (interval) { at[2 * k], at[2 * k + 1] });
  t->s->rest = (interval) { over_range[2 * n + 2], over_range[2 * n + 3] };
  t->s->slope = largest((interval) { over_wide[2], over_wide[3] });
  return is_bounded(t->s);
}

/* is the function smooth on all of x? tan: seen from an infinite slope */
static int is_smooth(uint32_t op, int32_t exponent, interval x) {
  switch (op) {
  case AMBIT_OP_LOG:
  case AMBIT_OP_SQRT: return x.lo > 0;
  case SERIES_RECIPROCAL: return x.lo > 0 || x.hi < 0;
  case AMBIT_OP_POWN: return exponent >= 0 || x.lo > 0 || x.hi < 0;
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: return x.lo > -1 && x.hi < 1;
  default: return 1;
  }
}

AMBIT_WORKER int series_expand(const ambit_num_service *num, uint32_t op, int32_t exponent, double centre,
    interval range, interval wide, series *s) {
  task t = { num, exponent, centre, range, wide, s };
  if (!is_smooth(op, exponent, wide) || exponent < -INT32_MAX + MONOMIALS_ORDER_MAX + 2) return 0;
  switch (op) {
  case AMBIT_OP_EXP: expand_exp(&t); break;
  case AMBIT_OP_LOG: expand_log(&t); break;
  case AMBIT_OP_SQRT: expand_sqrt(&t); break;
  case SERIES_RECIPROCAL: expand_power(&t, -1); break;
  case AMBIT_OP_POWN: expand_power(&t, exponent); break;
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: expand_pair(&t, op, AMBIT_OP_SIN, AMBIT_OP_COS, 1); break;
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: expand_pair(&t, op, AMBIT_OP_SINH, AMBIT_OP_COSH, 0); break;
  case AMBIT_OP_TAN: expand_tan(&t); break;
  case AMBIT_OP_TANH: expand_tanh(&t); break;
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: expand_asin(&t, op); break;
  case AMBIT_OP_ATAN: expand_atan(&t); break;
  default: return ambit_op_is_function(op) && expand_described(&t, op);
  }
  return is_bounded(s);
}
