/* elementary_oracle.h -- what the tests of the elementary functions compare with, and arguments that are hard for
** them. */
#ifndef ELEMENTARY_ORACLE_H
#define ELEMENTARY_ORACLE_H
#include "image.h"
#include "num/elementary.h"
#include "num/elementary_variant.h"
#include <string.h>

/* a slow path that is right */
static inline void oracle_slow(uint32_t op, double x, double y, double *lo, double *hi) {
  ambit_interval r = image_point(op, x, y, 0);
  *lo = r.lo, *hi = r.hi;
}

/* ---- arguments ---- */
static inline uint64_t random_bits(uint64_t *state) {
  *state ^= *state << 13, *state ^= *state >> 7, *state ^= *state << 17;
  return *state;
}
static inline double random_unit(uint64_t *state) { return (double)(random_bits(state) >> 11) * 0x1p-53; }
static inline double double_of(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}
/* up to 4 doubles beside x */
static inline double beside(double x, uint64_t *state) {
  for (uint64_t k = random_bits(state) % 5; k-- > 0;) x = nextafter(x, random_bits(state) & 1 ? INFINITY : -INFINITY);
  return x;
}

/* in [0, n) */
static inline int random_below(uint64_t *s, int n) { return (int)(random_bits(s) % (uint64_t)n); }
/* (0.xxx - shift) 2^(exponent - 0 .. range - 1); the order of the draws is fixed, so that every compiler's are equal */
static inline double random_scaled(uint64_t *s, double shift, int exponent, int range) {
  double u = random_unit(s) - shift;
  return ldexp(u, exponent - random_below(s, range));
}

static inline double hard_positive(uint64_t *s) {
  switch (random_below(s, 8)) {
  case 0: return beside(1, s);
  case 1: return 1 + random_scaled(s, 0.5, 0, 52);
  case 2: return double_of(1 + random_bits(s) % 0xfffffffffffff);
  case 3: return double_of(1 + random_bits(s) % 1000);
  case 4: return beside(ldexp(1, random_below(s, 2000) - 1000), s);
  case 5: {
    double c = 1 + (double)random_below(s, 512) / 512;
    return beside(ldexp(c, random_below(s, 5) - 2), s);
  }
  case 6: return double_of(0x7fefffffffffffff - random_bits(s) % 100);
  default: return double_of(1 + random_bits(s) % 0x7fefffffffffffff);
  }
}

/* any sign; break points of every reduction, neighbours of multiples of pi/2 and ln 2, tiny, subnormal, huge, edges
** of overflow */
static inline double hard_real(uint64_t *s) {
  double sign = random_bits(s) & 1 ? 1 : -1, k = random_below(s, 4096);
  switch (random_below(s, 18)) {
  case 0: return sign * double_of(random_bits(s) % 0x7ff0000000000000);
  case 1: return sign * random_scaled(s, 0, 0, 1070);
  case 2: return sign * double_of(random_bits(s) % 0x10000000000000);
  case 3: return sign * double_of(random_bits(s) % 20);
  case 4: return beside(sign * k * (PI_DOWN / 2), s);
  case 5: return beside(sign * (k * 25 + 0.5) * (PI_DOWN / 128), s);
  case 6: return sign * random_scaled(s, 0, 60, 60);
  case 7: return sign * (double)random_below(s, 1000000000) * (PI_DOWN / 2);
  case 8: return sign * 1000 * random_unit(s);
  case 9: return sign * random_scaled(s, -1, 41, 6);
  case 10: return beside(sign * (k + 0.5) / 32, s);
  case 11: return beside(sign * 32 / (k + 0.5), s);
  case 12: return beside(sign * k * 0x1.62e42fefa39efp-2, s);
  case 13: return sign * (690 + 60 * random_unit(s));
  case 14: return sign * (1 - random_scaled(s, 0, 0, 53));
  case 15: return sign * random_unit(s);
  default: return sign * 10 * random_unit(s);
  }
}

/* a hard argument in the domain of op */
static inline double hard_argument(uint32_t op, uint64_t *s) {
  if (op == AMBIT_OP_LOG) return hard_positive(s);
  double x = hard_real(s);
  if (op != AMBIT_OP_ASIN && op != AMBIT_OP_ACOS) return x;
  while (fabs(x) > 1) x = random_bits(s) % 4 ? 1 / x : hard_real(s);
  return x;
}
#endif
