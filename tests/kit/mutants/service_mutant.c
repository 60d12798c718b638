/* service_mutant.c -- services with one fault: elementary functions, eigenvalues, sequences, exported functions. */
#include "kit/mutants/mutant.h"
#include "kit/mutants/mutant_conduct.h"
#include <ambit/eigen.h>
#include <ambit/elementary.h>
#include <ambit/export.h>
#include <ambit/quasi_random.h>
#include <math.h>

typedef struct selection {
  const char *name; /* of the fault */
  void (*conduct)(void);
  ambit_elementary_service elementary;
  ambit_eigen_service eigen;
  ambit_quasi_random_service quasi_random;
  const ambit_elementary_service *honest_elementary;
  const ambit_eigen_service *honest_eigen;
  const ambit_quasi_random_service *honest_quasi_random;
  uint64_t calls;
  ambit_exports exports;
  ambit_function function[2];
} selection;

static selection *chosen;

static bool is(const char *name) { return strcmp(chosen->name, name) == 0; }

static void once(void) {
  chosen->calls++;
  if (chosen->conduct && chosen->calls == 3) chosen->conduct();
}

/* -- elementary */

static void point(uint32_t op, double x, double y, double *lo, double *hi) {
  bool turn = op == AMBIT_OP_SIN || op == AMBIT_OP_COS || op == AMBIT_OP_TAN;
  once();
  chosen->honest_elementary->point(op, x, y, lo, hi);
  if (is("one call of 1000 one ulp narrow") && chosen->calls % 1000 == 0) *lo = nextafter(*lo, INFINITY);
  if (is("bounds one ulp wide")) *hi = nextafter(*hi, INFINITY);
  if (is("lower bound is the upper one")) *lo = *hi;
  if (is("bounds exchanged") && *lo < *hi) {
    double down = *lo;
    *lo = *hi, *hi = down;
  }
  if (is("NaN at huge angles") && turn && fabs(x) > 1e15) *lo = *hi = NAN;
  if (is("huge angles one ulp off") && turn && fabs(x) > 1e15) *lo = *hi = nextafter(*lo, 0);
  if (is("cosine is not even") && op == AMBIT_OP_COS && x < 0) *lo = -*lo, *hi = -*hi;
  if (is("sine of 0 is -0 to 0x1p-1074") && op == AMBIT_OP_SIN && x == 0) *hi = 0x1p-1074;
  if (is("exponential underflows to 0") && op == AMBIT_OP_EXP && *hi < 0x1p-1022) *lo = *hi = 0;
  if (is("exponential overflows to DBL_MAX") && op == AMBIT_OP_EXP && isinf(*hi)) *hi = 0x1.fffffffffffffp+1023;
  if (is("logarithm of 1 is not 0") && op == AMBIT_OP_LOG && x == 1) *hi = 0x1p-1074;
  if (is("arc sine wrong at 1") && op == AMBIT_OP_ASIN && fabs(x) == 1) *hi = *lo;
  if (is("arc cosine of negative numbers") && op == AMBIT_OP_ACOS && x < 0) *lo = nextafter(*lo, 4);
  if (is("arc tangent beyond 2^53") && op == AMBIT_OP_ATAN && fabs(x) > 0x1p53) *lo = *hi;
  if (is("angle in the wrong quadrant") && op == AMBIT_OP_ATAN2 && x < 0 && y < 0) *lo += M_PI, *hi += M_PI;
  if (is("angle of (-1, -0) is -pi") && op == AMBIT_OP_ATAN2 && x == 0 && signbit(x) && y < 0) *lo = -*lo, *hi = -*hi;
  if (is("sinh of subnormal numbers") && op == AMBIT_OP_SINH && fabs(x) < 0x1p-1022) *lo = *hi = 0;
  if (is("cosh below 1") && op == AMBIT_OP_COSH && x != 0) *lo = fmin(*lo, nextafter(1, 0));
  if (is("tanh reaches 1") && op == AMBIT_OP_TANH && *hi == 1) *lo = 1;
  if (is("tangent of negative numbers") && op == AMBIT_OP_TAN && x < 0) *hi = nextafter(*hi, 0);
}

/* -- eigen */

