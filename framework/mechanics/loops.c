/* loops.c -- the reference configuration, and the choice of independent speeds that is made there. */
#include "mechanics/loops.h"
#include "mechanics/loop_point.h"
#include "mechanics/parts.h"
#include "num/random.h"
#include <string.h>

#define STARTS 24 /* random ones, if nothing was said about the reference */
#define NEIGHBOURS 3
#define NEARBY 1e-2 /* rad, m: how far they are away */

typedef struct search {
  ambit_mechanism *m;
  ambit_arena *arena;
  ambit_failure *f;
  const ambit_constraints *c;
  ambit_loop_point point;
  double *q, *other; /* [nq] */
  double t;          /* of the reference */
  ambit_random random;
} search;

/* -- what the user says */

static const char **copy_names(ambit_mechanism *m, size_t n, const char *const *name) {
  const char **copy = ambit_arena_alloc(m->arena, (n + 1) * sizeof *copy);
  for (size_t i = 0; copy && i < n; i++)
    if (!(copy[i] = ambit_arena_text(m->arena, name[i]))) return NULL;
  return copy;
}

ambit_status ambit_loops_refer(
    ambit_mechanism *m, size_t n, const char *const *name, const double *value, ambit_failure *f) {
  const char **names = copy_names(m, n, name);
  double *values = ambit_arena_alloc(m->arena, (n + 1) * sizeof *values);
  if (!names || !values) return ambit_no_memory(f);
  memcpy(values, value, n * sizeof *values);
  m->choice.reference_name = names;
  m->choice.reference = values;
  m->choice.nreference = n;
  return AMBIT_OK;
}

ambit_status ambit_loops_choose(ambit_mechanism *m, size_t n, const char *const *name, ambit_failure *f) {
  const char **names = copy_names(m, n, name);
  if (!names) return ambit_no_memory(f);
  m->choice.independent = names;
  m->choice.nindependent = n;
  return AMBIT_OK;
}

/* -- the reference */

/* Everything at 0, quaternions (coordinates without speeds of their own) at (1, 0, 0, 0); then what the user says. */
static ambit_status read_reference(search *s) {
  const ambit_loop_choice *choice = &s->m->choice;
  for (size_t j = 0; j < s->c->nq; j++) {
    bool has_speed = false;
    for (size_t k = 0; k < s->c->nu; k++) has_speed = has_speed || s->c->speed[k].coordinate == s->c->coordinate[j].q;
    s->q[j] = !has_speed && s->c->coordinate[j].index == 0;
  }
  for (size_t i = 0; i < choice->nreference; i++) {
    size_t j = 0;
    if (strcmp(choice->reference_name[i], "t") == 0) {
      s->t = choice->reference[i];
      continue;
    }
    while (j < s->c->nq && strcmp(s->c->coordinate[j].name, choice->reference_name[i]) != 0) j++;
    if (j == s->c->nq)
      return ambit_fail(s->f, AMBIT_INVALID, "reference: there is no coordinate `%s`", choice->reference_name[i]);
    s->q[j] = choice->reference[i];
  }
  return AMBIT_OK;
}

static ambit_status fail_open(search *s) {
  ambit_loop_point_evaluate(&s->point, s->q, s->t);
  size_t worst = ambit_loop_point_worst(&s->point);
  const ambit_constraint *row = &s->c->row[worst];
  return ambit_fail(s->f, AMBIT_INVALID,
      "the loop of `%s` could not be closed in numbers from the reference configuration: the residual of row `%s` "
      "is %g there; give an assembled one with m:reference { ... }, or check the lengths",
      row->loop, row->name, s->point.g[worst]);
}

/* An assembled configuration from a random position. */
static bool close_somewhere(search *s) {
  for (size_t j = 0; j < s->c->nq; j++) s->other[j] = ambit_random_in(&s->random, (ambit_interval) { -1.5, 1.5 });
  return ambit_loop_point_close(&s->point, s->other, s->t);
}

