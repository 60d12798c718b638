/* stage.h -- what the two halves of the articulated-body method share: the tree as stages (articulated.c), and the
** reduction of one of them (stage.c). The letters are those of articulated.c.
*/
#ifndef AMBIT_STAGE_H
#define AMBIT_STAGE_H
#include "mechanics/affine_in.h"
#include "mechanics/balance.h"
#include "mechanics/cut.h"
#include "mechanics/parts.h"

#define AMBIT_STAGE_DOF 6u
#define AMBIT_STAGE_ROOT UINT32_MAX

typedef struct ambit_stage {
  uint32_t part, from, to; /* ports */
  uint32_t before;         /* the stage whose OUT frame carries this one; ROOT: its acceleration is known */
  bool known;              /* no speed acts on it: part of the root */
  size_t d, speed[AMBIT_STAGE_DOF];
  ambit_expr symbol[6];                                  /* A */
  ambit_expr accel[6];                                   /* a + S u', then a */
  ambit_expr along[6 * AMBIT_STAGE_DOF];                 /* S by rows */
  ambit_expr y[AMBIT_STAGE_DOF], k[AMBIT_STAGE_DOF * 6]; /* u' = y - K a */
} ambit_stage;

typedef struct ambit_tree {
  ambit_mechanism *m;
  ambit_graph *g;
  const ambit_variables *v;
  const ambit_expr *applied;
  ambit_failure *f;
  ambit_arena *arena;
  ambit_cut *cut;
  ambit_affine *affine;
  ambit_stage *stage; /* in the order of the parts */
  uint32_t n;
  ambit_expr wrench[6];      /* symbols w */
  ambit_expr *pivot, *scale; /* in the order of the elimination */
  ambit_speed *pivot_speed;
  size_t npivot;
} ambit_tree;

/* In stage.c: eliminates the stage's speeds: fills accel, along, y and k, notes its pivots, and gives the wrench that
** is left to the frame before. */
ambit_status ambit_stage_reduce(ambit_tree *t, ambit_stage *s);

/* INVALID: the method does not fit this mechanism, because of this stage */
ambit_status ambit_stage_misfit(const ambit_tree *t, const ambit_stage *s, const char *why);

static inline ambit_frame ambit_stage_frame(const ambit_stage *s) { return (ambit_frame) { s->part, s->to }; }

/* a + b c, a - b c, where any may be a structural zero */
static inline ambit_expr ambit_stage_plus(const ambit_tree *t, ambit_expr a, ambit_expr b, ambit_expr c) {
  if (b == 0 || c == 0) return a;
  return ambit_graph_op(t->g, AMBIT_OP_ADD, a, ambit_graph_op(t->g, AMBIT_OP_MUL, b, c));
}
static inline ambit_expr ambit_stage_minus(const ambit_tree *t, ambit_expr a, ambit_expr b, ambit_expr c) {
  if (b == 0 || c == 0) return a;
  return ambit_graph_op(t->g, AMBIT_OP_SUB, a, ambit_graph_op(t->g, AMBIT_OP_MUL, b, c));
}

/* The quantity, copied to out[n]. */
static inline ambit_status ambit_stage_pull(
    const ambit_tree *t, ambit_frame at, uint32_t quantity, size_t n, ambit_expr *out) {
  const ambit_expr *e = ambit_mechanism_pull(t->m, at, quantity, t->f);
  if (e) memcpy(out, e, n * sizeof *out);
  return e ? AMBIT_OK : AMBIT_INVALID;
}
#endif
