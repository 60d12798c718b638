/* factor.c -- the elimination from the last row to the first, and the two substitutions. Structural zeros are skipped.
*/
#include "mechanics/factor.h"

static ambit_expr op(const ambit_factor *a, uint32_t code, ambit_expr x, ambit_expr y) {
  return ambit_graph_op(a->g, code, x, y);
}

/* x - y z */
static ambit_expr reduce(const ambit_factor *a, ambit_expr x, ambit_expr y, ambit_expr z) {
  if (y == 0 || z == 0) return x;
  return op(a, AMBIT_OP_SUB, x, op(a, AMBIT_OP_MUL, y, z));
}

static ambit_expr shorten(const ambit_factor *a, ambit_expr before, ambit_expr e) {
  return e == before || a->limit == 0 ? e : ambit_graph_simplify(a->g, e, a->limit);
}

ambit_status ambit_factorise(const ambit_factor *a, ambit_pivot_check check, void *user) {
  size_t n = a->n;
  for (size_t k = n; k-- > 0;) {
    ambit_expr pivot = a->u[k * n + k];
    ambit_status status = check(user, k, pivot);
    if (status != AMBIT_OK) return status;
    for (size_t i = 0; i < k; i++) {
      if (a->u[i * n + k] == 0) continue;
      ambit_expr unit = op(a, AMBIT_OP_DIV, a->u[i * n + k], pivot);
      for (size_t j = 0; j <= i; j++) {
        ambit_expr *left = &a->u[j * n + i];
        *left = shorten(a, *left, reduce(a, *left, unit, a->u[j * n + k]));
      }
    }
    for (size_t i = 0; i < k; i++)
      if (a->u[i * n + k]) a->u[i * n + k] = op(a, AMBIT_OP_DIV, a->u[i * n + k], pivot);
  }
  return AMBIT_OK;
}

/* U y = x from the last; x = D^-1 y; U^T x = x from the first. */
void ambit_factor_solve(const ambit_factor *a, ambit_expr *x) {
  size_t n = a->n;
  for (size_t k = n; k-- > 0;) {
    ambit_expr given = x[k];
    for (size_t i = k + 1; i < n; i++) x[k] = reduce(a, x[k], a->u[k * n + i], x[i]);
    x[k] = shorten(a, given, x[k]);
  }
  for (size_t k = 0; k < n; k++) {
    x[k] = op(a, AMBIT_OP_DIV, x[k], a->u[k * n + k]);
    for (size_t i = 0; i < k; i++) x[k] = reduce(a, x[k], a->u[i * n + k], x[i]);
  }
}
