/* plugin.c -- "ambit.quasi_random/1": Sobol, Niederreiter, Halton.
**
** Points of digital sequences come in Gray's order (Antonov & Saleev 1979): one direction number changes a point into
** the next. The first point, 0, is left out.
*/
#include "sequences.h"
#include <ambit/quasi_random.h>
#include <stdlib.h>
#include <string.h>

#define POINTS UINT32_MAX /* the most that a sequence has */

typedef enum family { SOBOL, NIEDERREITER, HALTON, REVERSE_HALTON, FAMILIES } family;

static const struct {
  const char *name;
  uint32_t dimensions;
} known[FAMILIES] = { [SOBOL] = { "sobol", SOBOL_MAX },
  [NIEDERREITER] = { "niederreiter", NIEDERREITER_MAX },
  [HALTON] = { "halton", HALTON_MAX },
  [REVERSE_HALTON] = { "reverse_halton", HALTON_MAX } };

typedef struct sequence {
  family family;
  uint32_t n;
  uint64_t drawn;      /* points */
  uint32_t *at, *base; /* [n] a digital point in 2^-DIGITS; Halton's primes */
  uint32_t *direction; /* [n, DIGITS] */
  uint32_t memory[];
} sequence;

static family find(const char *name) {
  family f = SOBOL;
  while (f < FAMILIES && strcmp(name, known[f].name) != 0) f++;
  return f;
}

static void most(const char *name, uint32_t *dimensions, uint64_t *points) {
  family f = find(name);
  *dimensions = f < FAMILIES ? known[f].dimensions : 0;
  *points = f < FAMILIES ? POINTS : 0;
}

static ambit_status open(const char *name, uint32_t n, void **self) {
  family f = find(name);
  *self = NULL;
  if (f == FAMILIES || n == 0 || n > known[f].dimensions) return AMBIT_INVALID;
  int is_digital = f == SOBOL || f == NIEDERREITER;
  sequence *s = calloc(1, sizeof *s + n * (is_digital ? 1 + (size_t)DIGITS : 1) * sizeof *s->memory);
  if (!s) return AMBIT_NOMEM;
  s->family = f, s->n = n, s->at = s->base = s->memory, s->direction = s->memory + n;
  if (f == SOBOL)
    sobol_directions(n, s->direction);
  else if (f == NIEDERREITER)
    niederreiter_directions(n, s->direction);
  else
    first_primes(n, s->base);
  *self = s;
  return AMBIT_OK;
}

/* in Gray's order: the direction of the lowest bit that is 0 in the number of the point before */
static void draw_digital(sequence *s, size_t k, double *point, size_t stride) {
  uint32_t bit = 0;
  while (s->drawn >> bit & 1) bit++;
  for (uint32_t i = 0; i < s->n; i++) {
    s->at[i] ^= s->direction[(size_t)i * DIGITS + bit];
    point[i * stride + k] = s->at[i] * 0x1p-32;
  }
}

static void draw_halton(const sequence *s, size_t k, double *point, size_t stride) {
  for (uint32_t i = 0; i < s->n; i++)
    point[i * stride + k] = radical_inverse(s->drawn + 1, s->base[i], s->family == REVERSE_HALTON);
}

static ambit_status next(void *self, size_t count, double *point, size_t stride) {
  sequence *s = self;
  if (count > POINTS - s->drawn) return AMBIT_UNABLE;
  for (size_t k = 0; k < count; k++, s->drawn++) {
    if (s->family == SOBOL || s->family == NIEDERREITER)
      draw_digital(s, k, point, stride);
    else
      draw_halton(s, k, point, stride);
  }
  return AMBIT_OK;
}

static const ambit_quasi_random_service service = { sizeof service, most, open, next, free };

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_QUASI_RANDOM_SERVICE) == 0 ? &service : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.quasi_random", "2.0",
  "Quasi-random sequences: Sobol, Niederreiter, Halton. The kernel loads it by itself where `sample` draws; they prove "
  "nothing.",
  get };
