/* eigen.c -- approximations from service/eigen, enclosures from verbs/stability/spectrum.h.
**
** Vectors of a nearly defective matrix depend on each other; those of a matrix beside it (a little is added along the
** diagonal) are as good a basis for discs. The tightest discs of a few attempts are taken: each of them is rigorous.
*/
#include "verbs/stability/eigen.h"
#include <ambit/eigen.h>
#include <math.h>
#include <string.h>

typedef struct bench {
  size_t n;
  const ambit_interval *a;
  const ambit_eigen_service *service;
  ambit_arena *arena;
  double *middle, *re, *im, *vector;
  bool *is_first;
  ambit_eigenvalue *trial;
} bench;

static const double disturbance[] = { 0, 1e-12, 1e-8, 1e-5 };

static bool allocate(bench *b) {
  size_t n = b->n;
  b->middle = ambit_arena_alloc(b->arena, (n * n + 1) * sizeof *b->middle);
  b->vector = ambit_arena_alloc(b->arena, (n * n + 1) * sizeof *b->vector);
  b->re = ambit_arena_alloc(b->arena, (n + 1) * sizeof *b->re);
  b->im = ambit_arena_alloc(b->arena, (n + 1) * sizeof *b->im);
  b->is_first = ambit_arena_alloc(b->arena, (n + 1) * sizeof *b->is_first);
  b->trial = ambit_arena_alloc(b->arena, (n + 1) * sizeof *b->trial);
  return b->middle && b->vector && b->re && b->im && b->is_first && b->trial;
}

static double norm_of(const bench *b) {
  double norm = 0;
  for (size_t i = 0; i < b->n; i++) {
    double row = 0;
    for (size_t j = 0; j < b->n; j++) row += ambit_interval_mag(b->a[i * b->n + j]);
    norm = fmax(norm, row);
  }
  return norm;
}

static bool decompose(const bench *b, double off) {
  size_t n = b->n;
  for (size_t i = 0; i < n * n; i++) b->middle[i] = ambit_interval_mid(b->a[i]);
  for (size_t i = 0; i < n; i++) b->middle[i * n + i] += off * (double)(i + 1) / (double)n;
  if (b->service->decompose((uint32_t)n, b->middle, b->re, b->im, b->vector) != AMBIT_OK) return false;
  for (size_t j = 0; j < n; j++) {
    b->is_first[j] = b->im[j] > 0;
    if (b->is_first[j] && (j + 1 == n || b->im[j + 1] > 0)) return false; /* no pair */
  }
  return true;
}

/* the tightest boxes of all attempts */
static bool enclose(const bench *b, ambit_eigenvalue *value) {
  double norm = norm_of(b), best = INFINITY;
  for (size_t k = 0; k < sizeof disturbance / sizeof *disturbance; k++) {
    double spread = INFINITY;
    if (!decompose(b, disturbance[k] * norm)) continue;
    if (!ambit_spectrum_enclose(b->n, b->a, b->vector, b->is_first, b->trial, &spread, b->arena)) continue;
    if (!(spread < best)) continue;
    best = spread;
    memcpy(value, b->trial, b->n * sizeof *value);
    if (best <= 1e-10 * norm) break;
  }
  return best < INFINITY;
}

static ambit_stability judge_boxes(size_t n, const ambit_eigenvalue *value) {
  bool left = true, right = false;
  for (size_t i = 0; i < n; i++) {
    left = left && value[i].re.hi < 0;
    right = right || value[i].re.lo > 0;
  }
  return left ? AMBIT_STABILITY_STABLE : right ? AMBIT_STABILITY_UNSTABLE : AMBIT_STABILITY_UNDECIDED;
}

/* roughly the vector along which P is least */
static const double *find_least(const bench *b, const double *p, double *v) {
  size_t n = b->n, best = 0;
  if (b->service->decompose((uint32_t)n, p, b->re, b->im, b->vector) != AMBIT_OK) return NULL;
  for (size_t j = 1; j < n; j++)
    if (b->re[j] < b->re[best]) best = j;
  for (size_t i = 0; i < n; i++) v[i] = b->vector[i * n + best];
  return v;
}

static ambit_stability judge_by_lyapunov(const bench *b) {
  size_t n = b->n;
  double *p = ambit_arena_alloc(b->arena, (n * n + 1) * sizeof *p),
         *v = ambit_arena_alloc(b->arena, (n + 1) * sizeof *v);
  ambit_interval *set = ambit_arena_alloc(b->arena, (n * n + 1) * sizeof *set);
  if (!p || !v || !set || !ambit_lyapunov_solve(n, b->a, p, b->arena) || !ambit_lyapunov_holds(n, b->a, p, b->arena))
    return AMBIT_STABILITY_UNDECIDED;
  for (size_t i = 0; i < n * n; i++) set[i] = (ambit_interval) { p[i], p[i] };
  if (ambit_is_positive_definite(n, set, b->arena)) return AMBIT_STABILITY_STABLE;
  return find_least(b, p, v) && ambit_is_negative_along(n, p, v) ? AMBIT_STABILITY_UNSTABLE : AMBIT_STABILITY_UNDECIDED;
}

static void analyse(const bench *b, ambit_eigenvalue *value, ambit_eigen *result) {
  *result = (ambit_eigen) { AMBIT_STABILITY_UNDECIDED, "", enclose(b, value) };
  if (result->enclosed) result->stability = judge_boxes(b->n, value);
  if (result->stability != AMBIT_STABILITY_UNDECIDED) {
    result->by = "eigenvalues";
    return;
  }
  result->stability = judge_by_lyapunov(b);
  if (result->stability != AMBIT_STABILITY_UNDECIDED) result->by = "Lyapunov's equation";
}

static ambit_status find_service(ambit_registry *registry, const ambit_eigen_service **s, ambit_failure *f) {
  const ambit_plugin *plugin;
  ambit_status status = ambit_registry_plugin(registry, "service", "eigen", &plugin, f);
  if (status != AMBIT_OK) return status;
  *s = plugin->get(AMBIT_EIGEN_SERVICE);
  if (*s && (*s)->size >= sizeof **s && (*s)->decompose) return AMBIT_OK;
  return ambit_fail(f, AMBIT_INVALID, "the plugin service/eigen offers no %s", AMBIT_EIGEN_SERVICE);
}

ambit_status ambit_eigen_analyse(ambit_registry *registry, size_t n, const ambit_interval *a, ambit_eigenvalue *value,
    ambit_eigen *result, ambit_failure *f) {
  bench b = { .n = n, .a = a };
  *result = (ambit_eigen) { AMBIT_STABILITY_UNDECIDED, "", false };
  for (size_t i = 0; i < n * n; i++)
    if (ambit_interval_is_empty(a[i]) || !ambit_interval_is_bounded(a[i])) return AMBIT_OK;
  ambit_status status = find_service(registry, &b.service, f);
  if (status != AMBIT_OK) return status;
  b.arena = ambit_arena_open();
  if (b.arena && allocate(&b))
    analyse(&b, value, result);
  else
    status = ambit_no_memory(f);
  ambit_arena_close(b.arena);
  return status;
}
