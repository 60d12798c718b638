/* digital.c -- direction numbers of digital sequences in base 2.
**
** Sobol (1967), with the recurrence of Bratley and Fox (1988): m_k = 2 a_1 m_(k-1) + ... + 2^s m_(k-s) + m_(k-s)
** without carries, for the primitive polynomial x^s + a_1 x^(s-1) + ... + 1. Niederreiter (1988) in base 2: row j of
** dimension i's matrix has the coefficients of x^u / p^q in powers of 1/x, for the i-th irreducible polynomial p of
** degree e and j = (q - 1) e + u, u < e.
*/
#include "sequences.h"

static uint32_t degree_of(uint64_t polynomial) {
  uint32_t degree = 0;
  while (polynomial >> (degree + 1)) degree++;
  return degree;
}

/* returns the entry of the next dimension */
static const uint16_t *sobol_dimension(const uint16_t *entry, uint32_t *direction) {
  uint32_t polynomial = entry[0], s = degree_of(polynomial), m[DIGITS] = { 0 };
  for (uint32_t k = 0; k < DIGITS; k++) {
    m[k] = k < s ? entry[1 + k] : m[k - s] ^ (m[k - s] << s);
    for (uint32_t j = 1; k >= s && j < s; j++)
      if (polynomial >> (s - j) & 1) m[k] ^= m[k - j] << j;
    direction[k] = m[k] << (DIGITS - 1 - k);
  }
  return entry + 1 + s;
}

void sobol_directions(uint32_t n, uint32_t *direction) {
  const uint16_t *entry = joe_kuo;
  for (uint32_t r = 0; r < DIGITS; r++) direction[r] = UINT32_C(1) << (DIGITS - 1 - r);
  for (uint32_t i = 1; i < n; i++) entry = sobol_dimension(entry, direction + (size_t)i * DIGITS);
}

/* polynomials over the field of two elements: bit k is the coefficient of x^k */
static uint64_t times(uint64_t a, uint64_t b) {
  uint64_t product = 0;
  for (; b; b >>= 1, a <<= 1)
    if (b & 1) product ^= a;
  return product;
}

static int is_divisible(uint64_t a, uint64_t b) {
  uint32_t e = degree_of(b);
  while (a && degree_of(a) >= e) a ^= b << (degree_of(a) - e);
  return a == 0;
}

static int is_irreducible(uint64_t p) {
  for (uint64_t q = 2; 2 * degree_of(q) <= degree_of(p); q++)
    if (is_divisible(p, q)) return 0;
  return 1;
}

/* coefficients of 1/x^1, 1/x^2, ... in 1/p, p of degree d; count of them */
static void expand(uint64_t p, uint32_t d, uint32_t count, uint32_t *coefficient) {
  for (uint32_t r = 0; r < count; r++) {
    coefficient[r] = r + 1 == d;
    for (uint32_t k = 1; k <= d && k <= r; k++)
      if (p >> (d - k) & 1) coefficient[r] ^= coefficient[r - k];
  }
}

static void niederreiter_dimension(uint64_t p, uint32_t *direction) {
  uint32_t e = degree_of(p);
  uint64_t power = 1;
  uint32_t coefficient[2 * DIGITS];
  for (uint32_t r = 0; r < DIGITS; r++) direction[r] = 0;
  for (uint32_t j = 0; j < DIGITS; j++) {
    uint32_t u = j % e;
    if (u == 0) {
      power = times(power, p);
      expand(power, degree_of(power), 2 * DIGITS, coefficient);
    }
    for (uint32_t r = 0; r < DIGITS; r++) direction[r] |= coefficient[r + u] << (DIGITS - 1 - j);
  }
}

void niederreiter_directions(uint32_t n, uint32_t *direction) {
  uint64_t p = 2;
  for (uint32_t i = 0; i < n; i++, p++) {
    while (!is_irreducible(p)) p++;
    niederreiter_dimension(p, direction + (size_t)i * DIGITS);
  }
}
