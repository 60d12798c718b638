/* linearise.c -- f(x) = slope x + g(x), with the range of g bounded over [a, b]. Upward mode.
**
** Any slope is sound; it decides only how wide g is. Chebyshev: where f'' keeps its sign the slope of the secant is the
** best there is; else the first coefficient of the Chebyshev series, from the four points of Lobatto, is near the best.
** Extrema of g: at the ends, or where f' = slope. A piece of [a, b] in which f is convex is bounded from below by a
** tangent of g at ANY point t of the piece,
**     g(x) >= g(t) + g'(t) (x - t),
** so t need only be near the place of the minimum; concave pieces from above likewise. A largest value of g on a convex
** piece is at its ends; an end inside [a, b] belongs to the concave piece next to it too. So over [a, b]:
**     max g = max(g(a), g(b), bound of the concave piece),  min g = min(g(a), g(b), bound of the convex piece).
** sin and cos may have more pieces; waves.c has the places of all extrema.
**
** Min-range: with f' in [p, q] over [a, b] and p >= 0, the slope p makes g nondecreasing, so g runs from g(a) to g(b);
** with q <= 0 the slope q makes it nonincreasing; else the slope is 0 and g is f. The range of slope x + g is then
** f's own. [de Figueiredo & Stolfi, Numerical Algorithms 37, 2004]
*/
#include "linearise.h"
#include <float.h>
#include <string.h>

/* a tangent: which entry, at t, of a piece [from, to] that is convex (or concave) */
typedef struct tangents {
  size_t n, owner[2 * LINEARISE_CHUNK];
  double t[2 * LINEARISE_CHUNK], from[2 * LINEARISE_CHUNK], to[2 * LINEARISE_CHUNK];
  int convex[2 * LINEARISE_CHUNK];
} tangents;

static double clipped(double t, double from, double to) {
  if (!(t >= from)) t = t < from ? from : 0.5 * from + 0.5 * to; /* NaN: anywhere */
  return t <= to ? t : to;
}

/* f - slope x at x, added to [glo, ghi] */
static void include(linearise_chunk *k, size_t i, double x, double flo, double fhi) {
  k->ghi[i] = larger(k->ghi[i], (-k->slope[i]) * x + fhi);
  k->glo[i] = smaller(k->glo[i], -(k->slope[i] * x - flo));
}

/* everywhere; where x > 0 (TAN: where f > 0), and not below */
enum {
  CONVEX = AMBIT_CONVEX,
  CONCAVE = AMBIT_CONCAVE,
  CONVEX_RIGHT = AMBIT_CONVEX_RIGHT,
  CONCAVE_RIGHT = AMBIT_CONCAVE_RIGHT
};

static int shape(const affine_context *c, uint32_t op, int32_t power) {
  const ambit_function_facts *facts = c->num->facts(op);
  if (facts) return facts->shape;
  switch (op) {
  case AMBIT_OP_SQRT:
  case AMBIT_OP_LOG: return CONCAVE;
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ACOS:
  case AMBIT_OP_TANH: return CONCAVE_RIGHT;
  case AMBIT_OP_TAN:
  case AMBIT_OP_ASIN:
  case AMBIT_OP_SINH:
  case LINEARISE_RECIPROCAL: return CONVEX_RIGHT;
  case AMBIT_OP_POWN: return power % 2 ? CONVEX_RIGHT : CONVEX;
  default: return CONVEX; /* EXP, COSH */
  }
}

static int is_wave(uint32_t op) { return op == AMBIT_OP_SIN || op == AMBIT_OP_COS; }

/* does f'' change its sign inside? */
static int is_mixed(const affine_context *c, const linearise_chunk *k, size_t i) {
  switch (k->op) {
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_TAN: return k->flo[i] < 0 && k->fhi[i] > 0;
  default: return shape(c, k->op, k->power) >= CONVEX_RIGHT && k->a[i] < 0 && k->b[i] > 0;
  }
}

/* f'(x) = slope at t or -t (TAN: from the multiple of pi next to the middle) */
static void add_tangent(tangents *g, size_t owner, double t, double from, double to, double end, int convex) {
  size_t n = g->n++;
  g->owner[n] = owner, g->convex[n] = convex;
  g->from[n] = smaller(from, end), g->to[n] = larger(to, end);
  g->t[n] = clipped(t, from, to);
}

