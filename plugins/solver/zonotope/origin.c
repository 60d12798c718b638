/* origin.c -- where the width comes from, for reasons: which data, and by which way errors of the method.
**
** The data's own share of a state's width is that of its terms. Errors are put down to the data that the failing
** operations' operands depend on, in proportion to their linear terms: estimates, on which no proof depends.
*/
#include "depend.h"
#include "modes.h"
#include "proof.h"
#include <stdarg.h>
#include <stdio.h>

#define SHOWN 3 /* data that are named */
#define LEAST_SHARE 0.05

static const char *const names[ORIGINS] = {
  [FROM_START] = "rounding",
  [FROM_DEGREE] = "higher degrees in the data",
  [FROM_TIME] = "truncation in time",
  [FROM_SQUARE] = "products of errors",
  [FROM_KERNEL] = "errors' action within a step",
  [FROM_SLOPE] = "errors' dependence on the data",
  [FROM_JACOBIAN] = "slopes' dependence on the data",
  [FROM_MIXED] = "older errors' dependence on the data",
  [FROM_VARYING] = "what varies in time",
};

typedef struct writer {
  char *text;
  size_t at, room;
} writer;

static void put(writer *w, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(w->text + w->at, w->room - w->at, format, list);
  va_end(list);
  if (n > 0) w->at = w->at + (size_t)n < w->room ? w->at + (size_t)n : w->room - 1;
}

/* the largest of x [n], which is taken out; its number */
static uint32_t take_largest(double *x, uint32_t n, double *value) {
  uint32_t most = 0;
  for (uint32_t i = 1; i < n; i++)
    if (x[i] > x[most]) most = i;
  *value = x[most], x[most] = -1;
  return most;
}

/* shares of the origins in E_i, the largest first */
static void put_origins(const zono *z, uint32_t i, writer *w) {
  double share[ORIGINS] = { 0 }, value;
  for (uint32_t c = 0; c < z->ngen; c++) share[z->proof->from[c]] += fabs(z->G[(size_t)c * z->nx + i]);
  share[FROM_MIXED] += discs_width(z, i) + depend_size(z, i);
  for (int n = 0; n < ORIGINS; n++) {
    uint32_t origin = take_largest(share, ORIGINS, &value);
    if (!(value > 0.01 * z->E[i])) return;
    put(w, "%s%s %.0f %%", n ? ", " : ": ", names[origin], 100 * value / z->E[i]);
  }
}

/* -- data */

/* share [m] += what terms of one and of two data have, times weight */
static void add_terms(const zono *z, const double *row, double weight, double *share) {
  const shape *s = &z->shape;
  for (uint32_t a = 0; a < s->m; a++) {
    share[a] += weight * fabs(row[1 + a]);
    for (uint32_t b = a; b < s->reach[a] && row_q(s, row) > 0; b++) {
      double half = 0.5 * weight * fabs(row[s->pair[a] + b - a]);
      share[a] += half, share[b] += half;
    }
  }
}

/* share [m] += what the lumps that act on state i owe to each datum */
static void add_lumps(const zono *z, uint32_t i, double *share) {
  const proof *p = z->proof;
  for (uint32_t turn = 0; turn < z->nx && p->link[i] == LINK_STATE; turn++) i = p->link_to[i];
  if (p->link[i] == LINK_STATE) return;
  const double *C = p->weight + (size_t)p->link_to[i] * z->nslot;
  for (uint32_t j = 0; j < z->nslot; j++) {
    const double *row = row_at(z, j, 0);
    double all = row_l(&z->shape, row), weight = fabs(C[j]) * z->r[j];
    for (uint32_t u = 0; u < z->m && all > 0 && weight > 0; u++) share[u] += weight * fabs(row[1 + u]) / all;
  }
}

/* what and the data, "`a` (40 %), `b` (20 %)", from shares [m] of the solver's data; nothing if none is known */
static void put_data(const zono *z, double *share, const char *what, writer *w) {
  double all = 0, value;
  uint32_t shown = 0;
  for (uint32_t u = 0; u < z->m; u++) all += share[u];
  for (uint32_t n = 0; n < SHOWN && n < z->m && all > 0 && all < INFINITY; n++) {
    uint32_t u = take_largest(share, z->m, &value), unknown = z->unknown[u];
    if (!(value > LEAST_SHARE * all)) return;
    if (unknown == AMBIT_NO_SLOT || !z->problem.unknown_name) continue;
    put(w, "%s`%s` (%.0f %%)", shown++ ? ", " : what, z->problem.unknown_name[unknown], 100 * value / all);
  }
}

/* the state of which errors are most; *share: how much */
static uint32_t widest_by_errors(const zono *z, double *share) {
  uint32_t worst = 0;
  *share = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    double part = 2 * z->E[i] / fmax(z->hi[i] - z->lo[i], 1e-300);
    if (part > *share) *share = part, worst = i;
  }
  return worst;
}

/* the state that is widest for its size */
static uint32_t widest(const zono *z) {
  uint32_t worst = 0;
  double most = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    double width = z->hi[i] - z->lo[i], part = width / fmax(fmax(fabs(z->lo[i]), fabs(z->hi[i])), 1e-300);
    if (part > most) most = part, worst = i;
  }
  return worst;
}

void origin_text(const zono *z, char *text, size_t room) {
  double errors, *share = z->proof->range;
  writer w = { text, 0, room };
  uint32_t worst = widest_by_errors(z, &errors);
  text[0] = 0;
  memset(share, 0, z->m * sizeof *share);
  if (errors > 0.01) {
    put(&w, " (of `%s` %.0f %% are errors of the method", z->problem.name[worst], 100 * fmin(errors, 1));
    put_origins(z, worst, &w);
    if (errors > 0.5)
      add_lumps(z, worst, share);
    else
      add_terms(z, z->P + (size_t)worst * z->shape.stride, 1, share);
    put_data(z, share, "; most of the width comes from ", &w);
    put(&w, ")");
  } else if (z->m > 0) {
    worst = widest(z);
    add_terms(z, z->P + (size_t)worst * z->shape.stride, 1, share);
    put(&w, " (most of the width of `%s` comes from ", z->problem.name[worst]);
    size_t before = w.at;
    put_data(z, share, "", &w);
    if (w.at == before) w.at = 0, text[0] = 0;
    if (w.at > 0) put(&w, ")");
  }
}
