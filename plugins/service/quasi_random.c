/* quasi_random.c -- "ambit.quasi_random/1" by the GNU Scientific Library.
**
** Sobol (Antonov & Saleev 1979, Bratley & Fox 1988), Niederreiter in base 2 (1988), Halton (1960) and Halton with
** reversed digits (Vandewoestyne & Cools 2006). Halton's first points of many dimensions are strung along lines; the
** reversed digits break these up. The counters of the library have 30 and 32 bits.
*/
#include <ambit/quasi_random.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_qrng.h>
#include <stdlib.h>
#include <string.h>

#define BITS 30

typedef struct sequence {
  gsl_qrng *generator;
  uint64_t left; /* points */
  uint32_t n;
  double point[];
} sequence;

static const gsl_qrng_type *type_of(const char *name, uint64_t *points) {
  *points = (UINT64_C(1) << BITS) - 1;
  if (strcmp(name, "sobol") == 0) return gsl_qrng_sobol;
  if (strcmp(name, "niederreiter") == 0) return gsl_qrng_niederreiter_2;
  *points = UINT32_MAX - 1;
  if (strcmp(name, "halton") == 0) return gsl_qrng_halton;
  if (strcmp(name, "reverse_halton") == 0) return gsl_qrng_reversehalton;
  *points = 0;
  return NULL;
}

static void most(const char *name, uint32_t *dimensions, uint64_t *points) {
  const gsl_qrng_type *type = type_of(name, points);
  *dimensions = type ? type->max_dimension : 0;
}

static void close(void *self) {
  sequence *s = self;
  if (!s) return;
  if (s->generator) gsl_qrng_free(s->generator);
  free(s);
}

static ambit_status open(const char *name, uint32_t n, void **self) {
  uint64_t points;
  const gsl_qrng_type *type = type_of(name, &points);
  *self = NULL;
  if (!type || n == 0 || n > type->max_dimension) return AMBIT_INVALID;
  gsl_set_error_handler_off(); /* GSL's own ends the process */
  sequence *s = malloc(sizeof *s + n * sizeof *s->point);
  if (!s) return AMBIT_NOMEM;
  *s = (sequence) { .generator = gsl_qrng_alloc(type, n), .left = points, .n = n };
  if (!s->generator) {
    close(s);
    return AMBIT_NOMEM;
  }
  *self = s;
  return AMBIT_OK;
}

static ambit_status next(void *self, size_t count, double *point, size_t stride) {
  sequence *s = self;
  if (count > s->left) return AMBIT_UNABLE;
  s->left -= count;
  for (size_t k = 0; k < count; k++) {
    if (gsl_qrng_get(s->generator, s->point) != GSL_SUCCESS) return AMBIT_UNABLE;
    for (uint32_t i = 0; i < s->n; i++) point[i * stride + k] = s->point[i];
  }
  return AMBIT_OK;
}

static const ambit_quasi_random_service service = { sizeof service, most, open, next, close };

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_QUASI_RANDOM_SERVICE) == 0 ? &service : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.quasi_random", "1.0",
  "Quasi-random sequences by the GNU Scientific Library: Sobol, Niederreiter, Halton. The kernel loads it by itself "
  "where `sample` draws; they prove nothing.",
  get };