/* the zero of TAN in or next to [a, b], enclosed; the number of turns is exact below FAR_OUT */
static range zero_of(const linearise_chunk *k, size_t i) {
  if (k->op != AMBIT_OP_TAN) return (range) { 0, 0 };
  double turns = round((0.5 * k->a[i] + 0.5 * k->b[i]) / 0x1.921fb54442d18p+1);
  if (turns < 0) return (range) { -(-turns * 0x1.921fb54442d19p+1), turns * 0x1.921fb54442d18p+1 };
  return (range) { -(-turns * 0x1.921fb54442d18p+1), turns * 0x1.921fb54442d19p+1 };
}

static void find_tangents(const affine_context *c, const linearise_chunk *k, const double *touch, tangents *g) {
  int form = shape(c, k->op, k->power), right = form == CONVEX_RIGHT;
  g->n = 0;
  for (size_t i = 0; i < k->n; i++) {
    double a = k->a[i], b = k->b[i], t = touch[i];
    if (form == CONVEX || form == CONCAVE) {
      int mirrored = k->op == AMBIT_OP_POWN && (b <= 0 || (a < 0 && k->slope[i] < 0));
      add_tangent(g, i, mirrored ? -t : t, a, b, a, form == CONVEX);
      continue;
    }
    range zero = zero_of(k, i);
    int tangent = k->op == AMBIT_OP_TAN, above = tangent ? k->fhi[i] > 0 : b > 0,
        below = tangent ? k->flo[i] < 0 : a < 0;
    if (above) add_tangent(g, i, zero.hi + t, larger(a, smaller(zero.hi, b)), b, below ? larger(a, zero.lo) : a, right);
    if (below)
      add_tangent(g, i, zero.lo - t, a, smaller(b, larger(zero.lo, a)), above ? smaller(b, zero.hi) : b, !right);
  }
}

/* TAN: the sign of f at t says in which piece t is; what it does not say is not used */
static int is_misplaced(const linearise_chunk *k, const tangents *g, size_t j, double flo, double fhi) {
  return k->op == AMBIT_OP_TAN && !(g->convex[j] ? flo >= 0 : fhi <= 0);
}

/* how far a line of this slope rises on this length; lengths of 0 may meet infinite slopes */
static double climb(double slope, double length) { return slope > 0 && length > 0 ? slope * length : 0; }

static void use_tangents(const affine_context *c, linearise_chunk *k, const tangents *g) {
  double flo[2 * LINEARISE_CHUNK], fhi[2 * LINEARISE_CHUNK], dlo[2 * LINEARISE_CHUNK], dhi[2 * LINEARISE_CHUNK];
  linearise_values(c, k->op, k->power, g->n, g->t, flo, fhi);
  linearise_slopes(c, k->op, k->power, g->n, g->t, g->t, flo, fhi, dlo, dhi);
  for (size_t j = 0; j < g->n; j++) {
    size_t i = g->owner[j];
    double t = g->t[j], s = k->slope[i], left = t - g->from[j], right = g->to[j] - t;
    /* slope of g at t in [-fall, rise] */
    double rise = dhi[j] - s, fall = s - dlo[j];
    if (is_misplaced(k, g, j, flo[j], fhi[j]))
      k->slope[i] = NAN;
    else if (g->convex[j])
      k->glo[i] = smaller(k->glo[i], -((s * t - flo[j]) + larger(climb(rise, left), climb(fall, right))));
    else
      k->ghi[i] = larger(k->ghi[i], ((-s) * t + fhi[j]) + larger(climb(fall, left), climb(rise, right)));
  }
}

/* f at the ends: of entry i at [i] and [n + i] */
typedef struct ends {
  double x[2 * LINEARISE_CHUNK], lo[2 * LINEARISE_CHUNK], hi[2 * LINEARISE_CHUNK];
} ends;

static void secants(const affine_context *c, linearise_chunk *k, ends *e) {
  size_t n = k->n;
  memcpy(e->x, k->a, n * sizeof *e->x), memcpy(e->x + n, k->b, n * sizeof *e->x);
  linearise_values(c, k->op, k->power, 2 * n, e->x, e->lo, e->hi);
  for (size_t i = 0; i < n; i++) k->slope[i] = (e->lo[n + i] - e->lo[i]) / (k->b[i] - k->a[i]);
}

static void include_ends(linearise_chunk *k, size_t i, const ends *e) {
  include(k, i, k->a[i], e->lo[i], e->hi[i]);
  include(k, i, k->b[i], e->lo[k->n + i], e->hi[k->n + i]);
}

