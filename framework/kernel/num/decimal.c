/* decimal.c -- literals of IEEE 1788-2015 (clauses 9.7 and 12.11) to enclosures.
**
** Bounds come from the C library's strtod in downward and upward mode: glibc's conversion is correctly rounded in the
** current mode for decimal and hexadecimal text of any length (tested against MPFR). The scan decides what belongs to
** a literal, so that strtod never sees "nan", "infinity" or a locale's digits. Sums of an uncertain literal and
** quotients are first made exact decimals (decimal_digits.h), so that their bounds are the tightest too.
*/
#include "num/decimal.h"
#include "num/decimal_digits.h"
#include "num/environment.h"
#include "num/interval.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is being read, for messages; the first failure stays. */
typedef struct reader {
  const char *text;
  ambit_failure *failure;
  ambit_status status;
  ambit_interval inner; /* of a set */
} reader;

/* returns NULL, the end of nothing */
static const char *no_number(reader *r) {
  if (r->status != AMBIT_OK) return NULL;
  r->status = ambit_fail(r->failure, AMBIT_INVALID,
      "\"%s\" is no number: expected for example \"0.1\", \"1/3\", \"2e-3\", \"pi\", \"[0.1, 0.2]\" or \"3.56?2\"",
      r->text);
  return NULL;
}
static const char *refused(reader *r, ambit_status status, const char *why) {
  if (r->status == AMBIT_OK) r->status = ambit_fail(r->failure, status, "\"%s\"%s", r->text, why);
  return NULL;
}
static bool no_memory(reader *r) {
  (void)refused(r, AMBIT_NOMEM, ": out of memory");
  return false;
}

/* ---- scanning; each returns the end of what it is named after */

static const char *skip_blank(const char *s) {
  while (*s == ' ' || *s == '\t' || *s == '\n' || *s == '\r') s++;
  return s;
}

static const char *skip_digits(const char *s, int base) {
  while (base == 16 ? isxdigit((unsigned char)*s) : isdigit((unsigned char)*s)) s++;
  return s;
}

static const char *skip_sign(const char *s) { return *s == '+' || *s == '-' ? s + 1 : s; }

/* "12.5", ".5", "1.8" in base 16; NULL if there is no digit */
static const char *skip_mantissa(const char *s, int base) {
  const char *whole = skip_digits(s, base), *end = whole;
  if (*whole == '.') end = skip_digits(whole + 1, base);
  return end - s > (*whole == '.') ? end : NULL;
}

static const char *skip_exponent(const char *s, char letter) {
  if (tolower((unsigned char)*s) != letter) return s;
  const char *digits = skip_sign(s + 1), *end = skip_digits(digits, 10);
  return end > digits ? end : s;
}

/* a number with its sign, or NULL */
static const char *skip_number(const char *s) {
  s = skip_sign(s);
  bool hex = s[0] == '0' && (s[1] == 'x' || s[1] == 'X');
  const char *end = skip_mantissa(hex ? s + 2 : s, hex ? 16 : 10);
  return end ? skip_exponent(end, hex ? 'p' : 'e') : NULL;
}

/* Words may be in capitals; not by tolower, which in Turkish makes no i of I. */
static bool starts_with_word(const char *s, const char *word) {
  for (; *word; s++, word++)
    if (*s != *word && *s != *word - 'a' + 'A') return false;
  return !isalnum((unsigned char)*s);
}

/* ---- exact decimals */

static void round_text(const char *text, ambit_interval *x) {
  ambit_environment old = ambit_environment_enter();
  ambit_environment_down();
  x->lo = strtod(text, NULL);
  ambit_environment_up();
  x->hi = strtod(text, NULL);
  ambit_environment_leave(old);
}

/* the enclosure of [s, end) */
static bool convert(reader *r, const char *s, const char *end, ambit_interval *x) {
  char small[128], *text = small;
  size_t n = (size_t)(end - s);
  if (n >= sizeof small && !(text = malloc(n + 1))) return no_memory(r);
  memcpy(text, s, n);
  text[n] = '\0';
  round_text(text, x);
  if (text != small) free(text);
  return true;
}