/* Closes the loops from the reference; where nothing was said, from random positions, too. */
static ambit_status find_reference(search *s) {
  memcpy(s->other, s->q, s->c->nq * sizeof *s->q);
  bool closed = ambit_loop_point_close(&s->point, s->other, s->t);
  for (int i = 0; !closed && s->m->choice.nreference == 0 && i < STARTS; i++) closed = close_somewhere(s);
  if (!closed) return fail_open(s);
  memcpy(s->q, s->other, s->c->nq * sizeof *s->q);
  return AMBIT_OK;
}

static size_t rank_at(search *s, const double *q) {
  if (!ambit_loop_point_evaluate(&s->point, q, s->t)) return 0;
  return ambit_partition_rank(s->arena, s->c->n, s->c->nu, s->point.velocity, s->f);
}

/* Rank a little away from the reference. */
static size_t rank_nearby(search *s) {
  size_t best = 0;
  for (int i = 0; i < NEIGHBOURS; i++) {
    for (size_t j = 0; j < s->c->nq; j++)
      s->other[j] = s->q[j] + ambit_random_in(&s->random, (ambit_interval) { -NEARBY, NEARBY });
    size_t rank = ambit_loop_point_close(&s->point, s->other, s->t) ? rank_at(s, s->other) : 0;
    best = rank > best ? rank : best;
  }
  return best;
}

/* A loop that is singular at the reference has a higher rank next to it: rows that look redundant there are not
** redundant elsewhere. A reference that the user chose is refused (UNABLE, for now); else another one is sought, at
** random, that has the higher rank.
*/
static ambit_status leave_singularity(search *s) {
  size_t rank = rank_at(s, s->q);
  size_t nearby = rank < s->c->n ? rank_nearby(s) : rank;
  if (s->f->status != AMBIT_OK) return s->f->status;
  if (nearby <= rank) return AMBIT_OK;
  for (int i = 0; s->m->choice.nreference == 0 && i < STARTS; i++) {
    if (!close_somewhere(s) || rank_at(s, s->other) < nearby) continue;
    memcpy(s->q, s->other, s->c->nq * sizeof *s->q);
    return s->f->status;
  }
  return AMBIT_UNABLE;
}

/* -- the choice */

static ambit_status read_independent(search *s, bool *keep) {
  const ambit_loop_choice *choice = &s->m->choice;
  for (size_t i = 0; i < choice->nindependent; i++) {
    bool found = false;
    for (size_t k = 0; k < s->c->nu; k++) {
      const ambit_speed *speed = &s->c->speed[k];
      bool same = strcmp(speed->name, choice->independent[i]) == 0;
      for (size_t j = 0; j < s->c->nq; j++)
        same = same || (s->c->coordinate[j].q == speed->coordinate &&
                           strcmp(s->c->coordinate[j].name, choice->independent[i]) == 0);
      keep[k] = keep[k] || same;
      found = found || same;
    }
    if (!found)
      return ambit_fail(s->f, AMBIT_INVALID, "independent: there is no coordinate `%s` whose speed could be chosen",
          choice->independent[i]);
  }
  return AMBIT_OK;
}

static ambit_status fail_choice(search *s, const ambit_partition *p, size_t rank) {
  size_t asked = s->m->choice.nindependent, freedom = s->c->nu - rank;
  if (asked > freedom)
    return ambit_fail(s->f, AMBIT_INVALID,
        "independent: %zu coordinates were named, but the loops leave %zu degree%s of freedom", asked, freedom,
        freedom == 1 ? "" : "s");
  return ambit_fail(s->f, AMBIT_INVALID,
      "independent: this choice does not determine the motion of loop `%s` at the reference configuration; name "
      "others, or leave the choice to me",
      s->c->row[p->redundant[0]].loop);
}

static ambit_status choose(search *s, ambit_partition *p) {
  const ambit_constraints *c = s->c;
  bool *nonzero = ambit_arena_alloc(s->arena, (c->n * c->nu + 1) * sizeof *nonzero),
       *keep = ambit_arena_alloc(s->arena, (c->nu + 1) * sizeof *keep);
  if (!nonzero || !keep) return ambit_no_memory(s->f);
  for (size_t i = 0; i < c->n * c->nu; i++) nonzero[i] = c->velocity[i] != 0;
  ambit_status status = read_independent(s, keep);
  size_t rank = status == AMBIT_OK ? rank_at(s, s->q) : 0;
  if (status == AMBIT_OK)
    status = ambit_partition_choose(s->arena, c->n, c->nu, s->point.velocity, nonzero, keep, p, s->f);
  return status == AMBIT_OK && p->rank < rank ? fail_choice(s, p, rank) : status;
}

