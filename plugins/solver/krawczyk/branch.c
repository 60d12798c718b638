/* branch.c -- what is proved: pieces, each a root that is alone in a region for each value of a part of the parameters.
**
** Two pieces whose parts of the parameters meet are the same root there if the enclosure of one lies in the region of
** the other (where that root is alone), different roots if enclosures are disjoint; if neither can be shown, the later
** piece is undecided. Pieces that are the same where they meet are one branch: a root that moves continuously with the
** parameters. A branch that is proved for all parameters is reported as a root, another one as a root for part of them.
*/
#include "krawczyk.h"
#include <math.h>

#define MERGED 8.0 /* undecided neighbours are joined up to this many tolerances */

enum kinship { UNRELATED, SAME, DISTINCT, UNCLEAR };

int32_t krawczyk_emit(krawczyk *k, ambit_sink *sink, const span *x, uint32_t event) {
  for (uint32_t i = 0; i < k->n; i++) k->in_lo[i] = x[i].lo + 0.0, k->in_hi[i] = x[i].hi + 0.0; /* no -0 */
  const ambit_record r = {
    .size = sizeof r, .kind = AMBIT_REC_ROOT, .nx = k->n, .event = event, .rigorous = 1, .lo = k->in_lo, .hi = k->in_hi
  };
  return sink->emit(sink, &r);
}

/* -- undecided boxes */

int krawczyk_is_known(const krawczyk *k, const span *x) {
  for (uint32_t i = 0; i < k->region.count; i++)
    if (box_is_inside(k->m, x, boxes_at(&k->region, k->m, i))) return 1;
  return 0;
}

void krawczyk_join_undecided(krawczyk *k) {
  boxes *list = &k->undecided;
  for (uint32_t i = 1; i < list->count;) {
    span *x = boxes_at(list, k->m, i), *y = x;
    for (uint32_t j = 0; j < i && y == x; j++)
      if (!box_is_apart(k->n, x, boxes_at(list, k->m, j))) y = boxes_at(list, k->m, j);
    i++;
    if (y == x) continue;
    box_join(k->m, y, x);
    box_copy(k->m, x, boxes_at(list, k->m, --list->count));
    i = 1; /* y has grown */
  }
}

enum why krawczyk_keep_undecided(krawczyk *k, const span *x) {
  for (uint32_t i = 0; i < k->undecided.count; i++) {
    span *other = boxes_at(&k->undecided, k->m, i);
    if (box_is_apart(k->n, x, other)) continue;
    box_copy(k->m, k->left, other);
    box_join(k->m, k->left, x);
    if (!krawczyk_is_small(k, k->left, MERGED) && !box_is_inside(k->n, x, other)) continue;
    box_copy(k->m, other, k->left);
    return WHY_DONE;
  }
  if (k->np && k->undecided.count == k->undecided.room) krawczyk_join_undecided(k);
  return boxes_push(&k->undecided, k->m, x, 0) ? WHY_DONE : WHY_UNDECIDED;
}

/* -- pieces */

static int has_same_part(const krawczyk *k, const span *x, const span *y) {
  return box_is_inside(k->np, x + k->n, y + k->n);
}

/* x where the parts of the parameters meet, its root enclosed anew */
static void restrict_to(krawczyk *k, span *to, const span *x, const span *part) {
  box_copy(k->m, to, x);
  box_meet(k->np, to + k->n, part + k->n);
  if (!has_same_part(k, x, to)) krawczyk_refine(k, to);
}

/* of the root x, alone in `around`, and piece i */
static enum kinship relate(krawczyk *k, uint32_t i, const span *x, const span *around) {
  const span *old = boxes_at(&k->proved, k->m, i), *region = boxes_at(&k->region, k->m, i);
  if (box_is_apart(k->np, x + k->n, old + k->n)) return UNRELATED;
  if (box_is_inside(k->n, x, region) || box_is_inside(k->n, old, around)) return SAME;
  if (box_is_apart(k->n, x, old)) return DISTINCT;
  if (!k->np) return UNCLEAR;
  restrict_to(k, k->common, x, old);
  restrict_to(k, k->enclosure, old, x);
  if (box_is_inside(k->n, k->common, region) || box_is_inside(k->n, k->enclosure, around)) return SAME;
  return box_is_apart(k->n, k->common, k->enclosure) ? DISTINCT : UNCLEAR;
}

