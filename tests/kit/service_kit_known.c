/* service_kit_known.c -- the interfaces that the kernel asks services for. */
#include "kit/guarded.h"
#include "kit/service_kit.h"
#include "num/random.h"
#include <ambit/tape.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* -- eigen */

enum { ORDER = 12 };
#define RESIDUAL 1e-9 /* of the matrix' size; for matrices with simple eigenvalues */

typedef struct eigen_case {
  uint32_t n;
  double *a, *re, *im, *vector; /* each ends where memory ends */
} eigen_case;

static bool eigen_open(eigen_case *c, uint32_t n) {
  size_t line = n * sizeof(double), all = n * line;
  *c = (eigen_case) { n, guarded_open(NULL, all), guarded_open(NULL, line), guarded_open(NULL, line),
    guarded_open(NULL, all) };
  return c->a && c->re && c->im && c->vector;
}

static void eigen_close(eigen_case *c) {
  size_t line = c->n * sizeof(double), all = c->n * line;
  guarded_close(c->a, all), guarded_close(c->re, line), guarded_close(c->im, line), guarded_close(c->vector, all);
}

/* the largest component of A v - lambda v, and of v; first: the pair's first column, second: its imaginary part */
static double residual(const eigen_case *c, uint32_t j, bool pair, double *size) {
  uint32_t n = c->n;
  double worst = 0;
  *size = 0;
  for (uint32_t i = 0; i < n; i++) {
    double x = 0, y = 0, u = c->vector[i * n + j], v = pair ? c->vector[i * n + j + 1] : 0;
    for (uint32_t k = 0; k < n; k++) {
      x += c->a[i * n + k] * c->vector[k * n + j];
      if (pair) y += c->a[i * n + k] * c->vector[k * n + j + 1];
    }
    x -= c->re[j] * u - c->im[j] * v, y -= c->re[j] * v + c->im[j] * u;
    worst = fmax(worst, isnan(x) || isnan(y) ? INFINITY : fmax(fabs(x), fabs(y)));
    *size = fmax(*size, fmax(fabs(u), fabs(v)));
  }
  return worst;
}

static void judge_eigen(service_kit *k, const eigen_case *c, const double *given) {
  double trace = 0, sum = 0, squares = 0, square_trace = 0, scale = 0, size;
  uint32_t n = c->n;
  if (memcmp(given, c->a, (size_t)n * n * sizeof *given) != 0)
    service_kit_find(k, "eigen", "it writes into the matrix");
  for (uint32_t i = 0; i < n * n; i++) scale = fmax(scale, fabs(given[i]));
  for (uint32_t i = 0; i < n; i++) {
    trace += given[i * n + i], sum += c->re[i], squares += c->re[i] * c->re[i] - c->im[i] * c->im[i];
    for (uint32_t m = 0; m < n; m++) square_trace += given[i * n + m] * given[m * n + i];
  }
  k->judged += 2 + n;
  if (!(fabs(trace - sum) <= RESIDUAL * n * (1 + scale)) ||
      !(fabs(squares - square_trace) <= RESIDUAL * n * n * (1 + scale * scale)))
    service_kit_find(k, "eigen", "the trace of %u x %u is %g, the sum of the eigenvalues %g", n, n, trace, sum);
  for (uint32_t j = 0; j < n; j++) {
    bool pair = c->im[j] != 0,
         whole = !pair || (c->im[j] > 0 && j + 1 < n && c->im[j + 1] == -c->im[j] && c->re[j + 1] == c->re[j]);
    if (!whole)
      service_kit_find(k, "eigen", "%g + %g i of %u x %u is not the first of a pair", c->re[j], c->im[j], n, n);
    if (!whole) return;
    double worst = residual(c, j, pair, &size);
    if (!(worst <= RESIDUAL * n * (1 + scale) * size) || !(size > 0 && size < INFINITY))
      service_kit_find(k, "eigen", "A v - (%g + %g i) v of %u x %u is %g, v %g", c->re[j], c->im[j], n, n, worst, size);
    j += pair;
  }
}

