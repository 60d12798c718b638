/* search.c -- branch and prune: every box of the searched one is emptied, proved to hold one root, or cut in two.
**
** Nothing is lost: a box leaves the stack only if it has no root, if all its roots are that of a proved box, or as
** undecided. Two proved boxes are the same root if one lies where the other is alone, different roots if they are
** disjoint; else the later one is undecided.
*/
#include "krawczyk.h"
#include <math.h>

#define MERGED 8.0 /* undecided neighbours are joined up to this many tolerances */

enum why { WHY_DONE, WHY_STOPPED, WHY_BOXES, WHY_UNDECIDED, WHY_ROOTS };

/* -- records */

static int32_t emit(krawczyk *k, ambit_sink *sink, const span *x, uint32_t event) {
  for (uint32_t i = 0; i < k->n; i++) k->in_lo[i] = x[i].lo + 0.0, k->in_hi[i] = x[i].hi + 0.0; /* no -0 */
  const ambit_record r = {
    .size = sizeof r, .kind = AMBIT_REC_ROOT, .nx = k->n, .event = event, .rigorous = 1, .lo = k->in_lo, .hi = k->in_hi
  };
  return sink->emit(sink, &r);
}

static int32_t emit_effort(const krawczyk *k, ambit_sink *sink) {
  const ambit_record r = { .size = sizeof r, .kind = AMBIT_REC_SEARCHED, .rigorous = 1, .ncoef = k->examined };
  return sink->emit(sink, &r);
}

static int32_t show_progress(const krawczyk *k, ambit_sink *sink) {
  return sink->progress ? sink->progress(sink, fmin(k->done, 1), NULL) : 0;
}

/* -- undecided boxes */

static int is_known(const krawczyk *k, const span *x) {
  for (uint32_t i = 0; i < k->region.count; i++)
    if (box_is_inside(k->n, x, boxes_at(&k->region, k->n, i))) return 1;
  return 0;
}

static int is_small(const krawczyk *k, const span *x, double times) {
  for (uint32_t i = 0; i < k->n; i++)
    if (!(box_extent(x[i]) <= times * k->options.tolerance)) return 0;
  return 1;
}

/* 0: no room */
static int keep_undecided(krawczyk *k, const span *x) {
  for (uint32_t i = 0; i < k->undecided.count; i++) {
    span *other = boxes_at(&k->undecided, k->n, i);
    if (box_is_apart(k->n, x, other)) continue;
    box_copy(k->n, k->left, other);
    box_join(k->n, k->left, x);
    if (!is_small(k, k->left, MERGED)) continue;
    box_copy(k->n, other, k->left);
    return 1;
  }
  return boxes_push(&k->undecided, k->n, x, 0);
}

/* -- proved boxes */

enum kinship { NEW, SAME, UNCLEAR };

static enum kinship compare(const krawczyk *k, const span *x, const span *around) {
  for (uint32_t i = 0; i < k->proved.count; i++) {
    const span *old = boxes_at(&k->proved, k->n, i), *region = boxes_at(&k->region, k->n, i);
    if (box_is_inside(k->n, x, region) || box_is_inside(k->n, old, around)) return SAME;
    if (!box_is_apart(k->n, x, old)) return UNCLEAR;
  }
  return NEW;
}

/* the further equations at a proved root: 0: one of them does not hold for any value of the parameters */
static int passes(krawczyk *k, span *x) {
  box_copy(k->n, k->left, x);
  return krawczyk_contract(k, k->left);
}

static enum why keep_root(krawczyk *k, ambit_sink *sink, span *x, const span *around) {
  if (box_is_apart(k->n, x, k->searched) || !passes(k, x)) return WHY_DONE;
  enum kinship kin = compare(k, x, around);
  if (kin == SAME) return WHY_DONE;
  if (kin == UNCLEAR || k->further) return keep_undecided(k, x) ? WHY_DONE : WHY_UNDECIDED;
  if (!boxes_push(&k->proved, k->n, x, 0)) return WHY_ROOTS;
  boxes_push(&k->region, k->n, around, 0);
  return emit(k, sink, x, AMBIT_ROOT_UNIQUE) ? WHY_STOPPED : WHY_DONE;
}

/* -- the search */

static uint32_t choose_cut(const krawczyk *k, const span *x) {
  uint32_t widest = 0;
  for (uint32_t i = 1; i < k->n; i++)
    if (box_extent(x[i]) > box_extent(x[widest])) widest = i;
  return widest;
}