static ambit_status decompose(uint32_t n, const double *a, double *re, double *im, double *vector) {
  once();
  ambit_status status = chosen->honest_eigen->decompose(n, a, re, im, vector);
  if (is("never converges")) return AMBIT_UNABLE;
  if (is("does not converge from 10 on") && n >= 10) return AMBIT_UNABLE;
  if (is("an eigenvalue off by 1e-6")) re[n - 1] += 1e-6;
  if (is("an eigenvalue off from 9 on") && n >= 9) re[0] += 1e-3 + 1e-6 * fabs(re[0]);
  if (is("last eigenvalue is 0")) re[n - 1] = im[n - 1] = 0;
  if (is("vectors by rows"))
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t j = 0; j < i; j++) {
        double x = vector[i * n + j];
        vector[i * n + j] = vector[j * n + i], vector[j * n + i] = x;
      }
  if (is("a vector of zeros"))
    for (uint32_t i = 0; i < n; i++) vector[i * n] = 0;
  if (is("pairs begin with the negative one"))
    for (uint32_t j = 0; j < n; j++) im[j] = -im[j];
  if (is("imaginary parts of vectors with the wrong sign"))
    for (uint32_t j = 0; j < n; j++)
      for (uint32_t i = 0; i < n && im[j] < 0; i++) vector[i * n + j] *= -1;
  if (is("imaginary parts forgotten"))
    for (uint32_t j = 0; j < n; j++) im[j] = 0;
  if (is("writes beyond the eigenvalues")) re[n] = 0;
  if (is("writes beyond the vectors")) vector[(size_t)n * n] = 0;
  if (is("reads beyond the matrix")) re[0] += 0 * a[(size_t)n * n];
  if (is("writes into the matrix")) ((double *)(uintptr_t)a)[0] = 1;
  if (is("a NaN among the vectors")) vector[n - 1] = NAN;
  return status;
}

/* -- quasi_random */

static void most(const char *sequence, uint32_t *dimensions, uint64_t *points) {
  once();
  chosen->honest_quasi_random->most(sequence, dimensions, points);
  if (is("one dimension more than it has")) ++*dimensions;
  if (is("knows every name") && !*dimensions) *dimensions = 3, *points = 1000;
}

static ambit_status open_sequence(const char *sequence, uint32_t n, void **self) {
  if (is("opens every name")) {
    ambit_status status = chosen->honest_quasi_random->open(sequence, n, self);
    return status == AMBIT_OK ? status : chosen->honest_quasi_random->open("sobol", n ? n : 1, self);
  }
  if (is("knows no sequence")) return AMBIT_INVALID;
  return chosen->honest_quasi_random->open(sequence, n, self);
}

static ambit_status next(void *self, size_t count, double *p, size_t stride) {
  if (is("gives more points than it has") && count > 1000) return AMBIT_OK;
  ambit_status status = chosen->honest_quasi_random->next(self, count, p, stride);
  if (status != AMBIT_OK || count < 4) return status;
  if (is("a coordinate that is 1")) p[2] = 1;
  if (is("a negative coordinate")) p[3] = -0x1p-60;
  if (is("a point of NaN")) p[1] = NAN;
  if (is("the same point twice")) p[1] = p[0];
  if (is("two coordinates are one")) memcpy(p + stride, p, count * sizeof *p);
  if (is("fills a half only"))
    for (size_t k = 0; k < count; k++) p[k] *= 0.5;
  if (is("writes one point too many")) p[count] = 0.5;
  if (is("the last point is left out")) p[count - 1] = -7;
  if (is("other points in parts") && count < 20) p[0] = 0.5 * p[1];
  return status;
}

/* -- exported functions */

static double twice(double x) {
  once();
  return 2 * x;
}
static double changing(double x) { return x + (double)chosen->calls++; }
static double beyond(const double *x, size_t n) { return x[n]; }
static double divides(double x) {
  if (isnan(x)) abort();
  return 1 / x;
}

static void export(void) {
  chosen->exports = (ambit_exports) { sizeof chosen->exports, 1, chosen->function };
  ambit_function f = { "twice", "d(d)", (void (*)(void))twice, "two times x" };
  if (is("exports a function without a name")) f.name = "";
  if (is("exports a name with a blank")) f.name = "two times";
  if (is("exports no signature")) f.signature = NULL;
  if (is("exports a signature that does not end")) f.signature = "d(d";
  if (is("exports a signature of unknown letters")) f.signature = "d(x)";
  if (is("exports a function that is none")) f.call = NULL;
  if (is("exports no sentence")) f.doc = NULL;
  if (is("exports a function that changes its mind")) f.call = (void (*)(void))changing;
  if (is("exports a function that reads beyond its array")) f.call = (void (*)(void))beyond, f.signature = "d(D)";
  if (is("exports a function that aborts at NaN")) f.call = (void (*)(void))divides;
  chosen->function[0] = chosen->function[1] = f;
  if (is("exports two functions of one name")) chosen->exports.count = 2;
  if (is("exports nothing")) chosen->exports.count = 0;
}