/* better slopes where f has a point of inflection inside; x_j = m + r cos(j pi/3) */
static void inflected(const affine_context *c, linearise_chunk *k, const ends *e) {
  size_t which[LINEARISE_CHUNK], n = 0;
  double low[LINEARISE_CHUNK], high[LINEARISE_CHUNK], flow[LINEARISE_CHUNK], fhigh[LINEARISE_CHUNK],
      unused[LINEARISE_CHUNK];
  for (size_t i = 0; i < k->n; i++) {
    if (!is_mixed(c, k, i)) continue;
    low[n] = 0.75 * k->a[i] + 0.25 * k->b[i], high[n] = 0.25 * k->a[i] + 0.75 * k->b[i];
    which[n++] = i;
  }
  if (n == 0) return;
  linearise_values(c, k->op, k->power, n, low, flow, unused);
  linearise_values(c, k->op, k->power, n, high, fhigh, unused);
  for (size_t j = 0; j < n; j++) {
    size_t i = which[j];
    k->slope[i] = ((e->lo[k->n + i] - e->lo[i]) + (fhigh[j] - flow[j])) / (1.5 * (k->b[i] - k->a[i]));
  }
}

static void chebyshev(const affine_context *c, linearise_chunk *k) {
  double touch[LINEARISE_CHUNK];
  ends e;
  tangents g;
  secants(c, k, &e);
  inflected(c, k, &e);
  for (size_t i = 0; i < k->n; i++) {
    if (is_wave(k->op)) k->slope[i] = smaller(larger(k->slope[i], -1), 1);
    if (k->op == AMBIT_OP_TAN && !(fabs(0.5 * k->a[i] + 0.5 * k->b[i]) < FAR_OUT)) k->slope[i] = NAN; /* zero_of */
    k->glo[i] = INFINITY, k->ghi[i] = -INFINITY;
    include_ends(k, i, &e);
  }
  if (is_wave(k->op)) {
    linearise_waves(c, k);
    return;
  }
  linearise_touch(c, k->op, k->power, k->n, k->slope, touch);
  find_tangents(c, k, touch, &g);
  use_tangents(c, k, &g);
}

static void min_range(const affine_context *c, linearise_chunk *k) {
  double dlo[LINEARISE_CHUNK], dhi[LINEARISE_CHUNK];
  ends e;
  secants(c, k, &e);
  linearise_slopes(c, k->op, k->power, k->n, k->a, k->b, k->flo, k->fhi, dlo, dhi);
  for (size_t i = 0; i < k->n; i++) {
    k->slope[i] = dlo[i] >= 0 ? dlo[i] : dhi[i] <= 0 ? dhi[i] : 0;
    k->glo[i] = INFINITY, k->ghi[i] = -INFINITY;
    if (k->slope[i] == 0) continue; /* also: f is not monotone; below */
    include_ends(k, i, &e);
  }
}

/* is the line better than none? */
static int is_good(const linearise_chunk *k, size_t i) {
  double width = k->ghi[i] - k->glo[i];
  return fabs(k->slope[i]) <= DBL_MAX && k->glo[i] <= k->ghi[i] && width < k->fhi[i] - k->flo[i];
}

/* entry i of k := entry j of from */
static void copy(linearise_chunk *k, size_t i, const linearise_chunk *from, size_t j) {
  k->a[i] = from->a[j], k->b[i] = from->b[j], k->flo[i] = from->flo[j], k->fhi[i] = from->fhi[j];
  k->slope[i] = from->slope[j], k->glo[i] = from->glo[j], k->ghi[i] = from->ghi[j];
}

/* min-range where the other failed: its tangent may have been misplaced */
static void repair(const affine_context *c, linearise_chunk *k) {
  linearise_chunk bad = { .op = k->op, .power = k->power };
  size_t which[LINEARISE_CHUNK], n = 0;
  for (size_t i = 0; i < k->n; i++) {
    if (is_good(k, i)) continue;
    copy(&bad, n, k, i);
    which[n++] = i;
  }
  if (n == 0) return;
  bad.n = n;
  min_range(c, &bad);
  for (size_t j = 0; j < n; j++) copy(k, which[j], &bad, j);
}

void linearise(const affine_context *c, linearise_chunk *k) {
  if (k->n == 0) return;
  if (c->min_range)
    min_range(c, k);
  else
    chebyshev(c, k), repair(c, k);
  for (size_t i = 0; i < k->n; i++)
    if (!is_good(k, i)) k->slope[i] = 0, k->glo[i] = k->flo[i], k->ghi[i] = k->fhi[i];
}