static void check_eigen(service_kit *k, const ambit_eigen_service *s, uint32_t n, ambit_random *random, int kind) {
  eigen_case c;
  double given[ORDER * ORDER];
  if (eigen_open(&c, n)) {
    for (uint32_t i = 0; i < n * n; i++) {
      bool below = i % n < i / n;
      double x = ambit_random_in(random, (ambit_interval) { -2, 2 });
      c.a[i] = kind == 0 ? x : kind == 1 ? (below ? 0 : i % n == i / n ? (double)(i % n) + 1 : x) : x * 1e6;
      if (kind == 3 && below) c.a[i] = -c.a[(i % n) * n + i / n] * 1e-6;
    }
    if (n == 1) c.a[0] = -3;
    memcpy(given, c.a, (size_t)n * n * sizeof *given);
    ambit_status status = s->decompose(n, c.a, c.re, c.im, c.vector);
    if (status == AMBIT_OK)
      judge_eigen(k, &c, given);
    else
      service_kit_find(k, "eigen", "status %d for an ordinary matrix of %u x %u", status, n, n);
  }
  eigen_close(&c);
}

void service_kit_eigen(service_kit *k, const ambit_eigen_service *s) {
  ambit_random random = { k->seed };
  for (int round = 0; round < 6 * fmax(1, k->effort); round++)
    for (uint32_t n = 1; n <= ORDER; n++) check_eigen(k, s, n, &random, round % 4);
}

/* -- quasi_random */

enum { POINTS = 256, DIMENSIONS = 4, BINS = 8 };

/* Points asked for in parts of this size, each part with the stride of the whole. */
static double *draw(service_kit *k, const ambit_quasi_random_service *s, const char *name, size_t part) {
  size_t bytes = POINTS * DIMENSIONS * sizeof(double);
  double *point = guarded_open(NULL, bytes);
  void *self = NULL;
  if (!point) return NULL;
  for (size_t i = 0; i < POINTS * DIMENSIONS; i++) point[i] = -7;
  ambit_status status = s->open(name, DIMENSIONS, &self);
  for (size_t done = 0; status == AMBIT_OK && done < POINTS; done += part) {
    size_t count = part < POINTS - done ? part : POINTS - done;
    status = s->next(self, count, point + done, POINTS);
    for (size_t i = 0; i < DIMENSIONS && done + count < POINTS; i++)
      if (point[i * POINTS + done + count] != -7) {
        service_kit_find(k, "quasi_random", "%s writes more than %zu points", name, count);
        done = POINTS;
      }
  }
  if (self) s->close(self);
  if (status == AMBIT_OK) return point;
  service_kit_find(k, "quasi_random", "%s of %d dimensions: status %d", name, (int)DIMENSIONS, status);
  guarded_close(point, bytes);
  return NULL;
}

static void judge_points(service_kit *k, const char *name, const double *point) {
  for (size_t i = 0; i < DIMENSIONS; i++) {
    size_t bin[BINS] = { 0 };
    for (size_t j = 0; j < POINTS; j++) {
      double x = point[i * POINTS + j];
      k->judged++;
      if (!(x >= 0 && x < 1)) {
        service_kit_find(k, "quasi_random", "%s: coordinate %zu of point %zu is %g", name, i, j, x);
        return;
      }
      bin[(size_t)(x * BINS)]++;
    }
    for (size_t b = 0; b < BINS; b++) /* even: within a quarter of the share; 3 points of 32 at random would be usual */
      if (bin[b] * BINS * 4 < POINTS * 3 || bin[b] * BINS * 4 > POINTS * 5)
        service_kit_find(k, "quasi_random", "%s: %zu of %d points in bin %zu of %d of coordinate %zu", name, bin[b],
            (int)POINTS, b, (int)BINS, i);
    for (size_t other = 0; other < i; other++)
      if (memcmp(point + i * POINTS, point + other * POINTS, POINTS * sizeof *point) == 0)
        service_kit_find(k, "quasi_random", "%s: coordinates %zu and %zu are the same", name, other, i);
    for (size_t j = 1; j < POINTS; j++)
      if (point[i * POINTS + j] == point[i * POINTS + j - 1])
        service_kit_find(k, "quasi_random", "%s: points %zu and %zu are the same in coordinate %zu", name, j - 1, j, i);
  }
}

