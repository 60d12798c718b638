/* callbacks.c -- a plugin for the tests of exported functions: every kind of argument, and callbacks. */
#include <ambit/export.h>
#include <string.h>

static double scale(double a, double b) { return a * b; }
static int32_t next_int(int32_t i) { return i + 1; }
static int64_t next_long(int64_t i) { return i + 1; }
static const char *greet(const char *name) { return strcmp(name, "Lua") == 0 ? "hello" : "who?"; }

static double sum(const double *x, size_t n) {
  double s = 0;
  for (size_t i = 0; i < n; i++) s += x[i];
  return s;
}

/* midpoint rule */
static double integrate(double a, double b, int32_t n, double (*f)(double x, void *user), void *user) {
  double s = 0, h = (b - a) / n;
  for (int32_t i = 0; i < n; i++) s += h * f(a + (i + 0.5) * h, user);
  return s;
}

static void each(
    const double *x, size_t n, void (*visit)(const double *part, size_t count, int32_t i, void *user), void *user) {
  for (size_t i = 0; i < n; i++) visit(x, i + 1, (int32_t)i, user);
}

/* Counts how often f was called although it fails from its first call on. */
static double stubborn(double (*f)(double x, void *user), void *user) {
  int nan = 0;
  for (int i = 0; i < 10; i++) {
    double y = f(i, user);
    nan += y != y;
  }
  return nan;
}

#define FUNCTION(name, signature, f, doc)                                                                              \
  { name, signature, (void (*)(void))f, doc }

static const ambit_function function[] = {
  FUNCTION("scale", "d(dd)", scale, "a b"),
  FUNCTION("next_int", "i(i)", next_int, "i + 1"),
  FUNCTION("next_long", "l(l)", next_long, "i + 1"),
  FUNCTION("greet", "s(s)", greet, "says hello to Lua"),
  FUNCTION("sum", "d(D)", sum, "sum of a list"),
  FUNCTION("integrate", "d(ddi(d(d)))", integrate, "integral of f over [a, b] by the midpoint rule"),
  FUNCTION("each", "v(D(v(Di)))", each, "calls visit with every beginning of a list"),
  FUNCTION("stubborn", "d((d(d)))", stubborn, "goes on calling"),
};

static const ambit_exports exports = { sizeof exports, sizeof function / sizeof *function, function };
static const void *get(const char *id) { return strcmp(id, AMBIT_EXPORTS) == 0 ? &exports : NULL; }
AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.callbacks", "1.0",
  "Functions for the tests of this binding.", get };
