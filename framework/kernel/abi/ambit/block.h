/* block.h -- running a tape in a completed arithmetic, one lane: for solvers that need values and no series.
**
** Everything is allocated at opening, through the host; running allocates nothing.
*/
#ifndef AMBIT_BLOCK_H
#define AMBIT_BLOCK_H
#include "arithmetic.h"
#include "work.h"

typedef struct ambit_lane {
  const ambit_tape *tape;
  const ambit_arithmetic *arithmetic;
  void *ctx, *base;
  size_t elem;
  ambit_work *work;    /* or NULL */
  uint32_t flags;      /* of the last run */
  int32_t given_empty; /* was an input or a constant ever empty? */
} ambit_lane;

static inline void *ambit_lane_at(const ambit_lane *lane, uint32_t slot) {
  return (char *)lane->base + slot * lane->elem;
}

/* [ctx] dst := constant number i of the tape, from its text where the arithmetic reads more from that than from two
** doubles */
static inline void ambit_constant_set(
    const ambit_arithmetic *arithmetic, void *actx, void *dst, const ambit_tape *t, uint32_t i) {
  const char *text = arithmetic->set_text && t->text ? t->text[i] : NULL;
  if (!text || !arithmetic->set_text(actx, dst, text)) arithmetic->set(actx, dst, 1, &t->lo[i], &t->hi[i], -1);
}

/* [ctx] room for every slot, constants set; the memory is the host object's */
static inline ambit_status ambit_lane_open(
    ambit_lane *lane, const ambit_host *h, const ambit_tape *t, const ambit_arithmetic *arithmetic, void *actx) {
  lane->tape = t, lane->arithmetic = arithmetic, lane->ctx = actx, lane->elem = arithmetic->elem(actx);
  lane->work = ambit_work_open(h);
  lane->flags = 0, lane->given_empty = 0;
  lane->base = h->alloc(h, t->nslot * lane->elem);
  if (!lane->base) return AMBIT_NOMEM;
  if (arithmetic->init && arithmetic->init(actx, lane->base, t->nslot) != AMBIT_OK) return AMBIT_NOMEM;
  for (uint32_t i = 0; i < t->nconst; i++) {
    ambit_constant_set(arithmetic, actx, ambit_lane_at(lane, i), t, i);
    lane->given_empty |= !(t->lo[i] <= t->hi[i]);
  }
  return AMBIT_OK;
}

static inline void ambit_lane_close(ambit_lane *lane) {
  if (lane->base && lane->arithmetic->clear) lane->arithmetic->clear(lane->ctx, lane->base, lane->tape->nslot);
}

/* [ctx] input number `in` := [lo, hi] */
static inline void ambit_lane_set(ambit_lane *lane, uint32_t in, double lo, double hi) {
  lane->given_empty |= !(lo <= hi);
  lane->arithmetic->set(lane->ctx, ambit_lane_at(lane, lane->tape->nconst + in), 1, &lo, &hi, -1);
}

/* [ctx] every instruction; AMBIT_F_* */
static inline uint32_t ambit_lane_run(ambit_lane *lane) {
  const ambit_tape *t = lane->tape;
  const ambit_arithmetic *a = lane->arithmetic;
  uint32_t flags = 0;
  ambit_work_evaluate(lane->work, t->ninstr, 1);
  if (a->enter) a->enter(lane->ctx);
  for (uint32_t i = 0; i < t->nrun; i++) {
    const ambit_run *run = &t->run[i];
    flags |= ambit_arithmetic_run(
        a, lane->ctx, run->op, lane->base, 1, 1, run->count, t->dst + run->first, t->a + run->first, t->b + run->first);
  }
  if (a->leave) a->leave(lane->ctx);
  if (flags & AMBIT_F_EMPTY) ambit_empty_check(a, flags, lane->given_empty, __builtin_inf(), -__builtin_inf());
  return lane->flags = flags;
}

/* [ctx] bounds of output number `out` */
static inline void ambit_lane_get(const ambit_lane *lane, uint32_t out, double *lo, double *hi) {
  ambit_bounds_read(lane->arithmetic, lane->ctx, ambit_lane_at(lane, lane->tape->out[out]), 1, lo, hi);
  ambit_empty_check(lane->arithmetic, lane->flags, lane->given_empty, *lo, *hi);
}

/* [ctx] lo, hi: [nslot], bounds of all slots; flags: of the operations that led to them */
static inline void ambit_lane_slots(const ambit_lane *lane, uint32_t flags, double *lo, double *hi) {
  ambit_bounds_read(lane->arithmetic, lane->ctx, lane->base, lane->tape->nslot, lo, hi);
  for (uint32_t i = 0; i < lane->tape->nslot; i++)
    ambit_empty_check(lane->arithmetic, flags, lane->given_empty, lo[i], hi[i]);
}
#endif
