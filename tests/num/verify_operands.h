/* verify_operands.h -- operands for verify.c: random ones and such as hurt, points and intervals, in every domain. */
#ifndef NUM_VERIFY_OPERANDS_H
#define NUM_VERIFY_OPERANDS_H
#include "elementary_oracle.h"

/* few significant bits: sums, products, roots and powers of these are often exact */
static inline double round_number(uint64_t *s) {
  double sign = random_bits(s) & 1 ? 1 : -1, k = random_below(s, 1 << (1 + random_below(s, 28)));
  return sign * ldexp(k, random_below(s, 40) - 20);
}

static inline double any_real(uint64_t *s) {
  static const double nasty[] = { 0.0, -0.0, 1, -1, 2, -2, 0.5, DBL_MIN, -DBL_MIN, 0x1p-1074, -0x1p-1074, DBL_MAX,
    -DBL_MAX, 0x1.fffffffffffffp-1, 0x1.0000000000001p0, PI_DOWN, -PI_UP, PI_DOWN / 2, PI_UP / 2, 1e300, -1e-300, 3, 10,
    0x1p53 };
  switch (random_below(s, 6)) {
  case 0: return nasty[random_below(s, (int)(sizeof nasty / sizeof *nasty))];
  case 1: return hard_real(s);
  case 2: return round_number(s);
  case 3: return double_of(random_bits(s) % 0x7ff0000000000000) * (random_bits(s) & 1 ? 1 : -1);
  default: return 20 * random_unit(s) - 10;
  }
}

/* a base whose power is a usual number as a rule, or at the edge of one */
static inline double power_base(int32_t n, uint64_t *s) {
  double size = fmax(1, fabs((double)n)), x;
  switch (random_below(s, 6)) {
  case 0: return any_real(s);
  case 1: x = random_below(s, 200); break;
  case 2: x = beside(1, s); break;
  case 3: x = beside(exp2((random_bits(s) & 1 ? 1024 : -1074) / size), s); break;
  default: x = exp2((random_unit(s) - 0.5) * 2050 / size);
  }
  x = fmin(x, DBL_MAX);
  return random_bits(s) & 1 ? x : -x;
}

static inline double any_argument(uint32_t op, int32_t n, uint64_t *s) {
  if (op == AMBIT_OP_POWN) return power_base(n, s);
  bool limited = op == AMBIT_OP_LOG || op == AMBIT_OP_SQRT || op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS;
  if (!limited || random_below(s, 32) == 0) return any_real(s);
  return op == AMBIT_OP_SQRT ? hard_positive(s) : hard_argument(op, s);
}

/* an interval that is never empty; half of them are points */
static inline ambit_interval any_interval(uint32_t op, int32_t n, uint64_t *s) {
  double a = any_argument(op, n, s), b = a;
  switch (random_below(s, 16)) {
  case 0: b = any_argument(op, n, s); break;
  case 1: b = a + fabs(a) * random_scaled(s, 0, 0, 52); break;
  case 2: b = a + random_scaled(s, 0, 4, 12); break;
  case 3: b = nextafter(a, INFINITY); break;
  case 4: b = INFINITY; break;
  case 5: b = -a; break;
  case 6: b = 0; break;
  case 7:
    if (random_below(s, 8) == 0) return AMBIT_ENTIRE;
    a = -INFINITY;
    break;
  default: break;
  }
  if (isinf(a) && a == b) b = 0;
  return a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a };
}

static inline int32_t any_exponent(uint64_t *s) {
  switch (random_below(s, 8)) {
  case 0: return random_below(s, 3) - 1;
  case 1: return random_below(s, 2001) - 1000;
  case 2: return (int32_t)(uint32_t)random_bits(s);
  case 3: return random_bits(s) & 1 ? INT32_MIN : INT32_MAX;
  case 4: return random_below(s, 129) - 64;
  default: return random_below(s, 17) - 8;
  }
}

/* the second operand, sometimes tied to the first: cancellation, quotients next to 1, equal sets */
static inline ambit_interval second_interval(uint32_t op, ambit_interval a, uint64_t *s) {
  if (random_below(s, 8) == 0 && fabs(a.lo) < INFINITY) {
    double x = beside(random_bits(s) & 1 ? a.lo : -a.lo, s);
    if (fabs(x) < INFINITY) return (ambit_interval) { x, x };
  }
  return random_below(s, 32) == 0 ? a : any_interval(op, 1, s);
}
#endif
