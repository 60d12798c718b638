/* sample_polish.c -- rounds of all searches side by side, as many candidates at a time as there is room for. */
#include "verbs/sample/sample_polish.h"
#include <math.h>

#define ROOM 1024        /* candidates at a time */
#define SLIGHT 1e-9      /* gains below this part of the width of what was seen are none */
#define MOST_ROUNDS 1000 /* of the same part of the range, after which gains are small */

typedef struct search {
  const ambit_extreme *best;
  size_t j;
  int side;
  double part;      /* of the ranges; below `finest`: it is over */
  double *together; /* [n] the moves of the last round that helped, as one */
  bool has_together;
  uint32_t rounds;
  /* of the round that is being made */
  double *centre;      /* [n] */
  double centre_value; /* what is to be gained on */
  size_t first, count; /* its candidates */
} search;

typedef struct bench {
  const ambit_polish *q;
  size_t n, m, room, evaluated, nsearch;
  search *search;
  double *point, *value; /* [n][room], [m][room] */
  size_t used;
} bench;

static bool make_room(bench *b, ambit_arena *arena) {
  size_t most = b->m * AMBIT_SIDES;
  b->room = 2 * b->n + 1 > ROOM ? 2 * b->n + 1 : ROOM;
  b->point = ambit_arena_alloc(arena, b->n * b->room * sizeof *b->point);
  b->value = ambit_arena_alloc(arena, b->m * b->room * sizeof *b->value);
  b->search = ambit_arena_alloc(arena, most * sizeof *b->search);
  double *vectors = ambit_arena_alloc(arena, 2 * most * b->n * sizeof *vectors);
  if (!b->point || !b->value || !b->search || !vectors) return false;
  for (size_t k = 0; k < most; k++) {
    const ambit_extreme *best = &b->q->extremes->at[k];
    if (!best->seen) continue;
    b->search[b->nsearch++] = (search) { .best = best,
      .j = k / AMBIT_SIDES,
      .side = (int)(k % AMBIT_SIDES),
      .part = 1,
      .centre = vectors + 2 * k * b->n,
      .together = vectors + (2 * k + 1) * b->n };
  }
  return true;
}

/* -- candidates */

static double moved(const bench *b, const search *s, size_t i, int sign) {
  ambit_interval range = b->q->range[i];
  double by = s->part == 1 ? INFINITY : s->part * ambit_interval_width(range);
  double to = s->centre[i] + sign * by;
  return to < range.lo ? range.lo : to > range.hi ? range.hi : to;
}

/* Candidates are laid down point by point, [room][n], and turned when they are complete. */
static double *add(bench *b) { return b->point + b->n * b->used++; }

static void add_candidates(bench *b, search *s) {
  s->first = b->used;
  for (size_t i = 0; i < b->n; i++) s->centre[i] = s->best->point[i];
  s->centre_value = s->best->value;
  for (size_t i = 0; i < b->n; i++)
    for (int sign = -1; sign <= 1; sign += 2) {
      double *to = add(b);
      for (size_t k = 0; k < b->n; k++) to[k] = s->centre[k];
      to[i] = moved(b, s, i, sign);
    }
  if (s->has_together) {
    double *to = add(b);
    for (size_t k = 0; k < b->n; k++) to[k] = s->together[k];
  }
  s->count = b->used - s->first;
}

static ambit_status evaluate(bench *b, double *turned) {
  for (size_t c = 0; c < b->used; c++)
    for (size_t i = 0; i < b->n; i++) turned[i * b->used + c] = b->point[c * b->n + i];
  ambit_status status = b->q->evaluate(b->q->user, b->used, turned, b->value);
  if (status != AMBIT_OK) return status;
  size_t number = b->q->first + b->evaluated;
  for (size_t j = 0; j < b->m; j++)
    for (size_t c = 0; c < b->used; c++)
      ambit_extremes_see(b->q->extremes, j, b->value[j * b->used + c], number + c, turned + c, b->used);
  b->evaluated += b->used;
  return AMBIT_OK;
}

/* -- what a round taught */

static double gain(const search *s, double value) {
  return s->side == AMBIT_LEAST ? s->centre_value - value : value - s->centre_value;
}

static void join_moves(bench *b, search *s) {
  size_t helped = 0;
  for (size_t i = 0; i < b->n; i++) {
    double best = 0;
    s->together[i] = s->centre[i];
    for (size_t k = 0; k < 2; k++) {
      double by = gain(s, b->value[s->j * b->used + s->first + 2 * i + k]);
      if (!(by > best)) continue;
      helped += best == 0;
      best = by;
      s->together[i] = b->point[(s->first + 2 * i + k) * b->n + i];
    }
  }
  s->has_together = helped > 1;
}

static void learn(bench *b, search *s) {
  const ambit_extreme *sides = &b->q->extremes->at[s->j * AMBIT_SIDES];
  double slight = SLIGHT * (sides[AMBIT_GREATEST].value - sides[AMBIT_LEAST].value);
  join_moves(b, s);
  if (gain(s, s->best->value) > slight && ++s->rounds < MOST_ROUNDS) return;
  s->part /= 4;
  s->rounds = 0;
}

static bool is_active(const bench *b, const search *s) { return s->part >= b->q->finest; }

/* One round of the searches from *next on that find room; *next is then the first of the others. */
static ambit_status make_round(bench *b, size_t *next, double *turned) {
  size_t first = *next, each = 2 * b->n + 1;
  b->used = 0;
  for (; *next < b->nsearch && b->used + each <= b->room; ++*next)
    if (is_active(b, &b->search[*next])) add_candidates(b, &b->search[*next]);
  if (!b->used) return AMBIT_OK;
  ambit_status status = evaluate(b, turned);
  for (size_t k = first; k < *next && status == AMBIT_OK; k++)
    if (is_active(b, &b->search[k])) learn(b, &b->search[k]);
  return status;
}

ambit_status ambit_polish_run(const ambit_polish *q, ambit_arena *arena, size_t *evaluated) {
  bench b = { .q = q, .n = q->extremes->n, .m = q->extremes->m };
  *evaluated = 0;
  if (b.n == 0 || b.m == 0) return AMBIT_OK;
  double *turned = NULL;
  if (!make_room(&b, arena) || !(turned = ambit_arena_alloc(arena, b.n * b.room * sizeof *turned))) return AMBIT_NOMEM;
  ambit_status status = AMBIT_OK;
  for (bool active = true; active && status == AMBIT_OK;) {
    size_t before = b.evaluated;
    for (size_t next = 0; next < b.nsearch && status == AMBIT_OK;) {
      if (b.evaluated + b.room > q->budget) b.room = q->budget - b.evaluated;
      if (b.room < 2 * b.n + 1) break;
      status = make_round(&b, &next, turned);
    }
    active = b.evaluated > before;
  }
  *evaluated = b.evaluated;
  return status;
}
