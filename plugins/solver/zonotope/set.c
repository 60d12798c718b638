/* set.c -- the set at the end of a step as polynomials in the problem's unknowns, where the receiver asks for it. What
** the run that goes on from it would compute with for next to nothing, coefficients that are small beside the
** rest or the set, is put into the rest.
*/
#include "proof.h"

#define SMALL_OF_REST 1e-3 /* shares of the rest, and of the set, that all coefficients put into the rest may have */
#define SMALL_OF_SET 1e-7

static int is_known(const zono *z, uint32_t i) { return z->unknown[i] != AMBIT_NO_SLOT; }

static uint32_t count_terms(const zono *z) {
  uint32_t n = 0, cubic = 0;
  for (uint32_t i = 0; i < z->m; i++) {
    if (!is_known(z, i)) continue;
    n++;
    if (i < z->shape.cubic) cubic++;
  }
  return 1 + n + n * (n + 1) / 2 + cubic * (cubic + 1) * (cubic + 2) / 6;
}

/* exponents of the terms, in the order of add_terms() */
static void list_terms(const zono *z, uint32_t *exponent) {
  size_t nu = z->problem.nu;
  uint32_t *to = exponent + nu, m = z->m, cubic = z->shape.cubic;
  for (uint32_t i = 0; i < m; i++)
    if (is_known(z, i)) to[z->unknown[i]] = 1, to += nu;
  for (uint32_t i = 0; i < m; i++)
    for (uint32_t j = i; j < m; j++)
      if (is_known(z, i) && is_known(z, j)) to[z->unknown[i]]++, to[z->unknown[j]]++, to += nu;
  for (uint32_t i = 0; i < cubic; i++)
    for (uint32_t j = i; j < cubic; j++)
      for (uint32_t k = j; k < cubic; k++)
        if (is_known(z, i) && is_known(z, j) && is_known(z, k))
          to[z->unknown[i]]++, to[z->unknown[j]]++, to[z->unknown[k]]++, to += nu;
}

int set_open(zono *z) {
  proof *p = z->proof;
  const ambit_host *h = z->host;
  size_t nu = z->problem.nu, nterm = count_terms(z);
  double *about = h->alloc(h, (nu + 1) * sizeof *about), *scale = h->alloc(h, (nu + 1) * sizeof *scale);
  uint32_t *exponent = h->alloc(h, (nterm * nu + 1) * sizeof *exponent);
  p->rest = h->alloc(h, z->nx * sizeof(double)), p->coefficient = h->alloc(h, z->nx * nterm * sizeof(double));
  if (!about || !scale || !exponent || !p->rest || !p->coefficient) return 0;
  for (size_t u = 0; u < nu; u++) about[u] = 0.5 * (z->problem.u_lo[u] + z->problem.u_hi[u]), scale[u] = 1;
  for (uint32_t i = 0; i < z->m; i++)
    if (is_known(z, i)) about[z->unknown[i]] = z->about[i], scale[z->unknown[i]] = z->scale[i];
  list_terms(z, exponent);
  p->set = (ambit_set) { .size = sizeof p->set,
    .nu = (uint32_t)nu,
    .nterm = (uint32_t)nterm,
    .about = about,
    .scale = scale,
    .exponent = exponent,
    .coefficient = p->coefficient,
    .rest = p->rest };
  return 1;
}

typedef struct sink {
  double *to, rest, small;
} sink;

static void add(sink *s, double c, int known) {
  int kept = known && fabs(c) > s->small;
  if (known) *s->to++ = kept ? c : 0;
  if (!kept) s->rest += fabs(c);
}

/* all terms of a row but its constant */
static void add_terms(const zono *z, const double *row, sink *to) {
  const shape *s = &z->shape;
  uint32_t m = z->m, cubic = s->cubic;
  const double *cube = row_c(s, row) > 0 ? row + s->cube : NULL;
  for (uint32_t i = 0; i < m; i++) add(to, row[1 + i], is_known(z, i));
  for (uint32_t i = 0; i < m; i++)
    for (uint32_t j = i; j < m; j++)
      add(to, j < s->reach[i] ? row[s->pair[i] + j - i] : 0, is_known(z, i) && is_known(z, j));
  for (uint32_t i = 0; i < cubic; i++)
    for (uint32_t j = i; j < cubic; j++)
      for (uint32_t k = j; k < cubic; k++)
        add(to, cube ? *cube++ : 0, is_known(z, i) && is_known(z, j) && is_known(z, k));
}

const ambit_set *zono_describe_set(zono *z) {
  const proof *p = z->proof;
  for (uint32_t x = 0; x < z->nx; x++) {
    const double *row = z->P + (size_t)x * z->shape.stride;
    double *to = p->coefficient + (size_t)x * p->set.nterm;
    double small = fmax(SMALL_OF_REST * z->E[x], SMALL_OF_SET * (row_moving(&z->shape, row) + z->E[x]));
    sink terms = { to + 1, z->E[x], small / p->set.nterm };
    to[0] = row[0];
    add_terms(z, row, &terms);
    p->rest[x] = (terms.rest + fabs(row_low(&z->shape, row))) * ABOVE;
  }
  return &p->set;
}
