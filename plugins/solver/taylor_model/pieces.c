/* pieces.c -- domain splitting: pieces side by side, from one output instant to the next.
**
** A piece is split in half where its truncation in the unknowns exceeds the tolerance [Wittig, Di Lizia, Armellin,
** Makino & Berz, Celest. Mech. Dyn. Astr. 122 (2015)], or where a step cannot be proved over all of it. Pieces advance
** in rounds: all that are not at the instant go until they are, or must be split; then those are split, in order. So
** the result does not depend on the number of threads.
*/
#include "flow.h"
#include <string.h>

#define DEPTH_MAX 40
#define PUTS_OFF 3 /* unknowns from which a split is put off: with fewer, pieces are cheap */
#define WORTH 1e-3 /* smallest width of a state, relative, that splitting may mend when steps fail */

/* -- halving */

static void copy(const flow *f, piece *to, const piece *from) {
  size_t nx = f->nx, np = f->np, size = f->space.size, nb = f->ns * (nx + np);
  memcpy(to->from, from->from, f->m * sizeof(double)), memcpy(to->to, from->to, f->m * sizeof(double));
  memcpy(to->x, from->x, nx * size * sizeof(double)), memcpy(to->p, from->p, np * size * sizeof(double));
  memcpy(to->parameter_rad, from->parameter_rad, np * sizeof(double));
  memcpy(to->mid, from->mid, nb * sizeof(double)), memcpy(to->rad, from->rad, nb * sizeof(double));
  memcpy(to->tube_lo, from->tube_lo, nx * sizeof(double)), memcpy(to->tube_hi, from->tube_hi, nx * sizeof(double));
  memcpy(to->pad, from->pad, nx * sizeof(double));
  to->t = from->t, to->guess = from->guess, to->depth = from->depth, to->level = from->level;
  to->parent_rest = from->why == WHY_DEFECT ? from->parent_rest : 0, to->futile = from->futile;
  to->done = to->tolerant = 0;
}

/* the sub-range of the parent that holds sub-range n of its half: cuts are powers of two */
static uint32_t parent_of(const flow *f, uint32_t n, uint32_t v, int half) {
  uint32_t stride = 1, digit, cuts = f->cuts[v];
  for (uint32_t i = 0; i < v; i++) stride *= f->cuts[i];
  if (cuts == 1) return n;
  digit = n / stride % cuts;
  uint32_t to = (half ? cuts : 0) / 2 + digit / 2;
  return n - digit * stride + to * stride;
}

/* `child` becomes one half of `parent` in unknown v */
static void become_half(worker *w, piece *child, const piece *parent, uint32_t v, int half) {
  flow *f = w->flow;
  const space *s = &f->space;
  double about[UNKNOWNS_MAX] = { 0 }, reach[UNKNOWNS_MAX], *error = w->rounding;
  for (uint32_t i = 0; i < f->m; i++) reach[i] = 1;
  about[v] = half ? 0.5 : -0.5, reach[v] = 0.5;
  copy(f, child, parent);
  for (uint32_t i = 0; i < f->nx; i++)
    error[i] = polynomial_restrict(s, parent->x + i * s->size, about, reach, child->x + i * s->size);
  for (uint32_t i = 0; i < f->np; i++)
    child->parameter_rad[i] += polynomial_restrict(s, parent->p + i * s->size, about, reach, child->p + i * s->size);
  for (uint32_t n = 0; n < f->ns; n++) {
    zonotope z = zonotope_at(&w->shape, child->zonotope, n);
    memcpy(z.head, zonotope_at(&w->shape, parent->zonotope, parent_of(f, n, v, half)).head,
        w->shape.size * sizeof(double));
    zonotope_push(&w->shape, z, error);
  }
  double middle = 0.5 * (parent->from[v] + parent->to[v]);
  (half ? child->from : child->to)[v] = middle;
  child->depth++;
  flow_boxes(w, child);
}

/* the unknown that the terms of the highest degrees, or all if they vanish, depend on most */
static uint32_t choose_unknown(const flow *f, const piece *p) {
  const space *s = &f->space;
  double score[UNKNOWNS_MAX] = { 0 };
  uint32_t best = 0;
  for (uint32_t i = 0; i < f->nx; i++) {
    const double *x = p->x + i * s->size;
    double unit = fabs(p->mid[i]) + p->rad[i] + TINY;
    for (uint32_t r = 0; r < s->nrow; r++)
      for (uint32_t j = 0; j < s->row[r].length; j++) {
        uint32_t degree = s->row[r].degree + j;
        if (!degree) continue;
        double size = fabs(x[s->row[r].at + j]) / unit * (degree + 2 > s->d ? 1 : p->why == WHY_DEFECT ? 1e-6 : 1);
        score[0] += size * j / degree;
        for (uint32_t v = 1; v < f->m; v++) score[v] += size * s->exponent[(size_t)r * f->m + v] / degree;
      }
  }
  for (uint32_t v = 1; v < f->m; v++)
    if (score[v] > score[best]) best = v;
  return best;
}

