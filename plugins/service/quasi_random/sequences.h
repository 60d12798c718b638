/* sequences.h -- the sequences behind "ambit.quasi_random/1". */
#ifndef QUASI_RANDOM_SEQUENCES_H
#define QUASI_RANDOM_SEQUENCES_H
#include <stddef.h>
#include <stdint.h>

enum { DIGITS = 32, SOBOL_MAX = 256, NIEDERREITER_MAX = 32, HALTON_MAX = 1229 /* primes below 10^4 */ };

extern const uint16_t joe_kuo[];

/* Direction numbers of n dimensions, direction[i * DIGITS + r]: what bit r of a point's number adds, in 2^-DIGITS. */
void sobol_directions(uint32_t n, uint32_t *direction);
void niederreiter_directions(uint32_t n, uint32_t *direction);

/* the first n primes */
void first_primes(uint32_t n, uint32_t *prime);
/* The digits of k in this base behind the point in opposite order, in [0, 1); each digit d > 0 as base - d if reversed.
*/
double radical_inverse(uint64_t k, uint32_t base, int is_reversed);
#endif
