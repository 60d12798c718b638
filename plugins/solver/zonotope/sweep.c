/* sweep.c -- coefficients of the error equation, by reverse sweeps in linear forms.
**
** 0 = W_x z + W_a alpha + sum_j W_j theta_j + V_R, W the adjoints of the equations R. inverse.c finds forms near the
** rows of -W_a^-1. A sweep that is seeded with such a row on all equations, and with 1 on an x'_i, gives coefficients C
** of all lumps and of z in this target: what cancels between equations cancels in the sweep. What it leaves at the
** unknowns a is by how much the row fails, rho; the true coefficients are C + rho C_a (close_rows), C_a those of the
** unknowns.
*/
#include "change.h"
#include "depend.h"
#include "kink.h"
#include "proof.h"
#include "residual.h"

#define TURNS 12
#define SQUARES 6
#define MOST_RHO 0.9
#define GOOD_RHO 0.1 /* above it a shorter step is tried, */
#define GAIN 0.7     /* and again as long as half of the step makes rho less than this share; */
#define PATIENCE 20  /* if not, not for so many steps */

static double *adjoint(const sweeps *w, uint32_t slot) { return proof_form(w, w->adjoint, slot); }
static double *entry(const zono *z, const sweeps *w, double *matrix, uint32_t i, uint32_t j) {
  return proof_form(w, matrix, (size_t)i * z->na + j);
}

/* -- memory */

static int doubles(const ambit_host *h, size_t n, double **to) {
  *to = h->alloc(h, (n ? n : 1) * sizeof(double));
  return *to != NULL;
}