/* kin[i] for every piece; what all of them say: SAME: an old piece says as much already, DISTINCT: new, UNCLEAR */
static enum kinship compare(krawczyk *k, const span *x, const span *around) {
  enum kinship all = DISTINCT;
  for (uint32_t i = 0; i < k->proved.count; i++) {
    enum kinship kin = relate(k, i, x, around);
    k->kin[i] = (uint8_t)kin;
    if (kin == SAME && has_same_part(k, x, boxes_at(&k->proved, k->m, i))) return SAME;
    if (kin == UNCLEAR) all = UNCLEAR;
  }
  return all;
}

/* the further equations at a proved root: 0: one of them does not hold for any value of the parameters */
static int passes(krawczyk *k, span *x) {
  box_copy(k->m, k->left, x);
  return krawczyk_contract(k, k->left);
}

static int is_implied(const krawczyk *k) { return k->problem.implied != 0; }

static void add_piece(krawczyk *k, const span *x, const span *around) {
  uint32_t piece = k->proved.count;
  boxes_push(&k->proved, k->m, x, 0);
  boxes_push(&k->region, k->m, around, 0);
  k->branch[piece] = piece;
  k->emitted[piece] = 0;
  for (uint32_t i = 0; i < piece; i++)
    if (k->kin[i] == SAME) k->branch[krawczyk_root_of(k, i)] = piece;
}

enum why krawczyk_keep_root(krawczyk *k, ambit_sink *sink, span *x, const span *around) {
  if (box_is_apart(k->n, x, k->searched) || !passes(k, x)) return WHY_DONE;
  enum kinship kin = compare(k, x, around);
  if (kin == SAME) return WHY_DONE;
  if (k->np) {
    krawczyk_tighten(k, x);
    if (box_is_apart(k->n, x, k->searched)) return WHY_DONE;
    kin = compare(k, x, around);
    if (kin == SAME) return WHY_DONE;
  }
  if (kin == UNCLEAR || (k->further && !is_implied(k))) return krawczyk_keep_undecided(k, x);
  if (k->proved.count == k->proved.room) return WHY_ROOTS;
  add_piece(k, x, around);
  if (!has_same_part(k, k->searched, x)) return WHY_DONE;
  k->emitted[k->proved.count - 1] = 1;
  return krawczyk_emit(k, sink, x, AMBIT_ROOT_UNIQUE) ? WHY_STOPPED : WHY_DONE;
}

/* -- branches */

/* has the branch one root only, wherever its pieces meet? */
static int is_single(krawczyk *k, uint32_t root) {
  for (uint32_t i = 0; i < k->proved.count; i++) {
    if (krawczyk_root_of(k, i) != root) continue;
    for (uint32_t j = 0; j < i; j++)
      if (krawczyk_root_of(k, j) == root &&
          relate(k, j, boxes_at(&k->proved, k->m, i), boxes_at(&k->region, k->m, i)) > SAME)
        return 0;
  }
  return 1;
}

static int is_emitted(const krawczyk *k, uint32_t root) {
  for (uint32_t i = 0; i < k->proved.count; i++)
    if (k->emitted[i] && krawczyk_root_of(k, i) == root) return 1;
  return 0;
}

/* `left` := the hull of the branch; its pieces, if each is to be emitted */
static int32_t emit_pieces(krawczyk *k, ambit_sink *sink, uint32_t root, int each) {
  int first = 1;
  for (uint32_t i = 0; i < k->proved.count; i++) {
    const span *x = boxes_at(&k->proved, k->m, i);
    if (krawczyk_root_of(k, i) != root) continue;
    if (each && krawczyk_emit(k, sink, x, AMBIT_ROOT_PARTLY)) return 1;
    if (first)
      box_copy(k->m, k->left, x);
    else
      box_join(k->m, k->left, x);
    first = 0;
  }
  return 0;
}

int32_t krawczyk_emit_branches(krawczyk *k, ambit_sink *sink) {
  for (uint32_t root = 0; root < k->proved.count; root++) {
    if (krawczyk_root_of(k, root) != root || is_emitted(k, root)) continue;
    int single = is_single(k, root);
    if (emit_pieces(k, sink, root, !single)) return 1;
    uint32_t event = single && krawczyk_covers(k, root) ? AMBIT_ROOT_UNIQUE : AMBIT_ROOT_PARTLY;
    if (single && krawczyk_emit(k, sink, k->left, event)) return 1;
  }
  return 0;
}
