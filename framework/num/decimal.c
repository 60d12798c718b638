/* decimal.c -- literals to enclosures.
**
** Bounds come from the C library's strtod in downward and upward mode: glibc's conversion is correctly rounded in the
** current mode for decimal and hexadecimal text of any length (tested against MPFR). The scan decides what belongs to
** a literal, so that strtod never sees "nan", "infinity" or a locale's digits.
*/
#include "num/decimal.h"
#include "num/environment.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *skip_blank(const char *s) {
  while (*s == ' ' || *s == '\t' || *s == '\n' || *s == '\r') s++;
  return s;
}

static const char *skip_digits(const char *s, int base) {
  while (base == 16 ? isxdigit((unsigned char)*s) : isdigit((unsigned char)*s)) s++;
  return s;
}

static const char *skip_sign(const char *s) { return *s == '+' || *s == '-' ? s + 1 : s; }

/* end of "12.5", ".5", "0x1.8"; NULL if there is no digit */
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

/* end of a number literal, or NULL */
static const char *skip_number(const char *s) {
  s = skip_sign(s);
  bool hex = s[0] == '0' && (s[1] == 'x' || s[1] == 'X');
  const char *end = skip_mantissa(hex ? s + 2 : s, hex ? 16 : 10);
  return end ? skip_exponent(end, hex ? 'p' : 'e') : NULL;
}

static bool starts_with_word(const char *s, const char *word) {
  size_t n = strlen(word);
  return strncmp(s, word, n) == 0 && !isalnum((unsigned char)s[n]);
}

/* Reads exactly [s, end) by strtod, rounded down and up. */
static bool convert(const char *s, const char *end, ambit_interval *x) {
  char small[128], *text = small;
  size_t n = (size_t)(end - s);
  if (n >= sizeof small && !(text = malloc(n + 1))) return false;
  memcpy(text, s, n);
  text[n] = '\0';
  ambit_environment old = ambit_environment_enter();
  ambit_environment_down();
  x->lo = strtod(text, NULL);
  ambit_environment_up();
  x->hi = strtod(text, NULL);
  ambit_environment_leave(old);
  if (text != small) free(text);
  return true;
}

/* One bound or point: a number, a quotient of numbers, or pi, each with a sign. Returns its end, or NULL. */
static const char *read_number(const char *s, ambit_interval *x) {
  const char *bare = skip_sign(s);
  if (starts_with_word(bare, "pi")) {
    *x = ambit_interval_pi();
    if (*s == '-') *x = (ambit_interval) { -x->hi, -x->lo };
    return bare + 2;
  }
  const char *end = skip_number(s);
  if (!end || !convert(s, end, x)) return NULL;
  if (*end != '/') return end;
  ambit_interval divisor;
  const char *second = skip_number(end + 1);
  if (!second || !isdigit((unsigned char)end[1]) || !convert(end + 1, second, &divisor)) return end;
  if (divisor.lo <= 0) return NULL;
  *x = ambit_interval_div(*x, divisor);
  return second;
}

static const char *read_bound(const char *s, ambit_interval *x) {
  const char *bare = skip_sign(s);
  const char *word = starts_with_word(bare, "infinity") ? "infinity" : starts_with_word(bare, "inf") ? "inf" : NULL;
  if (!word) return read_number(s, x);
  double value = *s == '-' ? -INFINITY : INFINITY;
  *x = (ambit_interval) { value, value };
  return bare + strlen(word);
}

static ambit_status malformed(const char *text, ambit_failure *f) {
  return ambit_fail(f, AMBIT_INVALID,
      "\"%s\" is no number: expected for example \"0.1\", \"1/3\", \"2e-3\", \"pi\", \"[0.1, 0.2]\" or \"3.56?2\"",
      text);
}

/* "[...]": s is behind the bracket */
static ambit_status read_brackets(
    const char *text, const char *s, ambit_interval *x, const char **end, ambit_failure *f) {
  s = skip_blank(s);
  *x = AMBIT_ENTIRE;
  if (starts_with_word(s, "empty")) {
    *x = AMBIT_EMPTY;
    s += strlen("empty");
  } else if (starts_with_word(s, "entire")) {
    s += strlen("entire");
  } else if (*s == ']') {
    *x = AMBIT_EMPTY;
  } else {
    ambit_interval lo = { -INFINITY, -INFINITY }, hi = { INFINITY, INFINITY };
    if (*s != ',' && !(s = read_bound(s, &lo))) return malformed(text, f);
    s = skip_blank(s);
    bool point = *s != ',';
    if (!point) s = skip_blank(s + 1);
    if (point) hi = lo;
    if (!point && *s != ']' && !(s = read_bound(s, &hi))) return malformed(text, f);
    if (lo.lo > hi.lo || lo.hi > hi.hi)
      return ambit_fail(f, AMBIT_INVALID, "\"%s\": the lower bound is above the upper one", text);
    *x = ambit_interval_of(lo.lo, hi.hi);
    if (ambit_interval_is_empty(*x)) return ambit_fail(f, AMBIT_INVALID, "\"%s\" holds no real number", text);
  }
  s = skip_blank(s);
  if (*s != ']') return malformed(text, f);
  *end = s + 1;
  return AMBIT_OK;
}

