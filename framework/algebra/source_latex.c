/* source_latex.c -- LaTeX in math mode: fractions, roots, \sin^{2}\left(x\right), 1.5 \cdot 10^{-3}. */
#include "algebra/source.h"
#include <stdio.h>
#include <string.h>

/* Functions that are written with an exponent behind their names; the inverse ones would be, with -1. */
static const char *name_of(uint32_t op, bool *takes_power) {
  *takes_power = true;
  switch (op) {
  case AMBIT_OP_SIN: return "\\sin";
  case AMBIT_OP_COS: return "\\cos";
  case AMBIT_OP_TAN: return "\\tan";
  case AMBIT_OP_SINH: return "\\sinh";
  case AMBIT_OP_COSH: return "\\cosh";
  case AMBIT_OP_TANH: return "\\tanh";
  default: break;
  }
  *takes_power = false;
  switch (op) {
  case AMBIT_OP_EXP: return "\\exp";
  case AMBIT_OP_LOG: return "\\ln";
  case AMBIT_OP_ASIN: return "\\arcsin";
  case AMBIT_OP_ACOS: return "\\arccos";
  case AMBIT_OP_ATAN: return "\\arctan";
  case AMBIT_OP_ATAN2: return "\\operatorname{atan2}";
  case AMBIT_OP_MIN: return "\\min";
  case AMBIT_OP_MAX: return "\\max";
  default: return NULL;
  }
}

/* Does a factor to the right begin with a digit, so that a mere space would not do? */
static bool begins_with_digit(const ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  while (!ambit_writer_name(w, e) &&
         (x->op == AMBIT_OP_MUL || x->op == AMBIT_OP_SQR || (x->op == AMBIT_OP_POWN && (int32_t)x->b > 0))) {
    e = x->a;
    x = ambit_at(w->g, e);
  }
  return x->op == AMBIT_LEAF_CONSTANT && !ambit_writer_name(w, e);
}

/* f(a)^n; false: a is no such function */
static bool lay_power_of_function(const ambit_writer *w, ambit_expr a, int32_t n, ambit_layout *l) {
  bool takes;
  const char *name = name_of(ambit_at(w->g, a)->op, &takes);
  if (!name || !takes || ambit_writer_name(w, a)) return false;
  snprintf(l->head, sizeof l->head, "%s^{%d}\\left(", name, (int)n);
  snprintf(l->tail, sizeof l->tail, "\\right)");
  l->a = ambit_at(w->g, a)->a;
  l->place_a = AMBIT_BINDS_SUM;
  return true;
}

/* a^n; negative n: 1/a^-n */
static void lay_power(const ambit_writer *w, int32_t n, ambit_layout *l) {
  int64_t size = n < 0 ? -(int64_t)n : n;
  bool function = n > 0 && lay_power_of_function(w, l->a, n, l);
  if (function) return;
  snprintf(l->head, sizeof l->head, n < 0 ? "\\frac{1}{" : "");
  snprintf(l->tail, sizeof l->tail, n < 0 ? "^{%lld}}" : "^{%lld}", (long long)size);
  l->place_a = AMBIT_BINDS_ATOM;
}

static void lay_function(uint32_t op, ambit_layout *l) {
  bool takes;
  const char *name = name_of(op, &takes);
  if (op == AMBIT_OP_SQRT || op == AMBIT_OP_ABS) {
    snprintf(l->head, sizeof l->head, op == AMBIT_OP_SQRT ? "\\sqrt{" : "\\left|");
    snprintf(l->tail, sizeof l->tail, op == AMBIT_OP_SQRT ? "}" : "\\right|");
    return;
  }
  snprintf(l->head, sizeof l->head, "%s\\left(", name);
  snprintf(l->middle, sizeof l->middle, ", ");
  snprintf(l->tail, sizeof l->tail, "\\right)");
}