static int is_worth_splitting(const flow *f, const piece *p) {
  if (p->why == WHY_DEFECT) return 1;
  for (uint32_t i = 0; i < f->nx; i++) {
    double reach =
        polynomial_norm(&f->space, p->x + i * f->space.size) - fabs(p->x[i * f->space.size + f->space.row[0].at]);
    double rest = 0;
    for (uint32_t n = 0; n < f->ns; n++) rest = larger(rest, zonotope_at(&f->worker[0].shape, p->zonotope, n).sum[i]);
    if (reach > rest && reach > WORTH * fabs(p->x[i * f->space.size + f->space.row[0].at])) return 1;
  }
  return 0;
}

int flow_split(flow *f, uint32_t number) {
  piece *parent = &f->piece[number];
  if (!f->m || f->npiece >= f->options.pieces_max || parent->depth >= DEPTH_MAX || !is_worth_splitting(f, parent))
    return 0;
  uint32_t v = choose_unknown(f, parent);
  /* the slot behind the last one holds the parent while it becomes the first half */
  piece *second = &f->piece[f->npiece++], *spare = &f->piece[f->npiece];
  piece keep = *spare;
  *spare = *parent, *parent = keep;
  become_half(&f->worker[0], parent, spare, v, 0);
  become_half(&f->worker[0], second, spare, v, 1);
  return 1;
}

/* -- going back

A piece that is alone puts off its first split (run.c). What it was then lies in the slot behind the last one, which
nothing else needs until the split. */

static void keep(const flow *f, piece *to, const piece *from) {
  copy(f, to, from);
  memcpy(to->zonotope, from->zonotope, f->ns * f->worker[0].shape.size * sizeof(double));
  to->why = from->why;
}

int flow_put_off(flow *f) {
  if (f->m < PUTS_OFF || f->options.pieces_max < 2) return 0;
  keep(f, &f->piece[f->options.pieces_max], &f->piece[0]);
  return f->put_off = f->piece[0].tolerant = 1;
}

enum why flow_go_back(flow *f) {
  piece *p = &f->piece[0];
  keep(f, p, &f->piece[f->options.pieces_max]);
  f->put_off = 0, f->t_to = f->t;
  flow_split(f, 0); /* there is room: it was put off */
  return p->t == f->t_to ? WHY_NOTHING : flow_advance_pieces(f);
}

/* -- rounds */

static AMBIT_WORKER void advance(worker *w, piece *p) {
  p->why = WHY_NOTHING;
  flow *f = w->flow;
  while (p->t != f->t_to && p->why == WHY_NOTHING) {
    p->why = flow_step(w, p, f->t_to);
    if (!f->pool && flow_ask(f)) f->stop = 1; /* with a pool its owner asks meanwhile */
    if (f->stop) p->why = WHY_STOPPED;
  }
  p->done = p->why == WHY_NOTHING;
  if (p->done) flow_hull(w, p);
}

static ambit_status job(void *user, uint32_t item, uint32_t number) {
  flow *f = user;
  ambit_rounding old = ambit_round_up();
  advance(&f->worker[number], &f->piece[f->todo[item]]);
  ambit_rounding_restore(old);
  return AMBIT_OK;
}

static int32_t meanwhile(void *user) {
  flow *f = user;
  if (flow_ask(f)) f->stop = 1;
  return f->stop;
}

/* every item, by the pool or one after the other; nonzero: stop */
static int run_round(flow *f, uint32_t count) {
  if (f->pool) return f->pool_service->run(f->pool, count, job, f, meanwhile) != AMBIT_OK || f->stop;
  for (uint32_t i = 0; i < count; i++) {
    job(f, i, 0);
    if (f->stop) return 1;
  }
  return 0;
}

/* after a round: the pieces that are not there are split, or told to be content; 0: one can't go on */
static int mend(flow *f, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) {
    piece *p = &f->piece[f->todo[i]];
    if (p->done || (p->why != WHY_WIDE && flow_split(f, f->todo[i]))) continue;
    f->failed = f->todo[i];
    if (p->tolerant || p->why == WHY_WIDE || p->why == WHY_SERIES || p->why == WHY_KINK) return 0;
    p->tolerant = 1;
  }
  return 1;
}

enum why flow_advance_pieces(flow *f) {
  for (uint32_t n = 0; n < f->npiece; n++) {
    piece *p = &f->piece[n];
    p->done = 0;
    for (uint32_t i = 0; i < f->nx; i++) p->tube_lo[i] = INFINITY, p->tube_hi[i] = -INFINITY;
  }
  for (;;) {
    uint32_t count = 0;
    for (uint32_t n = 0; n < f->npiece; n++)
      if (!f->piece[n].done) f->todo[count++] = n;
    if (!count) return WHY_NOTHING;
    if (run_round(f, count)) return WHY_STOPPED;
    if (!mend(f, count)) return f->piece[f->failed].why;
  }
}
