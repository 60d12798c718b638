/* range.c -- branch and bound for the range of a polynomial. Where it is nearly linear, boxes are cut, not halved
** [the linear dominated bounder of Makino & Berz, Trans. Computers 4 (2005)]. */
#include "range.h"
#include <string.h>

#define LEAST_PART 0x1p-30 /* of the cube: smaller boxes are left alone */

static double *doubles(const ambit_host *h, size_t count) { return h->alloc(h, (count ? count : 1) * sizeof(double)); }

int search_open(const ambit_host *h, search *w, const space *s, uint32_t boxes) {
  *w = (search) { .space = s, .room = boxes };
  w->about = doubles(h, (size_t)boxes * s->m), w->reach = doubles(h, (size_t)boxes * s->m);
  w->bound = doubles(h, boxes), w->rest = doubles(h, boxes);
  w->p = doubles(h, s->size), w->q = doubles(h, s->size);
  return w->about && w->reach && w->bound && w->rest && w->p && w->q;
}

void search_begin(search *w, const double *p, double sign) {
  for (size_t j = 0; j < w->space->size; j++) w->p[j] = sign * p[j];
  w->used = 0;
  w->best = -INFINITY;
}

static void bound_box(search *w, uint32_t n) {
  const space *s = w->space;
  double low, high, about_low, about_high;
  double error = polynomial_restrict(s, w->p, w->about + (size_t)n * s->m, w->reach + (size_t)n * s->m, w->q);
  polynomial_bounds(s, w->q, &low, &high);
  polynomial_vertex(s, w->q, 1, &about_low, &about_high);
  w->bound[n] = high + error + w->rest[n];
  double value = -(error - about_low - w->rest[n]);
  if (value > w->best) w->best = value;
}

void search_add(search *w, const double *about, const double *reach, double rest) {
  size_t m = w->space->m, at = w->used * m;
  memcpy(w->about + at, about, m * sizeof *about);
  memcpy(w->reach + at, reach, m * sizeof *reach);
  w->rest[w->used] = rest;
  bound_box(w, w->used++);
}

/* the unknown in which the polynomial over the box, w->q, bends or, if nowhere, moves most */
static uint32_t widest(const search *w) {
  const space *s = w->space;
  uint32_t at = 0;
  double most = -1;
  for (uint32_t v = 0; v < s->m; v++) {
    double size = 0;
    for (uint32_t r = 0; r < s->nrow; r++) {
      const double *c = w->q + s->row[r].at;
      uint32_t e = s->exponent[(size_t)r * s->m + v];
      for (uint32_t j = 0; j < s->row[r].length; j++) {
        uint32_t degree = s->row[r].degree + j, own = v == 0 ? j : e;
        if (own) size += fabs(c[j]) * (degree == 1 ? 0x1p-20 : own);
      }
    }
    if (size > most) most = size, at = v;
  }
  return at;
}

static void halve(search *w, uint32_t n) {
  size_t m = w->space->m;
  uint32_t v = widest(w), to = w->used++;
  memcpy(w->about + to * m, w->about + n * m, m * sizeof(double));
  memcpy(w->reach + to * m, w->reach + n * m, m * sizeof(double));
  w->rest[to] = w->rest[n];
  double half = 0.5 * w->reach[n * m + v];
  w->reach[n * m + v] = w->reach[to * m + v] = half;
  w->about[n * m + v] -= half;
  w->about[to * m + v] += half;
  bound_box(w, n), bound_box(w, to);
}

/* The bound of box n is what linear terms l_v make of their best corner, sign s_v, and what is left at most. So at eta
** p is at most bound - |l_v| (1 - s_v eta_v): where |l_v| (1 - s_v eta_v) >= bound - best it is no more than `best`,
** and that part is left out, in powers of two, which are exact. Leaves w->q of the box. 0: nothing is left out */
static int cut(search *w, uint32_t n) {
  const space *s = w->space;
  size_t m = s->m;
  double *about = w->about + n * m, *reach = w->reach + n * m, gap = w->bound[n] - w->best;
  int found = 0;
  polynomial_restrict(s, w->p, about, reach, w->q);
  for (uint32_t v = 0; v < m && s->d; v++) {
    double slope = w->q[polynomial_linear(s, v)], part = reach[v], share = 1;
    while (part > LEAST_PART && gap <= fabs(slope) * share) part *= 0.5, share *= 0.5;
    if (part == reach[v]) continue;
    about[v] += slope > 0 ? reach[v] - part : part - reach[v];
    reach[v] = part;
    found = 1;
  }
  return found;
}

double search_maximum(search *w, double tolerance, int sign_only) {
  for (uint32_t cuts = 0;;) {
    uint32_t top = 0;
    for (uint32_t n = 1; n < w->used; n++)
      if (w->bound[n] > w->bound[top]) top = n;
    double bound = larger(w->bound[top], w->best);
    if (sign_only ? bound < 0 || w->best >= 0 : bound - w->best <= tolerance) return bound;
    if (!w->space->m || !(bound < INFINITY) || cuts > w->room) return bound;
    if (cut(w, top)) {
      bound_box(w, top), cuts++;
      continue;
    }
    if (w->used == w->room) return bound;
    halve(w, top);
  }
}
