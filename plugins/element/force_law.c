/* force_law.c -- any force along the line between two points (line.h): the law is an expression, or a Lua function of
** length, its rate and time that is recorded once.
**
** Positive pushes apart, as a positive effort drives a joint's coordinate up; a spring is -k (l - l0). Power f l'. No
** energy: a law need not have a potential.
*/
#include "line.h"

enum { FORCE = LINE_PARAMS };

static const ambit_port ports[] = { LINE_PORTS };
static const ambit_param params[] = {
  LINE_PARAM { "force", "N", "", NULL,
      "the force, positive where it pushes the points apart: a number, an expression or a function of length, rate and "
      "time" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  line s;
  int power = port == AMBIT_NO_PORT && quantity == AMBIT_POWER;
  if (!power && !(port <= LINE_TO && quantity == AMBIT_WRENCH)) return AMBIT_UNABLE;
  ambit_status status = line_place(b, &s);
  if (status == AMBIT_OK && power) status = line_move(b, &s);
  if (status != AMBIT_OK) return status;
  ambit_expr density = ambit_divide(b, *b->param(b, FORCE), line_length(b, &s));
  if (!power) return line_wrench(b, port, &s, density, out);
  *out = ambit_multiply(b, density, line_half_square_rate(b, &s));
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 2, ports, params, express, line_check };

AMBIT_ELEMENT_ENTRY("force_law", "1.0",
    "A force along the line between two points, given as a number, an expression or a function(length, rate, t); "
    "positive pushes apart. The function is called once and recorded. The two points must stay apart.",
    element)
