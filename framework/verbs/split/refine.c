/* refine.c -- rounds of parts, and which of them are cut next. */
#include "verbs/split/refine.h"
#include "host/pool.h"
#include "verbs/run/allocation.h"
#include "verbs/split/merge.h"
#include "verbs/split/piece.h"
#include "verbs/split/probe.h"
#include <ambit/code.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#define CANDIDATES 8 /* data that the worst part is halved across */
#define AT_ONCE 2    /* data that a part is cut across in one round */
#define WORST 0.5    /* of the worst excess: parts below that wait for a later round */
#define CREEP 8      /* times the operations of the whole, after which a part does not go on */
#define DULL 0.9     /* what is left of an excess where little was gained; two such rounds end it */

typedef struct part {
  const double *box;     /* [2 nu] lo and hi */
  ambit_merge *own;      /* its run */
  const ambit_merge *of; /* the run of what it is a part of, or NULL */
  double excess;         /* how far its sets reach beyond the band, in widths of the band; infinite: it did not end */
  bool complete;         /* it came to the end, or holds no solution */
  uint64_t done;         /* operations of its run */
} part;

typedef struct part_list { /* parts that are run together */
  part *part;
  uint32_t count;
} part_list;

typedef struct refinement {
  const ambit_split *s;
  ambit_arena *arena;
  ambit_split_outcome *out;
  ambit_pool *pool;
  ambit_piece *piece; /* [ncontext] */
  ambit_split asked;  /* s with the parts of this round as pieces */
  ambit_pieces boxes;
  const part_list *now;
  part *kept; /* they cover the data */
  uint32_t nkept, runs, datum[CANDIDATES], ndatum;
  double gain[CANDIDATES]; /* of datum[]: what half a part still has of its excess; ascending */
  bool starved;            /* of memory: a part is missing */
  bool alone;              /* the caller's thread does the parts, so it must look at the sink meanwhile */
  double done, allowed;    /* operations until now; of one part */
  _Atomic bool stopped;    /* the sink says so */
} refinement;

/* -- runs of parts */

static int32_t meanwhile(void *user) {
  refinement *r = user;
  ambit_sink *sink = r->s->sink;
  if (sink->progress && sink->progress(sink, (double)r->runs / r->s->band->most, "parts") != 0) r->stopped = true;
  return r->stopped;
}

static int32_t look(void *user) {
  refinement *r = user;
  return r->alone ? meanwhile(user) : r->stopped;
}

static ambit_status do_part(void *user, uint32_t item, uint32_t worker) {
  refinement *r = user;
  r->piece[worker].allowed = r->allowed;
  ambit_status status = ambit_piece_run(&r->piece[worker], &r->asked, r->now->part[item].own, item, look, r);
  r->now->part[item].done = r->piece[worker].done;
  return status;
}

static double excess_of(const refinement *r, const part *p) {
  const ambit_cut_band *band = r->s->band;
  uint32_t nx = r->s->problem->nx;
  double most = 0;
  for (uint32_t k = 0; k + 1 < r->s->problem->ntime; k++) {
    const double *hull = ambit_merge_hull(p->own, k);
    for (uint32_t i = 0; i < nx; i++) {
      double lo = band->lo[k * nx + i], hi = band->hi[k * nx + i];
      if (!(hi > lo) || !hull) continue;
      most = fmax(most, fmax(lo - hull[i], hull[nx + i] - hi) / (hi - lo));
    }
  }
  return most;
}

/* done: the sink let all parts run; those that did too much work count as failed. */
static ambit_status run_round(refinement *r, const part_list *now, bool *done, ambit_failure *f) {
  uint32_t nu = r->s->problem->nu;
  *done = false;
  double *box = ambit_arena_alloc(r->arena, (size_t)now->count * 2 * nu * sizeof *box);
  if (!box) return ambit_no_memory(f);
  for (uint32_t i = 0; i < now->count; i++) {
    if (nu) memcpy(box + (size_t)i * 2 * nu, now->part[i].box, 2 * nu * sizeof *box);
    if (ambit_merge_open(r->arena, r->s->problem, 1, &now->part[i].own) != AMBIT_OK) return ambit_no_memory(f);
  }
  r->boxes = (ambit_pieces) { .nu = nu, .count = now->count, .box = box };
  r->now = now;
  ambit_status status = ambit_pool_run(r->pool, now->count, do_part, r, meanwhile);
  ambit_allocation_forbid(0);
  for (uint32_t i = 0; status != AMBIT_OK && status != AMBIT_STOPPED && i < now->count; i++)
    if (ambit_merge_outcome(now->part[i].own, f) == status) return status;
  *done = status == AMBIT_OK && !r->stopped;
  r->runs += now->count;
  for (uint32_t i = 0; i < now->count; i++) {
    part *p = &now->part[i];
    if (p->of) ambit_merge_narrow(p->own, p->of);
    r->done += (double)p->done;
    p->complete = ambit_merge_is_complete(p->own);
    p->excess = p->complete ? excess_of(r, p) : INFINITY;
  }
  return AMBIT_OK;
}