#define EXPONENT_ROOM 32

/* the enclosure of +-digits 10^exponent */
static bool convert_digits(reader *r, bool negative, ambit_digits a, long exponent, ambit_interval *x) {
  char *text = malloc(a.n + EXPONENT_ROOM), *s = text;
  if (!text) return no_memory(r);
  if (negative) *s++ = '-';
  *s++ = '0';
  for (size_t i = 0; i < a.n; i++) *s++ = (char)('0' + a.d[i]);
  snprintf(s, EXPONENT_ROOM - 2, "e%ld", exponent);
  round_text(text, x);
  free(text);
  return true;
}

/* The digits of [s, end) in memory of n + extra bytes that the caller frees; behind a point, *fraction of them. */
static bool copy_digits(reader *r, const char *s, const char *end, size_t extra, ambit_digits *a, size_t *fraction) {
  a->d = malloc((size_t)(end - s) + extra + 1);
  a->n = 0;
  if (!a->d) return no_memory(r);
  const char *point = memchr(s, '.', (size_t)(end - s));
  for (; s < end; s++)
    if (*s != '.') a->d[a->n++] = (unsigned char)(*s - '0');
  if (fraction) *fraction = point ? (size_t)(end - point) - 1 : 0;
  return true;
}

/* ---- quotients */

/* All doubles are multiples of 10^-1074, so that none lies between two neighbours of this many places. */
#define PLACES 1075
#define QUOTIENT_MOST 1000 /* longer numbers are rounded first: division takes the product of their lengths */

static bool is_natural(const char *s, const char *end) { return skip_digits(s, 10) == end; }

/* p / q for integers [s, slash) and (slash, end), q > 0: floor(10^PLACES p/q) and, if that is not all, a 5 behind */
static bool divide_exactly(reader *r, const char *s, const char *slash, const char *end, ambit_interval *x) {
  ambit_digits p = { NULL, 0 }, q = { NULL, 0 }, quotient = { NULL, 0 }, rest = { NULL, 0 };
  bool done = copy_digits(r, skip_sign(s), slash, 0, &p, NULL) && copy_digits(r, slash + 1, end, 0, &q, NULL);
  if (done) {
    quotient.d = malloc(p.n + PLACES + 1);
    rest.d = malloc(q.n + 1);
    done = (quotient.d && rest.d) || no_memory(r);
  }
  if (done) {
    int exact = ambit_digits_divide(&quotient, &rest, p, PLACES, q);
    quotient.d[quotient.n++] = exact ? 0 : 5;
    done = convert_digits(r, *s == '-', quotient, -PLACES - 1, x);
  }
  free(p.d), free(q.d), free(quotient.d), free(rest.d);
  return done;
}

/* "p/q" from the number [s, slash) and what follows */
static const char *read_quotient(reader *r, const char *s, const char *slash, ambit_interval *x) {
  ambit_interval divisor;
  const char *end = isdigit((unsigned char)slash[1]) ? skip_number(slash + 1) : NULL;
  if (!end) return slash;
  if (!convert(r, slash + 1, end, &divisor)) return NULL;
  if (divisor.lo <= 0) return no_number(r);
  bool exact = ambit_interval_is_point(*x) && ambit_interval_is_point(divisor);
  if (!exact && end - s <= QUOTIENT_MOST && is_natural(skip_sign(s), slash) && is_natural(slash + 1, end))
    return divide_exactly(r, s, slash, end, x) ? end : NULL;
  *x = ambit_interval_div(*x, divisor);
  return end;
}

/* ---- bounds and points */

/* a number, a quotient of numbers, or pi, each with a sign */
static const char *read_number(reader *r, const char *s, ambit_interval *x) {
  const char *bare = skip_sign(s);
  if (starts_with_word(bare, "pi")) {
    *x = ambit_interval_pi();
    if (*s == '-') *x = (ambit_interval) { -x->hi, -x->lo };
    return bare + 2;
  }
  const char *end = skip_number(s);
  if (!end) return no_number(r);
  if (!convert(r, s, end, x)) return NULL;
  return *end == '/' ? read_quotient(r, s, end, x) : end;
}

