/* params.c -- options by name -> numbers, as the plugin's declaration says. */
#include "host/params.h"
#include "base/names.h"
#include <ambit/registry.h>
#include "num/decimal.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VALUE_MAX 256 /* bytes of one number or word in a list */

static bool is_number_shape(const char *shape) { return shape[0] == '\0'; }

/* "3" -> 3, "3x3" -> 9, all others 1 (axis 3) */
static size_t components(const char *shape) {
  if (strcmp(shape, "axis") == 0) return 3;
  char *end;
  unsigned long rows = strtoul(shape, &end, 10);
  if (end == shape) return 1;
  unsigned long columns = *end == 'x' ? strtoul(end + 1, NULL, 10) : 1;
  return rows && columns ? rows * columns : 1;
}

size_t ambit_params_count(const ambit_param *param) {
  size_t n = 0;
  while (param && param[n].name) n++;
  return n;
}

size_t ambit_params_doubles(const ambit_param *param) {
  size_t n = 0;
  for (; param && param->name; param++) n += components(param->shape);
  return n;
}

/* One option being read: who asks, what it is, what was given. */
typedef struct reading {
  const char *owner, *text;
  const ambit_param *param;
  ambit_failure *failure;
} reading;

static ambit_status wrong(const reading *r, const char *expected) {
  return ambit_fail(r->failure, AMBIT_INVALID, "%s: option `%s` must be %s, not `%.80s`", r->owner, r->param->name,
      expected, r->text);
}

/* The nearest double of a literal that is a point; false: it is none. */
static bool read_number(const char *text, double *x) {
  ambit_failure ignored = { 0 };
  ambit_interval value;
  if (strcmp(text, "inf") == 0 || strcmp(text, "-inf") == 0) {
    *x = text[0] == '-' ? -INFINITY : INFINITY;
    return true;
  }
  if (ambit_decimal_read(text, &value, NULL, &ignored) != AMBIT_OK) return false;
  if (!ambit_interval_is_bounded(value) || nextafter(value.lo, INFINITY) < value.hi) return false;
  *x = value.lo == value.hi ? value.lo : strtod(text, NULL);
  if (!(value.lo <= *x && *x <= value.hi)) *x = value.lo; /* "1/3", another locale */
  return true;
}

static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/* Copies text[0..length) without blanks around it; false: too long. */
static bool copy_trimmed(char out[VALUE_MAX], const char *text, size_t length) {
  while (length && is_space(*text)) text++, length--;
  while (length && is_space(text[length - 1])) length--;
  if (length >= VALUE_MAX) return false;
  memcpy(out, text, length);
  out[length] = '\0';
  return true;
}

/* Exactly n numbers, separated by commas. */
static bool read_numbers(const char *text, size_t n, double *out) {
  char piece[VALUE_MAX];
  for (size_t i = 0; i < n; i++) {
    size_t length = strcspn(text, ",");
    if (!copy_trimmed(piece, text, length) || !read_number(piece, &out[i])) return false;
    text += length;
    if ((*text == ',') != (i + 1 < n)) return false;
    if (*text) text++;
  }
  return true;
}

static ambit_status read_axis(const reading *r, double *out) {
  const char *t = r->text;
  double sign = *t == '-' ? -1 : 1;
  if (*t == '-' || *t == '+') t++;
  if (t[0] >= 'x' && t[0] <= 'z' && t[1] == '\0') {
    for (int i = 0; i < 3; i++) out[i] = t[0] - 'x' == i ? sign : 0;
    return AMBIT_OK;
  }
  bool good = read_numbers(r->text, 3, out) && isfinite(out[0]) && isfinite(out[1]) && isfinite(out[2]) &&
              (out[0] != 0 || out[1] != 0 || out[2] != 0);
  return good ? AMBIT_OK : wrong(r, "an axis: `x`, `-z`, or three numbers that are not all zero");
}

static ambit_status read_flag(const reading *r, double *out) {
  bool yes = strcmp(r->text, "true") == 0 || strcmp(r->text, "1") == 0;
  bool no = strcmp(r->text, "false") == 0 || strcmp(r->text, "0") == 0;
  *out = yes;
  return yes || no ? AMBIT_OK : wrong(r, "true or false");
}

static ambit_status read_integer(const reading *r, double *out) {
  const double largest = 9007199254740992.0; /* 2^53: beyond it not every integer is a double */
  bool good = read_number(r->text, out) && fabs(*out) <= largest && *out == nearbyint(*out);
  return good ? AMBIT_OK : wrong(r, "an integer of at most 2^53");
}

