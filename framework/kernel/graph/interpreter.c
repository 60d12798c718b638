/* interpreter.c -- a tape over a block of elements: constants once, then run by run.
**
** The result is sound because every run function encloses the exact image of its operands, and operands precede.
*/
#include "graph/interpreter.h"
#include "base/memory.h"
#include "base/meter.h"
#include <ambit/block.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ALIGNMENT 64u

struct ambit_block {
  const ambit_tape *tape;
  const ambit_arithmetic *arithmetic;
  void *ctx;
  char *base;
  size_t lanes, elem;
  bool initialised; /* clear() is due */
  bool metered;
  uint32_t flags;      /* of the last run */
  int32_t given_empty; /* was an input or a constant ever empty? */
};

static char *element(const ambit_block *block, uint32_t slot, size_t lane) {
  return block->base + ((size_t)slot * block->lanes + lane) * block->elem;
}

static ambit_status allocate(ambit_block *block, ambit_failure *f) {
  size_t slots = block->tape->nslot, lanes = block->lanes, elem = block->elem, count, bytes;
  double need = (double)slots * (double)lanes * (double)elem;
  bool overflow = __builtin_mul_overflow(slots, lanes, &count) || __builtin_mul_overflow(count, elem, &bytes) ||
                  bytes > SIZE_MAX / 2;
  if (overflow)
    return ambit_fail(f, AMBIT_INVALID,
        "%zu slots in %zu lanes of %zu bytes need %.3g bytes, more than there are addresses", slots, lanes, elem, need);
  if (!ambit_memory_allows(bytes))
    return ambit_fail(f, AMBIT_NOMEM,
        "%zu slots in %zu lanes of %zu bytes need %.3g bytes, but only %.3g are free; make fewer data uncertain, ask "
        "for less at once, or allow more memory",
        slots, lanes, elem, need, (double)ambit_memory_available());
  bytes = (bytes / ALIGNMENT + 1) * ALIGNMENT;
  block->base = aligned_alloc(ALIGNMENT, bytes);
  if (!block->base)
    return ambit_fail(
        f, AMBIT_NOMEM, "out of memory: %zu slots in %zu lanes of %zu bytes need %.3g bytes", slots, lanes, elem, need);
  memset(block->base, 0, bytes);
  ambit_status status = block->arithmetic->init ? block->arithmetic->init(block->ctx, block->base, count) : AMBIT_OK;
  if (status != AMBIT_OK) return ambit_fail(f, status, "the arithmetic could not initialise %zu elements", count);
  block->initialised = true;
  return AMBIT_OK;
}

static void set_constants(ambit_block *block) {
  const ambit_tape *t = block->tape;
  for (uint32_t i = 0; i < t->nconst; i++) {
    block->given_empty |= !(t->lo[i] <= t->hi[i]);
    for (size_t lane = 0; lane < block->lanes; lane++)
      ambit_constant_set(block->arithmetic, block->ctx, element(block, i, lane), t, i);
  }
}

ambit_status ambit_block_open(
    const ambit_tape *t, const ambit_arithmetic *full, void *ctx, size_t lanes, ambit_block **block, ambit_failure *f) {
  *block = NULL;
  if (lanes == 0) return ambit_fail(f, AMBIT_INVALID, "a block needs at least one lane");
  size_t elem = full->elem(ctx);
  if (elem == 0 || elem % 8 != 0)
    return ambit_fail(f, AMBIT_INVALID, "the arithmetic's elements have %zu bytes; a multiple of 8 is required", elem);
  ambit_block *made = calloc(1, sizeof *made);
  if (!made) return ambit_no_memory(f);
  *made = (ambit_block) {
    .tape = t, .arithmetic = full, .ctx = ctx, .lanes = lanes, .elem = elem, .metered = ambit_meter_is_on()
  };
  ambit_status status = allocate(made, f);
  if (status != AMBIT_OK) {
    ambit_block_close(made);
    return status;
  }
  set_constants(made);
  *block = made;
  return AMBIT_OK;
}

void ambit_block_close(ambit_block *block) {
  if (!block) return;
  if (block->initialised && block->arithmetic->clear)
    block->arithmetic->clear(block->ctx, block->base, (size_t)block->tape->nslot * block->lanes);
  free(block->base);
  free(block);
}

void ambit_block_set(ambit_block *block, uint32_t in, size_t lane, ambit_interval x, int32_t var) {
  block->given_empty |= !(x.lo <= x.hi);
  block->arithmetic->set(block->ctx, element(block, block->tape->nconst + in, lane), 1, &x.lo, &x.hi, var);
}

static uint32_t run_all(ambit_block *block) {
  const ambit_tape *t = block->tape;
  const ambit_arithmetic *full = block->arithmetic;
  if (full->eval_tape) return full->eval_tape(block->ctx, t, block->base, block->lanes, block->lanes);
  uint32_t flags = 0;
  for (uint32_t i = 0; i < t->nrun; i++) {
    const ambit_run *r = &t->run[i];
    flags |= ambit_arithmetic_run(full, block->ctx, r->op, block->base, block->lanes, block->lanes, r->count,
        t->dst + r->first, t->a + r->first, t->b + r->first);
  }
  return flags;
}

uint32_t ambit_block_run(ambit_block *block) {
  const ambit_arithmetic *full = block->arithmetic;
  if (block->metered) ambit_meter_enter(AMBIT_FRAME_ARITHMETIC, "tape");
  if (full->enter) full->enter(block->ctx);
  uint32_t flags = run_all(block);
  if (full->leave) full->leave(block->ctx);
  if (block->metered) ambit_meter_leave();
  if (flags & AMBIT_F_EMPTY) ambit_empty_check(full, flags, block->given_empty, INFINITY, -INFINITY);
  return block->flags = flags;
}

void ambit_block_run_each(ambit_block *block, uint32_t *flags) {
  const ambit_tape *t = block->tape;
  const ambit_arithmetic *full = block->arithmetic;
  if (full->enter) full->enter(block->ctx);
  for (uint32_t i = 0; i < t->ninstr; i++)
    flags[i] = ambit_arithmetic_run(
        full, block->ctx, t->op[i], block->base, block->lanes, block->lanes, 1, t->dst + i, t->a + i, t->b + i);
  if (full->leave) full->leave(block->ctx);
}

ambit_interval ambit_block_get(const ambit_block *block, uint32_t out, size_t lane) {
  ambit_interval x;
  ambit_bounds_read(block->arithmetic, block->ctx, element(block, block->tape->out[out], lane), 1, &x.lo, &x.hi);
  ambit_empty_check(block->arithmetic, block->flags, block->given_empty, x.lo, x.hi);
  return x;
}

void *ambit_block_base(ambit_block *block, size_t *pitch) {
  *pitch = block->lanes;
  return block->base;
}
