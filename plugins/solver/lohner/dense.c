/* dense.c -- what a record says besides its bounds, where the problem asks for it.
**
** Dense enclosure: x(t + s) = sum_k x_k s^k +- excess + sum_j (sum_k s_jk s^k +- slope_excess_j) v_j for each state of
** the set (series.c), |v_j| <= r_j: middle x_k, a column s_jk r_j for each direction, and radii for what is rounded and
** for the radii of slopes; what is beyond the orders is added to coefficient 0. Set: centre + low + C xi + z, with
** xi_j = (u_j - mid_j) / radius_j for the unknowns of the problem (start.c); low, z and the columns of what is no
** unknown are its rest.
*/
#include "lohner.h"
#include <string.h>

static int is_asked(const field *f, uint32_t what) { return (f->problem.extras & what) != 0; }

/* -- memory */

static int open_set(const field *f, extras *e) {
  const ambit_host *h = f->host;
  uint32_t nu = f->problem.nu, nterm = nu + 1;
  double *about, *scale;
  uint32_t *exponent = h->alloc(h, (size_t)nterm * (nu ? nu : 1) * sizeof *exponent);
  const request list[] = { { &about, nu }, { &scale, nu }, { &e->set_rest, f->nx },
    { &e->set_coefficient, (size_t)f->nx * nterm } };
  if (!exponent || !field_allocate(h, sizeof list / sizeof *list, list)) return 0;
  memset(exponent, 0, (size_t)nterm * nu * sizeof *exponent);
  for (uint32_t j = 0; j < nu; j++) {
    exponent[(size_t)(j + 1) * nu + j] = 1;
    about[j] = e->about[j];
    scale[j] = e->scale[j] > 0 ? e->scale[j] : 1; /* the column of a point is zero */
  }
  e->set = (ambit_set) { .size = sizeof e->set,
    .nu = nu,
    .nterm = nterm,
    .about = about,
    .scale = scale,
    .exponent = exponent,
    .coefficient = e->set_coefficient,
    .rest = e->set_rest };
  return 1;
}

int extras_open(const field *f, extras *e) {
  size_t n = (size_t)f->nx * (f->options.order + 1u);
  const request list[] = { { &e->dense.mid, n }, { &e->dense.rad, n }, { &e->dense_column, n * f->ndir } };
  if (is_asked(f, AMBIT_EXTRA_DENSE) && !field_allocate(f->host, sizeof list / sizeof *list, list)) return 0;
  return !is_asked(f, AMBIT_EXTRA_SET) || open_set(f, e);
}

/* -- the enclosure over the step */

/* Column j of state i; what rounding and the radii of slopes add goes into rad. */
static void put_column(
    const field *f, const flow *phi, uint32_t i, uint32_t j, double reach, double *column, double *rad) {
  for (uint32_t k = 0; k <= phi->q; k++) {
    balls s = balls_at(phi->slope, ((size_t)i * (phi->q + 1u) + k) * f->ndir + j);
    double high = *s.mid * reach, low = -(-*s.mid * reach);
    column[k] = high;
    rad[k] += high - low + *s.rad * reach;
  }
  rad[0] += phi->slope_excess[(size_t)i * f->ndir + j] * reach;
}

void extras_take_step(const field *f, const set *x, const flow *phi, extras *e) {
  if (!e->dense.mid) return;
  uint32_t p = phi->p, q = phi->q;
  for (uint32_t i = 0; i < f->nx; i++) {
    balls from = balls_at(phi->centre, (size_t)i * (p + 1u)), to = balls_at(e->dense, (size_t)i * (p + 1u));
    memcpy(to.mid, from.mid, (p + 1u) * sizeof(double));
    memcpy(to.rad, from.rad, (p + 1u) * sizeof(double));
    to.rad[0] += phi->excess[i];
    for (uint32_t j = 0; j < f->ndir; j++)
      put_column(f, phi, i, j, set_reach(f, x, j), e->dense_column + ((size_t)i * f->ndir + j) * (q + 1u), to.rad);
  }
}

/* -- the set at its end */

static const ambit_set *describe(const field *f, const set *x, extras *e) {
  if (!e->set_rest) return NULL;
  uint32_t nu = f->problem.nu, nterm = e->set.nterm;
  for (uint32_t i = 0; i < f->nx; i++) {
    const double *row = x->column + (size_t)i * f->nc;
    double *out = e->set_coefficient + (size_t)i * nterm, rest = x->rest[i] + fabs(x->low[i]);
    out[0] = x->centre[i];
    for (uint32_t j = 0; j < f->nc; j++)
      if (j < nu)
        out[1 + j] = row[j];
      else
        rest += fabs(row[j]);
    e->set_rest[i] = rest;
  }
  return &e->set;
}

void extras_grant(const field *f, const set *x, const flow *phi, extras *e, ambit_record *r) {
  r->ndense = e->dense.mid ? phi->p + 1u : 0;
  r->dense_mid = e->dense.mid;
  r->dense_rad = e->dense.rad;
  r->ncolumn = e->dense.mid ? f->ndir : 0;
  r->ncoef_column = phi->q + 1u;
  r->dense_column = e->dense_column;
  r->set = describe(f, x, e);
}
