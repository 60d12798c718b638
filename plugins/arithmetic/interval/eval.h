/* eval.h -- a whole tape in one call: flags are collected over all runs before they are looked at, and no run costs a
** call. Elementary functions leave upward mode, and restore it.
*/
INLINE uint32_t serve_run(void *ctx, const ambit_tape *t, const ambit_run *r, place at) {
  const uint32_t *dst = t->dst + r->first, *a = t->a + r->first, *b = t->b + r->first;
  switch (r->op) {
#define CASE(OP, outside, other)                                                                                       \
  case AMBIT_OP_##OP: return run_##OP(NULL, ctx, at.slots, at.pitch / 2, at.lanes, r->count, dst, a, b);
    ELEMENTARY_OPERATIONS(CASE)
#undef CASE
  case AMBIT_OP_POWN: return run_POWN(NULL, ctx, at.slots, at.pitch / 2, at.lanes, r->count, dst, a, b);
  default: return run_function(NULL, ctx, r->op, at.slots, at.pitch / 2, at.lanes, r->count, dst, a, b);
  }
}

static AMBIT_WORKER uint32_t eval_tape(void *ctx, const ambit_tape *t, void *base, size_t pitch, size_t lanes) {
  const ambit_meter_service *meter = ((interval_context *)ctx)->meter;
  place at = { base, 2 * pitch, lanes };
  findings f = { 0 };
  uint32_t flags = 0;
  for (const ambit_run *r = t->run; r < t->run + t->nrun; r++) {
    const uint32_t *dst = t->dst + r->first, *a = t->a + r->first, *b = t->b + r->first;
    if (meter) meter->operation(r->op);
    switch (r->op) {
#define CASE(OP, work, other)                                                                                          \
  case AMBIT_OP_##OP: run(&f, at, r->count, dst, a, other, work); break;
      BASIC_OPERATIONS(CASE)
#undef CASE
    default: flags |= serve_run(ctx, t, r, at);
    }
  }
  return flags | flags_of(&f);
}