/* The index of the word in "rk4|rk8pd|msbdf". */
static ambit_status read_choice(const reading *r, double *out) {
  char words[512], *word[64], expected[600];
  snprintf(words, sizeof words, "%s", r->param->shape);
  size_t n = 0;
  for (char *rest = words; rest && n < 64; n++) {
    word[n] = rest;
    rest = strchr(rest, '|');
    if (rest) *rest++ = '\0';
    if (strcmp(word[n], r->text) == 0) {
      *out = (double)n;
      return AMBIT_OK;
    }
  }
  const char *near = ambit_names_nearest(r->text, (const char *const *)word, n);
  snprintf(expected, sizeof expected, "one of %s%s%s%s", r->param->shape, near ? " (did you mean `" : "",
      near ? near : "", near ? "`?)" : "");
  return wrong(r, expected);
}

static ambit_status read_value(const reading *r, double *out) {
  const char *shape = r->param->shape;
  size_t n = components(shape);
  char expected[96];
  if (strcmp(shape, "axis") == 0) return read_axis(r, out);
  if (strcmp(shape, "flag") == 0) return read_flag(r, out);
  if (strcmp(shape, "integer") == 0) return read_integer(r, out);
  if (strchr(shape, '|')) return read_choice(r, out);
  if (read_numbers(r->text, n, out)) return AMBIT_OK;
  bool bare = !r->param->unit || strcmp(r->param->unit, "1") == 0;
  if (is_number_shape(shape))
    snprintf(expected, sizeof expected, "one number%s%.40s", bare ? "" : " in ", bare ? "" : r->param->unit);
  else
    snprintf(expected, sizeof expected, "%zu numbers (%.20s)%s%.40s", n, shape, bare ? "" : " in ",
        bare ? "" : r->param->unit);
  return wrong(r, expected);
}

static const ambit_option *find_given(const char *name, size_t n, const ambit_option *given) {
  for (size_t i = 0; i < n && given[i].name; i++)
    if (strcmp(given[i].name, name) == 0) return &given[i];
  return NULL;
}

static ambit_status unknown_name(const ambit_param *param, const char *owner, const char *name, ambit_failure *f) {
  size_t count = ambit_params_count(param);
  if (count == 0) return ambit_fail(f, AMBIT_INVALID, "%s has no options, so none called `%s`", owner, name);
  const char **known = calloc(count, sizeof *known);
  if (!known) return ambit_no_memory(f);
  char list[512] = "";
  for (size_t i = 0, used = 0; i < count; i++) {
    known[i] = param[i].name;
    if (used < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", param[i].name);
  }
  const char *near = ambit_names_nearest(name, known, count);
  ambit_fail(f, AMBIT_INVALID, "%s has no option `%s`%s%s%s; it has %s", owner, name, near ? " (did you mean `" : "",
      near ? near : "", near ? "`?)" : "", list);
  free(known);
  return AMBIT_INVALID;
}

/* Every given name is declared, and given once. */
static ambit_status check_names(
    const ambit_param *param, const char *owner, size_t n, const ambit_option *given, ambit_failure *f) {
  size_t count = ambit_params_count(param);
  for (size_t i = 0; i < n && given[i].name; i++) {
    size_t k = 0;
    while (k < count && strcmp(param[k].name, given[i].name) != 0) k++;
    if (k == count) return unknown_name(param, owner, given[i].name, f);
    if (find_given(given[i].name, i, given))
      return ambit_fail(f, AMBIT_INVALID, "%s: option `%s` is given twice", owner, given[i].name);
  }
  return AMBIT_OK;
}

ambit_status ambit_params_resolve(
    const ambit_param *param, const char *owner, size_t n, const ambit_option *given, double *out, ambit_failure *f) {
  ambit_status status = check_names(param, owner, n, given, f);
  for (; status == AMBIT_OK && param && param->name; out += components(param->shape), param++) {
    const ambit_option *found = find_given(param->name, n, given);
    const char *text = found ? found->text : param->fallback;
    if (!text)
      return ambit_fail(
          f, AMBIT_INVALID, "%s needs the option `%s`: %s", owner, param->name, param->doc ? param->doc : "");
    if (!found && text[0] == '\0')
      for (size_t i = 0; i < components(param->shape); i++) out[i] = NAN;
    else
      status = read_value(&(reading) { owner, text, param, f }, out);
  }
  return status;
}
