/* box.c -- boxes: set operations, and how to cut them. Widths and cuts are choices, not bounds. */
#include "krawczyk.h"
#include <float.h>
#include <math.h>
#include <string.h>

#define LARGE 1024.0     /* ends beyond it are cut by size, not in the middle */
#define OFF_CENTRE 0.493 /* not at 0 of a box that is symmetric: roots like to be there */
#define INFLATION 0.1

int box_is_empty(uint32_t n, const span *x) {
  for (uint32_t i = 0; i < n; i++)
    if (!(x[i].lo <= x[i].hi)) return 1;
  return 0;
}

int box_is_bounded(uint32_t n, const span *x) {
  for (uint32_t i = 0; i < n; i++)
    if (!(x[i].lo > -INFINITY && x[i].hi < INFINITY && x[i].hi - x[i].lo < INFINITY)) return 0;
  return 1;
}

int box_is_inside(uint32_t n, const span *x, const span *of) {
  for (uint32_t i = 0; i < n; i++)
    if (!(x[i].lo >= of[i].lo && x[i].hi <= of[i].hi)) return 0;
  return 1;
}

int box_is_apart(uint32_t n, const span *x, const span *from) {
  for (uint32_t i = 0; i < n; i++)
    if (x[i].lo > from[i].hi || x[i].hi < from[i].lo) return 1;
  return 0;
}

int box_meet(uint32_t n, span *x, const span *y) {
  for (uint32_t i = 0; i < n; i++) {
    if (y[i].lo > x[i].lo) x[i].lo = y[i].lo;
    if (y[i].hi < x[i].hi) x[i].hi = y[i].hi;
  }
  return !box_is_empty(n, x);
}

void box_join(uint32_t n, span *x, const span *y) {
  for (uint32_t i = 0; i < n; i++) {
    if (y[i].lo < x[i].lo) x[i].lo = y[i].lo;
    if (y[i].hi > x[i].hi) x[i].hi = y[i].hi;
  }
}

void box_copy(uint32_t n, span *to, const span *from) { memcpy(to, from, n * sizeof *to); }

double box_shrinking(uint32_t n, const span *x, const span *old) {
  double least = 1;
  for (uint32_t i = 0; i < n; i++) {
    double before = old[i].hi - old[i].lo, now = x[i].hi - x[i].lo;
    if (before > 0 && now / before < least) least = now / before;
    if (before == INFINITY && now < INFINITY) least = 0;
  }
  return least;
}

/* between lo and hi, both > 0 */
static double between_sizes(double lo, double hi) { return sqrt(lo) * sqrt(hi); }

double box_point(span x) {
  double lo = fmax(x.lo, -DBL_MAX), hi = fmin(x.hi, DBL_MAX);
  if (hi > LARGE && lo < 1) return 1.0625;
  if (lo < -LARGE && hi > -1) return -1.0625;
  if (lo > 0 && hi > LARGE * lo) return between_sizes(lo, hi);
  if (hi < 0 && lo < LARGE * hi) return -between_sizes(-lo, -hi);
  double cut = lo + OFF_CENTRE * (hi - lo);
  return cut > lo && cut < hi ? cut : lo;
}

double box_extent(span x) {
  if (!(x.hi - x.lo < INFINITY)) return DBL_MAX / fmax(1, fmax(x.lo, -x.hi)); /* nearer ends first, the line at once */
  double size = fmax(1, fmin(fabs(x.lo), fabs(x.hi)));
  return (x.hi - x.lo) / size;
}

double box_middle(span x) { return fmin(fmax(0.5 * x.lo + 0.5 * x.hi, x.lo), x.hi); }

void box_inflate(uint32_t n, span *x, double floor) {
  for (uint32_t i = 0; i < n; i++) {
    double more = INFLATION * (x[i].hi - x[i].lo) + 4 * DBL_EPSILON * fmax(fabs(x[i].lo), fabs(x[i].hi)) + floor;
    x[i].lo -= more;
    x[i].hi += more;
  }
}

span *boxes_at(const boxes *b, uint32_t n, uint32_t i) { return b->x + (size_t)i * n; }

int boxes_push(boxes *b, uint32_t n, const span *x, double share) {
  if (b->count == b->room) return 0;
  if (b->share) b->share[b->count] = share;
  box_copy(n, boxes_at(b, n, b->count++), x);
  return 1;
}