static const char *read_bound(reader *r, const char *s, ambit_interval *x) {
  const char *bare = skip_sign(s);
  const char *word = starts_with_word(bare, "infinity") ? "infinity" : starts_with_word(bare, "inf") ? "inf" : NULL;
  if (!word) return read_number(r, s, x);
  double value = *s == '-' ? -INFINITY : INFINITY;
  *x = (ambit_interval) { value, value };
  return bare + strlen(word);
}

/* "[l, u]", "[l,]", "[,u]", "[,]", "[x]": s is behind the bracket, the end before the other one */
static const char *read_bounds(reader *r, const char *s, ambit_interval *x) {
  ambit_interval lo = { -INFINITY, -INFINITY }, hi = { INFINITY, INFINITY };
  if (*s != ',' && !(s = read_bound(r, s, &lo))) return NULL;
  s = skip_blank(s);
  if (*s != ',') {
    hi = lo;
  } else {
    s = skip_blank(s + 1);
    if (*s != ']' && !(s = read_bound(r, s, &hi))) return NULL;
  }
  if (*skip_blank(s) != ']') return no_number(r);
  if (lo.lo > hi.lo || lo.hi > hi.hi) return refused(r, AMBIT_INVALID, ": the lower bound is above the upper one");
  r->inner = ambit_interval_of(lo.hi, hi.lo);
  *x = ambit_interval_of(lo.lo, hi.hi);
  return ambit_interval_is_empty(*x) ? refused(r, AMBIT_INVALID, " holds no real number") : s;
}

#define DECORATED                                                                                                      \
  ": Ambit's intervals are bare, without the decorations of IEEE 1788 (_com, _dac, _def, _trv, _ill, [nai])"

static const char *read_brackets(reader *r, const char *s, ambit_interval *x) {
  s = skip_blank(s);
  if (starts_with_word(s, "nai")) return refused(r, AMBIT_INVALID, DECORATED);
  if (starts_with_word(s, "empty") || *s == ']') {
    *x = AMBIT_EMPTY;
    s += *s == ']' ? 0 : strlen("empty");
  } else if (starts_with_word(s, "entire")) {
    *x = r->inner = AMBIT_ENTIRE;
    s += strlen("entire");
  } else if (!(s = read_bounds(r, s, x))) {
    return NULL;
  }
  s = skip_blank(s);
  return *s == ']' ? s + 1 : no_number(r);
}

/* ---- uncertain literals: "m?r", m with its radius r in units of its last place */

typedef struct uncertain {
  bool negative, down, up, infinite;
  ambit_digits middle, radius; /* in units of 10^exponent */
  long exponent;
} uncertain;

#define EXPONENT_MAX 1000000000000L /* beyond any text and any double */

static long bounded_exponent(const char *digits) {
  long exponent = strtol(digits, NULL, 10); /* saturates */
  return exponent > EXPONENT_MAX ? EXPONENT_MAX : exponent < -EXPONENT_MAX ? -EXPONENT_MAX : exponent;
}

static bool is_uncertain(const char *s) {
  const char *end = skip_mantissa(skip_sign(s), 10);
  return end && *end == '?';
}

static const char *scan_uncertain(reader *r, const char *s, uncertain *u) {
  size_t fraction = 0;
  *u = (uncertain) { .negative = *s == '-', .down = true, .up = true };
  const char *mantissa = skip_sign(s), *mark = skip_mantissa(mantissa, 10);
  if (!copy_digits(r, mantissa, mark, 1, &u->middle, &fraction)) return NULL;
  const char *radius = mark + 1, *end = skip_digits(radius, 10);
  if (!copy_digits(r, radius, end, 1, &u->radius, NULL)) return NULL;
  u->exponent = -(long)fraction;
  if (*radius == '?') {
    u->infinite = true;
    end = radius + 1;
  } else if (end == radius) { /* half a unit: count in tenths */
    u->middle.d[u->middle.n++] = 0;
    u->radius.d[u->radius.n++] = 5;
    u->exponent--;
  }
  int direction = tolower((unsigned char)*end);
  if (direction == 'u' || direction == 'd') {
    u->down = direction == 'd', u->up = direction == 'u';
    end++;
  }
  s = skip_exponent(end, 'e');
  if (s > end) u->exponent += bounded_exponent(end + 1);
  return s;
}

