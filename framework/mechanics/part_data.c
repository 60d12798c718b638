/* part_data.c -- the parameters of a part: what the user gave, else what the declaration says. */
#include "host/params.h"
#include "graph/name.h"
#include <ambit/registry.h>
#include "mechanics/parts.h"
#include <stdio.h>
#include <string.h>

#define PIECE_MAX 64

static size_t components(const ambit_param *param) {
  ambit_param one[2] = { *param, { 0 } };
  return ambit_params_doubles(one);
}

/* "z", "-x" */
static bool read_axis(ambit_graph *g, const char *text, ambit_expr *out) {
  bool minus = *text == '-';
  char letter = text[minus];
  if (letter < 'x' || letter > 'z' || text[minus + 1]) return false;
  for (int i = 0; i < 3; i++) out[i] = ambit_graph_number(g, letter - 'x' != i ? 0 : minus ? -1 : 1);
  return true;
}

/* the number of the word in "rk4|rk8pd|msbdf" */
static bool read_choice(ambit_graph *g, const char *shape, const char *text, ambit_expr *out) {
  for (double number = 0; shape; number++) {
    size_t length = strcspn(shape, "|");
    if (strlen(text) == length && memcmp(text, shape, length) == 0) {
      *out = ambit_graph_number(g, number);
      return true;
    }
    shape = shape[length] ? shape + length + 1 : NULL;
  }
  return false;
}

/* n numbers, separated by commas */
static bool read_numbers(ambit_graph *g, const char *text, size_t n, ambit_expr *out) {
  char piece[PIECE_MAX];
  for (size_t i = 0; i < n; i++) {
    size_t length = strcspn(text, ",");
    if (length >= sizeof piece) return false;
    memcpy(piece, text, length);
    piece[length] = '\0';
    out[i] = ambit_graph_decimal(g, piece, NULL);
    text += length;
    if (out[i] == AMBIT_NO_EXPR || (*text == ',') != (i + 1 < n)) return false;
    text += *text == ',';
  }
  return true;
}

static bool read_fallback(ambit_graph *g, const ambit_param *param, size_t n, ambit_expr *out) {
  const char *text = param->fallback;
  if (strchr(param->shape, '|')) return read_choice(g, param->shape, text, out);
  if (strcmp(param->shape, "flag") == 0)
    return read_choice(g, "false|true", text, out) || read_choice(g, "0|1", text, out);
  if (strcmp(param->shape, "axis") == 0 && read_axis(g, text, out)) return true;
  return read_numbers(g, text, n, out);
}

static ambit_status take_param(ambit_mechanism *m, ambit_part *p, size_t i, const ambit_expr *given, ambit_failure *f) {
  const ambit_param *param = &p->element->param[i];
  char who[AMBIT_WHO_MAX];
  size_t n = components(param);
  ambit_part_who(p, who);
  if (!given && !param->fallback)
    return ambit_fail(
        f, AMBIT_INVALID, "%s needs `%s`: %s", who, param->name, param->doc ? param->doc : "no description");
  if (!given && !*param->fallback) return AMBIT_OK;
  ambit_expr *value = ambit_arena_alloc(m->arena, n * sizeof *value);
  if (!value) return ambit_no_memory(f);
  p->param[i] = value;
  if (given)
    memcpy(value, given, n * sizeof *value);
  else if (!read_fallback(m->graph, param, n, value))
    return ambit_fail(
        f, AMBIT_INVALID, "%s: the fallback `%s` of `%s` is not of its shape", who, param->fallback, param->name);
  for (size_t k = 0; k < n; k++)
    if (value[k] >= ambit_graph_count(m->graph))
      return ambit_fail(f, AMBIT_INVALID, "%s: component %zu of `%s` is no expression", who, k + 1, param->name);
  return AMBIT_OK;
}

/* "upper.offset.x", "body.inertia[4]" */
static bool name_param(ambit_mechanism *m, const ambit_part *p, const ambit_param *param, const ambit_expr *value) {
  size_t n = components(param);
  for (size_t k = 0; k < n; k++) {
    char label[AMBIT_DATUM_NAME_MAX];
    int used = snprintf(label, sizeof label, "%.100s.%.100s", p->name, param->name);
    if (n == 3)
      snprintf(label + used, sizeof label - (size_t)used, ".%c", "xyz"[k]);
    else if (n > 1)
      snprintf(label + used, sizeof label - (size_t)used, "[%zu]", k + 1);
    if (!ambit_graph_name_data(m->graph, value[k], label)) return false;
  }
  return true;
}

bool ambit_part_name_data(ambit_mechanism *m, const ambit_part *p) {
  for (size_t i = 0; i < p->nparam; i++)
    if (p->param[i] && !name_param(m, p, &p->element->param[i], p->param[i])) return false;
  return true;
}

void ambit_part_unknown_name(ambit_part *p, char out[AMBIT_DATUM_NAME_MAX]) {
  const char *of = p->nparam ? p->element->param[p->nparam - 1].name : "unknown";
  uint32_t number = ++p->nunknown;
  snprintf(out, AMBIT_DATUM_NAME_MAX, number > 1 ? "%.100s.%.100s (%u)" : "%.100s.%.100s", p->name, of, number);
}

size_t ambit_part_components(const ambit_part *p, size_t i) { return components(&p->element->param[i]); }

ambit_status ambit_part_take_params(
    ambit_mechanism *m, ambit_part *p, const ambit_expr *const *given, ambit_failure *f) {
  ambit_status status = AMBIT_OK;
  p->nparam = ambit_params_count(p->element->param);
  p->param = ambit_arena_alloc(m->arena, (p->nparam + 1) * sizeof *p->param);
  if (!p->param) return ambit_no_memory(f);
  for (size_t i = 0; status == AMBIT_OK && i < p->nparam; i++) status = take_param(m, p, i, given ? given[i] : NULL, f);
  return status;
}
