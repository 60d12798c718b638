/* range.c -- branch and bound for the range of a polynomial. */
#include "range.h"
#include <string.h>

static double *room(const ambit_host *h, size_t count) { return h->alloc(h, (count ? count : 1) * sizeof(double)); }

int search_open(const ambit_host *h, search *w, const space *s, uint32_t boxes) {
  *w = (search) { .space = s, .room = boxes };
  w->about = room(h, (size_t)boxes * s->m), w->reach = room(h, (size_t)boxes * s->m);
  w->bound = room(h, boxes), w->rest = room(h, boxes);
  w->p = room(h, s->size), w->q = room(h, s->size);
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

/* the unknown in which the polynomial over the box bends or, if nowhere, moves most */
static uint32_t widest(const search *w, uint32_t n) {
  const space *s = w->space;
  uint32_t at = 0;
  double most = -1;
  polynomial_restrict(s, w->p, w->about + (size_t)n * s->m, w->reach + (size_t)n * s->m, w->q);
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
  uint32_t v = widest(w, n), to = w->used++;
  memcpy(w->about + to * m, w->about + n * m, m * sizeof(double));
  memcpy(w->reach + to * m, w->reach + n * m, m * sizeof(double));
  w->rest[to] = w->rest[n];
  double half = 0.5 * w->reach[n * m + v];
  w->reach[n * m + v] = w->reach[to * m + v] = half;
  w->about[n * m + v] -= half;
  w->about[to * m + v] += half;
  bound_box(w, n), bound_box(w, to);
}

double search_maximum(search *w, double tolerance, int sign_only) {
  for (;;) {
    uint32_t top = 0;
    for (uint32_t n = 1; n < w->used; n++)
      if (w->bound[n] > w->bound[top]) top = n;
    double bound = w->bound[top];
    if (sign_only ? bound < 0 || w->best >= 0 : bound - w->best <= tolerance) return bound;
    if (w->used == w->room || !w->space->m || !(bound < INFINITY)) return bound;
    halve(w, top);
  }
}
