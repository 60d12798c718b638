/* search.c -- branch and prune: every box of the searched one is emptied, proved to hold one root, or cut in two.
**
** Nothing is lost: a box leaves the stack only if it has no root, if all its roots are that of a proved piece, or as
** undecided. Boxes are cut in the unknowns and, where those alone do not help, in the parameters (cut.c).
*/
#include "krawczyk.h"
#include <math.h>

static int32_t emit_effort(const krawczyk *k, ambit_sink *sink) {
  const ambit_record r = { .size = sizeof r, .kind = AMBIT_REC_SEARCHED, .rigorous = 1, .ncoef = k->examined };
  return sink->emit(sink, &r);
}

static int32_t show_progress(const krawczyk *k, ambit_sink *sink) {
  return sink->progress ? sink->progress(sink, fmin(k->done, 1), NULL) : 0;
}

static enum why examine(krawczyk *k, ambit_sink *sink, double share) {
  span *x = k->box;
  enum why why = WHY_DONE;
  k->examined++;
  ambit_work_try(k->counted);
  if (krawczyk_contract(k, x) && !krawczyk_is_known(k, x)) {
    int proved = krawczyk_prove(k, x, k->around);
    if (proved > 0) why = krawczyk_keep_root(k, sink, x, k->around);
    if (proved < 0) {
      if (krawczyk_cut(k, x, share)) return WHY_DONE;
      why = krawczyk_keep_undecided(k, x);
    }
  }
  if (why == WHY_DONE) k->done += share;
  return why;
}

static enum why search(krawczyk *k, ambit_sink *sink) {
  boxes_push(&k->stack, k->m, k->searched, 1);
  while (k->stack.count) {
    if (k->examined == k->options.boxes_max) return WHY_BOXES;
    double share = k->stack.share[--k->stack.count];
    box_copy(k->m, k->box, boxes_at(&k->stack, k->m, k->stack.count));
    enum why why = examine(k, sink, share);
    if (why != WHY_DONE) {
      if (why != WHY_STOPPED) boxes_push(&k->stack, k->m, k->box, share); /* there is room: it came from there */
      return why;
    }
    if (show_progress(k, sink)) return WHY_STOPPED;
  }
  return WHY_DONE;
}

/* the undecided boxes, and those that were not reached; how many, or UINT32_MAX: stopped */
static uint32_t emit_undecided(krawczyk *k, ambit_sink *sink) {
  const boxes *const list[] = { &k->undecided, &k->stack };
  uint32_t count = 0;
  if (k->np) krawczyk_join_undecided(k);
  for (int l = 0; l < 2; l++)
    for (uint32_t i = 0; i < list[l]->count; i++) {
      const span *x = boxes_at(list[l], k->m, i);
      if (krawczyk_is_known(k, x)) continue;
      count++;
      if (krawczyk_emit(k, sink, x, AMBIT_ROOT_UNDECIDED)) return UINT32_MAX;
    }
  return count;
}

static void reset(krawczyk *k) {
  k->stack.count = k->proved.count = k->region.count = k->undecided.count = k->examined = 0;
  k->done = 0;
}

ambit_status krawczyk_run(void *self, ambit_sink *sink) {
  krawczyk *k = self;
  reset(k);
  enum why why = search(k, sink);
  if (why == WHY_STOPPED || krawczyk_emit_branches(k, sink)) return AMBIT_STOPPED;
  uint32_t undecided = emit_undecided(k, sink);
  if (undecided == UINT32_MAX || emit_effort(k, sink)) return AMBIT_STOPPED;
  return undecided ? krawczyk_explain(k, why, undecided) : AMBIT_OK;
}