/* both parts onto the stack; 0: there is no double between the ends, or no room */
static int cut(krawczyk *k, const span *x, double share) {
  uint32_t i = choose_cut(k, x);
  double at = box_point(x[i]);
  if (!(at > x[i].lo && at < x[i].hi) || k->stack.count + 2 > k->stack.room) return 0;
  for (int part = 0; part < 2; part++) {
    boxes_push(&k->stack, k->n, x, 0.5 * share);
    span *top = boxes_at(&k->stack, k->n, k->stack.count - 1);
    *(part ? &top[i].hi : &top[i].lo) = at;
  }
  return 1;
}

static enum why examine(krawczyk *k, ambit_sink *sink, double share) {
  span *x = k->box;
  k->examined++;
  if (krawczyk_contract(k, x) && !is_known(k, x)) {
    int proved = krawczyk_prove(k, x, k->around);
    if (proved > 0) {
      enum why why = keep_root(k, sink, x, k->around);
      if (why != WHY_DONE) return why;
    } else if (proved < 0) {
      if (!is_small(k, x, 1) && cut(k, x, share)) return WHY_DONE;
      if (!keep_undecided(k, x)) return WHY_UNDECIDED;
    }
  }
  k->done += share;
  return WHY_DONE;
}

static enum why search(krawczyk *k, ambit_sink *sink) {
  boxes_push(&k->stack, k->n, k->searched, 1);
  while (k->stack.count) {
    if (k->examined == k->options.boxes_max) return WHY_BOXES;
    double share = k->stack.share[--k->stack.count];
    box_copy(k->n, k->box, boxes_at(&k->stack, k->n, k->stack.count));
    enum why why = examine(k, sink, share);
    if (why != WHY_DONE) {
      if (why != WHY_STOPPED) boxes_push(&k->stack, k->n, k->box, share); /* there is room: it came from there */
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
  for (int l = 0; l < 2; l++)
    for (uint32_t i = 0; i < list[l]->count; i++) {
      const span *x = boxes_at(list[l], k->n, i);
      if (is_known(k, x)) continue;
      count++;
      if (emit(k, sink, x, AMBIT_ROOT_UNDECIDED)) return UINT32_MAX;
    }
  return count;
}

static int has_unbounded(const krawczyk *k) {
  for (uint32_t i = 0; i < k->undecided.count; i++)
    if (!box_is_bounded(k->n, boxes_at(&k->undecided, k->n, i))) return 1;
  return 0;
}

static ambit_status explain(const krawczyk *k, enum why why, uint32_t undecided) {
  const ambit_host *h = k->host;
  const char *s = undecided == 1 ? "" : "es";
  switch (why) {
  case WHY_BOXES:
    return h->fail(h, AMBIT_UNABLE,
        "%u box%s left undecided after `boxes_max` = %u: raise it, search a smaller box, or narrow the data", undecided,
        undecided == 1 ? " is" : "es are", k->options.boxes_max);
  case WHY_UNDECIDED:
    return h->fail(h, AMBIT_UNABLE,
        "more than `undecided_max` = %u boxes could be neither proved nor excluded: the roots are not isolated, or the "
        "data too uncertain; narrow the data, or raise `tolerance` or `undecided_max`",
        k->options.undecided_max);
  case WHY_ROOTS:
    return h->fail(h, AMBIT_UNABLE, "there are more than `roots_max` = %u roots: raise it, or search a smaller box",
        k->options.roots_max);
  default:
    if (k->further)
      return h->fail(h, AMBIT_UNABLE,
          "%u box%s cannot be told: there are more equations than unknowns, and that those left over hold exactly "
          "where the others do cannot be proved by enclosures",
          undecided, s);
    if (has_unbounded(k))
      return h->fail(h, AMBIT_UNABLE,
          "%u box%s could be neither proved nor excluded, and cut no further: they reach out to infinity, beyond the "
          "largest double; search a bounded box",
          undecided, s);
    return h->fail(h, AMBIT_UNABLE,
        "%u box%s of at most `tolerance` = %g could be neither proved nor excluded: a multiple root, a singular "
        "Jacobian, an edge of f's domain, or data too uncertain; lower `tolerance` or narrow the data",
        undecided, s, k->options.tolerance);
  }
}

static void reset(krawczyk *k) {
  k->stack.count = k->proved.count = k->region.count = k->undecided.count = k->examined = 0;
  k->done = 0;
}

ambit_status krawczyk_run(void *self, ambit_sink *sink) {
  krawczyk *k = self;
  reset(k);
  enum why why = search(k, sink);
  if (why == WHY_STOPPED) return AMBIT_STOPPED;
  uint32_t undecided = emit_undecided(k, sink);
  if (undecided == UINT32_MAX || emit_effort(k, sink)) return AMBIT_STOPPED;
  return undecided ? explain(k, why, undecided) : AMBIT_OK;
}
