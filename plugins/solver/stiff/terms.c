/* terms.c -- the powers of the unknowns that fields keep (field.h). */
#include "field.h"

/* more terms cost more than they gain */
uint32_t terms_degree(uint32_t nu) {
  static const uint32_t degree[] = { 0, 14, 8, 6, 4, 3, 3, 2, 2, 2, 2 };
  return nu < sizeof degree / sizeof *degree ? degree[nu] : 0;
}

/* appends all powers of total degree `left` in unknowns j .. nu - 1 to what is fixed in `power` */
static void append(terms *t, uint32_t *power, uint32_t j, uint32_t left) {
  if (j + 1 == t->nu) {
    power[j] = left;
    for (uint32_t i = 0; i < t->nu; i++) t->exponent[t->count * t->nu + i] = power[i];
    t->count++;
    return;
  }
  for (uint32_t p = left + 1; p-- > 0;) {
    power[j] = p;
    append(t, power, j + 1, left - p);
  }
}

static uint32_t find(const terms *t, uint32_t a, uint32_t b) {
  uint32_t nu = t->nu;
  for (uint32_t k = 0; k < t->count; k++) {
    uint32_t i = 0;
    while (i < nu && t->exponent[k * nu + i] == t->exponent[a * nu + i] + t->exponent[b * nu + i]) i++;
    if (i == nu) return k;
  }
  return 0;
}

uint32_t terms_count(uint32_t nu, uint32_t degree) {
  uint32_t count = 1;
  for (uint32_t i = 1; i <= degree; i++) count = count * (nu + i) / i; /* exact: a binomial coefficient each */
  return count;
}

int terms_open(const ambit_host *h, uint32_t nu, uint32_t degree, terms *t) {
  uint32_t power[TERMS_MAX] = { 0 };
  uint32_t room = terms_count(nu, degree);
  *t = (terms) { .nu = nu, .degree = degree };
  t->exponent = h->alloc(h, (size_t)room * nu * sizeof *t->exponent);
  t->grade = h->alloc(h, room * sizeof *t->grade);
  t->product = h->alloc(h, (size_t)room * room * sizeof *t->product);
  if (!t->exponent || !t->grade || !t->product) return 0;
  for (uint32_t d = 0; d <= degree; d++) {
    append(t, power, 0, d);
    t->below[d] = t->count;
  }
  for (uint32_t k = 0; k < t->count; k++) {
    uint32_t pairs = 1;
    t->grade[k] = 0;
    for (uint32_t i = 0; i < nu; i++) t->grade[k] += t->exponent[k * nu + i], pairs *= t->exponent[k * nu + i] + 1;
    if (pairs > t->pairs) t->pairs = pairs;
  }
  for (uint32_t a = 0; a < t->count; a++)
    for (uint32_t b = 0; b < t->below[degree - t->grade[a]]; b++)
      t->product[a * t->count + b] = (uint16_t)find(t, a, b);
  return 1;
}
