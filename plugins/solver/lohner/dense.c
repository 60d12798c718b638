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

static int is_asked(const lohner *s, uint32_t what) { return (s->problem.extras & what) != 0; }

/* -- memory */

static int doubles(const ambit_host *h, size_t count, double **array) {
  *array = h->alloc(h, (count ? count : 1) * sizeof(double));
  return *array != NULL;
}

static int open_set(lohner *s) {
  const ambit_host *h = s->host;
  uint32_t nu = s->problem.nu, nterm = nu + 1;
  double *about, *scale;
  uint32_t *exponent = h->alloc(h, (size_t)nterm * (nu ? nu : 1) * sizeof *exponent);
  if (!exponent || !doubles(h, nu, &about) || !doubles(h, nu, &scale) || !doubles(h, s->nx, &s->set_rest) ||
      !doubles(h, (size_t)s->nx * nterm, &s->set_coefficient))
    return 0;
  memset(exponent, 0, (size_t)nterm * nu * sizeof *exponent);
  for (uint32_t j = 0; j < nu; j++) {
    exponent[(size_t)(j + 1) * nu + j] = 1;
    about[j] = s->about[j];
    scale[j] = s->scale[j] > 0 ? s->scale[j] : 1; /* the column of a point is zero */
  }
  s->set = (ambit_set) { .size = sizeof s->set,
    .nu = nu,
    .nterm = nterm,
    .about = about,
    .scale = scale,
    .exponent = exponent,
    .coefficient = s->set_coefficient,
    .rest = s->set_rest };
  return 1;
}

int lohner_open_extras(lohner *s) {
  size_t n = (size_t)s->nx * (s->options.order + 1u);
  if (is_asked(s, AMBIT_EXTRA_DENSE) && (!doubles(s->host, n, &s->dense_mid) || !doubles(s->host, n, &s->dense_rad) ||
                                            !doubles(s->host, n * s->ndir, &s->dense_column)))
    return 0;
  return !is_asked(s, AMBIT_EXTRA_SET) || open_set(s);
}

/* -- the enclosure over the step */

/* Column j of state i; what rounding and the radii of slopes add goes into rad. */
static void put_column(const lohner *s, uint32_t i, uint32_t j, double *column, double *rad) {
  double reach = lohner_reach(s, j);
  for (uint32_t k = 0; k <= s->slope_order; k++) {
    size_t at = ((size_t)i * (s->slope_order + 1u) + k) * s->ndir + j;
    double high = s->slope_mid[at] * reach, low = -(-s->slope_mid[at] * reach);
    column[k] = high;
    rad[k] += high - low + s->slope_rad[at] * reach;
  }
  rad[0] += s->slope_excess[(size_t)i * s->ndir + j] * reach;
}

void lohner_dense(lohner *s) {
  if (!s->dense_mid) return;
  uint32_t p = s->options.order, q = s->slope_order;
  for (uint32_t i = 0; i < s->nx; i++) {
    double *rad = s->dense_rad + (size_t)i * (p + 1u);
    memcpy(s->dense_mid + (size_t)i * (p + 1u), s->series_mid + (size_t)i * (p + 1u), (p + 1u) * sizeof(double));
    memcpy(rad, s->series_rad + (size_t)i * (p + 1u), (p + 1u) * sizeof(double));
    rad[0] += s->excess[i];
    for (uint32_t j = 0; j < s->ndir; j++)
      put_column(s, i, j, s->dense_column + ((size_t)i * s->ndir + j) * (q + 1u), rad);
  }
}

/* -- the set at its end */

static const ambit_set *describe(lohner *s) {
  if (!s->set_rest) return NULL;
  uint32_t nu = s->problem.nu, nterm = s->set.nterm;
  for (uint32_t i = 0; i < s->nx; i++) {
    const double *row = s->column + (size_t)i * s->nc;
    double *out = s->set_coefficient + (size_t)i * nterm, rest = s->rest[i] + fabs(s->low[i]);
    out[0] = s->centre[i];
    for (uint32_t j = 0; j < s->nc; j++)
      if (j < nu)
        out[1 + j] = row[j];
      else
        rest += fabs(row[j]);
    s->set_rest[i] = rest;
  }
  return &s->set;
}

void lohner_grant(lohner *s, ambit_record *r) {
  r->ndense = s->dense_mid ? s->options.order + 1u : 0;
  r->dense_mid = s->dense_mid;
  r->dense_rad = s->dense_rad;
  r->ncolumn = s->dense_mid ? s->ndir : 0;
  r->ncoef_column = s->slope_order + 1u;
  r->dense_column = s->dense_column;
  r->set = describe(s);
}