static ambit_status check_singular(search *s, const ambit_partition *p, ambit_status singular) {
  if (singular != AMBIT_UNABLE) return singular;
  return ambit_fail(s->f, AMBIT_INVALID,
      "the loop of `%s` is singular at the reference configuration: its constraints are dependent there, but not next "
      "to it; give a regular one with m:reference { ... }",
      s->c->row[p->redundant[0]].loop);
}

/* G u + c = 0 must have solutions: a redundant row may not ask for another speed than those that imply it. Like the
** rank itself this is told at the reference only, in doubles; a validated run whose rows disagree later ends there.
*/
static ambit_status check_drives(search *s, const ambit_partition *p) {
  size_t n = s->c->n, nu = s->c->nu;
  double *a = ambit_arena_alloc(s->arena, (n * (nu + 1) + 1) * sizeof *a);
  if (!a) return ambit_no_memory(s->f);
  for (size_t k = 0; k < n; k++) {
    memcpy(a + k * (nu + 1), s->point.velocity + k * nu, nu * sizeof *a);
    a[k * (nu + 1) + nu] = s->point.drive[k];
  }
  if (p->rank == n || ambit_partition_rank(s->arena, n, nu + 1, a, s->f) <= p->rank) return s->f->status;
  return ambit_fail(s->f, AMBIT_INVALID,
      "the given motions pull the loop of `%s` apart: at the reference configuration, t = %g s, no speeds of the "
      "joints "
      "keep its row `%s` at 0",
      s->c->row[p->redundant[0]].loop, s->t, s->c->row[p->redundant[0]].name);
}

static ambit_status check_freedom(search *s, const ambit_partition *p) {
  bool driven = p->rank < s->c->nu;
  for (size_t k = 0; k < s->c->n; k++) driven = driven || s->c->drive[k] != 0;
  if (driven) return AMBIT_OK;
  return ambit_fail(s->f, AMBIT_INVALID,
      "nothing can move: the loops, the last of them `%s`, leave no degree of freedom", s->c->row[s->c->n - 1].loop);
}

ambit_status ambit_loops_build(ambit_mechanism *m, ambit_arena *arena, ambit_loops *loops, ambit_failure *f) {
  ambit_failure own = { 0 };
  const ambit_constraints *c = &loops->constraints;
  search s = { .m = m, .arena = arena, .f = &own, .c = c, .random = { 1 } };
  *loops = (ambit_loops) { .reference = NULL };
  ambit_status status = ambit_constraints_build(m, arena, &loops->constraints, &own);
  if (status == AMBIT_OK) status = ambit_loop_point_open(c, arena, &s.point, &own);
  s.q = ambit_arena_alloc(arena, (c->nq + 1) * sizeof *s.q);
  s.other = ambit_arena_alloc(arena, (c->nq + 1) * sizeof *s.other);
  if (!s.q || !s.other) status = ambit_no_memory(&own);
  if (status == AMBIT_OK) status = read_reference(&s);
  if (status == AMBIT_OK && c->n) status = find_reference(&s);
  ambit_status singular = status == AMBIT_OK && c->n ? leave_singularity(&s) : AMBIT_OK;
  if (status == AMBIT_OK) status = choose(&s, &loops->partition);
  if (status == AMBIT_OK) status = check_singular(&s, &loops->partition, singular);
  if (status == AMBIT_OK && c->n) status = check_drives(&s, &loops->partition);
  if (status == AMBIT_OK && c->n) status = check_freedom(&s, &loops->partition);
  loops->reference = s.q;
  loops->nfree = c->nu - loops->partition.rank;
  return status == AMBIT_OK ? status : ambit_fail(f, status, "%s", own.message);
}
