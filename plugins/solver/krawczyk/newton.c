/* newton.c -- an interval Newton operator over a box X about its midpoint m, preconditioned with C, roughly the inverse
** of the midpoint of J(X).
**
** For x in X and p in P there is a matrix S in J(X) with f(x, p) = f(m, p) + S (x - m), continuous in x (mean value
** theorem, f being continuously differentiable on X for each p). So a root satisfies A (x - m) = -b with A = C S, b = C
** f(m, p).
**   If every matrix in [A] = C J(X) is regular, Z encloses its solutions (solution.c), and m + Z lies in X: exactly one
** root for each p (Moore 1977; Brouwer). Else roots are in X and m + Z, at most one for each p.
**   If not: rows solved for their own unknown narrow X (Hansen & Sengupta 1981).
** Before all that f's ranges by its slopes and signs of slopes are looked at: if one has no 0, there is no root.
*/
#include "krawczyk.h"
#include <ambit/matrix.h>
#include <math.h>
#include <string.h>

#define SHARPENED 12 /* up to this many unknowns, whose Jacobians are worth their time */

/* -- preconditioning */

/* A := C M, its diagonal and what is off it; 0: too large for doubles */
static int set_matrix(krawczyk *k, matrix M) {
  uint32_t n = k->n;
  size_t entries = (size_t)n * n;
  ambit_work_multiply(k->counted);
  k->num->matmul(n, n, n, k->A.lo, k->A.hi, k->C, k->C, M.lo, M.hi);
  for (size_t i = 0; i < entries; i++)
    if (!isfinite(k->A.lo[i]) || !isfinite(k->A.hi[i])) return 0;
  memcpy(k->off.lo, k->A.lo, entries * sizeof(double));
  memcpy(k->off.hi, k->A.hi, entries * sizeof(double));
  for (uint32_t i = 0; i < n; i++) {
    size_t at = (size_t)i * n + i;
    k->diagonal[i] = (span) { k->A.lo[at], k->A.hi[at] };
    k->off.lo[at] = k->off.hi[at] = 0;
  }
  return 1;
}

/* C and A := C J; 0: no inverse */
static int precondition(krawczyk *k) {
  for (size_t i = 0; i < (size_t)k->n * k->n; i++) k->work[i] = 0.5 * k->J.lo[i] + 0.5 * k->J.hi[i];
  return ambit_matrix_invert(k->n, k->work, k->C) && set_matrix(k, k->J);
}

/* A := C H with slopes H inside J: column j over the first j components of the box and the midpoints of the others
** (Hansen 1968). 0: A is as it was. */
static int sharpen(krawczyk *k, const span *x) {
  uint32_t n = k->n;
  if (n < 2 || n > SHARPENED) return 0;
  box_copy(k->m, k->other, k->mid);
  for (uint32_t j = 0; j < n; j++) {
    k->other[j] = x[j];
    if (!krawczyk_matrix(k, &k->jacobian, k->other, k->part)) return 0;
    for (uint32_t i = 0; i < n; i++) {
      size_t at = (size_t)i * n + j;
      k->H.lo[at] = k->part.lo[at], k->H.hi[at] = k->part.hi[at];
    }
  }
  return set_matrix(k, k->H);
}

/* -- the residual */

/* f := f(m, P) and S := df/dp(m, P), if f is smooth in p; 0: f is not defined there */
static int evaluate_middle(krawczyk *k, int smooth) {
  if (!krawczyk_vector(k, k->mid, k->f)) return 0;
  for (uint32_t i = 0; i < k->n; i++) k->blur[i] = k->np ? k->f[i].hi - k->f[i].lo : 0;
  k->has_S = smooth && k->problem.slope && krawczyk_matrix(k, &k->slope, k->mid, k->S);
  return 1;
}

/* b := C f(m, P), also as C f(m, p_mid) + C df/dp(m, P) (P - p_mid), which keeps what the equations' dependence on the
** parameters has in common */
static void set_residual(krawczyk *k) {
  krawczyk_multiply(k, k->b, k->C, k->C, k->n, k->f);
  if (!k->has_S) return;
  box_copy(k->m, k->other, k->mid);
  for (uint32_t i = k->n; i < k->m; i++) {
    double p = box_middle(k->mid[i]);
    k->other[i] = (span) { p, p };
  }
  if (!krawczyk_vector(k, k->other, k->f_mid)) return;
  krawczyk_map(k, AMBIT_OP_SUB, k->p_off, k->mid + k->n, k->other + k->n, k->np);
  ambit_work_multiply(k->counted);
  k->num->matmul(k->n, k->n, k->np, k->CS.lo, k->CS.hi, k->C, k->C, k->S.lo, k->S.hi);
  krawczyk_multiply(k, k->f_mid, k->C, k->C, k->n, k->f_mid);
  krawczyk_multiply(k, k->row, k->CS.lo, k->CS.hi, k->np, k->p_off);
  krawczyk_map(k, AMBIT_OP_ADD, k->row, k->row, k->f_mid, k->n);
  box_meet(k->n, k->b, k->row);
}

/* -- ranges without 0 */

static int has_zero(span f) { return f.lo <= 0 && f.hi >= 0; }