/* "m?r", a decimal m with its radius r in units of its last place: exact integers scaled by a power of ten. */
__extension__ typedef __int128 wide;

typedef struct uncertain {
  wide middle, radius; /* in units of 10^exponent */
  long exponent;
  bool down, up, infinite;
} uncertain;

#define DIGITS_MAX 30 /* with the factor 2 below, far inside 128 bits */

#define EXPONENT_MAX 100000 /* far beyond every double, even after the shift by the digits */

static long bounded_exponent(const char *digits) {
  long exponent = strtol(digits, NULL, 10); /* saturates */
  return exponent > EXPONENT_MAX ? EXPONENT_MAX : exponent < -EXPONENT_MAX ? -EXPONENT_MAX : exponent;
}

static const char *read_uncertain(const char *s, uncertain *u) {
  bool negative = *s == '-';
  int digits = 0;
  *u = (uncertain) { .down = true, .up = true };
  bool fraction = false;
  for (s = skip_sign(s); isdigit((unsigned char)*s) || (*s == '.' && !fraction); s++) {
    if (*s == '.') {
      fraction = true;
      continue;
    }
    if (++digits > DIGITS_MAX) return NULL;
    u->middle = 10 * u->middle + (*s - '0');
    u->exponent -= fraction;
  }
  if (negative) u->middle = -u->middle;
  s++; /* the question mark */
  if (*s == '?') {
    u->infinite = true;
    s++;
  }
  digits = 0;
  const char *radius = s;
  for (; isdigit((unsigned char)*s); s++) {
    if (++digits > DIGITS_MAX) return NULL;
    u->radius = 10 * u->radius + (*s - '0');
  }
  if (s == radius) { /* half a unit: count in tenths */
    u->middle *= 10;
    u->radius = 5;
    u->exponent--;
  }
  if (*s == 'u' || *s == 'd') {
    u->down = *s == 'd';
    u->up = *s == 'u';
    s++;
  }
  const char *end = skip_exponent(s, 'e');
  if (end > s) u->exponent += bounded_exponent(s + 1);
  return end;
}

/* value * 10^exponent as an enclosure */
static bool scaled(wide value, long exponent, ambit_interval *x) {
  char text[80], *s = text + sizeof text;
  char tail[24];
  int n = snprintf(tail, sizeof tail, "e%ld", exponent);
  s -= n + 1;
  memcpy(s, tail, (size_t)n + 1);
  bool negative = value < 0;
  if (negative) value = -value;
  do {
    *--s = (char)('0' + (int)(value % 10));
    value /= 10;
  } while (value);
  if (negative) *--s = '-';
  return convert(s, s + strlen(s), x);
}

static bool enclose_uncertain(const uncertain *u, ambit_interval *x) {
  ambit_interval lo, hi;
  if (!scaled(u->middle - (u->down ? u->radius : 0), u->exponent, &lo)) return false;
  if (!scaled(u->middle + (u->up ? u->radius : 0), u->exponent, &hi)) return false;
  *x = (ambit_interval) { u->infinite && u->down ? -INFINITY : lo.lo, u->infinite && u->up ? INFINITY : hi.hi };
  return true;
}

static bool is_uncertain(const char *s) {
  const char *end = skip_mantissa(skip_sign(s), 10);
  return end && *end == '?';
}

ambit_status ambit_decimal_read(const char *text, ambit_interval *x, const char **rest, ambit_failure *failure) {
  const char *s = skip_blank(text), *end = NULL;
  if (*s == '[') {
    ambit_status status = read_brackets(text, s + 1, x, &end, failure);
    if (status != AMBIT_OK) return status;
  } else if (is_uncertain(s)) {
    uncertain u;
    end = read_uncertain(s, &u);
    if (!end || !enclose_uncertain(&u, x))
      return ambit_fail(
          failure, AMBIT_INVALID, "\"%s\": an uncertain literal may have at most %d digits", text, DIGITS_MAX);
  } else {
    end = read_number(s, x);
  }
  if (!end) return malformed(text, failure);
  end = skip_blank(end);
  if (rest)
    *rest = end;
  else if (*end)
    return malformed(text, failure);
  return AMBIT_OK;
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
    return malformed(text, failure);
  if (!(x->lo >= 0) || !ambit_interval_is_bounded(*x))
    return ambit_fail(failure, AMBIT_INVALID, "\"%s\": a tolerance is a finite number that is not negative", text);
  return AMBIT_OK;
}