static void close_runs(const part_list *now) {
  for (uint32_t i = 0; i < now->count; i++) {
    ambit_merge_close(now->part[i].own);
    now->part[i].own = NULL;
  }
}

/* -- what to cut */

static bool middle_of(const double *box, uint32_t nu, uint32_t j, double *middle) {
  *middle = 0.5 * box[j] + 0.5 * box[nu + j];
  return *middle > box[j] && *middle < box[nu + j];
}

/* The two halves of p across datum j, behind those that `to` has; false: it cannot be cut. */
static bool halve(refinement *r, const part *p, uint32_t j, part_list *to) {
  uint32_t nu = r->s->problem->nu;
  double middle;
  if (!middle_of(p->box, nu, j, &middle)) return false;
  double *box = ambit_arena_alloc(r->arena, 4 * (size_t)nu * sizeof *box);
  r->starved = r->starved || !box;
  if (!box) return false;
  memcpy(box, p->box, 2 * nu * sizeof *box);
  memcpy(box + 2 * (size_t)nu, p->box, 2 * nu * sizeof *box);
  box[nu + j] = box[2 * (size_t)nu + j] = middle;
  const ambit_merge *of = p->own ? p->own : p->of;
  to->part[to->count++] = (part) { .box = box, .of = of };
  to->part[to->count++] = (part) { .box = box + 2 * (size_t)nu, .of = of };
  return true;
}

/* The data that move the solution most in what the part has left of their ranges. */
static void find_candidates(refinement *r, const part *worst, const double *influence) {
  const ambit_problem *p = r->s->problem;
  double least[CANDIDATES], middle;
  r->ndatum = 0;
  for (uint32_t j = 0; j < p->nu; j++) {
    if (!middle_of(worst->box, p->nu, j, &middle)) continue;
    double moves = influence[j] * (worst->box[p->nu + j] - worst->box[j]) / (p->u_hi[j] - p->u_lo[j]);
    uint32_t at = r->ndatum;
    while (at > 0 && least[at - 1] < moves) at--;
    if (at == CANDIDATES) continue;
    uint32_t last = r->ndatum < CANDIDATES ? r->ndatum++ : CANDIDATES - 1;
    for (uint32_t i = last; i > at; i--) r->datum[i] = r->datum[i - 1], least[i] = least[i - 1];
    r->datum[at] = j, least[at] = moves;
  }
}

static void rank(refinement *r, const part *worst, const part_list *halves) {
  for (uint32_t c = 0; c < r->ndatum; c++) {
    uint32_t j = r->datum[c], at = c;
    double left = fmax(halves->part[2 * c].excess, halves->part[2 * c + 1].excess);
    double gain = isinf(worst->excess) ? (isinf(left) ? 1 : 0) : left / worst->excess;
    for (; at > 0 && r->gain[at - 1] > gain; at--) r->datum[at] = r->datum[at - 1], r->gain[at] = r->gain[at - 1];
    r->datum[at] = j, r->gain[at] = gain;
  }
}

/* Halves the worst part across each candidate. With one there is no choice. */
static ambit_status try_data(refinement *r, const part *worst, const double *influence, bool *done, ambit_failure *f) {
  find_candidates(r, worst, influence);
  r->gain[0] = 0.5;
  *done = true;
  if (r->ndatum < 2) return AMBIT_OK;
  part half[2 * CANDIDATES];
  part_list halves = { .part = half };
  for (uint32_t c = 0; c < r->ndatum; c++) halve(r, worst, r->datum[c], &halves);
  if (r->starved) return ambit_no_memory(f);
  ambit_status status = run_round(r, &halves, done, f);
  if (status == AMBIT_OK && *done) rank(r, worst, &halves);
  close_runs(&halves);
  return status;
}

/* Cuts p into the parts of the next round: how many? */
static uint32_t cut(refinement *r, const part *p, part_list *to) {
  uint32_t first = to->count;
  double left = p->excess;
  for (uint32_t c = 0, depth = 0; c < r->ndatum && depth < AT_ONCE && left > r->s->band->limit; c++) {
    if (depth > 0 && r->gain[c] > DULL) break;
    uint32_t from = first, before = to->count;
    if (depth == 0) {
      if (!halve(r, p, r->datum[c], to)) continue;
    } else {
      double middle;
      if (!middle_of(p->box, r->s->problem->nu, r->datum[c], &middle)) continue;
      for (; from < before; from++) halve(r, &to->part[from], r->datum[c], to);
      memmove(to->part + first, to->part + before, (to->count - before) * sizeof *to->part);
      to->count -= before - first;
    }
    depth++;
    if (isinf(left)) break;
    left *= r->gain[c];
  }
  return to->count - first;
}

