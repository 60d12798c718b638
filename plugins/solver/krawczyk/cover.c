/* cover.c -- is the box of the parameters the union of the parts for which a branch is proved?
**
** A box is covered if it lies in one part, or if both halves are covered into which the face of a part cuts it.
*/
#include "krawczyk.h"

uint32_t krawczyk_root_of(const krawczyk *k, uint32_t piece) {
  while (k->branch[piece] != piece) piece = k->branch[piece];
  return piece;
}

static int meets_inside(const krawczyk *k, const span *a, const span *b) {
  for (uint32_t i = k->n; i < k->m; i++)
    if (!(a[i].lo < b[i].hi && b[i].lo < a[i].hi)) return 0;
  return 1;
}

/* a face of x that cuts q: its component and place; m: none does */
static uint32_t find_face(const krawczyk *k, const span *q, const span *x, double *at) {
  for (uint32_t i = k->n; i < k->m; i++)
    for (int end = 0; end < 2; end++) {
      *at = end ? x[i].hi : x[i].lo;
      if (*at > q[i].lo && *at < q[i].hi) return i;
    }
  return k->m;
}

/* the box on top of the stack k->cover; leaves the stack as it was */
static int covers(krawczyk *k, uint32_t root) {
  uint32_t top = k->cover.count - 1;
  span *q = boxes_at(&k->cover, k->m, top);
  for (uint32_t i = 0; i < k->proved.count; i++) {
    const span *x = boxes_at(&k->proved, k->m, i);
    if (krawczyk_root_of(k, i) != root || !meets_inside(k, q, x)) continue;
    double at;
    uint32_t face = find_face(k, q, x, &at);
    if (face == k->m) return 1;
    if (!boxes_push(&k->cover, k->m, q, 0)) return 0; /* deeper than any cut */
    span *half = boxes_at(&k->cover, k->m, top + 1);
    half[face].hi = at;
    int good = covers(k, root);
    box_copy(k->m, half, q);
    half[face].lo = at;
    good = good && covers(k, root);
    k->cover.count = top + 1;
    return good;
  }
  return 0;
}

int krawczyk_covers(krawczyk *k, uint32_t root) {
  k->cover.count = 0;
  boxes_push(&k->cover, k->m, k->searched, 0);
  return covers(k, root);
}
