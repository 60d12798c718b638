/* sweep.c -- coefficients of the error equation, by reverse sweeps in linear forms.
**
** 0 = W_x z + W_a alpha + sum_j W_j theta_j + V_R,  W the adjoints of the equations R. One sweep from each equation,
** through slots that depend on a only, gives W_a; its factors (eliminated in the order of pivots, no exchange) give the
** rows of -W_a^-1. A sweep that is seeded with such a row on all equations, and with 1 on an x'_i, gives the
** coefficients of all lumps and of z in this target: what cancels between equations cancels in the sweep.
*/
#include "proof.h"

static double *adjoint(const sweeps *w, uint32_t slot) { return proof_form(w, w->adjoint, slot); }
static double *entry(const zono *z, const sweeps *w, double *matrix, uint32_t i, uint32_t j) {
  return proof_form(w, matrix, (size_t)i * z->na + j);
}

/* -- memory */

static int doubles(const ambit_host *h, size_t n, double **to) {
  *to = h->alloc(h, (n ? n : 1) * sizeof(double));
  return *to != NULL;
}

int sweep_open(zono *z, sweeps *w, uint32_t sigmas) {
  const ambit_host *h = z->host;
  w->forms = forms_of(sigmas);
  size_t f = w->forms.stride, na = z->na;
  size_t slopes = z->proof->nslope;
  return doubles(h, f * z->nslot, &w->value) && doubles(h, f * slopes, &w->slope) &&
         doubles(h, f * z->nslot, &w->adjoint) && doubles(h, f * na * na, &w->matrix) &&
         doubles(h, f * na, &w->pivot) && doubles(h, f * na * na, &w->lambda) && doubles(h, f * (na + 4), &w->scratch);
}

/* -- one sweep */

/* to the operands of instruction i from its closed adjoint; AMBIT_NO_SLOT: no second operand */
static void pass(const zono *z, const sweeps *w, uint32_t i, int inner) {
  const ambit_tape *t = z->program.tape;
  const forms *f = &w->forms;
  uint32_t op = t->op[i], dst = t->dst[i], sa = t->a[i], sb = t->b[i];
  const double *x = adjoint(w, dst), *va = proof_form(w, w->value, sa), *vb = proof_form(w, w->value, sb);
  const double *slope =
      z->proof->slope_at[dst] == AMBIT_NO_SLOT ? NULL : proof_form(w, w->slope, z->proof->slope_at[dst]);
  int to_a = !inner || z->program.level[sa], to_b = !inner || z->program.level[sb];
  double *a = adjoint(w, sa), *b = adjoint(w, sb);
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
    if (to_a) form_add(f, a, 1, x);
    if (to_b) form_add(f, b, op == AMBIT_OP_ADD ? 1 : -1, x);
    return;
  case AMBIT_OP_NEG: form_add(f, a, -1, x); return;
  case AMBIT_OP_MUL:
    if (to_a) form_product(f, a, 1, x, vb);
    if (to_b) form_product(f, b, 1, x, va);
    return;
  case AMBIT_OP_SQR: form_product(f, a, 2, x, va); return;
  case AMBIT_OP_ABS: form_add(f, a, z->branch[i], x); return;
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: form_add(f, z->branch[i] > 0 ? a : b, 1, x); return;
  case AMBIT_OP_COS: form_product(f, a, -1, x, slope); return;
  case AMBIT_OP_DIV:
  case AMBIT_OP_ATAN2:
    if (to_a) form_product(f, a, 1, x, slope);
    if (to_b) form_product(f, b, 1, x, slope + f->stride);
    return;
  default: form_product(f, a, 1, x, slope);
  }
}

/* inner: only through slots that depend on a */
static void sweep_back(const zono *z, const sweeps *w, int inner) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t i = t->ninstr; i-- > 0;) {
    double *x = adjoint(w, t->dst[i]);
    if (!form_seen(&w->forms, x) || (inner && !z->program.level[t->dst[i]])) continue;
    form_close(&w->forms, x);
    pass(z, w, i, inner);
  }
  for (uint32_t j = 0; j < t->nconst + t->nin; j++) {
    double *x = adjoint(w, j);
    if (form_seen(&w->forms, x)) form_close(&w->forms, x);
  }
}

static void clear(const zono *z, const sweeps *w) {
  memset(adjoint(w, 0), 0, (size_t)z->nslot * w->forms.stride * sizeof(double));
}

static void seed_one(const sweeps *w, uint32_t slot) {
  double *one = proof_form(w, w->scratch, 0);
  form_constant(&w->forms, one, 1);
  form_close(&w->forms, one);
  form_add(&w->forms, adjoint(w, slot), 1, one);
}

/* -- the equations */

