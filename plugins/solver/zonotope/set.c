/* set.c -- the set at the end of a step as polynomials in the problem's unknowns, on the receiver's wish. */
#include "proof.h"

static uint32_t whole_term(const zono *z, uint32_t i, uint32_t j) {
  return z->unknown[i] != AMBIT_NO_SLOT && z->unknown[j] != AMBIT_NO_SLOT;
}

static uint32_t count_terms(const zono *z) {
  uint32_t n = 1;
  for (uint32_t i = 0; i < z->m; i++) {
    n += z->unknown[i] != AMBIT_NO_SLOT;
    for (uint32_t j = i; j < z->m; j++) n += whole_term(z, i, j);
  }
  return n;
}

int set_open(zono *z) {
  proof *p = z->proof;
  const ambit_host *h = z->host;
  size_t nu = z->problem.nu, nterm = count_terms(z);
  double *about = h->alloc(h, (nu + 1) * sizeof *about), *scale = h->alloc(h, (nu + 1) * sizeof *scale);
  uint32_t *exponent = h->alloc(h, (nterm * nu + 1) * sizeof *exponent), at = 1;
  p->rest = h->alloc(h, z->nx * sizeof(double)), p->coefficient = h->alloc(h, z->nx * nterm * sizeof(double));
  if (!about || !scale || !exponent || !p->rest || !p->coefficient) return 0;
  for (size_t u = 0; u < nu; u++) about[u] = 0.5 * (z->problem.u_lo[u] + z->problem.u_hi[u]), scale[u] = 1;
  for (uint32_t i = 0; i < z->m; i++) {
    if (z->unknown[i] == AMBIT_NO_SLOT) continue;
    about[z->unknown[i]] = z->about[i], scale[z->unknown[i]] = z->scale[i];
    exponent[at++ * nu + z->unknown[i]] = 1;
  }
  for (uint32_t i = 0; i < z->m; i++)
    for (uint32_t j = i; j < z->m; j++)
      if (whole_term(z, i, j)) exponent[at * nu + z->unknown[i]]++, exponent[at++ * nu + z->unknown[j]]++;
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

const ambit_set *zono_describe_set(zono *z) {
  const proof *p = z->proof;
  const shape *s = &z->shape;
  for (uint32_t x = 0; x < z->nx; x++) {
    const double *row = z->P + (size_t)x * s->stride;
    double *to = p->coefficient + (size_t)x * p->set.nterm, rest = z->E[x] + row_c(s, row);
    uint32_t at = 0;
    to[at++] = row[0];
    for (uint32_t i = 0; i < z->m; i++)
      if (z->unknown[i] != AMBIT_NO_SLOT)
        to[at++] = row[1 + i];
      else
        rest += fabs(row[1 + i]);
    for (uint32_t i = 0; i < z->m; i++)
      for (uint32_t j = i; j < z->m; j++) {
        double c = j < s->reach[i] ? row[s->pair[i] + j - i] : 0;
        if (whole_term(z, i, j))
          to[at++] = c;
        else
          rest += fabs(c);
      }
    p->rest[x] = rest * ABOVE;
  }
  return &p->set;
}
