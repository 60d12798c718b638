/* unit.c -- reading units. Every factor is exact: integers, powers of ten and of pi, so that "1 lbf" is enclosed as
** tightly as its decimal.
**
** Definitions: SI brochure (BIPM 2019), with all prefixes and all 22 units of their own name but the degree Celsius;
** international inch and pound (1959): in = 25.4 mm, lb = 0.453 592 37 kg, lbf = lb * 9.806 65 m/s^2; thermochemical
** calorie: 4.184 J.
*/
#include "models/unit.h"
#include "base/names.h"
#include "num/decimal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WORD_MAX 32
#define TEXT_MAX 256
#define NESTING_MAX 8

typedef struct entry {
  const char *name;
  bool prefix; /* takes SI prefixes */
  int8_t power[AMBIT_DIMENSIONS];
  ambit_unit_factor factor;
} entry;

/* clang-format off */
/*                                  m kg  s  A  K mol cd  pi  10^ numerator denominator */
static const entry known[] = {
  { "1", false,               {  0,  0,  0,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "m", true,                {  1,  0,  0,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "g", true,                {  0,  1,  0,  0,  0,  0,  0 }, { 0,  -3, 1, 1 } },
  { "s", true,                {  0,  0,  1,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "A", true,                {  0,  0,  0,  1,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "K", true,                {  0,  0,  0,  0,  1,  0,  0 }, { 0,   0, 1, 1 } },
  { "mol", true,              {  0,  0,  0,  0,  0,  1,  0 }, { 0,   0, 1, 1 } },
  { "cd", true,               {  0,  0,  0,  0,  0,  0,  1 }, { 0,   0, 1, 1 } },
  { "rad", true,              {  0,  0,  0,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "sr", true,               {  0,  0,  0,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "Hz", true,               {  0,  0, -1,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "N", true,                {  1,  1, -2,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "Pa", true,               { -1,  1, -2,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "J", true,                {  2,  1, -2,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "W", true,                {  2,  1, -3,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "C", true,                {  0,  0,  1,  1,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "V", true,                {  2,  1, -3, -1,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "F", true,                { -2, -1,  4,  2,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "ohm", true,              {  2,  1, -3, -2,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "\xe2\x84\xa6", true,     {  2,  1, -3, -2,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "\xce\xa9", true,         {  2,  1, -3, -2,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "S", true,                { -2, -1,  3,  2,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "Wb", true,               {  2,  1, -2, -1,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "T", true,                {  0,  1, -2, -1,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "H", true,                {  2,  1, -2, -2,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "lm", true,               {  0,  0,  0,  0,  0,  0,  1 }, { 0,   0, 1, 1 } },
  { "lx", true,               { -2,  0,  0,  0,  0,  0,  1 }, { 0,   0, 1, 1 } },
  { "Bq", true,               {  0,  0, -1,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "Gy", true,               {  2,  0, -2,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "Sv", true,               {  2,  0, -2,  0,  0,  0,  0 }, { 0,   0, 1, 1 } },
  { "kat", true,              {  0,  0, -1,  0,  0,  1,  0 }, { 0,   0, 1, 1 } },
  { "deg", false,             {  0,  0,  0,  0,  0,  0,  0 }, { 1,   0, 1, 180 } },
  { "arcmin", false,          {  0,  0,  0,  0,  0,  0,  0 }, { 1,   0, 1, 10800 } },
  { "arcsec", false,          {  0,  0,  0,  0,  0,  0,  0 }, { 1,   0, 1, 648000 } },
  { "rev", false,             {  0,  0,  0,  0,  0,  0,  0 }, { 1,   0, 2, 1 } },
  { "rpm", false,             {  0,  0, -1,  0,  0,  0,  0 }, { 1,   0, 1, 30 } },
  { "min", false,             {  0,  0,  1,  0,  0,  0,  0 }, { 0,   0, 60, 1 } },
  { "h", false,               {  0,  0,  1,  0,  0,  0,  0 }, { 0,   0, 3600, 1 } },
  { "d", false,               {  0,  0,  1,  0,  0,  0,  0 }, { 0,   0, 86400, 1 } },
  { "L", true,                {  3,  0,  0,  0,  0,  0,  0 }, { 0,  -3, 1, 1 } },
  { "l", true,                {  3,  0,  0,  0,  0,  0,  0 }, { 0,  -3, 1, 1 } },
  { "ha", false,              {  2,  0,  0,  0,  0,  0,  0 }, { 0,   4, 1, 1 } },
  { "t", false,               {  0,  1,  0,  0,  0,  0,  0 }, { 0,   3, 1, 1 } },
  { "bar", true,              { -1,  1, -2,  0,  0,  0,  0 }, { 0,   5, 1, 1 } },
  { "atm", false,             { -1,  1, -2,  0,  0,  0,  0 }, { 0,   0, 101325, 1 } },
  { "kgf", false,             {  1,  1, -2,  0,  0,  0,  0 }, { 0,  -5, 980665, 1 } },
  { "Wh", true,               {  2,  1, -2,  0,  0,  0,  0 }, { 0,   0, 3600, 1 } },
  { "cal", true,              {  2,  1, -2,  0,  0,  0,  0 }, { 0,  -3, 4184, 1 } },
  { "eV", true,               {  2,  1, -2,  0,  0,  0,  0 }, { 0, -28, 1602176634, 1 } },
  { "in", false,              {  1,  0,  0,  0,  0,  0,  0 }, { 0,  -4, 254, 1 } },
  { "ft", false,              {  1,  0,  0,  0,  0,  0,  0 }, { 0,  -4, 3048, 1 } },
  { "yd", false,              {  1,  0,  0,  0,  0,  0,  0 }, { 0,  -4, 9144, 1 } },
  { "mi", false,              {  1,  0,  0,  0,  0,  0,  0 }, { 0,  -3, 1609344, 1 } },
  { "nmi", false,             {  1,  0,  0,  0,  0,  0,  0 }, { 0,   0, 1852, 1 } },
  { "kn", false,              {  1,  0, -1,  0,  0,  0,  0 }, { 0,   0, 463, 900 } },
  { "oz", false,              {  0,  1,  0,  0,  0,  0,  0 }, { 0, -12, 28349523125, 1 } },
  { "lb", false,              {  0,  1,  0,  0,  0,  0,  0 }, { 0,  -8, 45359237, 1 } },
  { "lbf", false,             {  1,  1, -2,  0,  0,  0,  0 }, { 0, -13, 44482216152605, 1 } },
  { "psi", false,             { -1,  1, -2,  0,  0,  0,  0 }, { 0,  -5, 44482216152605, 64516 } },
};
/* clang-format on */
#define KNOWN (sizeof known / sizeof *known)

static const struct {
  const char *name;
  int16_t decimal;
} prefixes[] = { { "q", -30 }, { "r", -27 }, { "y", -24 }, { "z", -21 }, { "a", -18 }, { "f", -15 }, { "p", -12 },
  { "n", -9 }, { "u", -6 }, { "\xc2\xb5", -6 }, { "\xce\xbc", -6 }, { "m", -3 }, { "c", -2 }, { "d", -1 }, { "da", 1 },
  { "h", 2 }, { "k", 3 }, { "M", 6 }, { "G", 9 }, { "T", 12 }, { "P", 15 }, { "E", 18 }, { "Z", 21 }, { "Y", 24 },
  { "R", 27 }, { "Q", 30 } };

static const ambit_unit one = { .factor = { .numerator = 1, .denominator = 1 } };

/* -- exact products */

static uint64_t common_divisor(uint64_t a, uint64_t b) {
  while (b) {
    uint64_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/* u := u * v^sign; false: too large to be exact */
static bool multiply_factor(ambit_unit_factor *u, ambit_unit_factor v, int sign) {
  uint64_t above = sign > 0 ? v.numerator : v.denominator, below = sign > 0 ? v.denominator : v.numerator;
  uint64_t p = common_divisor(above, u->denominator), q = common_divisor(below, u->numerator);
  bool fits = !__builtin_mul_overflow(u->numerator / q, above / p, &u->numerator);
  fits = !__builtin_mul_overflow(u->denominator / p, below / q, &u->denominator) && fits;
  int pi = u->pi + sign * v.pi, decimal = u->decimal + sign * v.decimal;
  fits = fits && pi >= -9 && pi <= 9 && decimal >= -300 && decimal <= 300;
  u->pi = (int8_t)pi;
  u->decimal = (int16_t)decimal;
  return fits;
}

static bool raise_factor(ambit_unit_factor *u, ambit_unit_factor v, int n) {
  for (int k = n < 0 ? -n : n; k > 0; k--)
    if (!multiply_factor(u, v, n > 0 ? 1 : -1)) return false;
  return true;
}

static bool same_factor(ambit_unit_factor a, ambit_unit_factor b) {
  return a.pi == b.pi && a.decimal == b.decimal && a.numerator == b.numerator && a.denominator == b.denominator;
}

/* u := u * v^(share / 60): whole powers into the exact factor, the rest as a root */
static bool multiply_root(ambit_unit *u, ambit_unit_factor v, int share) {
  if (same_factor(v, one.factor)) return true;
  unsigned k = 0;
  while (k < u->roots && !same_factor(u->root[k], v)) k++;
  if (k < u->roots) share += u->share[k];
  int rest = share % AMBIT_POWER_ONE;
  if (rest < 0) rest += AMBIT_POWER_ONE;
  if (!raise_factor(&u->factor, v, (share - rest) / AMBIT_POWER_ONE)) return false;
  if (k == u->roots) {
    if (rest == 0) return true;
    if (k == AMBIT_UNIT_ROOTS) return false;
    u->roots++;
  }
  u->root[k] = v;
  u->share[k] = (uint8_t)rest;
  if (rest > 0) return true;
  u->roots--;
  u->root[k] = u->root[u->roots];
  u->share[k] = u->share[u->roots];
  return true;
}

/* u := u * v^(power / 60) */
static bool multiply(ambit_unit *u, ambit_unit v, int power) {
  for (int i = 0; i < AMBIT_DIMENSIONS; i++) {
    int p = v.power[i] * power;
    if (p % AMBIT_POWER_ONE != 0) return false;
    p = u->power[i] + p / AMBIT_POWER_ONE;
    if (p > AMBIT_POWER_MAX || p < -AMBIT_POWER_MAX) return false;
    u->power[i] = (int16_t)p;
  }
  for (unsigned k = 0; k < v.roots; k++) {
    int share = v.share[k] * power;
    if (share % AMBIT_POWER_ONE != 0 || !multiply_root(u, v.root[k], share / AMBIT_POWER_ONE)) return false;
  }
  return multiply_root(u, v.factor, power);
}

/* -- names */

static const entry *find_entry(const char *name) {
  for (size_t i = 0; i < KNOWN; i++)
    if (strcmp(known[i].name, name) == 0) return &known[i];
  return NULL;
}

static ambit_unit unit_of(const entry *e, int decimal) {
  ambit_unit unit = { .factor = e->factor };
  for (int i = 0; i < AMBIT_DIMENSIONS; i++) unit.power[i] = (int16_t)(e->power[i] * AMBIT_POWER_ONE);
  unit.factor.decimal = (int16_t)(unit.factor.decimal + decimal);
  return unit;
}

/* A unit by its own name, else a prefix and a unit. */
static bool find_unit(const char *name, ambit_unit *unit) {
  const entry *e = find_entry(name);
  if (e) {
    *unit = unit_of(e, 0);
    return true;
  }
  for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
    size_t n = strlen(prefixes[i].name);
    if (strncmp(name, prefixes[i].name, n) != 0) continue;
    e = find_entry(name + n);
    if (!e || !e->prefix) continue;
    *unit = unit_of(e, prefixes[i].decimal);
    return true;
  }
  return false;
}

/* "Nm": two units of different dimensions without a sign between them */
static bool find_pair(const char *name, char hint[2 * WORD_MAX]) {
  ambit_unit left, right;
  for (size_t cut = 1; cut < strlen(name); cut++) {
    char first[WORD_MAX];
    snprintf(first, sizeof first, "%.*s", (int)cut, name);
    if (!find_unit(first, &left) || !find_unit(name + cut, &right)) continue;
    if (memcmp(left.power, right.power, sizeof left.power) == 0) continue;
    snprintf(hint, 2 * WORD_MAX, "%s %s", first, name + cut);
    return true;
  }
  return false;
}

const char *ambit_unit_name(size_t k, bool *takes_prefix) {
  if (k >= KNOWN) return NULL;
  *takes_prefix = known[k].prefix;
  return known[k].name;
}

const char *ambit_unit_prefix(size_t k, int *decimal) {
  if (k >= sizeof prefixes / sizeof *prefixes) return NULL;
  *decimal = prefixes[k].decimal;
  return prefixes[k].name;
}

static ambit_status fail_unknown(const char *name, ambit_failure *f) {
  const char *candidate[KNOWN + 6] = { "km", "cm", "mm", "kg", "kN", "ms" };
  char hint[2 * WORD_MAX];
  if (strcmp(name, "degC") == 0 || strcmp(name, "degF") == 0 || strcmp(name, "\xc2\xb0\x43") == 0)
    return ambit_fail(f, AMBIT_INVALID, "`%s` has an offset, so it is not a unit here: give temperatures in K", name);
  for (size_t i = 0; i < KNOWN; i++) candidate[6 + i] = known[i].name;
  const char *near = find_pair(name, hint) ? hint : ambit_names_nearest(name, candidate, KNOWN + 6);
  return ambit_fail(f, AMBIT_INVALID, "unknown unit `%s`%s%s%s", name, near ? " (did you mean `" : "", near ? near : "",
      near ? "`?)" : "");
}

/* -- grammar: unit := factor { [* . /] factor }; factor := (name | "1" | "(" unit ")") [^ power]; power := integer
** | decimal | "(" integer "/" integer ")" */

typedef struct reader {
  const char *whole, *at;
  int nesting;
  ambit_failure *f;
} reader;

static ambit_status wrong(reader *r, const char *what) {
  return ambit_fail(r->f, AMBIT_INVALID, "`%.80s` is not a unit: %s", r->whole, what);
}

static void skip_blanks(reader *r) {
  while (*r->at == ' ' || *r->at == '\t') r->at++;
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (unsigned char)c >= 0x80; }

static ambit_status read_product(reader *r, ambit_unit *unit);

#define WHOLE_MAX 9

static bool read_integer(reader *r, long *n) {
  char *end;
  if (*r->at < '0' || *r->at > '9') return false;
  *n = strtol(r->at, &end, 10);
  r->at = end;
  return *n < 1000;
}

/* "2", "-1", "1.5", "(1/3)" -> sixtieths; false: no such power */
static bool read_sixtieths(reader *r, int *power) {
  long above = 0, below = 1;
  bool bracket = *r->at == '(';
  if (bracket) r->at++;
  int sign = *r->at == '-' ? -1 : 1;
  if (*r->at == '-' || *r->at == '+') r->at++;
  if (!read_integer(r, &above)) return false;
  if (bracket && *r->at == '/') {
    r->at++;
    if (!read_integer(r, &below) || below == 0) return false;
  } else if (*r->at == '.' && r->at[1] >= '0' && r->at[1] <= '9') { /* m^2.kg is a product */
    for (r->at++; *r->at >= '0' && *r->at <= '9' && below < 1000; r->at++, below *= 10)
      above = 10 * above + *r->at - '0';
  }
  if (bracket && *r->at++ != ')') return false;
  if (above * AMBIT_POWER_ONE % below != 0 || above > WHOLE_MAX * below) return false;
  *power = sign * (int)(above * AMBIT_POWER_ONE / below);
  return true;
}

static ambit_status read_power(reader *r, ambit_unit *unit) {
  skip_blanks(r);
  if (*r->at != '^') return AMBIT_OK;
  int power;
  r->at++;
  if (!read_sixtieths(r, &power)) return wrong(r, "expected a power from -9 to 9 after ^, such as 2, -1, 1.5 or (1/3)");
  ambit_unit base = *unit;
  *unit = one;
  return multiply(unit, base, power) ? AMBIT_OK : wrong(r, "the powers are too large or too fine");
}

static ambit_status read_factor(reader *r, ambit_unit *unit) {
  char name[WORD_MAX];
  size_t n = 0;
  skip_blanks(r);
  if (*r->at == '(') {
    if (r->nesting == NESTING_MAX) return wrong(r, "too many brackets");
    r->at++;
    r->nesting++;
    ambit_status status = read_product(r, unit);
    r->nesting--;
    if (status != AMBIT_OK) return status;
    if (*r->at != ')') return wrong(r, "a bracket is not closed");
    r->at++;
    return read_power(r, unit);
  }
  if (*r->at == '1') {
    name[n++] = *r->at++;
  } else {
    while (is_letter(r->at[n]) && n < sizeof name - 1) name[n] = r->at[n], n++;
    r->at += n;
  }
  name[n] = '\0';
  if (n == 0) return wrong(r, "expected the name of a unit");
  if (!find_unit(name, unit)) return fail_unknown(name, r->f);
  return read_power(r, unit);
}

static ambit_status read_product(reader *r, ambit_unit *unit) {
  *unit = one;
  for (int sign = 1;;) {
    ambit_unit factor;
    ambit_status status = read_factor(r, &factor);
    if (status != AMBIT_OK) return status;
    if (!multiply(unit, factor, sign * AMBIT_POWER_ONE)) return wrong(r, "its factor is too large");
    skip_blanks(r);
    if (*r->at == '\0' || *r->at == ')') return AMBIT_OK;
    sign = *r->at == '/' ? -1 : 1;
    if (*r->at == '*' || *r->at == '.' || *r->at == '/')
      r->at++;
    else if (!is_letter(*r->at) && *r->at != '(' && *r->at != '1')
      return wrong(r, "expected a blank, *, . or / between units");
  }
}

ambit_status ambit_unit_read(const char *text, ambit_unit *unit, ambit_failure *f) {
  reader r = { .whole = text, .at = text, .f = f };
  *unit = one;
  skip_blanks(&r);
  if (!*r.at) return AMBIT_OK;
  ambit_status status = read_product(&r, unit);
  if (status == AMBIT_OK && *r.at) return wrong(&r, "a bracket is closed but not opened");
  return status;
}

/* -- quantities */

/* The literal times 10^decimal: within the text where it is a plain decimal, so that it is rounded once. */
static ambit_expr read_number(ambit_graph *g, const char *literal, int decimal, ambit_failure *f) {
  char text[TEXT_MAX];
  bool plain = strspn(literal, "+-0123456789.eE \t") == strlen(literal);
  if (decimal == 0) return ambit_graph_decimal(g, literal, f);
  size_t mantissa = strcspn(literal, plain ? "eE \t" : "");
  const char *e = literal + strcspn(literal, "eE");
  long exponent = plain && *e ? strtol(e + 1, NULL, 10) : 0;
  if (plain && labs(exponent) < 100000 && mantissa > 0) {
    snprintf(text, sizeof text, "%.*se%ld", (int)mantissa, literal, exponent + decimal);
    return ambit_graph_decimal(g, text, f);
  }
  snprintf(text, sizeof text, "1e%d", decimal);
  ambit_expr x = ambit_graph_decimal(g, literal, f), ten = ambit_graph_decimal(g, text, f);
  return x == AMBIT_NO_EXPR || ten == AMBIT_NO_EXPR ? AMBIT_NO_EXPR : ambit_graph_op(g, AMBIT_OP_MUL, x, ten);
}

static ambit_expr integer(ambit_graph *g, uint64_t n) {
  char text[32];
  snprintf(text, sizeof text, "%llu", (unsigned long long)n);
  return ambit_graph_decimal(g, text, NULL);
}

/* x times a factor. 90 deg is exactly pi/2: the rational factor first. */
static ambit_expr scale(ambit_graph *g, ambit_expr x, const ambit_unit_factor *u) {
  x = ambit_graph_op(g, AMBIT_OP_MUL, x, integer(g, u->numerator));
  x = ambit_graph_op(g, AMBIT_OP_DIV, x, integer(g, u->denominator));
  ambit_expr pi = u->pi ? ambit_graph_pi(g) : 0;
  for (int k = u->pi; k > 0; k--) x = ambit_graph_op(g, AMBIT_OP_MUL, x, pi);
  for (int k = u->pi; k < 0; k++) x = ambit_graph_op(g, AMBIT_OP_DIV, x, pi);
  return x;
}

/* u^(share / 60): a square root where it is one, otherwise by the logarithm */
static ambit_expr root_of(ambit_graph *g, const ambit_unit_factor *u, int share) {
  char ten[16], part[16];
  snprintf(ten, sizeof ten, "1e%d", u->decimal);
  snprintf(part, sizeof part, "%d/%d", share, AMBIT_POWER_ONE);
  ambit_expr x = scale(g, ambit_graph_decimal(g, ten, NULL), u), power = ambit_graph_decimal(g, part, NULL);
  if (2 * share == AMBIT_POWER_ONE) return ambit_graph_op(g, AMBIT_OP_SQRT, x, x);
  x = ambit_graph_op(g, AMBIT_OP_LOG, x, x);
  x = ambit_graph_op(g, AMBIT_OP_MUL, x, power);
  return ambit_graph_op(g, AMBIT_OP_EXP, x, x);
}

static ambit_status fail_dimension(const char *text, const char *unit, const char *wanted, ambit_failure *f) {
  bool bare = strcmp(wanted, "1") == 0 || !*wanted;
  return ambit_fail(f, AMBIT_INVALID, "`%.80s` is in %.40s, but %s%.40s is expected", text, unit,
      bare ? "a number without dimension" : "", bare ? "" : wanted);
}

ambit_status ambit_unit_quantity(
    ambit_graph *g, const char *text, const char *wanted, ambit_expr *out, ambit_failure *f) {
  char literal[TEXT_MAX];
  ambit_interval x;
  const char *rest;
  ambit_unit unit, goal;
  *out = AMBIT_NO_EXPR;
  while (*text == ' ' || *text == '\t') text++;
  ambit_status status = ambit_decimal_read(text, &x, &rest, f);
  if (status == AMBIT_OK) status = ambit_unit_read(rest, &unit, f);
  if (status == AMBIT_OK) status = ambit_unit_read(wanted, &goal, f);
  if (status != AMBIT_OK) return status;
  while (*rest == ' ' || *rest == '\t') rest++;
  size_t length = (size_t)(rest - text);
  if (length >= sizeof literal) return ambit_fail(f, AMBIT_INVALID, "`%.80s...` is too long for a number", text);
  memcpy(literal, text, length);
  literal[length] = '\0';
  if (*rest && memcmp(unit.power, goal.power, sizeof unit.power) != 0) return fail_dimension(text, rest, wanted, f);
  ambit_expr e = read_number(g, literal, unit.factor.decimal, f);
  if (e == AMBIT_NO_EXPR) return f && f->status != AMBIT_OK ? f->status : AMBIT_INVALID;
  e = scale(g, e, &unit.factor);
  for (unsigned k = 0; k < unit.roots; k++)
    e = ambit_graph_op(g, AMBIT_OP_MUL, e, root_of(g, &unit.root[k], unit.share[k]));
  *out = e;
  return *out == AMBIT_NO_EXPR ? ambit_no_memory(f) : AMBIT_OK;
}
