/* source_name.c -- names of a model as names of a language.
**
** Modelica: an identifier, or a quoted one (specification 3.6, 2.3.1); bytes that may not be quoted become %XX. LaTeX:
** what is one letter, or a Greek one, stands by itself, digits at the end become an index, primes stay; the rest is
** upright.
*/
#include "algebra/source.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

typedef struct sink {
  char *out;
  size_t room, used;
} sink;

static void put(sink *s, const char *text, size_t n) {
  if (s->used + n < s->room) memcpy(s->out + s->used, text, n);
  s->used += n;
}

static void puts_to(sink *s, const char *text) { put(s, text, strlen(text)); }

static bool finish(sink *s) {
  if (s->room > 0) s->out[s->used < s->room ? s->used : s->room - 1] = '\0';
  return s->used < s->room;
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static bool is_among(const char *name, size_t n, const char *const *list) {
  for (; *list; list++)
    if (strlen(*list) == n && memcmp(*list, name, n) == 0) return true;
  return false;
}

/* ---- Modelica */

/* Keywords, and what is predefined: not to be declared. */
static bool is_reserved(const char *name) {
  static const char *const words[] = { "algorithm", "and", "annotation", "block", "break", "class", "connect",
    "connector", "constant", "constrainedby", "der", "discrete", "each", "else", "elseif", "elsewhen", "encapsulated",
    "end", "enumeration", "equation", "expandable", "extends", "external", "false", "final", "flow", "for", "function",
    "if", "import", "impure", "in", "initial", "inner", "input", "loop", "model", "not", "operator", "or", "outer",
    "output", "package", "parameter", "partial", "protected", "public", "pure", "record", "redeclare", "replaceable",
    "return", "stream", "then", "true", "type", "when", "while", "within", "time", "Real", "Integer", "Boolean",
    "String", "Clock", "abs", "sign", "sqrt", "div", "mod", "rem", "ceil", "floor", "integer", "sin", "cos", "tan",
    "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "log10", "min", "max", "sum", "product",
    "size", "ndims", "fill", "zeros", "ones", "identity", "diagonal", "linspace", "transpose", "outerProduct",
    "symmetric", "cross", "skew", "cat", "scalar", "vector", "matrix", "promote", "delay", "cardinality", "homotopy",
    "semiLinear", "inStream", "actualStream", "spatialDistribution", "getInstanceName", "terminal", "noEvent", "smooth",
    "sample", "pre", "edge", "change", "reinit", "assert", "terminate", "previous", "interval", "StateSelect",
    "AssertionLevel", "ExternalObject", "pi", NULL };
  return is_among(name, strlen(name), words);
}

static bool is_plain(const char *name) {
  if (!is_letter(*name) && *name != '_') return false;
  for (const char *c = name; *c; c++)
    if (!is_letter(*c) && !is_digit(*c) && *c != '_') return false;
  return true;
}

static void put_modelica(sink *s, const char *name) {
  if (is_plain(name) && !is_reserved(name)) {
    puts_to(s, name);
    return;
  }
  puts_to(s, "'");
  for (const char *c = name; *c; c++) {
    char hex[8];
    if (*c == '\'' || *c == '\\' || *c == '"')
      snprintf(hex, sizeof hex, "\\%c", *c);
    else if (*c < ' ' || *c > '~' || *c == '`')
      snprintf(hex, sizeof hex, "%%%02X", (unsigned)(unsigned char)*c);
    else
      snprintf(hex, sizeof hex, "%c", *c);
    puts_to(s, hex);
  }
  puts_to(s, "'");
}

/* ---- LaTeX */

static bool is_greek(const char *name, size_t n) {
  static const char *const letters[] = { "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota",
    "kappa", "lambda", "mu", "nu", "xi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega", "Gamma",
    "Delta", "Theta", "Lambda", "Xi", "Sigma", "Upsilon", "Phi", "Psi", "Omega", NULL };
  return is_among(name, n, letters);
}

/* Upright, with all that TeX would understand otherwise escaped. */
static void put_upright(sink *s, const char *name, size_t n) {
  puts_to(s, "\\mathrm{");
  for (size_t i = 0; i < n; i++) {
    char c = name[i];
    if (c == '\\')
      puts_to(s, "\\backslash{}");
    else if (c == '^')
      puts_to(s, "\\wedge{}");
    else if (c == '~')
      puts_to(s, "\\sim{}");
    else if (c == ' ')
      puts_to(s, "\\ ");
    else if (iscntrl((unsigned char)c))
      puts_to(s, "?");
    else {
      if (strchr("_&%#${}", c)) puts_to(s, "\\");
      put(s, &c, 1);
    }
  }
  puts_to(s, "}");
}

static void put_latex(sink *s, const char *name) {
  size_t n = strlen(name), primes = 0;
  for (; n > 1 && name[n - 1] == '\''; n--) primes++;
  size_t base = n;
  while (base > 0 && is_digit(name[base - 1])) base--;
  if (base == 0 || !is_letter(name[base - 1])) base = n; /* x_1 is not x1 */
  if (is_greek(name, base)) puts_to(s, "\\");
  if (is_greek(name, base) || (base == 1 && is_letter(*name)))
    put(s, name, base);
  else
    put_upright(s, name, base);
  if (base < n) {
    puts_to(s, "_{");
    put(s, name + base, n - base);
    puts_to(s, "}");
  }
  for (; primes > 0; primes--) puts_to(s, "'");
}

bool ambit_source_identifier(ambit_language language, const char *name, size_t room, char *out) {
  sink s = { out, room, 0 };
  if (language == AMBIT_LANGUAGE_MODELICA)
    put_modelica(&s, name);
  else if (language == AMBIT_LANGUAGE_LATEX)
    put_latex(&s, name);
  else
    puts_to(&s, name);
  return finish(&s);
}