static void fill_matrix(const zono *z, const sweeps *w) {
  for (uint32_t r = 0; r < z->na; r++) {
    clear(z, w);
    seed_one(w, slot_out(z)[z->nx + z->proof->order[r]]);
    sweep_back(z, w, 1);
    for (uint32_t c = 0; c < z->na; c++)
      memcpy(entry(z, w, w->matrix, r, c), adjoint(w, slot_a(z, z->proof->order[c])), w->forms.stride * sizeof(double));
  }
}

static int factor(zono *z, const sweeps *w) {
  const forms *f = &w->forms;
  uint32_t n = z->na;
  for (uint32_t p = 0; p < n; p++) {
    double *inverse = proof_form(w, w->pivot, p), *l = proof_form(w, w->scratch, 0);
    if (!form_inverse(f, inverse, entry(z, w, w->matrix, p, p), 0))
      return z->why = WHY_PIVOT, z->culprit = z->proof->order[p], 0;
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

/* -- targets */

/* seeds of target n on the equations, by place: a row of lambda, or sum_k F_a,k lambda_kq for an x'_i */
static double *find_seeds(const zono *z, const sweeps *w, uint32_t n) {
  const forms *f = &w->forms;
  double *seeds = proof_form(w, w->scratch, 4);
  if (n < z->na) {
    memcpy(seeds, entry(z, w, w->lambda, n, 0), (size_t)z->na * f->stride * sizeof(double));
    return seeds;
  }
  clear(z, w);
  seed_one(w, slot_out(z)[z->proof->target_out[n - z->na]]);
  if (z->na) sweep_back(z, w, 1);
  for (uint32_t q = 0; q < z->na; q++) {
    double *to = proof_form(w, seeds, q);
    form_clear(f, to);
    for (uint32_t k = 0; k < z->na; k++) {
      const double *by = adjoint(w, slot_a(z, k)), *row = entry(z, w, w->lambda, k, q);
      if (form_seen(f, by) && form_seen(f, row)) form_product(f, to, 1, by, row);
    }
    if (form_seen(f, to)) form_close(f, to);
  }
  return seeds;
}

static double varies(const sweeps *w, const double *x) {
  return form_seen(&w->forms, x) ? form_moving(&w->forms, x) * ABOVE + LEAST : 0;
}

/* target n: C [nslot] and L [na], by equation, are the centres, dC and dL (or NULL) the half widths */
static void sweep_target(const zono *z, const sweeps *w, uint32_t n, double *C, double *dC, double *L, double *dL) {
  const forms *f = &w->forms;
  double *seeds = find_seeds(z, w, n);
  clear(z, w);
  if (n >= z->na) seed_one(w, slot_out(z)[z->proof->target_out[n - z->na]]);
  for (uint32_t q = 0; q < z->na; q++) {
    const double *x = proof_form(w, seeds, q);
    uint32_t equation = z->proof->order[q];
    L[equation] = x[0];
    if (dL) dL[equation] = varies(w, x);
    if (form_seen(f, x)) form_add(f, adjoint(w, slot_out(z)[z->nx + equation]), 1, x);
  }
  sweep_back(z, w, 0);
  for (uint32_t j = 0; j < z->nslot; j++) {
    const double *x = adjoint(w, j);
    C[j] = x[0];
    if (dC) dC[j] = varies(w, x);
  }
}

static int sweep(zono *z, const sweeps *w, double h, double *C, double *dC, double *L, double *dL) {
  if (!slope_forms(z, w, h)) return 0;
  fill_matrix(z, w);
  if (!factor(z, w)) return 0;
  find_lambda(z, w);
  for (uint32_t n = 0; n < z->proof->ntarget; n++)
    sweep_target(z, w, n, C + (size_t)n * z->nslot, dC ? dC + (size_t)n * z->nslot : NULL, L + (size_t)n * z->na,
        dL ? dL + (size_t)n * z->na : NULL);
  return 1;
}

/* -- results */

/* J and dJ of x'_i */
static void read_slope(zono *z, uint32_t i) {
  proof *p = z->proof;
  double *J = p->J + (size_t)i * z->nx, *dJ = p->dJ + (size_t)i * z->nx;
  memset(J, 0, z->nx * sizeof *J), memset(dJ, 0, z->nx * sizeof *dJ);
  if (p->link[i] == LINK_STATE) {
    J[p->link_to[i]] = 1;
    return;
  }
  size_t at = (size_t)p->link_to[i] * z->nslot + slot_x(z, 0);
  memcpy(J, p->C + at, z->nx * sizeof *J);
  memcpy(dJ, p->dC + at, z->nx * sizeof *dJ);
}

int sweep_coefficients(zono *z) {
  proof *p = z->proof;
  if (!sweep(z, &p->forms, z->h, p->C, p->dC, p->L, p->dL)) return 0;
  for (uint32_t i = 0; i < z->nx; i++) read_slope(z, i);
  return 1;
}

int sweep_weights(zono *z) { return sweep(z, &z->proof->points, 0, z->proof->weight, NULL, z->proof->weight_L, NULL); }