static void check_limits(service_kit *k, const ambit_quasi_random_service *s, const char *name) {
  uint32_t dimensions = 0;
  uint64_t points = 0;
  void *self = NULL;
  double one[1];
  s->most(name, &dimensions, &points);
  k->judged += 4;
  if (dimensions < DIMENSIONS || points < POINTS)
    service_kit_find(k, "quasi_random", "%s has %u dimensions and few points", name, dimensions);
  if (s->open(name, 0, &self) != AMBIT_INVALID || s->open(name, dimensions + 1, &self) != AMBIT_INVALID)
    service_kit_find(k, "quasi_random", "%s opens with 0 or %u dimensions", name, dimensions + 1);
  self = NULL;
  if (s->open(name, 1, &self) != AMBIT_OK) return;
  if (points < SIZE_MAX && s->next(self, (size_t)points + 1, one, 1) != AMBIT_UNABLE)
    service_kit_find(k, "quasi_random", "%s gives more points than it has", name);
  s->close(self);
}

void service_kit_quasi_random(service_kit *k, const ambit_quasi_random_service *s) {
  static const char *const name[] = { "sobol", "niederreiter", "halton", "reverse_halton" };
  size_t bytes = POINTS * DIMENSIONS * sizeof(double);
  uint32_t dimensions = 1;
  uint64_t points = 1;
  void *self = NULL;
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
    double *all = draw(k, s, name[i], POINTS), *parts = draw(k, s, name[i], 7);
    if (all) judge_points(k, name[i], all);
    k->judged++;
    if (all && parts && memcmp(all, parts, bytes) != 0)
      service_kit_find(k, "quasi_random", "%s gives other points in parts", name[i]);
    guarded_close(all, bytes), guarded_close(parts, bytes);
    check_limits(k, s, name[i]);
  }
  s->most("nonesuch", &dimensions, &points);
  k->judged += 2;
  if (dimensions || points) service_kit_find(k, "quasi_random", "it knows a sequence called `nonesuch`");
  if (s->open("nonesuch", 2, &self) != AMBIT_INVALID)
    service_kit_find(k, "quasi_random", "it opens a sequence called `nonesuch`");
}

/* -- elementary */

static double operand(ambit_random *random) {
  static const double nasty[] = { 0.0, -0.0, 1, -1, 0x1p-1074, -0x1p-1074, DBL_MIN, 0x1p53, 1e22, 1e300, DBL_MAX,
    -DBL_MAX, 0x1.921fb54442d18p+0, 0x1.921fb54442d18p+1, 0x1.fffffffffffffp-1, 709.78, -745.2 };
  uint64_t bits = ambit_random_bits(random);
  double unit = ambit_random_in(random, (ambit_interval) { -1, 1 });
  switch (bits % 4) {
  case 0: return nasty[(bits >> 8) % (sizeof nasty / sizeof *nasty)];
  case 1: return ldexp(unit, (int)((bits >> 8) % 2098) - 1074);
  case 2: return unit;
  default: return 8 * unit;
  }
}

void service_kit_elementary(service_kit *k, const ambit_elementary_service *s) {
  ambit_random random = { k->seed };
  for (uint32_t op = AMBIT_OP_EXP; op <= AMBIT_OP_TANH; op++)
    for (int i = 0; i < 600 * fmax(1, k->effort); i++) {
      double x = operand(&random), y = operand(&random), lo = NAN, hi = NAN;
      double down = k->oracle(op, x, y, 0, 0), up = k->oracle(op, x, y, 0, 1);
      if (isnan(down)) continue;
      s->point(op, x, y, &lo, &hi);
      k->judged++;
      if (!(lo == down && hi == up))
        service_kit_find(k, "elementary", "operation %u at (%a, %a): [%a, %a], the tightest bounds are [%a, %a]", op, x,
            y, lo, hi, down, up);
    }
}
