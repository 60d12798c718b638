/* arithmetic_case.h -- the conformance kit as a cmocka test. */
#ifndef AMBIT_ARITHMETIC_CASE_H
#define AMBIT_ARITHMETIC_CASE_H
#include "kit/arithmetic_kit.h"
#include "kit/arithmetic_loader.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

static inline double case_oracle(uint32_t op, double x, double y, int32_t n, bool up) {
  return oracle_rounded(op, x, y, n, up ? MPFR_RNDU : MPFR_RNDD);
}

static inline void case_finding(void *user, const char *check, const char *message) {
  (void)user;
  print_error("%s: %s\n", check, message);
}

static inline void case_fallback(void *user, const char *operation) {
  (void)operation;
  ++*(size_t *)user;
}

/* The number of findings; *fallbacks: operations left to the kernel. */
static inline size_t case_run(const arithmetic_loader *l, bool isotonic, size_t *fallbacks) {
  *fallbacks = 0;
  arithmetic_kit kit = { .plugin = l->plugin,
    .full = &l->full,
    .host = &l->scope->host,
    .isotonic = isotonic,
    .seed = 4711,
    .oracle = case_oracle,
    .finding = case_finding,
    .fallback = case_fallback,
    .user = fallbacks };
  return arithmetic_kit_run(&kit);
}

static inline void case_load(arithmetic_loader *l, const char *name) {
  const char *problem = arithmetic_load(l, name);
  if (problem) fail_msg("%s", problem);
}
#endif
