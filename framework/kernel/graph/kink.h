/* kink.h -- what a place where a formula is not smooth (abs, min, max) or may not be defined (sqrt, /) is called, for
** messages: what it says, and the element that wrote it.
*/
#ifndef AMBIT_KINK_H
#define AMBIT_KINK_H
#include <ambit/graph.h>

static inline bool ambit_op_has_kink(uint32_t op) {
  return op == AMBIT_OP_ABS || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}

/* From now on formulas are written by `maker`, or by nobody known (NULL); returns who it was before. The text must
** live until the next call. */
const char *ambit_graph_written_by(ambit_graph *g, const char *maker);
/* Who wrote e, if it is such a place that somebody known wrote; else NULL. */
const char *ambit_graph_writer(const ambit_graph *g, ambit_expr e);
/* "abs(v) of joint_friction `knee`", in the arena; NULL: out of memory. */
const char *ambit_kink_text(const ambit_graph *g, ambit_expr e, ambit_arena *arena);
#endif
