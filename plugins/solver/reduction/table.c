/* table.c -- a tape at several nodes of a reference at once: one lane for each. */
#include "reduce.h"
#include <math.h>

static void *slot_at(const table *t, uint32_t slot) { return (char *)t->base + (size_t)slot * t->width * t->elem; }

static void set_constants(table *t) {
  for (uint32_t i = 0; i < t->tape->nconst; i++)
    for (uint32_t l = 0; l < t->width; l++)
      ambit_constant_set(t->arithmetic, t->ctx, (char *)slot_at(t, i) + l * t->elem, t->tape, i);
}

ambit_status table_open(table *t, reducer *s, const ambit_tape *tape, uint32_t width) {
  const ambit_arithmetic *a = s->r.arithmetic;
  if (!tape) return AMBIT_OK;
  *t = (table) { .arithmetic = a, .ctx = s->r.actx, .elem = a->elem(s->r.actx), .width = width };
  size_t n = (size_t)tape->nslot * width;
  t->base = reduce_room(s, n, t->elem);
  t->lo = reduce_room(s, width, sizeof *t->lo);
  t->hi = reduce_room(s, width, sizeof *t->hi);
  t->value = reduce_room(s, (size_t)tape->nout * width, sizeof *t->value);
  if (!t->base || !t->lo || !t->hi || !t->value) return AMBIT_NOMEM;
  if (a->init && a->init(t->ctx, t->base, n) != AMBIT_OK) return AMBIT_NOMEM;
  t->tape = tape;
  t->counted = ambit_work_open(s->host);
  set_constants(t);
  return AMBIT_OK;
}

void table_close(table *t) {
  if (t->tape && t->arithmetic->clear) t->arithmetic->clear(t->ctx, t->base, (size_t)t->tape->nslot * t->width);
}

static void set_inputs(table *t, const double *in, uint32_t count) {
  for (uint32_t i = 0; i < t->tape->nin; i++) {
    for (uint32_t l = 0; l < count; l++) t->lo[l] = in[(size_t)l * t->tape->nin + i];
    t->arithmetic->set(t->ctx, slot_at(t, t->tape->nconst + i), count, t->lo, t->lo, -1);
  }
}

static void get_outputs(table *t, uint32_t count) {
  for (uint32_t o = 0; o < t->tape->nout; o++) {
    ambit_bounds_read(t->arithmetic, t->ctx, slot_at(t, t->tape->out[o]), count, t->lo, t->hi);
    for (uint32_t l = 0; l < count; l++) {
      double lo = t->lo[l], hi = t->hi[l];
      t->value[(size_t)l * t->tape->nout + o] = !(lo <= hi) ? NAN : lo == hi ? lo : 0.5 * lo + 0.5 * hi;
    }
  }
}

void table_load(table *t, const double *in, uint32_t count) {
  const ambit_tape *tape = t->tape;
  const ambit_arithmetic *a = t->arithmetic;
  set_inputs(t, in, count);
  ambit_work_evaluate(t->counted, tape->ninstr, count);
  if (a->enter) a->enter(t->ctx);
  for (uint32_t i = 0; i < tape->nrun; i++) {
    const ambit_run *run = &tape->run[i];
    ambit_arithmetic_run(a, t->ctx, run->op, t->base, t->width, count, run->count, tape->dst + run->first,
        tape->a + run->first, tape->b + run->first);
  }
  if (a->leave) a->leave(t->ctx);
  get_outputs(t, count);
}
