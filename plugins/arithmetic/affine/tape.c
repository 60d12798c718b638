/* tape.c -- a whole tape: symbols only where they can pay, and room for new ones when they run out.
**
** A result that is an operand once passes all it carries to that one result, so its own error needs no symbol. Only
** slots that are used more than once get one. When all symbols are taken, those that no live slot carries any more are
** free again, and the least important others are merged (condense.c).
*/
#include "affine.h"
#include <stdlib.h>
#include <string.h>

/* merging costs about as much as an operation on each live slot; so it waits for this part of their number in
** instructions since the last time */
#define PATIENCE 4

/* room for a tape, kept for the next one */
static int make_room(affine_plan *p, uint32_t nslot) {
  if (nslot <= p->room) return 1;
  affine_close_plan(p);
  p->uses = malloc(nslot * sizeof *p->uses);
  p->last = malloc(nslot * sizeof *p->last);
  p->live = malloc(nslot * sizeof *p->live);
  if (p->uses && p->last && p->live) p->room = nslot;
  return p->room != 0;
}

void affine_close_plan(affine_plan *p) {
  free(p->uses), free(p->last), free(p->live);
  *p = (affine_plan) { 0 };
}

static void use(affine_plan *p, uint32_t slot, uint32_t when) {
  if (p->uses[slot] < 2) p->uses[slot]++;
  p->last[slot] = when;
}

static int is_binary(uint32_t op) { return ambit_op_arity(op) == 2; }

static void make_plan(affine_plan *p, const ambit_tape *t) {
  memset(p->uses, 0, t->nslot * sizeof *p->uses);
  memset(p->last, 0, t->nslot * sizeof *p->last);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    use(p, t->a[i], i);
    if (is_binary(t->op[i])) use(p, t->b[i], i);
  }
  for (uint32_t i = 0; i < t->nout; i++) use(p, t->out[i], t->ninstr);
}

static int carries_symbols(const affine_context *c, const affine_element *x) {
  return x->blocks > c->vblocks && x->epoch == c->epoch;
}

/* all symbols are free unless some given slot has one of this epoch */
static void begin(affine_context *c, const ambit_tape *t, void *base, size_t pitch, size_t lanes) {
  for (uint32_t s = 0; s < t->nconst + t->nin; s++)
    for (size_t l = 0; l < lanes; l++)
      if (carries_symbols(c, affine_at(c, base, s * pitch + l))) return;
  c->epoch++, c->next = 0;
}

/* the slots written so far that instruction `first` or a later one uses */
static uint32_t list_live(affine_plan *p, const ambit_tape *t, uint32_t first) {
  uint32_t n = 0;
  for (uint32_t s = 0; s < t->nconst + t->nin + first; s++)
    if (p->uses[s] && p->last[s] >= first) p->live[n++] = s;
  return n;
}

static uint32_t wanted(const affine_plan *p, const ambit_tape *t, const ambit_run *run) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < run->count; i++) n += p->uses[t->dst[run->first + i]] > 1;
  return n;
}

/* Makes room for the symbols of a run; *since: instructions since the last time. */
static void prepare(affine_context *c, const ambit_tape *t, const ambit_run *run, void *base, size_t pitch,
    size_t lanes, uint32_t *since) {
  uint32_t want = wanted(&c->plan, t, run), half = c->symbols / 2;
  if (want > half) want = half;
  if (want == 0 || want <= c->symbols - c->next) return;
  uint32_t n = list_live(&c->plan, t, run->first);
  if (*since < n / PATIENCE) return;
  uint32_t spare = want > c->symbols / 4 ? want : c->symbols / 4;
  affine_condense(c, base, pitch, lanes, n, c->symbols - spare);
  *since = 0;
}

uint32_t affine_eval_tape(void *ctx, const ambit_tape *t, void *base, size_t pitch, size_t lanes) {
  affine_context *c = ctx;
  uint32_t flags = 0, since = UINT32_MAX / 2;
  int planned = make_room(&c->plan, t->nslot);
  begin(c, t, base, pitch, lanes);
  if (planned) make_plan(&c->plan, t);
  c->planned = planned;
  for (uint32_t i = 0; i < t->nrun; i++) {
    const ambit_run *run = &t->run[i];
    if (planned) prepare(c, t, run, base, pitch, lanes, &since);
    if (c->meter) c->meter->operation(run->op);
    const uint32_t *dst = t->dst + run->first, *a = t->a + run->first, *b = t->b + run->first;
    flags |= ambit_op_is_function(run->op)
                 ? affine_run_function(NULL, c, run->op, base, pitch, lanes, run->count, dst, a, b)
                 : c->run[run->op](NULL, c, base, pitch, lanes, run->count, dst, a, b);
    since += run->count;
  }
  c->planned = 0;
  return flags;
}
