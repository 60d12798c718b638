/* element_kit_inside.h -- what the files of the element kit share: the stage, and what must vanish on it. */
#ifndef AMBIT_ELEMENT_KIT_INSIDE_H
#define AMBIT_ELEMENT_KIT_INSIDE_H
#include <ambit/graph.h>
#include "kit/element_kit.h"
#include "kit/element_stage.h"
#include <ambit/mechanism.h>
#include "num/random.h"

#define ELEMENT_KIT_PORTS 8u
#define ELEMENT_KIT_PARAMS 16u
#define ELEMENT_KIT_RESIDUALS 512u

typedef struct element_kit {
  element_kit_report *report;
  const ambit_element *element;
  const char *name;
  ambit_random random;
  /* the stage */
  ambit_graph *graph;
  ambit_mechanism *mechanism;
  uint32_t part, mover[ELEMENT_KIT_PORTS]; /* mover: of IN ports */
  ambit_expr value[ELEMENT_KIT_PARAMS][AMBIT_QUANTITY_MAX], load[ELEMENT_KIT_PORTS][AMBIT_QUANTITY_MAX];
  element_stage_joint joint[ELEMENT_KIT_PORTS];
  bool moving; /* parameters move in time */
  size_t nleaf;
  ambit_expr *leaf, *rate; /* [nleaf] coordinates and speeds, and their time derivatives */
  size_t nresidual;
  ambit_expr residual[ELEMENT_KIT_RESIDUALS];
  const char *about[ELEMENT_KIT_RESIDUALS];
  size_t nfollowed;
  ambit_expr followed[ELEMENT_KIT_RESIDUALS]; /* what was differentiated: it may not jump */
} element_kit;

/* The first complaint is kept, the others are counted. */
void element_kit_complain(element_kit *k, const char *format, ...) AMBIT_PRINTF(2, 3);

static inline ambit_expr kit_op(element_kit *k, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(k->graph, code, a, b);
}
static inline ambit_expr kit_add(element_kit *k, ambit_expr a, ambit_expr b) { return kit_op(k, AMBIT_OP_ADD, a, b); }
static inline ambit_expr kit_subtract(element_kit *k, ambit_expr a, ambit_expr b) {
  return kit_op(k, AMBIT_OP_SUB, a, b);
}
static inline ambit_expr kit_multiply(element_kit *k, ambit_expr a, ambit_expr b) {
  return kit_op(k, AMBIT_OP_MUL, a, b);
}
static inline ambit_expr kit_dot(element_kit *k, uint32_t n, const ambit_expr *a, const ambit_expr *b) {
  ambit_expr s = 0;
  for (uint32_t i = 0; i < n; i++) s = kit_add(k, s, kit_multiply(k, a[i], b[i]));
  return s;
}

/* This expression must vanish, whatever the motion. */
void element_kit_vanish(element_kit *k, const char *about, ambit_expr e);
/* the total time derivative */
ambit_expr element_kit_derivative(element_kit *k, ambit_expr e);

/* In element_kit_stage.c: builds the stage; bit j of `given`: the j-th optional parameter is given. False: the element
** refuses the data.
*/
bool element_kit_open_stage(element_kit *k, unsigned given);
void element_kit_close_stage(element_kit *k);

/* In element_kit_ask.c: a quantity. NULL: declined or refused, which is counted; a refusal must name the part. */
const ambit_expr *element_kit_ask(element_kit *k, uint32_t part, uint32_t port, uint32_t quantity);
/* What the subject itself has contributed to a quantity of the whole; NULL: nothing. */
const ambit_expr *element_kit_own(element_kit *k, uint32_t quantity);
void element_kit_ask_whole(element_kit *k);
void element_kit_check_declines(element_kit *k);
/* What the subject has written on this stage; a frame or a joint that it carries must have its motion. */
void element_kit_count_own(element_kit *k);

/* In element_kit_motion.c */
void element_kit_check_motion(element_kit *k);
/* In element_kit_power.c; the multiplier of a row that has been asked for: 0 if the row holds by itself. */
void element_kit_check_power(element_kit *k);
ambit_expr element_kit_multiplier(element_kit *k, uint32_t row);
/* In element_kit_momentum.c */
void element_kit_check_momentum(element_kit *k);
/* In element_kit_points.c: everything that must vanish, at random points. */
void element_kit_evaluate(element_kit *k);
#endif