/* -- rounds */

static uint32_t worst_of(const part *list, uint32_t n) {
  uint32_t worst = 0;
  for (uint32_t i = 1; i < n; i++)
    if (list[i].excess > list[worst].excess) worst = i;
  return worst;
}

/* Those that are too wide, the worst first, as long as runs are left; of equals, the first. */
static void choose(const refinement *r, bool *chosen) {
  const double least = fmax(r->s->band->limit, WORST * r->kept[worst_of(r->kept, r->nkept)].excess);
  uint32_t left = (r->s->band->most - r->runs) >> AT_ONCE;
  memset(chosen, 0, r->nkept * sizeof *chosen);
  for (; left > 0; left--) {
    uint32_t worst = r->nkept;
    for (uint32_t i = 0; i < r->nkept; i++) {
      bool is_worse = worst == r->nkept || r->kept[i].excess > r->kept[worst].excess;
      if (!chosen[i] && r->kept[i].excess > r->s->band->limit && r->kept[i].excess >= least && is_worse) worst = i;
    }
    if (worst == r->nkept) return;
    chosen[worst] = true;
  }
}

/* What a part was cut into takes its place if all of that came to the end, or it had not come there itself. */
static bool replaces(const part *whole, const part *own, uint32_t n, bool done) {
  bool all = n > 0;
  for (uint32_t i = 0; i < n; i++) all = all && own[i].complete;
  return all || (n > 0 && done && !whole->complete);
}

static void take(refinement *r, const part_list *next, const uint32_t *parts, bool done, part *list) {
  uint32_t n = 0;
  part *from = next->part;
  for (uint32_t i = 0; i < r->nkept; from += parts[i++]) {
    part whole = r->kept[i];
    const part_list own = { from, parts[i] }, all = { &whole, 1 };
    bool is_better = replaces(&whole, from, parts[i], done);
    if (is_better)
      memcpy(list + n, from, parts[i] * sizeof *list);
    else
      list[n] = whole;
    n += is_better ? parts[i] : 1;
    close_runs(is_better ? &all : &own);
  }
  r->kept = list, r->nkept = n;
}

/* Cuts those that are chosen, and runs what they were cut into. */
static ambit_status cut_round(refinement *r, bool *done, ambit_failure *f) {
  size_t room = r->s->band->most + r->nkept + 1u;
  part_list next = { .part = ambit_arena_alloc(r->arena, 2 * room * sizeof *next.part) };
  part *list = ambit_arena_alloc(r->arena, 2 * room * sizeof *list);
  uint32_t *parts = ambit_arena_alloc(r->arena, r->nkept * sizeof *parts);
  bool *chosen = ambit_arena_alloc(r->arena, r->nkept * sizeof *chosen);
  if (!next.part || !list || !parts || !chosen) return ambit_no_memory(f);
  choose(r, chosen);
  for (uint32_t i = 0; i < r->nkept; i++) parts[i] = chosen[i] ? cut(r, &r->kept[i], &next) : 0;
  if (r->starved) return ambit_no_memory(f);
  ambit_status status = run_round(r, &next, done, f);
  if (status == AMBIT_OK)
    take(r, &next, parts, *done, list);
  else
    close_runs(&next);
  return status;
}

/* Are so many runs allowed, if they take what those until now did? */
static bool is_allowed(const refinement *r, uint32_t runs) {
  double each = r->runs > 0 ? r->done / r->runs : 0;
  return !(r->s->band->work > 0) || r->done + runs * each <= r->s->band->work;
}

static ambit_status refine(refinement *r, const double *influence, bool *done, ambit_failure *f) {
  const ambit_cut_band *band = r->s->band;
  uint32_t dull = 0;
  *done = true;
  while (*done && dull < 2) {
    const part *worst = &r->kept[worst_of(r->kept, r->nkept)];
    double before = worst->excess;
    const uint32_t least = 2 * CANDIDATES + (1u << AT_ONCE);
    if (!(before > band->limit) || r->runs + least > band->most || !is_allowed(r, least)) return AMBIT_OK;
    ambit_status status = try_data(r, worst, influence, done, f);
    if (status != AMBIT_OK || !*done || r->ndatum == 0) return status;
    status = cut_round(r, done, f);
    if (status != AMBIT_OK) return status;
    dull = r->kept[worst_of(r->kept, r->nkept)].excess > DULL * before ? dull + 1 : 0;
  }
  return AMBIT_OK;
}

/* -- the whole */

