/* element_kit_ask.c -- asking for quantities: each is expressed, declined, or refused by a message that names the
** part; what is not of a port is declined.
*/
#include "kit/element_kit_inside.h"
#include "mechanics/parts.h"
#include <string.h>

static const uint32_t whole[] = { AMBIT_FIELD, AMBIT_ENERGY, AMBIT_POWER, AMBIT_MASS, AMBIT_MASS_MOMENT,
  AMBIT_MOMENTUM };
#define WHOLE (sizeof whole / sizeof *whole)

/* names the part, and says more than a word */
static bool is_clear(const char *message) {
  const char *place = strstr(message, "kit.lua:1): ");
  return strstr(message, "subject") && strlen(message) >= 30 && !(place && strlen(place) < strlen("kit.lua:1): ") + 8);
}

const ambit_expr *element_kit_ask(element_kit *k, uint32_t part, uint32_t port, uint32_t quantity) {
  ambit_failure f = { 0 };
  const ambit_expr *e = ambit_mechanism_pull(k->mechanism, (ambit_frame) { part, port }, quantity, &f);
  if (e) {
    k->report->expressed++;
    return e;
  }
  k->report->refused++;
  if (f.status == AMBIT_OK || !is_clear(f.message))
    element_kit_complain(
        k, "%s of port %u is refused without a clear message: `%s`", ambit_quantity_name(quantity), port, f.message);
  if (f.status == AMBIT_BROKEN) element_kit_complain(k, "%s", f.message);
  return NULL;
}

const ambit_expr *element_kit_own(element_kit *k, uint32_t quantity) {
  ambit_failure f = { 0 };
  if (!ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, quantity, &f)) return NULL;
  const ambit_cell *cell = ambit_part_cell(&k->mechanism->part[k->part], AMBIT_NO_PORT, quantity);
  return cell->state == AMBIT_CELL_DONE ? cell->value : NULL;
}

/* Its share of what is summed over all parts. */
void element_kit_ask_whole(element_kit *k) {
  for (size_t i = 0; i < WHOLE; i++) {
    ambit_failure f = { 0 };
    if (!ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, whole[i], &f)) {
      k->report->refused++;
      if (f.status == AMBIT_BROKEN) element_kit_complain(k, "%s", f.message);
      if (!is_clear(f.message))
        element_kit_complain(
            k, "its %s is refused without a clear message: `%s`", ambit_quantity_name(whole[i]), f.message);
    } else if (element_kit_own(k, whole[i]))
      k->report->expressed++;
    else
      k->report->declined++;
  }
}

static void check_declined(element_kit *k, uint32_t port, uint32_t quantity) {
  ambit_failure f = { 0 };
  ambit_expr out[AMBIT_QUANTITY_MAX];
  ambit_cell cell = { .part = k->part, .port = port, .quantity = quantity };
  k->mechanism->failure = &f;
  ambit_status status = ambit_build_express(k->mechanism, &cell, out);
  k->mechanism->failure = NULL;
  if (status == AMBIT_UNABLE && f.status == AMBIT_OK)
    k->report->declined++;
  else
    element_kit_complain(
        k, "the unknown quantity %u at port %d is not declined with AMBIT_UNABLE", quantity, (int)port);
}

void element_kit_check_declines(element_kit *k) {
  static const uint32_t later[] = { 7, 15, 22, 23, 25, 31, 36, 99, 1000 };
  for (size_t i = 0; i < sizeof later / sizeof *later; i++) {
    check_declined(k, AMBIT_NO_PORT, later[i]);
    for (uint32_t port = 0; port < k->element->nport; port++) check_declined(k, port, later[i]);
  }
  for (uint32_t port = 0; port < k->element->nport; port++)
    for (size_t i = 0; i < WHOLE; i++) check_declined(k, port, whole[i]);
}

static uint32_t state_of(const element_kit *k, uint32_t port, uint32_t quantity) {
  const ambit_cell *cell = ambit_part_cell(&k->mechanism->part[k->part], port, quantity);
  return cell ? cell->state : AMBIT_CELL_EMPTY;
}

static void check_not_declined(element_kit *k, uint32_t port, size_t n, const uint32_t *quantity) {
  for (size_t i = 0; i < n; i++)
    if (state_of(k, port, quantity[i]) == AMBIT_CELL_DECLINED)
      element_kit_complain(k, "port `%s` has no %s", k->element->port[port].name, ambit_quantity_name(quantity[i]));
}

void element_kit_count_own(element_kit *k) {
  static const uint32_t motion[] = { AMBIT_POSE, AMBIT_TWIST, AMBIT_ACCEL }, residual[] = { AMBIT_RESIDUAL };
  static const uint32_t state[] = { AMBIT_COORDINATE, AMBIT_COORDINATE_RATE };
  static const uint32_t joint[] = { AMBIT_COORDINATE, AMBIT_RATE, AMBIT_RATE2, AMBIT_BALANCE };
  for (uint32_t port = 0; port <= k->element->nport; port++)
    for (uint32_t quantity = 1; quantity <= AMBIT_MOMENTUM; quantity++)
      k->report->own += state_of(k, port < k->element->nport ? port : AMBIT_NO_PORT, quantity) == AMBIT_CELL_DONE;
  for (uint32_t port = 0; port < k->element->nport; port++) {
    const ambit_port *p = &k->element->port[port];
    if (p->role != AMBIT_ROLE_OUT) continue;
    if (p->kind == AMBIT_PORT_FRAME) check_not_declined(k, port, 3, motion);
    if (p->kind == AMBIT_PORT_JOINT) check_not_declined(k, port, 4, joint);
    if (p->kind == AMBIT_PORT_STATE) check_not_declined(k, port, 2, state);
    if (p->kind == AMBIT_PORT_CONSTRAINT) check_not_declined(k, port, 1, residual);
  }
}