int sweep_open(zono *z, sweeps *w, uint32_t sigmas, int powers) {
  const ambit_host *h = z->host;
  w->forms = forms_of(sigmas, powers);
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
  double *a = adjoint(w, sa), *b = adjoint(w, sb), share_a, share_b;
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
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX:
    kink_shares(z, i, &share_a, &share_b);
    if (has_twin(z, i)) {
      share_a = share_b = 1;
      form_add(f, adjoint(w, t->dst[z->kinks->of[i].twin]), -1, x);
    }
    if (to_a && share_a != 0) form_add(f, a, share_a, x);
    if (to_b && share_b != 0) form_add(f, b, share_b, x);
    return;
  case AMBIT_OP_TANH:
    if (is_line(z, i))
      form_add(f, a, z->kinks->of[i].slope, x);
    else
      form_product(f, a, 1, x, slope);
    return;
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

/* dR/da, in the order of elimination; only centres and linear parts are used */
static void fill_matrix(const zono *z, const sweeps *w) {
  for (uint32_t r = 0; r < z->na; r++) {
    clear(z, w);
    seed_one(w, slot_out(z)[z->nx + z->proof->order[r]]);
    sweep_back(z, w, 1);
    for (uint32_t c = 0; c < z->na; c++)
      memcpy(entry(z, w, w->matrix, r, c), adjoint(w, slot_a(z, z->proof->order[c])), w->forms.stride * sizeof(double));
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
    if (form_seen(f, to)) form_close(f, to), *form_rad(f, to) = 0; /* any function near it will do */
  }
  return seeds;
}

static double varies(const sweeps *w, const double *x) {
  return form_seen(&w->forms, x) ? form_moving(&w->forms, x) * ABOVE + LEAST : 0;
}

/* coefficients of targets: centres and (or NULL) half widths */
typedef struct coefficients {
  double *C, *dC, *L, *dL, *rho;
} coefficients;

/* what each datum makes of the coefficients of the states */
static void keep_slopes(const zono *z, const sweeps *w, uint32_t n) {
  if (!z->proof->change->known) return;
  for (uint32_t l = 0; l < z->nx; l++) {
    const double *x = adjoint(w, slot_x(z, l));
    double *to = z->proof->change->slope + ((size_t)n * z->nx + l) * z->m;
    if (form_seen(&w->forms, x))
      memcpy(to, x + 1, z->m * sizeof *to);
    else
      memset(to, 0, z->m * sizeof *to);
  }
}

/* target n: C [nslot] and L [na], by equation, and rho [na], by unknown */
static void sweep_target(const zono *z, const sweeps *w, uint32_t n, const coefficients *k) {
  const forms *f = &w->forms;
  size_t at = (size_t)n * z->nslot, row = (size_t)n * z->na;
  double *seeds = find_seeds(z, w, n);
  clear(z, w);
  if (n >= z->na) seed_one(w, slot_out(z)[z->proof->target_out[n - z->na]]);
  for (uint32_t q = 0; q < z->na; q++) {
    double *x = proof_form(w, seeds, q);
    uint32_t equation = z->proof->order[q];
    k->L[row + equation] = x[0];
    if (k->dL) k->dL[row + equation] = varies(w, x);
    if (form_seen(f, x)) form_add(f, adjoint(w, slot_out(z)[z->nx + equation]), 1, x);
  }
  sweep_back(z, w, 0);
  for (uint32_t j = 0; j < z->nslot; j++) {
    const double *x = adjoint(w, j);
    k->C[at + j] = x[0];
    if (k->dC) k->dC[at + j] = varies(w, x);
  }
  if (k->dC) keep_slopes(z, w, n);
  for (uint32_t c = 0; k->rho && c < z->na; c++) {
    const double *x = adjoint(w, slot_a(z, c));
    k->rho[row + c] = (fabs(x[0] + (c == n)) + form_moving(f, x)) * ABOVE + 2 * UNIT;
  }
}

static int sweep(zono *z, const sweeps *w, double h, const coefficients *k) {
  if (!slope_forms(z, w, h)) return 0;
  ambit_work *counted = z->shape.counted;
  if (counted) counted->operations += (uint64_t)z->proof->ntarget * z->program.tape->ninstr * (w->forms.n / 8 + 1);
  fill_matrix(z, w);
  if (!inverse_find(z, w)) return 0;
  for (uint32_t n = 0; n < z->proof->ntarget; n++) sweep_target(z, w, n, k);
  return 1;
}

/* adjoints of the equations themselves */
static void sweep_equations(zono *z, const sweeps *w) {
  for (uint32_t q = 0; q < z->na; q++) {
    clear(z, w);
    seed_one(w, slot_out(z)[z->nx + q]);
    sweep_back(z, w, 0);
    for (uint32_t j = 0; j < z->nslot; j++) {
      const double *x = adjoint(w, j);
      residual_keep(z, q, j, x[0], varies(w, x), x + 1 + z->shape.m);
    }
  }
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

/* close := rho (I + rho + rho^2 + ...): powers, and the rest by the norm `most` in units of `unit` */
static int close_series(const zono *z, const double *unit, double most) {
  proof *p = z->proof;
  uint32_t n = z->na;
  size_t row = n * sizeof(double);
  double *now = p->work + 2 * (size_t)n, *next = now + n;
  for (uint32_t t = 0; t < p->ntarget; t++) {
    double *sum = p->close + (size_t)t * n, size = 0;
    memcpy(now, p->rho + (size_t)t * n, row), memcpy(sum, now, row);
    for (int power = 0; power < SQUARES; power++) {
      memset(next, 0, row);
      for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) next[j] += now[i] * p->rho[(size_t)i * n + j];
      for (uint32_t j = 0; j < n; j++) sum[j] += next[j];
      memcpy(now, next, row);
    }
    for (uint32_t i = 0; i < n; i++) size += now[i] * unit[i];
    size *= most / (1 - most) * ABOVE;
    for (uint32_t j = 0; j < n; j++) sum[j] = (sum[j] + size / unit[j]) * ABOVE;
  }
  return 1;
}

/* Should the step be halved because rho is large? What rho has from time goes with the step, what it has from the data
** does not. */
static int is_worth_less(zono *z, double worst) {
  proof *p = z->proof;
  if (p->patience > 0 || (z->guess > 0 && fabs(z->h) < 0.6 * z->guess && p->rho_before == 0)) return 0;
  int gains = p->rho_before == 0 || worst <= GAIN * p->rho_before;
  p->rho_before = worst;
  if (!gains) p->patience = PATIENCE;
  return gains;
}

/* (I - rho)^-1 <= sum of powers of rho: p->close := rho (I - rho)^-1 for all targets; 0: rho is not small */
static int close_rows(zono *z) {
  proof *p = z->proof;
  uint32_t n = z->na;
  double *unit = p->work, *next = p->work + n, worst = 0;
  for (uint32_t k = 0; k < n; k++) unit[k] = 1;
  for (int turn = 0; turn < TURNS; turn++) {
    double most = 0;
    for (uint32_t i = 0; i < n; i++) {
      next[i] = 1e-3 * unit[i];
      for (uint32_t j = 0; j < n; j++) next[i] += p->rho[(size_t)i * n + j] * unit[j];
      most = fmax(most, next[i]);
    }
    for (uint32_t i = 0; i < n; i++) unit[i] = fmax(next[i] / most, 1e-100);
  }
  for (uint32_t i = 0; i < n; i++) {
    double sum = 0;
    for (uint32_t j = 0; j < n; j++) sum += p->rho[(size_t)i * n + j] * unit[j];
    if (!(sum / unit[i] <= worst)) worst = sum / unit[i], z->blamed = i;
  }
  if (!(worst * ABOVE < MOST_RHO)) return z->why = WHY_PIVOT, 0;
  if (worst > GOOD_RHO && !is_certain(z) && is_worth_less(z, worst)) return z->why = WHY_GROWTH, 0;
  return close_series(z, unit, worst * ABOVE);
}

/* |true C - C| <= close |C_a|, for all lumps and for z */
static void add_rest(zono *z) {
  proof *p = z->proof;
  uint32_t n = z->na;
  for (uint32_t t = p->ntarget; t-- > 0;) { /* unknowns last: others use their coefficients */
    const double *by = p->close + (size_t)t * n;
    for (uint32_t k = 0; k < n; k++) {
      const double *C = p->C + (size_t)k * z->nslot, *dC = p->dC + (size_t)k * z->nslot;
      double *to = p->dC_new + (size_t)t * z->nslot;
      if (k == 0) memcpy(to, p->dC + (size_t)t * z->nslot, z->nslot * sizeof *to);
      for (uint32_t j = 0; j < z->nslot; j++) to[j] += by[k] * (fabs(C[j]) + dC[j]) * ABOVE;
      const double *L = p->L + (size_t)k * n, *dL = p->dL + (size_t)k * n;
      double *left = p->dL_new + (size_t)t * n;
      if (k == 0) memcpy(left, p->dL + (size_t)t * n, n * sizeof *left);
      for (uint32_t q = 0; q < n; q++) left[q] += by[k] * (fabs(L[q]) + dL[q]) * ABOVE;
    }
  }
  if (!n) return;
  double *old = p->dC;
  p->dC = p->dC_new, p->dC_new = old;
  old = p->dL, p->dL = p->dL_new, p->dL_new = old;
}

int sweep_coefficients(zono *z) {
  proof *p = z->proof;
  coefficients k = { p->C, p->dC, p->L, p->dL, p->rho };
  p->change->known = p->depend->any;
  if (!sweep(z, &p->forms, z->h, &k) || !close_rows(z)) return 0;
  if (p->residual->used) sweep_equations(z, &p->forms);
  add_rest(z);
  for (uint32_t i = 0; i < z->nx; i++) read_slope(z, i);
  return 1;
}

int sweep_weights(zono *z) {
  coefficients k = { z->proof->weight, NULL, z->proof->weight_L, NULL, NULL };
  return sweep(z, &z->proof->points, 0, &k);
}