/* the enclosure of the middle, plus or minus the radius */
static bool shifted(reader *r, const uncertain *u, bool minus, ambit_interval *x) {
  ambit_digits sum = { malloc(u->middle.n + u->radius.n + 1), 0 };
  bool negative = u->negative;
  if (!sum.d) return no_memory(r);
  if (negative == minus) {
    ambit_digits_add(&sum, u->middle, u->radius);
  } else if (ambit_digits_compare(u->middle, u->radius) >= 0) {
    ambit_digits_subtract(&sum, u->middle, u->radius);
  } else {
    ambit_digits_subtract(&sum, u->radius, u->middle);
    negative = !negative;
  }
  bool done = convert_digits(r, negative, sum, u->exponent, x);
  free(sum.d);
  return done;
}

static const char *read_uncertain(reader *r, const char *s, ambit_interval *x) {
  uncertain u;
  ambit_interval middle = AMBIT_EMPTY, lo, hi;
  const char *end = scan_uncertain(r, s, &u);
  bool done = end && convert_digits(r, u.negative, u.middle, u.exponent, &middle);
  lo = hi = middle;
  if (done && !u.infinite) done = (!u.down || shifted(r, &u, true, &lo)) && (!u.up || shifted(r, &u, false, &hi));
  free(u.middle.d), free(u.radius.d);
  if (!done) return NULL;
  if (u.infinite && u.down) lo = (ambit_interval) { -INFINITY, -INFINITY };
  if (u.infinite && u.up) hi = (ambit_interval) { INFINITY, INFINITY };
  r->inner = ambit_interval_of(lo.hi, hi.lo);
  *x = (ambit_interval) { lo.lo, hi.hi };
  return end;
}

ambit_status ambit_decimal_read_set(
    const char *text, ambit_interval *x, ambit_interval *inner, const char **rest, ambit_failure *failure) {
  reader r = { text, failure, AMBIT_OK, AMBIT_EMPTY };
  const char *s = skip_blank(text);
  const char *end = *s == '['         ? read_brackets(&r, s + 1, x)
                    : is_uncertain(s) ? read_uncertain(&r, s, x)
                                      : read_number(&r, s, x);
  if (end && *end == '_') end = refused(&r, AMBIT_INVALID, DECORATED);
  if (!end) return r.status;
  end = skip_blank(end);
  if (rest)
    *rest = end;
  else if (*end)
    no_number(&r);
  *inner = r.status == AMBIT_OK && ambit_interval_is_point(*x) ? *x : r.inner;
  return r.status;
}

ambit_status ambit_decimal_read(const char *text, ambit_interval *x, const char **rest, ambit_failure *failure) {
  ambit_interval inner;
  return ambit_decimal_read_set(text, x, &inner, rest, failure);
}

ambit_status ambit_decimal_tolerance(
    const char *text, ambit_interval *x, bool *relative, const char **rest, ambit_failure *failure) {
  const char *end = text;
  ambit_status status = ambit_decimal_read(text, x, &end, failure);
  if (status != AMBIT_OK) return status;
  *relative = *end == '%';
  if (*relative) {
    end = skip_blank(end + 1);
    *x = ambit_interval_div(*x, (ambit_interval) { 100, 100 });
  }
  if (rest)
    *rest = end;
  else if (*end)
    return ambit_fail(failure, AMBIT_INVALID, "\"%s\": \"%s\" is too much after a tolerance", text, end);
  if (!(x->lo >= 0) || !ambit_interval_is_bounded(*x))
    return ambit_fail(failure, AMBIT_INVALID, "\"%s\": a tolerance is a finite number that is not negative", text);
  return AMBIT_OK;
}
