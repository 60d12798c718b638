/* slope.c -- linear forms of the slots and of the derivatives of operations, over the set and the step.
**
** s = h tau, tau in [0, 1]. tau^k lies between tau - g and tau, g = (1 - 1/k) k^(-1/(k-1)): the constant parts of all
** orders share the symbol of time, the last one. Linear parts of orders k > 0 are taken at h^k / 2, the other half and
** terms of degree 2 are radius.
*/
#include "kink.h"
#include "proof.h"

/* At least the most of tau - tau^k over [0, 1]: the tangent at any point lies above it, so pow need not be right. */
static double gap(uint32_t k) {
  double tau = fmin(fmax(pow(k, -1 / (k - 1.0)), 0), 1), below = 1; /* tau^(k-1) */
  for (uint32_t j = 1; j < k; j++) below *= tau;
  return tau - tau * below + fabs(1 - k * below) + 4 * k * UNIT;
}

void slope_open(proof *p) {
  for (uint32_t k = 0; k < TIME_ORDERS; k++) {
    double *c = p->chebyshev[k], middle = 1; /* of tau^k: C(2 k, k - v) / 4^k, twice that for v > 0 */
    p->gap[k] = k < 2 ? 0 : gap(k);
    for (uint32_t j = 1; j <= k; j++) middle *= (2 * j - 1.0) / (2 * j);
    for (uint32_t v = 0; v <= POWERS; v++) {
      c[v] = v > k ? 0 : v ? 2 * middle : middle;
      if (v < k) middle *= (k - v) / (k + v + 1.0);
    }
  }
}

/* as polynomials in time alone: all coefficients of tau^k are positive, and those of higher degree are 1 less the
** others */
static void power_form(const zono *z, const forms *f, uint32_t j, double h, double *to) {
  const shape *s = &z->shape;
  uint32_t count = orders(z, j);
  double power = 1, rad = 0, size = 0;
  form_clear(f, to);
  for (uint32_t k = 0; k < count; k++, power *= h) {
    const double *row = row_at(z, j, k), *c = z->proof->chebyshev[k];
    double part = row[0] * power, high = 1;
    for (uint32_t v = 0; v <= f->n && v <= k; v++) to[v] += part * c[v], high -= c[v];
    if (k > f->n) rad += fabs(part) * (fmax(high, 0) + 4 * k * UNIT);
    rad += row_moving(s, row) * fabs(power), size += row_total(s, row) * fabs(power);
  }
  *form_rad(f, to) = rad * ABOVE + 8 * (count + 2) * UNIT * size;
  to[4 + f->n] = 1;
  form_close(f, to);
}

/* of slot j; w->forms.n is m + nx + 1, or 0 with h = 0: the centre of the set at the start of the step */
static void slot_form(const zono *z, const sweeps *w, uint32_t j, double h, double *to) {
  const shape *s = &z->shape;
  const forms *f = &w->forms;
  uint32_t n = s->m + s->nx, count = orders(z, j);
  double power = 1, rad = 0, size = 0, time = 0;
  if (f->powers) {
    power_form(z, f, j, h, to);
    return;
  }
  form_clear(f, to);
  to[0] = row_at(z, j, 0)[0];
  if (f->n) {
    const double *row = row_at(z, j, 0);
    memcpy(to + 1, row + 1, n * sizeof *to);
    rad = row_bent(s, row), size = row_total(s, row);
  }
  for (uint32_t k = 1; k < count && f->n; k++) {
    const double *row = row_at(z, j, k);
    power *= h;
    double half = 0.5 * power, g = z->proof->gap[k] * power, sizes = fabs(power);
    for (uint32_t v = 1; v <= n; v++) to[v] += half * row[v];
    time += row[0] * power;
    to[0] -= 0.5 * g * row[0];
    rad += 0.5 * fabs(g * row[0]) + (0.5 * (row_l(s, row) + row_r(s, row)) + row_bent(s, row)) * sizes;
    size += row_total(s, row) * sizes;
  }
  if (f->n) to[f->n] = 0.5 * time;
  to[0] += 0.5 * time;
  *form_rad(f, to) = rad * ABOVE + 8 * (count + 2) * UNIT * size;
  to[4 + f->n] = 1;
  form_close(f, to);
}