/* the mean value form f(m, P) + J (X - m) of a component has no 0 */
static int is_excluded_by_slopes(krawczyk *k) {
  krawczyk_multiply(k, k->row, k->J.lo, k->J.hi, k->n, k->shift);
  krawczyk_map(k, AMBIT_OP_ADD, k->row, k->row, k->f, k->n);
  for (uint32_t i = 0; i < k->n; i++)
    if (!has_zero(k->row[i])) return 1;
  return 0;
}

/* other := the face of x where f_i is least (side 0) or largest (1): components in which it is monotone are at an end;
** 0: there is none */
static int set_face(krawczyk *k, const span *x, uint32_t i, int side) {
  int monotone = 0;
  for (uint32_t j = 0; j < k->n; j++) {
    double lo = k->J.lo[(size_t)i * k->n + j], hi = k->J.hi[(size_t)i * k->n + j];
    if ((lo < 0 && hi > 0) || !(x[j].lo < x[j].hi)) continue;
    double end = (lo >= 0) == (side == 0) ? x[j].lo : x[j].hi;
    k->other[j] = (span) { end, end };
    monotone = 1;
  }
  return monotone;
}

/* f_i is positive on the face where it is least, or negative where it is largest */
static int is_excluded_by_signs(krawczyk *k, const span *x) {
  for (uint32_t i = 0; i < k->n; i++)
    for (int side = 0; side < 2; side++) {
      box_copy(k->m, k->other, x);
      if (!set_face(k, x, i, side)) break;
      if (!krawczyk_vector(k, k->other, k->f_mid)) continue;
      if (side == 0 ? k->f_mid[i].lo > 0 : k->f_mid[i].hi < 0) return 1;
    }
  return 0;
}

/* -- the operator */

/* x := x and m + z */
static int meet_solution(const krawczyk *k, span *x) {
  krawczyk_map(k, AMBIT_OP_ADD, k->row, k->mid, k->z, k->n);
  return box_meet(k->n, x, k->row);
}

/* m + z lies in x; z and x := what rows leave of it */
static enum verdict narrow_unique(krawczyk *k, span *x) {
  if (k->options.operation == OPERATOR_HANSEN_SENGUPTA && !krawczyk_sweep(k, k->z)) return VERDICT_NONE;
  return meet_solution(k, x) ? VERDICT_UNIQUE : VERDICT_NONE;
}

static int has_rows(const krawczyk *k) {
  return k->options.operation == OPERATOR_AUTO || k->options.operation == OPERATOR_HANSEN_SENGUPTA;
}

/* Sharper slopes serve existence; that the root is alone was seen with the Jacobian. */
static enum verdict regular_case(krawczyk *k, span *x) {
  if (!krawczyk_solve(k)) return VERDICT_NONE;
  if (!box_is_inside(k->n, k->estimate, x) && sharpen(k, x) && krawczyk_is_regular(k) && !krawczyk_solve(k))
    return VERDICT_NONE;
  if (box_is_inside(k->n, k->estimate, x)) return narrow_unique(k, x);
  if (!box_meet(k->n, k->z, k->shift)) return VERDICT_NONE;
  if (has_rows(k) && !krawczyk_sweep(k, k->z)) return VERDICT_NONE;
  return meet_solution(k, x) ? VERDICT_AT_MOST : VERDICT_NONE;
}

static enum verdict general_case(krawczyk *k, span *x) {
  if (k->options.operation == OPERATOR_NEWTON) return VERDICT_UNKNOWN;
  if (k->options.operation == OPERATOR_KRAWCZYK) {
    krawczyk_solve(k);
    if (!box_meet(k->n, k->z, k->shift)) return VERDICT_NONE;
  } else {
    box_copy(k->n, k->z, k->shift);
    if (!krawczyk_sweep(k, k->z)) return VERDICT_NONE;
  }
  return meet_solution(k, x) ? VERDICT_UNKNOWN : VERDICT_NONE;
}

enum verdict krawczyk_newton(krawczyk *k, span *x) {
  k->has_J = k->has_S = 0;
  k->gap = (gap) { 0, 0, 0 };
  if (!box_is_bounded(k->n, x)) return VERDICT_UNKNOWN;
  uint32_t flags = krawczyk_inspect(k, x);
  if (flags & ~AMBIT_F_KINK_ELSEWHERE) return VERDICT_UNKNOWN;
  k->has_J = krawczyk_matrix(k, &k->jacobian, x, k->J);
  if (!k->has_J) return VERDICT_UNKNOWN;
  box_copy(k->m, k->mid, x);
  for (uint32_t i = 0; i < k->n; i++) {
    double m = box_middle(x[i]);
    k->mid[i] = (span) { m, m };
  }
  krawczyk_map(k, AMBIT_OP_SUB, k->shift, x, k->mid, k->n);
  if (!evaluate_middle(k, flags == 0)) return k->has_J = 0, VERDICT_UNKNOWN;
  if (is_excluded_by_slopes(k)) return VERDICT_NONE;
  int invertible = precondition(k);
  if (invertible) set_residual(k);
  if (invertible && krawczyk_is_regular(k)) return regular_case(k, x);
  if (is_excluded_by_signs(k, x)) return VERDICT_NONE;
  return invertible ? general_case(k, x) : VERDICT_UNKNOWN;
}
