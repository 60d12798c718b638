/* random.h -- reproducible draws: SplitMix64 (Steele, Lea & Flood 2014), the same numbers on every machine. */
#ifndef AMBIT_RANDOM_H
#define AMBIT_RANDOM_H
#include <ambit/interval.h>
#include <stdbool.h>

typedef struct ambit_random {
  uint64_t state; /* start with any seed */
} ambit_random;

static inline uint64_t ambit_random_bits(ambit_random *r) {
  uint64_t z = r->state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

/* as if so many numbers had been taken: the state is a counter */
static inline void ambit_random_skip(ambit_random *r, uint64_t count) {
  r->state += count * UINT64_C(0x9e3779b97f4a7c15);
}

/* a double of the bounded, nonempty x */
static inline double ambit_random_in(ambit_random *r, ambit_interval x) {
  double u = (double)(ambit_random_bits(r) >> 11) * 0x1p-53; /* [0, 1) */
  double v = x.lo * (1 - u) + x.hi * u;
  return v < x.lo ? x.lo : v > x.hi ? x.hi : v;
}
#endif
