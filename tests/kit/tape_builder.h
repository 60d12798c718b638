/* tape_builder.h -- small tapes written by hand, so that tests of arithmetics need no expression graph.
**
** Constants first, then inputs, then instructions; each function returns a slot. Degrees in time follow from the
** operands. `tape_seal` sets runs (one per instruction), helper slots and outputs (every slot is one).
*/
#ifndef AMBIT_TAPE_BUILDER_H
#define AMBIT_TAPE_BUILDER_H
#include <ambit/tape.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TAPE_ROOM 256

typedef struct tape_builder {
  ambit_tape tape;
  uint32_t op[TAPE_ROOM], dst[TAPE_ROOM], a[TAPE_ROOM], b[TAPE_ROOM], aux[TAPE_ROOM];
  uint32_t out[TAPE_ROOM], degree[TAPE_ROOM];
  double lo[TAPE_ROOM], hi[TAPE_ROOM], range_lo[TAPE_ROOM], range_hi[TAPE_ROOM];
  const char *text[TAPE_ROOM];
  ambit_run run[TAPE_ROOM];
} tape_builder;

static inline void tape_begin(tape_builder *t) { memset(t, 0, sizeof *t); }

static inline uint32_t tape_constant(tape_builder *t, double lo, double hi) {
  uint32_t s = t->tape.nconst++;
  t->lo[s] = lo, t->hi[s] = hi;
  return t->tape.nslot++;
}

static inline uint32_t tape_input(tape_builder *t, uint32_t degree) {
  t->degree[t->tape.nslot] = degree;
  t->tape.nin++;
  return t->tape.nslot++;
}

static inline uint32_t tape_degree(uint32_t op, uint32_t a, uint32_t b) {
  if (a == AMBIT_DEGREE_ANY || b == AMBIT_DEGREE_ANY) return AMBIT_DEGREE_ANY;
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_NEG:
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return a > b ? a : b;
  case AMBIT_OP_MUL: return a + b;
  case AMBIT_OP_SQR: return 2 * a;
  case AMBIT_OP_DIV: return b == 0 ? a : AMBIT_DEGREE_ANY;
  default: return a == 0 && b == 0 ? 0 : AMBIT_DEGREE_ANY;
  }
}

static inline uint32_t tape_op(tape_builder *t, uint32_t op, uint32_t a, uint32_t b) {
  uint32_t i = t->tape.ninstr++, s = t->tape.nslot++;
  if (s >= TAPE_ROOM) abort();
  t->op[i] = op, t->dst[i] = s, t->a[i] = a, t->b[i] = b, t->aux[i] = AMBIT_NO_SLOT;
  t->degree[s] = op == AMBIT_OP_POWN ? AMBIT_DEGREE_ANY : tape_degree(op, t->degree[a], t->degree[b]);
  return s;
}

static inline uint32_t tape_unary(tape_builder *t, uint32_t op, uint32_t a) { return tape_op(t, op, a, a); }

/* the helper that aux of an instruction names, written if it is not there */
static inline uint32_t tape_find(tape_builder *t, uint32_t op, uint32_t a, uint32_t b) {
  for (uint32_t i = 0; i < t->tape.ninstr; i++)
    if (t->op[i] == op && t->a[i] == a && t->b[i] == b) return t->dst[i];
  return tape_op(t, op, a, b);
}

static inline uint32_t tape_helper(tape_builder *t, uint32_t i, uint32_t one) {
  uint32_t a = t->a[i], b = t->b[i];
  switch (t->op[i]) {
  case AMBIT_OP_SIN: return tape_find(t, AMBIT_OP_COS, a, a);
  case AMBIT_OP_COS: return tape_find(t, AMBIT_OP_SIN, a, a);
  case AMBIT_OP_SINH: return tape_find(t, AMBIT_OP_COSH, a, a);
  case AMBIT_OP_COSH: return tape_find(t, AMBIT_OP_SINH, a, a);
  case AMBIT_OP_TANH: return tape_find(t, AMBIT_OP_SUB, one, tape_find(t, AMBIT_OP_SQR, t->dst[i], t->dst[i]));
  case AMBIT_OP_ATAN: return tape_find(t, AMBIT_OP_ADD, one, tape_find(t, AMBIT_OP_SQR, a, a));
  case AMBIT_OP_ATAN2: {
    uint32_t y = tape_find(t, AMBIT_OP_SQR, a, a), x = tape_find(t, AMBIT_OP_SQR, b, b);
    return tape_find(t, AMBIT_OP_ADD, y, x);
  }
  default: return AMBIT_NO_SLOT;
  }
}

/* Neighbours of one opcode that do not read each other's results are one run. Returns the number of runs. */
static inline uint32_t tape_group(tape_builder *t) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < t->tape.ninstr; i++) {
    ambit_run *run = n ? &t->run[n - 1] : NULL;
    uint32_t first = run ? t->dst[run->first] : 0, b = t->op[i] == AMBIT_OP_POWN ? t->a[i] : t->b[i];
    if (run && run->op == t->op[i] && t->a[i] < first && b < first)
      run->count++;
    else
      t->run[n++] = (ambit_run) { t->op[i], i, 1, 0 };
  }
  return n;
}

/* one: the slot of the constant 1, for TANH and ATAN; AMBIT_NO_SLOT: not a SERIES tape */
static inline const ambit_tape *tape_seal(tape_builder *t, uint32_t one) {
  if (one != AMBIT_NO_SLOT)
    for (uint32_t i = 0; i < t->tape.ninstr; i++) t->aux[i] = tape_helper(t, i, one);
  ambit_tape *p = &t->tape;
  p->size = sizeof *p, p->flags = one != AMBIT_NO_SLOT ? AMBIT_TAPE_SERIES : 0;
  for (uint32_t s = 0; s < p->nslot; s++) t->out[s] = s, t->range_lo[s] = -INFINITY, t->range_hi[s] = INFINITY;
  p->nout = p->nslot, p->nrun = tape_group(t);
  p->op = t->op, p->dst = t->dst, p->a = t->a, p->b = t->b, p->aux = t->aux, p->run = t->run, p->lo = t->lo,
  p->hi = t->hi;
  p->text = t->text, p->out = t->out, p->degree = t->degree, p->range_lo = t->range_lo, p->range_hi = t->range_hi;
  return p;
}
#endif