static ambit_layout layout(const ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  if (ambit_op_is_function(x->op)) return ambit_layout_form(&ambit_function_of(x->op)->latex, x, AMBIT_BINDS_SUM);
  ambit_layout l = ambit_layout_infix(w, e);
  switch (x->op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_NEG: break;
  case AMBIT_OP_MUL: snprintf(l.middle, sizeof l.middle, begins_with_digit(w, x->b) ? " \\cdot " : " \\, "); break;
  case AMBIT_OP_DIV:
    snprintf(l.head, sizeof l.head, "\\frac{");
    snprintf(l.middle, sizeof l.middle, "}{");
    snprintf(l.tail, sizeof l.tail, "}");
    l.place_a = l.place_b = AMBIT_BINDS_SUM;
    break;
  case AMBIT_OP_SQR: lay_power(w, 2, &l); break;
  case AMBIT_OP_POWN: lay_power(w, (int32_t)x->b, &l); break;
  default:
    l.place_a = AMBIT_BINDS_SUM;
    l.head[0] = l.middle[0] = l.tail[0] = '\0';
    lay_function(x->op, &l);
  }
  return l;
}

/* The text of a number without its sign; false: it is no number. */
static const char *number_of(const ambit_node *x, char buffer[AMBIT_LEAF_MAX]) {
  if (x->op != AMBIT_LEAF_CONSTANT || x->value.lo > x->value.hi) return NULL;
  if (x->text) return x->text;
  if (x->value.lo != x->value.hi) return NULL;
  ambit_decimal_shortest(buffer, x->value.lo);
  return buffer;
}

static int strength(const ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  char buffer[AMBIT_LEAF_MAX];
  const char *number = number_of(x, buffer);
  if (x->op == AMBIT_OP_DIV || (x->op == AMBIT_OP_POWN && (int32_t)x->b < 0))
    return AMBIT_BINDS_PRODUCT; /* a fraction */
  if (!number) return ambit_writer_strength(w, e);
  return *number == '-' ? AMBIT_BINDS_SIGN : strpbrk(number, "/eE") ? AMBIT_BINDS_PRODUCT : AMBIT_BINDS_ATOM;
}

/* "1.5e-03" */
static bool put_decimal(ambit_writer *w, const char *text) {
  char mantissa[AMBIT_LEAF_MAX], power[AMBIT_LEAF_MAX];
  const char *e = strpbrk(text, "eE");
  if (!e || (size_t)(e - text) >= sizeof mantissa) return ambit_writer_put(w, text);
  snprintf(mantissa, sizeof mantissa, "%.*s", (int)(e - text), text);
  const char *digits = e + 1 + strspn(e + 1, "+-0");
  bool unit = strcmp(mantissa, "1") == 0, minus = strcmp(mantissa, "-1") == 0;
  snprintf(power, sizeof power, "10^{%s%s}", e[1] == '-' && *digits ? "-" : "", *digits ? digits : "0");
  return ambit_writer_put(w, unit    ? ""
                             : minus ? "-"
                                     : mantissa) &&
         (unit || minus || ambit_writer_put(w, " \\cdot ")) && ambit_writer_put(w, power);
}

/* "1/3" */
static bool put_fraction(ambit_writer *w, const char *text, const char *slash) {
  char above[AMBIT_LEAF_MAX];
  if ((size_t)(slash - text) >= sizeof above) return ambit_writer_put(w, text);
  snprintf(above, sizeof above, "%.*s", (int)(slash - text), text);
  return ambit_writer_put(w, "\\frac{") && put_decimal(w, above) && ambit_writer_put(w, "}{") &&
         put_decimal(w, slash + 1) && ambit_writer_put(w, "}");
}

static bool leaf(ambit_writer *w, ambit_expr e, bool wrap) {
  const ambit_node *x = ambit_at(w->g, e);
  char buffer[AMBIT_LEAF_MAX], name[4 * AMBIT_LEAF_MAX];
  (void)wrap;
  const char *number = number_of(x, buffer);
  if (!number) {
    const char *text = ambit_leaf_text(w->g, e, buffer);
    bool named = x->op != AMBIT_LEAF_CONSTANT && ambit_source_identifier(AMBIT_LANGUAGE_LATEX, text, sizeof name, name);
    return ambit_writer_put(w, named ? name : text);
  }
  if (strcmp(number, "pi") == 0) return ambit_writer_put(w, "\\pi");
  const char *slash = strchr(number, '/');
  if (strpbrk(number, "xX")) return ambit_writer_put(w, number);
  return slash ? put_fraction(w, number, slash) : put_decimal(w, number);
}

const ambit_style ambit_style_latex = { "\\left(", "\\right)", strength, layout, leaf };
