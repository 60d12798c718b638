/* verify_subject.h -- what verify.c judges: the kernel's interval functions, or an arithmetic plugin by its name. */
#ifndef NUM_VERIFY_SUBJECT_H
#define NUM_VERIFY_SUBJECT_H
#include "kit/arithmetic_loader.h"
#include "num/interval.h"

#define VERIFY_LANES 64

typedef struct verify_subject { /* one for each thread */
  const char *plugin;           /* NULL: the kernel */
  arithmetic_loader loaded;
  void *block; /* three slots: r, a, b */
} verify_subject;

/* The context again, for two independent variables, so that an arithmetic with symbols works with them. */
static inline ambit_status verify_reopen(arithmetic_loader *l) {
  if (!l->full.open) return AMBIT_OK;
  if (l->full.close) l->full.close(l->ctx);
  l->ctx = NULL;
  return l->full.open(&l->scope->host, l->option, 2, &l->ctx);
}

/* NULL, or what went wrong */
static inline const char *verify_open(verify_subject *v, const char *plugin) {
  *v = (verify_subject) { .plugin = plugin };
  if (!plugin) return NULL;
  const char *trouble = arithmetic_load(&v->loaded, plugin);
  if (trouble) return trouble;
  const ambit_arithmetic *full = &v->loaded.full;
  if (!full->rigorous) return "it promises no enclosures";
  if (verify_reopen(&v->loaded) != AMBIT_OK) return v->loaded.scope->failure.message;
  size_t bytes = (3 * VERIFY_LANES * full->elem(v->loaded.ctx) + 63) / 64 * 64;
  v->block = aligned_alloc(64, bytes);
  if (!v->block) return "out of memory";
  memset(v->block, 0, bytes);
  if (full->init && full->init(v->loaded.ctx, v->block, 3 * VERIFY_LANES) != AMBIT_OK) return "init failed";
  return NULL;
}

static inline void verify_close(verify_subject *v) {
  if (!v->plugin) return;
  const ambit_arithmetic *full = &v->loaded.full;
  if (v->block && full->clear) full->clear(v->loaded.ctx, v->block, 3 * VERIFY_LANES);
  free(v->block);
  arithmetic_unload(&v->loaded);
}

static inline char *verify_slot(verify_subject *v, size_t slot) {
  return (char *)v->block + slot * VERIFY_LANES * v->loaded.full.elem(v->loaded.ctx);
}
static inline void verify_put(verify_subject *v, size_t slot, const ambit_interval *x, int32_t variable) {
  double lo[VERIFY_LANES], hi[VERIFY_LANES];
  for (int i = 0; i < VERIFY_LANES; i++) lo[i] = x[i].lo, hi[i] = x[i].hi;
  v->loaded.full.set(v->loaded.ctx, verify_slot(v, slot), VERIFY_LANES, lo, hi, variable);
}

/* r[i] := op(a[i], b[i]), i < VERIFY_LANES */
static inline void verify_run(verify_subject *v, uint32_t op, ambit_interval *r, const ambit_interval *a,
    const ambit_interval *b, int32_t exponent) {
  if (!v->plugin) {
    ambit_interval_map(op, VERIFY_LANES, r, a, b, exponent);
    return;
  }
  const ambit_arithmetic *full = &v->loaded.full;
  const uint32_t dst = 0, first = 1, second = op == AMBIT_OP_POWN ? (uint32_t)exponent : 2;
  double lo[VERIFY_LANES], hi[VERIFY_LANES];
  verify_put(v, 1, a, 0), verify_put(v, 2, b, 1);
  if (full->enter) full->enter(v->loaded.ctx);
  full->run[op](full, v->loaded.ctx, v->block, VERIFY_LANES, VERIFY_LANES, 1, &dst, &first, &second);
  if (full->leave) full->leave(v->loaded.ctx);
  full->bounds(v->loaded.ctx, verify_slot(v, 0), VERIFY_LANES, lo, hi);
  for (int i = 0; i < VERIFY_LANES; i++) r[i] = (ambit_interval) { lo[i], hi[i] };
}
#endif
