/* element_kit.c -- see element_kit.h. */
#include "kit/element_kit.h"
#include "kit/element_kit_inside.h"
#include "models/unit.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define UNIT_MAX 64

void element_kit_complain(element_kit *k, const char *format, ...) {
  va_list arguments;
  if (k->report->failures++) return;
  va_start(arguments, format);
  int n = snprintf(k->report->first, sizeof k->report->first, "%s: ", k->name);
  vsnprintf(k->report->first + n, sizeof k->report->first - (size_t)n, format, arguments);
  va_end(arguments);
}

void element_kit_vanish(element_kit *k, const char *about, ambit_expr e) {
  if (k->nresidual == ELEMENT_KIT_RESIDUALS) {
    element_kit_complain(k, "too many residuals");
    return;
  }
  k->about[k->nresidual] = about;
  k->residual[k->nresidual++] = e;
}

ambit_expr element_kit_derivative(element_kit *k, ambit_expr e) {
  ambit_failure f = { 0 };
  ambit_expr d = ambit_graph_rate_off_kinks(k->graph, e, k->nleaf, k->leaf, k->rate, &f);
  if (d == AMBIT_NO_EXPR) element_kit_complain(k, "%s", f.message);
  if (k->nfollowed < ELEMENT_KIT_RESIDUALS) k->followed[k->nfollowed++] = e;
  return d == AMBIT_NO_EXPR ? 0 : d;
}

/* -- description */

static bool is_sentence(const char *text) { return text && strlen(text) >= 3; }

static bool known_shape(const char *shape) {
  static const char *const word[] = { "", "axis", "flag", "integer" };
  for (size_t i = 0; i < sizeof word / sizeof *word; i++)
    if (strcmp(shape, word[i]) == 0) return true;
  return strchr(shape, '|') || (shape[0] >= '1' && shape[0] <= '9');
}

/* One unit, or several separated by | */
static bool known_unit(const char *text, ambit_failure *f) {
  ambit_unit unit;
  char one[UNIT_MAX];
  for (bool more = text != NULL; more;) {
    size_t length = strcspn(text, "|");
    if (length >= sizeof one) return false;
    memcpy(one, text, length);
    one[length] = '\0';
    if (ambit_unit_read(one, &unit, f) != AMBIT_OK) return false;
    more = text[length] == '|';
    text += length + more;
  }
  return text != NULL;
}

static void check_port(element_kit *k, uint32_t i) {
  const ambit_port *p = &k->element->port[i];
  if (!p->name || !*p->name || !is_sentence(p->doc)) element_kit_complain(k, "port %u has no name or no sentence", i);
  for (uint32_t j = 0; j < i; j++)
    if (strcmp(k->element->port[j].name, p->name) == 0) element_kit_complain(k, "two ports are called `%s`", p->name);
}

static void check_param(element_kit *k, const ambit_param *p) {
  ambit_failure f = { 0 };
  if (!is_sentence(p->doc)) element_kit_complain(k, "parameter `%s` has no sentence", p->name);
  if (!known_unit(p->unit, &f)) element_kit_complain(k, "unit of `%s`: %s", p->name, f.message);
  if (!p->shape || !known_shape(p->shape)) element_kit_complain(k, "parameter `%s` has no known shape", p->name);
  for (const ambit_param *q = k->element->param; q < p; q++)
    if (strcmp(p->name, q->name) == 0) element_kit_complain(k, "two parameters are called `%s`", p->name);
  for (uint32_t i = 0; i < k->element->nport; i++)
    if (strcmp(p->name, k->element->port[i].name) == 0)
      element_kit_complain(k, "a port and a parameter are called `%s`", p->name);
}

static void check_description(element_kit *k) {
  for (uint32_t i = 0; i < k->element->nport; i++) check_port(k, i);
  for (const ambit_param *p = k->element->param; p && p->name; p++) check_param(k, p);
}

/* -- stages */

static void run_stage(element_kit *k, unsigned given) {
  if (element_kit_open_stage(k, given)) {
    element_kit_check_declines(k);
    element_kit_ask_whole(k);
    element_kit_check_motion(k);
    element_kit_check_power(k);
    element_kit_check_momentum(k);
    element_kit_evaluate(k);
    element_kit_count_own(k);
  }
  element_kit_close_stage(k);
}

element_kit_report element_kit_run(const ambit_element *element, const char *name, uint64_t seed) {
  element_kit_report report = { 0 };
  element_kit k = { .report = &report, .element = element, .name = name, .random = { seed } };
  unsigned optional = 0;
  size_t params = 0;
  for (const ambit_param *p = element->param; p && p->name; p++, params++) optional += p->fallback != NULL;
  if (element->nport > ELEMENT_KIT_PORTS || params > ELEMENT_KIT_PARAMS || optional > 8)
    element_kit_complain(&k, "more ports or parameters than the kit can stage");
  else
    check_description(&k);
  for (unsigned given = 0; report.failures == 0 && given < 1u << optional; given++)
    for (int moving = 0; moving < 2; moving++) {
      k.moving = moving;
      run_stage(&k, given);
    }
  if (report.failures == 0 && report.own == 0) element_kit_complain(&k, "it expresses nothing at all");
  return report;
}
