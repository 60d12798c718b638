/* halton.c -- radical inverses (van der Corput 1935, Halton 1960), with reversed digits (Vandewoestyne & Cools 2006).
** The first points of many dimensions are strung along lines; the reversed digits break these up. */
#include "sequences.h"

void first_primes(uint32_t n, uint32_t *prime) {
  for (uint32_t count = 0, candidate = 2; count < n; candidate++) {
    uint32_t k = 0;
    while (k < count && prime[k] * prime[k] <= candidate && candidate % prime[k]) k++;
    if (k == count || prime[k] * prime[k] > candidate) prime[count++] = candidate;
  }
}

/* Both integers stay below 2^53, so the quotient is below 1. */
double radical_inverse(uint64_t k, uint32_t base, int is_reversed) {
  uint64_t mirrored = 0, scale = 1;
  for (; k; k /= base, scale *= base) {
    uint64_t digit = k % base;
    mirrored = mirrored * base + (is_reversed && digit ? base - digit : digit);
  }
  return (double)mirrored / (double)scale;
}
