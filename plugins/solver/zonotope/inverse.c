/* inverse.c -- forms near the rows of -W_a^-1, to first order: plain arithmetic that proves nothing (sweep.c does). The
** matrix is eliminated in the order of pivots without exchange: from the tips of a mechanism to its base.
*/
#include "proof.h"

static double *entry(const zono *z, const sweeps *w, double *matrix, uint32_t i, uint32_t j) {
  return proof_form(w, matrix, (size_t)i * z->na + j);
}

/* 1 / a to first order; twice more by Newton's method where forms are polynomials in time */
static int reciprocal(const forms *f, double *to, const double *a, double *left) {
  double c = 1 / a[0];
  if (!isfinite(c)) return 0;
  form_clear(f, to);
  to[0] = c;
  for (uint32_t v = 1; v <= f->n; v++) to[v] = -c * c * a[v];
  to[4 + f->n] = 1;
  form_close(f, to);
  for (int turn = 0; turn < 2 && f->powers; turn++) {
    double *next = left + f->stride;
    form_constant(f, left, 1), form_close(f, left);
    form_product(f, left, -1, a, to), form_close(f, left);
    form_clear(f, next), form_add(f, next, 1, to), form_product(f, next, 1, to, left), form_close(f, next);
    memcpy(to, next, f->stride * sizeof *to);
    *form_rad(f, to) = 0;
  }
  return 1;
}

/* dR/da -> L U, to first order */
static int factor(zono *z, const sweeps *w) {
  const forms *f = &w->forms;
  uint32_t n = z->na;
  for (uint32_t p = 0; p < n; p++) {
    double *inverse = proof_form(w, w->pivot, p), *l = proof_form(w, w->scratch, 0);
    if (!reciprocal(f, inverse, entry(z, w, w->matrix, p, p), proof_form(w, w->scratch, 1)))
      return z->why = WHY_PIVOT, z->blamed = z->proof->order[p], 0;
    for (uint32_t i = p + 1; i < n; i++) {
      double *left = entry(z, w, w->matrix, i, p);
      if (!form_seen(f, left)) continue;
      form_clear(f, l), form_product(f, l, 1, left, inverse), form_close(f, l);
      memcpy(left, l, f->stride * sizeof *l);
      for (uint32_t j = p + 1; j < n; j++) {
        const double *up = entry(z, w, w->matrix, p, j);
        double *to = entry(z, w, w->matrix, i, j);
        if (form_seen(f, up)) form_product(f, to, -1, left, up), form_close(f, to);
      }
    }
  }
  return 1;
}

/* x L U = b, b in x [na forms, in the order of elimination] */
static void solve_left(const zono *z, const sweeps *w, double *x) {
  const forms *f = &w->forms;
  double *y = proof_form(w, w->scratch, 0);
  uint32_t n = z->na;
  for (uint32_t j = 0; j < n; j++) {
    double *xj = proof_form(w, x, j);
    for (uint32_t i = 0; i < j; i++)
      if (form_seen(f, proof_form(w, x, i)) && form_seen(f, entry(z, w, w->matrix, i, j)))
        form_product(f, xj, -1, proof_form(w, x, i), entry(z, w, w->matrix, i, j));
    if (!form_seen(f, xj)) continue;
    form_close(f, xj);
    form_clear(f, y), form_product(f, y, 1, xj, proof_form(w, w->pivot, j)), form_close(f, y);
    memcpy(xj, y, f->stride * sizeof *y);
  }
  for (uint32_t j = n; j-- > 0;) {
    double *xj = proof_form(w, x, j);
    for (uint32_t i = j + 1; i < n; i++)
      if (form_seen(f, proof_form(w, x, i)) && form_seen(f, entry(z, w, w->matrix, i, j)))
        form_product(f, xj, -1, proof_form(w, x, i), entry(z, w, w->matrix, i, j));
    if (form_seen(f, xj)) form_close(f, xj);
  }
}

/* row k of lambda: -(row of W_a^-1 for unknown k), by place in the order of elimination */
static void find_lambda(const zono *z, const sweeps *w) {
  for (uint32_t p = 0; p < z->na; p++) {
    double *row = entry(z, w, w->lambda, z->proof->order[p], 0), *one = proof_form(w, row, p);
    memset(row, 0, (size_t)z->na * w->forms.stride * sizeof(double));
    form_constant(&w->forms, one, -1);
    form_close(&w->forms, one);
    solve_left(z, w, row);
  }
}

/* no radii: seeds are what they are */
static void strip(const zono *z, const sweeps *w, double *x) {
  for (size_t n = 0; n < (size_t)z->na * z->na; n++) {
    double *form = proof_form(w, x, n);
    int seen = form_seen(&w->forms, form);
    *form_rad(&w->forms, form) = 0;
    form[3 + w->forms.n] = 0;
    if (seen) form_close(&w->forms, form);
    *form_rad(&w->forms, form) = 0;
  }
}

int inverse_find(zono *z, const sweeps *w) {
  strip(z, w, w->matrix);
  if (!factor(z, w)) return 0;
  find_lambda(z, w);
  strip(z, w, w->lambda);
  return 1;
}
