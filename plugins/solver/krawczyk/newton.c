/* newton.c -- the interval Newton operator over a box X about its midpoint m, preconditioned with C, roughly the
** inverse of the midpoint of J(X).
**
** For x in X and p in P there is a matrix S in J(X) with f(x, p) = f(m, p) + S (x - m), continuous in x (mean value
** theorem, f being continuously differentiable on X). So a root satisfies A (x - m) = -b with A = C S, b = C f(m, p).
**   If every matrix in [A] = C J(X) is regular, Z encloses all its solutions, and m + Z lies in X: exactly one root for
** each p (Moore 1977; Brouwer's theorem for x -> m - A(x)^-1 b). Else roots are in X and m + Z, at most one for each p.
**   If not: row i solved for its own unknown narrows X (Hansen & Sengupta 1981).
*/
#include "krawczyk.h"
#include <math.h>
#include <string.h>

#define SWEEPS 8
#define SHARPENED 12 /* up to this many unknowns, whose Jacobians are worth their time */
#define SLOW 0.9     /* less narrowing than this is not worth another sweep */

/* -- evaluation */

static void set_input(const krawczyk *k, ambit_lane *lane, uint32_t in, span x) {
  int32_t variable = x.lo < x.hi ? (int32_t)in : -1;
  lane->arithmetic->set(lane->ctx, ambit_lane_at(lane, lane->tape->nconst + in), 1, &x.lo, &x.hi, variable);
  (void)k;
}

/* outputs at (x, p); 0: not defined everywhere, or not bounded */
static int evaluate(
    const krawczyk *k, ambit_lane *lane, const span *x, const span *p, double *lo, double *hi, ptrdiff_t stride) {
  for (uint32_t i = 0; i < k->n; i++) set_input(k, lane, i, x[i]);
  for (uint32_t i = 0; i < k->np; i++) set_input(k, lane, k->n + i, p[i]);
  if (ambit_lane_run(lane) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY)) return 0;
  for (uint32_t i = 0; i < lane->tape->nout; i++) {
    double *l = lo + i * stride, *h = hi + i * stride;
    ambit_lane_get(lane, i, l, h);
    if (!(*l <= *h) || !isfinite(*l) || !isfinite(*h)) return 0;
  }
  return 1;
}

static int evaluate_matrix(const krawczyk *k, ambit_lane *lane, const span *x, matrix M) {
  return evaluate(k, lane, x, k->p, M.lo, M.hi, 1);
}

static int evaluate_vector(krawczyk *k, const span *x, const span *p, span *f) {
  return evaluate(k, &k->rhs, x, p, &f->lo, &f->hi, 2);
}

/* f is defined and continuous over the whole box */
static int is_smooth(const krawczyk *k, const span *x) {
  for (uint32_t i = 0; i < k->n; i++) k->in_lo[i] = x[i].lo, k->in_hi[i] = x[i].hi;
  for (uint32_t i = 0; i < k->np; i++) k->in_lo[k->n + i] = k->p[i].lo, k->in_hi[k->n + i] = k->p[i].hi;
  return k->contract->inspect(k->shape, k->in_lo, k->in_hi) == 0;
}

/* -- linear algebra, all of it by ambit.num/1 */

static void map(const krawczyk *k, uint32_t op, span *r, const span *a, const span *b, uint32_t n) {
  k->num->map(op, n, &r->lo, &a->lo, b ? &b->lo : NULL, 0);
}

/* r [n] := M v for a matrix of `cols` columns */
static void multiply(const krawczyk *k, span *r, const double *Mlo, const double *Mhi, uint32_t cols, const span *v) {
  for (uint32_t j = 0; j < cols; j++) k->in.lo[j] = v[j].lo, k->in.hi[j] = v[j].hi;
  k->num->matmul(k->n, cols, 1, k->out.lo, k->out.hi, Mlo, Mhi, k->in.lo, k->in.hi);
  for (uint32_t i = 0; i < k->n; i++) r[i] = (span) { k->out.lo[i], k->out.hi[i] };
}

/* A := C M, its diagonal and what is off it */
static void set_matrix(krawczyk *k, matrix M) {
  uint32_t n = k->n;
  size_t entries = (size_t)n * n;
  k->num->matmul(n, n, n, k->A.lo, k->A.hi, k->C, k->C, M.lo, M.hi);
  memcpy(k->off.lo, k->A.lo, entries * sizeof(double));
  memcpy(k->off.hi, k->A.hi, entries * sizeof(double));
  for (uint32_t i = 0; i < n; i++) {
    size_t at = (size_t)i * n + i;
    k->diagonal[i] = (span) { k->A.lo[at], k->A.hi[at] };
    k->off.lo[at] = k->off.hi[at] = 0;
  }
}

/* C and A := C J; 0: no inverse */
static int precondition(krawczyk *k) {
  for (size_t i = 0; i < (size_t)k->n * k->n; i++) k->work[i] = 0.5 * k->J.lo[i] + 0.5 * k->J.hi[i];
  if (!krawczyk_invert(k->n, k->work, k->C)) return 0;
  set_matrix(k, k->J);
  return 1;
}

/* A := C H with slopes H inside J: column j over the first j components of the box and the midpoints of the others
** (Hansen 1968). 0: A is as it was. */
static int sharpen(krawczyk *k, const span *x) {
  uint32_t n = k->n;
  if (n < 2 || n > SHARPENED) return 0;
  box_copy(n, k->f, k->mid);
  for (uint32_t j = 0; j < n; j++) {
    k->f[j] = x[j];
    if (!evaluate_matrix(k, &k->jacobian, k->f, k->J)) return 0;
    for (uint32_t i = 0; i < n; i++) {
      size_t at = (size_t)i * n + j;
      k->H.lo[at] = k->J.lo[at], k->H.hi[at] = k->J.hi[at];
    }
  }
  set_matrix(k, k->H);
  return 1;
}