/* Equal parts, at most `total`, dealt out by influence; they take the place of what is kept if they get as far. */
static ambit_status start(refinement *r, const double *influence, uint32_t total, bool *done, ambit_failure *f) {
  const ambit_problem *p = r->s->problem;
  uint32_t *parts = ambit_arena_alloc(r->arena, (p->nu + 1u) * sizeof *parts);
  if (!parts) return ambit_no_memory(f);
  ambit_pieces grid;
  ambit_pieces_deal(p->nu, influence, total, parts);
  ambit_status status = ambit_pieces_cut(r->arena, p->nu, p->u_lo, p->u_hi, parts, &grid, f);
  if (status != AMBIT_OK) return status;
  double *box = ambit_arena_alloc(r->arena, ((size_t)grid.count * 2 * p->nu + 1) * sizeof *box);
  part_list next = { ambit_arena_alloc(r->arena, grid.count * sizeof *next.part), grid.count };
  if (!box || !next.part) return ambit_no_memory(f);
  for (uint32_t i = 0; i < grid.count; i++, box += 2 * (size_t)p->nu) {
    ambit_pieces_range(&grid, i, box, box + p->nu);
    next.part[i] = (part) { .box = box };
  }
  status = run_round(r, &next, done, f);
  bool all = true;
  for (uint32_t i = 0; i < grid.count; i++) all = all && next.part[i].complete;
  bool is_better = status == AMBIT_OK && (r->nkept == 0 || all);
  const part_list old = { r->kept, r->nkept };
  close_runs(is_better ? &old : &next);
  if (is_better) r->kept = next.part, r->nkept = next.count;
  return status;
}

static ambit_status run_all(refinement *r, ambit_failure *f) {
  static const uint32_t totals[] = { 1, 8, 64 };
  const ambit_problem *p = r->s->problem;
  double *influence = ambit_arena_alloc(r->arena, (p->nu + 1u) * sizeof *influence);
  if (!influence || ambit_probe_influence(p, r->s->initial, r->arena, influence) != AMBIT_OK) return ambit_no_memory(f);
  bool done = true;
  for (size_t n = 0; n < sizeof totals / sizeof *totals; n++) {
    if (n > 0 && (totals[n] > r->s->band->most / 4 || !is_allowed(r, totals[n]))) break;
    ambit_status status = start(r, influence, totals[n], &done, f);
    if (status != AMBIT_OK || !done) return status;
    if (n == 0 && r->s->band->work > 0 && r->done > 0) r->allowed = CREEP * r->done;
    if (!(r->kept[worst_of(r->kept, r->nkept)].excess > r->s->band->limit)) return AMBIT_OK;
  }
  return refine(r, influence, &done, f);
}

static ambit_status tell(refinement *r, ambit_failure *f) {
  ambit_merge *all;
  if (ambit_merge_open(r->arena, r->s->problem, r->nkept, &all) != AMBIT_OK) return ambit_no_memory(f);
  for (uint32_t i = 0; i < r->nkept; i++) ambit_merge_join(all, i, r->kept[i].own);
  bool stopped = ambit_merge_forward(all, r->s->sink) != 0 || r->stopped;
  if (stopped)
    r->out->said = AMBIT_STOPPED;
  else
    r->out->said = ambit_merge_outcome(all, &r->out->why);
  r->out->pieces = r->nkept;
  ambit_allocation_forbid(0);
  ambit_merge_close(all);
  return AMBIT_OK;
}

static ambit_status open_pieces(refinement *r, ambit_failure *f) {
  const ambit_split *s = r->s;
  r->piece = ambit_arena_alloc(r->arena, s->ncontext * sizeof *r->piece);
  if (!r->piece) return ambit_no_memory(f);
  for (uint32_t i = 0; i < s->ncontext; i++)
    if (ambit_piece_prepare(&r->piece[i], &r->asked, &s->context[i], r->arena) != AMBIT_OK) return ambit_no_memory(f);
  return ambit_pool_open(NULL, s->ncontext, &r->pool) == AMBIT_OK ? AMBIT_OK : ambit_no_memory(f);
}

ambit_status ambit_refine_run(const ambit_split *s, ambit_arena *arena, ambit_split_outcome *out, ambit_failure *f) {
  refinement r = { .s = s, .arena = arena, .out = out, .asked = *s };
  *out = (ambit_split_outcome) { 0 };
  r.asked.pieces = &r.boxes;
  r.allowed = s->band->work;
  ambit_status status = open_pieces(&r, f);
  if (status == AMBIT_OK) {
    out->threads = ambit_pool_threads(r.pool);
    r.alone = out->threads == 1;
    status = run_all(&r, f);
    ambit_pool_close(r.pool);
    for (uint32_t i = 0; i < s->ncontext; i++) ambit_work_add(&out->work, &r.piece[i].work);
  }
  if (status == AMBIT_OK) status = tell(&r, f);
  const part_list kept = { r.kept, r.nkept };
  close_runs(&kept);
  return status;
}
