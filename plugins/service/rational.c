/* rational.c -- "ambit.rational/1" by GMP. */
#include <ambit/rational.h>
#include <ctype.h>
#include <float.h>
#include <gmp.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct ambit_rational {
  mpq_t q;
};

#define MOST_EXPONENT 5000 /* of ten */
#define MOST_BITS 100000
#define MOST_POWER 1000
#define FAR 1000000L /* an exponent that no number of digits makes small enough again */

/* The digits of [s, end) without the point in memory that the caller frees; *fraction of them stand behind it. */
static char *digits_of(const char *s, const char *end, long *fraction) {
  char *digits = malloc((size_t)(end - s) + 1), *to = digits;
  if (!digits) return NULL;
  *fraction = 0;
  for (bool behind = false; s < end; s++) {
    if (*s == '.') {
      behind = true;
      continue;
    }
    *to++ = *s, *fraction += behind;
  }
  *to = '\0';
  return digits;
}

/* q := digits 10^exponent */
static bool set_decimal(mpq_t q, const char *digits, long exponent) {
  if (exponent < -MOST_EXPONENT || exponent > MOST_EXPONENT || mpz_set_str(mpq_numref(q), digits, 10)) return false;
  mpz_set_ui(mpq_denref(q), 1);
  mpz_t power;
  mpz_init(power);
  mpz_ui_pow_ui(power, 10, (unsigned long)labs(exponent));
  if (exponent < 0)
    mpz_set(mpq_denref(q), power);
  else
    mpz_mul(mpq_numref(q), mpq_numref(q), power);
  mpz_clear(power);
  mpq_canonicalize(q);
  return true;
}

/* "12.5e-3" without a sign; returns its end, or NULL */
static const char *read_decimal(const char *s, mpq_t q) {
  const char *end = s;
  int points = 0;
  for (; isdigit((unsigned char)*end) || *end == '.'; end++) points += *end == '.';
  if (end - s <= points || points > 1 || end - s > MOST_BITS / 4) return NULL;
  long exponent = 0, fraction;
  const char *after = end;
  if (*end == 'e' || *end == 'E') {
    char *stop;
    exponent = strtol(end + 1, &stop, 10); /* saturates */
    if (stop == end + 1 || isspace((unsigned char)end[1])) return NULL;
    after = stop;
  }
  char *digits = digits_of(s, end, &fraction);
  if (exponent > FAR) exponent = FAR; /* LONG_MIN has no absolute value */
  if (exponent < -FAR) exponent = -FAR;
  bool good = digits && set_decimal(q, digits, exponent - fraction);
  free(digits);
  return good ? after : NULL;
}

/* a literal of the graph, without white space: a decimal, or a quotient of two */
static bool read_literal(const char *text, mpq_t q) {
  bool negative = *text == '-';
  const char *end = read_decimal(text + (negative || *text == '+'), q);
  if (end && *end == '/') {
    mpq_t divisor;
    mpq_init(divisor);
    end = read_decimal(end + 1, divisor);
    if (end && mpq_sgn(divisor) == 0) end = NULL;
    if (end) mpq_div(q, q, divisor);
    mpq_clear(divisor);
  }
  if (negative) mpq_neg(q, q);
  return end && *end == '\0';
}

static bool is_short(const mpq_t q) {
  return mpz_sizeinbase(mpq_numref(q), 2) + mpz_sizeinbase(mpq_denref(q), 2) <= MOST_BITS;
}

static bool power(mpq_t q, int32_t n) {
  if (n < -MOST_POWER || n > MOST_POWER || (n < 0 && mpq_sgn(q) == 0)) return false;
  unsigned long by = (unsigned long)labs((long)n);
  mpz_pow_ui(mpq_numref(q), mpq_numref(q), by);
  mpz_pow_ui(mpq_denref(q), mpq_denref(q), by);
  if (n < 0) mpq_inv(q, q);
  return true;
}

/* q := q op b */
static bool combine(uint32_t op, mpq_t q, const mpq_t b) {
  switch (op) {
  case AMBIT_OP_NEG: mpq_neg(q, q); return true;
  case AMBIT_OP_ABS: mpq_abs(q, q); return true;
  case AMBIT_OP_SQR: mpq_mul(q, q, q); return true;
  case AMBIT_OP_ADD: mpq_add(q, q, b); return true;
  case AMBIT_OP_SUB: mpq_sub(q, q, b); return true;
  case AMBIT_OP_MUL: mpq_mul(q, q, b); return true;
  case AMBIT_OP_DIV:
    if (mpq_sgn(b) == 0) return false;
    mpq_div(q, q, b);
    return true;
  default: return false;
  }
}

static ambit_rational *open(void) {
  ambit_rational *x = malloc(sizeof *x);
  if (x) mpq_init(x->q);
  return x;
}

static void close(ambit_rational *x) {
  if (x) mpq_clear(x->q);
  free(x);
}

static void set(ambit_rational *x, double value) { mpq_set_d(x->q, value); }

static uint32_t read(ambit_rational *x, const char *literal) { return read_literal(literal, x->q); }

static uint32_t apply(ambit_rational *x, uint32_t op, const ambit_rational *b, int32_t n) {
  return (op == AMBIT_OP_POWN ? power(x->q, n) : combine(op, x->q, b->q)) && is_short(x->q);
}

static void go(ambit_rational *x, const ambit_rational *first, const ambit_rational *period, uint32_t k) {
  mpq_set_ui(x->q, k, 1);
  mpq_mul(x->q, x->q, period->q);
  mpq_add(x->q, x->q, first->q);
}

static int32_t compare(const ambit_rational *a, const ambit_rational *b) {
  int side = mpq_cmp(a->q, b->q);
  return (side > 0) - (side < 0);
}

static void enclose(const ambit_rational *x, double *lo, double *hi) {
  mpq_t at;
  mpq_init(at);
  *lo = -INFINITY, *hi = -DBL_MAX;
  mpq_set_d(at, DBL_MAX);
  if (mpq_cmp(x->q, at) > 0) {
    *lo = DBL_MAX, *hi = INFINITY;
  } else if (mpq_set_d(at, -DBL_MAX), mpq_cmp(x->q, at) >= 0) {
    double d = mpq_get_d(x->q); /* towards zero */
    mpq_set_d(at, d);
    int side = mpq_cmp(x->q, at);
    *lo = side < 0 ? nextafter(d, -INFINITY) : d, *hi = side > 0 ? nextafter(d, INFINITY) : d;
  }
  mpq_clear(at);
}

static const ambit_rational_service service = { sizeof service, open, close, set, read, apply, go, compare, enclose };
static const void *get(const char *id) { return strcmp(id, AMBIT_RATIONAL_SERVICE) == 0 ? &service : NULL; }
AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.rational", "1.0",
  "Exact quotients of decimals. The kernel loads it for sampled systems, whose instants it compares.", get };