/* b := C f(m, P), also as C f(m, p_mid) + C df/dp(m, P) (P - p_mid), which keeps what the equations' dependence on the
** parameters has in common */
static int evaluate_residual(krawczyk *k) {
  if (!evaluate_vector(k, k->mid, k->p, k->f)) return 0;
  multiply(k, k->b, k->C, k->C, k->n, k->f);
  if (!k->problem.slope || !evaluate_vector(k, k->mid, k->p_mid, k->f_mid)) return 1;
  if (!evaluate_matrix(k, &k->slope, k->mid, k->S)) return 1;
  k->num->matmul(k->n, k->n, k->np, k->CS.lo, k->CS.hi, k->C, k->C, k->S.lo, k->S.hi);
  multiply(k, k->f_mid, k->C, k->C, k->n, k->f_mid);
  multiply(k, k->row, k->CS.lo, k->CS.hi, k->np, k->p_off);
  map(k, AMBIT_OP_ADD, k->row, k->row, k->f_mid, k->n);
  box_meet(k->n, k->b, k->row);
  return 1;
}

/* -- the solution of A z = -b */

/* y := y and -c / a; 0: empty. Both parts of a quotient by an interval around 0 count. */
static int meet_quotient(const krawczyk *k, span *y, span c, span a) {
  span part[2] = { { a.lo, a.lo < 0 && a.hi > 0 ? 0 : a.hi }, { a.lo < 0 && a.hi > 0 ? 0 : a.lo, a.hi } };
  span sum = { INFINITY, -INFINITY };
  for (int i = 0; i < 2; i++) {
    span q;
    k->num->map(AMBIT_OP_DIV, 1, &q.lo, &c.lo, &part[i].lo, 0);
    q = (span) { -q.hi, -q.lo };
    if (q.lo <= q.hi && box_meet(1, &q, y)) box_join(1, &sum, &q);
  }
  if (c.lo <= 0 && c.hi >= 0 && a.lo <= 0 && a.hi >= 0) return 1;
  *y = sum;
  return sum.lo <= sum.hi;
}

/* narrows z by row i solved for z[i], all rows at once; 0: no solution in z */
static int sweep(const krawczyk *k, span *z) {
  multiply(k, k->row, k->off.lo, k->off.hi, k->n, z);
  map(k, AMBIT_OP_ADD, k->row, k->row, k->b, k->n);
  for (uint32_t i = 0; i < k->n; i++)
    if (!meet_quotient(k, &z[i], k->row[i], k->diagonal[i])) return 0;
  return 1;
}

static int narrow_solution(const krawczyk *k, span *z) {
  for (uint32_t i = 0; i < SWEEPS; i++) {
    box_copy(k->n, k->f, z); /* f has been used */
    if (!sweep(k, z)) return 0;
    if (box_shrinking(k->n, z, k->f) > SLOW) return 1;
  }
  return 1;
}

/* x := x and m + z */
static int meet_solution(const krawczyk *k, span *x) {
  map(k, AMBIT_OP_ADD, k->row, k->mid, k->z, k->n);
  return box_meet(k->n, x, k->row);
}

/* -- the operator */

/* z and estimate := all solutions, A being regular; 0: there are none */
static int solve(krawczyk *k) {
  krawczyk_bound_solution(k, k->z);
  if (!narrow_solution(k, k->z)) return 0;
  map(k, AMBIT_OP_ADD, k->estimate, k->mid, k->z, k->n);
  return 1;
}

/* Sharper slopes serve existence; that the root is alone was seen with the Jacobian. */
static enum verdict regular_case(krawczyk *k, span *x) {
  if (!solve(k)) return VERDICT_NONE;
  if (!box_is_inside(k->n, k->estimate, x) && sharpen(k, x) && krawczyk_is_regular(k) && !solve(k)) return VERDICT_NONE;
  if (box_is_inside(k->n, k->estimate, x)) {
    box_copy(k->n, x, k->estimate);
    return VERDICT_UNIQUE;
  }
  if (!box_meet(k->n, k->z, k->shift) || !narrow_solution(k, k->z)) return VERDICT_NONE;
  return meet_solution(k, x) ? VERDICT_AT_MOST : VERDICT_NONE;
}

static enum verdict general_case(krawczyk *k, span *x) {
  box_copy(k->n, k->z, k->shift);
  if (!narrow_solution(k, k->z)) return VERDICT_NONE;
  return meet_solution(k, x) ? VERDICT_UNKNOWN : VERDICT_NONE;
}

enum verdict krawczyk_newton(krawczyk *k, span *x) {
  if (!box_is_bounded(k->n, x) || !is_smooth(k, x)) return VERDICT_UNKNOWN;
  if (!evaluate_matrix(k, &k->jacobian, x, k->J) || !precondition(k)) return VERDICT_UNKNOWN;
  for (uint32_t i = 0; i < k->n; i++) {
    double m = fmin(fmax(0.5 * x[i].lo + 0.5 * x[i].hi, x[i].lo), x[i].hi);
    k->mid[i] = (span) { m, m };
  }
  if (!evaluate_residual(k)) return VERDICT_UNKNOWN;
  map(k, AMBIT_OP_SUB, k->shift, x, k->mid, k->n);
  return krawczyk_is_regular(k) ? regular_case(k, x) : general_case(k, x);
}