static double *slope_form(const zono *z, const sweeps *w, uint32_t slot, uint32_t n) {
  return proof_form(w, w->slope, z->proof->slope_at[slot] + n);
}

/* form of u v -> scratch n */
static double *product_form(const sweeps *w, uint32_t n, const double *u, const double *v) {
  double *to = proof_form(w, w->scratch, n);
  form_clear(&w->forms, to);
  form_product(&w->forms, to, 1, u, v);
  form_close(&w->forms, to);
  return to;
}

/* 1 / (1 + a^2); or b / (a^2 + b^2) and -a / (a^2 + b^2) */
static int angle_slope(const zono *z, const sweeps *w, uint32_t i) {
  const ambit_tape *t = z->program.tape;
  const forms *f = &w->forms;
  const double *a = proof_form(w, w->value, t->a[i]), *b = proof_form(w, w->value, t->b[i]);
  double *q = product_form(w, 0, a, a), *first = slope_form(z, w, t->dst[i], 0), *one = proof_form(w, w->scratch, 1);
  if (t->op[i] == AMBIT_OP_ATAN) {
    form_constant(f, one, 1), form_close(f, one);
    form_add(f, q, 1, one), form_close(f, q);
    return form_inverse(f, first, q, 0);
  }
  form_product(f, q, 1, b, b), form_close(f, q);
  if (!form_inverse(f, one, q, 0)) return 0;
  double *second = slope_form(z, w, t->dst[i], 1);
  form_clear(f, first), form_clear(f, second);
  form_product(f, first, 1, one, b), form_close(f, first);
  form_product(f, second, -1, one, a), form_close(f, second);
  return 1;
}

/* 1 - tanh^2 is the aux slot a, as far as that is 1 - y^2, and differs from it by at most (|y| + 1) r */
static void tanh_slope(const zono *z, const sweeps *w, uint32_t i, double *to, int bounded) {
  const ambit_tape *t = z->program.tape;
  uint32_t dst = t->dst[i], aux = t->aux[i];
  double off = bounded ? tanh_aux_error(z, i) + (1 + z->proof->high[dst]) * z->r[dst] : 0;
  form_widen(&w->forms, to, proof_form(w, w->value, aux), off);
}

static int slope_of(const zono *z, const sweeps *w, uint32_t i, int bounded) {
  const ambit_tape *t = z->program.tape;
  const forms *f = &w->forms;
  uint32_t dst = t->dst[i], aux = t->aux[i];
  const double *a = proof_form(w, w->value, t->a[i]), *b = proof_form(w, w->value, t->b[i]);
  const double *own = proof_form(w, w->value, dst);
  double *to = z->proof->slope_at[dst] == AMBIT_NO_SLOT ? NULL : slope_form(z, w, dst, 0);
  double *twice = proof_form(w, w->scratch, 0), r = bounded ? z->r[dst] : 0;
  switch (t->op[i]) {
  case AMBIT_OP_DIV:
    if (!form_inverse(f, to, b, 0)) return 0;
    form_widen(f, twice, own, r);
    form_clear(f, to + f->stride);
    form_product(f, to + f->stride, -1, twice, to), form_close(f, to + f->stride);
    return 1;
  case AMBIT_OP_SQRT:
    form_clear(f, twice), form_add(f, twice, 2, own), form_close(f, twice);
    return form_inverse(f, to, twice, 2 * r);
  case AMBIT_OP_LOG: return form_inverse(f, to, a, 0);
  case AMBIT_OP_EXP: form_widen(f, to, own, r); return 1;
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: form_widen(f, to, proof_form(w, w->value, aux), bounded ? z->r[aux] : 0); return 1;
  case AMBIT_OP_TANH:
    if (!is_line(z, i)) tanh_slope(z, w, i, to, bounded);
    return 1;
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ATAN2: return angle_slope(z, w, i);
  default: return 1;
  }
}

int slope_forms(zono *z, const sweeps *w, double h) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t j = 0; j < z->nslot; j++) slot_form(z, w, j, h, proof_form(w, w->value, j));
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (!slope_of(z, w, i, w->forms.n > 0)) return z->why = WHY_UNDEFINED, z->blamed = t->dst[i], 0;
  return 1;
}