/* -- the faults */

static const char *const faults[] = { "one call of 1000 one ulp narrow", "bounds one ulp wide",
  "lower bound is the upper one", "bounds exchanged", "NaN at huge angles", "huge angles one ulp off",
  "cosine is not even", "sine of 0 is -0 to 0x1p-1074", "exponential underflows to 0",
  "exponential overflows to DBL_MAX", "logarithm of 1 is not 0", "arc sine wrong at 1",
  "arc cosine of negative numbers", "arc tangent beyond 2^53", "angle in the wrong quadrant",
  "angle of (-1, -0) is -pi", "sinh of subnormal numbers", "cosh below 1", "tanh reaches 1",
  "tangent of negative numbers", "never converges", "does not converge from 10 on", "an eigenvalue off by 1e-6",
  "an eigenvalue off from 9 on", "last eigenvalue is 0", "vectors by rows", "a vector of zeros",
  "pairs begin with the negative one", "imaginary parts of vectors with the wrong sign", "imaginary parts forgotten",
  "writes beyond the eigenvalues", "writes beyond the vectors", "reads beyond the matrix", "writes into the matrix",
  "a NaN among the vectors", "one dimension more than it has", "knows every name", "opens every name",
  "knows no sequence", "gives more points than it has", "a coordinate that is 1", "a negative coordinate",
  "a point of NaN", "the same point twice", "two coordinates are one", "fills a half only", "writes one point too many",
  "the last point is left out", "other points in parts", "exports a function without a name",
  "exports a name with a blank", "exports no signature", "exports a signature that does not end",
  "exports a signature of unknown letters", "exports a function that is none", "exports no sentence",
  "exports a function that changes its mind", "exports a function that reads beyond its array",
  "exports a function that aborts at NaN", "exports two functions of one name", "exports nothing",
  "offers no interface that anybody knows" };
enum { FAULTS = sizeof faults / sizeof *faults };

AMBIT_EXPORT const char *ambit_mutant_name(size_t i);
const char *ambit_mutant_name(size_t i) {
  return i < FAULTS ? faults[i] : i < FAULTS + CONDUCT_FAULTS ? conduct_faults[i - FAULTS].name : NULL;
}

__attribute__((constructor)) static void choose(void);
static void choose(void) {
  chosen = calloc(1, sizeof *chosen);
  chosen->name = strdup(mutant_wanted());
  chosen->conduct = conduct_of(chosen->name);
  chosen->honest_elementary = mutant_base("elementary", AMBIT_ELEMENTARY_SERVICE);
  chosen->honest_eigen = mutant_base("eigen", AMBIT_EIGEN_SERVICE);
  chosen->honest_quasi_random = mutant_base("quasi_random", AMBIT_QUASI_RANDOM_SERVICE);
  if (!chosen->honest_elementary || !chosen->honest_eigen || !chosen->honest_quasi_random) exit(1);
  chosen->elementary = (ambit_elementary_service) { sizeof chosen->elementary, point };
  chosen->eigen = (ambit_eigen_service) { sizeof chosen->eigen, decompose };
  chosen->quasi_random = (ambit_quasi_random_service) { sizeof chosen->quasi_random, most, open_sequence, next,
    chosen->honest_quasi_random->close };
  export();
}

static const void *get(const char *id) {
  bool nothing = is("exports nothing");
  if (is("offers no interface that anybody knows")) return NULL;
  if (strcmp(id, AMBIT_EXPORTS) == 0) return &chosen->exports;
  if (strcmp(id, AMBIT_ELEMENTARY_SERVICE) == 0 && !nothing) return &chosen->elementary;
  if (strcmp(id, AMBIT_EIGEN_SERVICE) == 0 && !nothing) return &chosen->eigen;
  if (strcmp(id, AMBIT_QUASI_RANDOM_SERVICE) == 0 && !nothing) return &chosen->quasi_random;
  return NULL;
}

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.service_mutant", "1.0",
  "Services with one fault.", get };
