/* cut.c -- where an undecided box is cut.
**
** In a gap that the operator saw; else across the component that contributes most to the equations' spread: the sum
** over rows of |J_ij| w_j, relative to that of the whole row (Trombettoni & al. 2011, "smear sum relative"), the width
** of f(m, P) being what the parameters contribute. A box that is so small that the parameters alone spread the
** equations is not worth cutting, unless the parameters' ranges are.
*/
#include "krawczyk.h"
#include <math.h>
#include <string.h>

#define GAP 0.1        /* of the width: smaller gaps come at the price of lopsided parts */
#define WEIGHT_P 0.5   /* an unknown is cut rather than a parameter */
#define DROWNED 0.05   /* an unknown's share of every row below which the parameters drown it */
#define AUTOMATIC 1024 /* pieces of the parameters' ranges for the sake of a proof */

int krawczyk_is_small(const krawczyk *k, const span *x, double times) {
  for (uint32_t i = 0; i < k->n; i++)
    if (!(box_extent(x[i]) <= times * k->options.tolerance)) return 0;
  return 1;
}

static double width(span x) { return x.hi - x.lo; }

static double size_of(const double *lo, const double *hi, size_t at) { return fmax(-lo[at], hi[at]); }

double krawczyk_count_parts(const krawczyk *k, const span *x) {
  double parts = 1;
  for (uint32_t i = k->n; i < k->m; i++)
    if (width(x[i]) > 0) parts *= width(k->searched[i]) / width(x[i]);
  return parts;
}

/* may the parameters' part be cut once more? */
static int has_pieces(const krawczyk *k, const span *x) {
  return 1.9 * krawczyk_count_parts(k, x) <= (k->options.pieces ? k->options.pieces : AUTOMATIC);
}

/* the parameter of which this is the largest part */
static uint32_t find_coarsest(const krawczyk *k, const span *x) {
  uint32_t best = k->m;
  double most = 0;
  for (uint32_t i = k->n; i < k->m; i++) {
    double whole = width(k->searched[i]), part = whole > 0 ? width(x[i]) / whole : 0;
    if (part > most) most = part, best = i;
  }
  return best;
}

/* what the parameters contribute to row i: each its slope's share of the blur, or all of it the coarsest */
static void weigh_parameters(const krawczyk *k, const span *x, uint32_t i, double sum) {
  double all = 0;
  for (uint32_t j = 0; j < k->np && k->has_S; j++)
    all += size_of(k->S.lo, k->S.hi, (size_t)i * k->np + j) * width(x[k->n + j]);
  double blur = WEIGHT_P * k->blur[i] / sum;
  uint32_t coarsest = find_coarsest(k, x);
  if (!(all > 0) && coarsest < k->m) k->weight[coarsest] += blur;
  for (uint32_t j = 0; j < k->np && all > 0; j++)
    k->weight[k->n + j] += blur * size_of(k->S.lo, k->S.hi, (size_t)i * k->np + j) * width(x[k->n + j]) / all;
}

/* weight[m] := share of each component in the rows' spread; *largest: of an unknown in one row. 0: no slopes were
** seen */
static int weigh(const krawczyk *k, const span *x, int with_p, double *largest) {
  uint32_t n = k->n;
  memset(k->weight, 0, k->m * sizeof *k->weight);
  *largest = 0;
  if (!k->has_J) return 0;
  for (uint32_t i = 0; i < n; i++) {
    double sum = k->blur[i];
    for (uint32_t j = 0; j < n; j++) sum += size_of(k->J.lo, k->J.hi, (size_t)i * n + j) * width(x[j]);
    if (!(sum > 0 && sum < INFINITY)) continue;
    for (uint32_t j = 0; j < n; j++) {
      double share = size_of(k->J.lo, k->J.hi, (size_t)i * n + j) * width(x[j]) / sum;
      k->weight[j] += share;
      *largest = fmax(*largest, share);
    }
    if (with_p) weigh_parameters(k, x, i, sum);
  }
  return 1;
}

static uint32_t find_heaviest(const krawczyk *k, const span *x) {
  uint32_t best = k->m;
  for (uint32_t i = 0; i < k->m; i++) {
    if (i < k->n && !(box_extent(x[i]) > k->options.tolerance)) continue;
    if (k->weight[i] > 0 && (best == k->m || k->weight[i] > k->weight[best])) best = i;
  }
  return best;
}

static uint32_t find_widest(const krawczyk *k, const span *x) {
  uint32_t best = 0;
  for (uint32_t i = 1; i < k->n; i++)
    if (box_extent(x[i]) > box_extent(x[best])) best = i;
  return best;
}

/* m: the box is not worth a cut */
static uint32_t choose(const krawczyk *k, const span *x) {
  int small = krawczyk_is_small(k, x, 1), pieces = k->np && has_pieces(k, x);
  double largest;
  if (small) return pieces ? find_coarsest(k, x) : k->m;
  if (!box_is_bounded(k->n, x) || !weigh(k, x, pieces, &largest)) return find_widest(k, x);
  if (k->np && !pieces && largest < DROWNED) return k->m;
  uint32_t best = find_heaviest(k, x);
  return best < k->m ? best : find_widest(k, x);
}

static int push_parts(krawczyk *k, const span *x, uint32_t i, double to, double from, double share) {
  if (k->stack.count + 2 > k->stack.room) return 0;
  for (int part = 0; part < 2; part++) {
    boxes_push(&k->stack, k->m, x, 0.5 * share);
    span *top = boxes_at(&k->stack, k->m, k->stack.count - 1);
    if (part)
      top[i].hi = to;
    else
      top[i].lo = from;
  }
  return 1;
}

int krawczyk_cut(krawczyk *k, const span *x, double share) {
  gap g = k->gap;
  span whole = x[g.at];
  if (g.hi > g.lo && g.lo > whole.lo && g.hi < whole.hi && g.hi - g.lo > GAP * width(whole))
    return push_parts(k, x, g.at, g.lo, g.hi, share);
  uint32_t i = choose(k, x);
  if (i == k->m) return 0;
  double at = i < k->n ? box_point(x[i]) : box_middle(x[i]);
  return at > x[i].lo && at < x[i].hi && push_parts(k, x, i, at, at, share);
}
