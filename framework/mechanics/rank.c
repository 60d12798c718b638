/* rank.c -- subdivision, and the test of one box. */
#include "mechanics/rank.h"
#include "graph/contract.h"
#include "graph/hull.h"
#include "graph/tape.h"
#include "host/services.h"
#include "mechanics/loop_point.h"
#include "num/regular.h"
#include <string.h>

#define ROOM 64   /* boxes waiting at a time: bisection depth */
#define SHARE 0.9 /* narrowing is repeated while it takes a tenth */

typedef struct certificate {
  const ambit_constraints *c;
  const ambit_partition *p;
  ambit_graph *g;
  ambit_arena *arena;
  ambit_failure *f;
  size_t nin, nvar;      /* leaves; the first nvar are coordinates and time, which are bisected */
  ambit_expr *leaf;      /* [nin] */
  ambit_interval *whole; /* [nin] */
  const ambit_tape *residual, *matrix;
  ambit_contractor *contractor;
  ambit_interval *slot, *stack; /* [nslot], [ROOM * nin] */
  double *lo, *hi;              /* [nin] */
  ambit_interval *entry;        /* [largest block] */
  double *scratch;              /* [largest block, twice] */
  size_t boxes, budget;
  uint32_t failed; /* the block that was not proved */
  bool any;        /* some box may hold an assembled configuration */
} certificate;

/* -- the leaves and their ranges */

static ambit_status range_of(const ambit_rank_request *q, const ambit_constraints *c, const ambit_node *node,
    ambit_expr leaf, ambit_interval *x, ambit_failure *f) {
  if (ambit_leaf_is_uncertain(node->op)) {
    *x = node->value;
    return AMBIT_OK;
  }
  *x = (ambit_interval) { q->time_lo, q->time_hi };
  const char *name = "t";
  size_t j = 0, i = 0;
  while (j < c->nq && c->coordinate[j].q != leaf) j++;
  if (j < c->nq) {
    name = c->coordinate[j].name;
    while (i < q->n && strcmp(q->name[i], name) != 0) i++;
    if (i == q->n) return ambit_fail(f, AMBIT_INVALID, "rank: the box says nothing about the coordinate `%s`", name);
    *x = (ambit_interval) { q->lo[i], q->hi[i] };
  }
  if (ambit_interval_is_empty(*x) || !ambit_interval_is_bounded(*x))
    return ambit_fail(f, AMBIT_INVALID, "rank: the range of `%s` must be finite and not empty", name);
  return AMBIT_OK;
}

static ambit_status read_leaves(certificate *s, const ambit_rank_request *q) {
  const ambit_constraints *c = s->c;
  size_t nexpr = c->n + c->npure + c->n * c->nu;
  ambit_expr *all = ambit_arena_alloc(s->arena, (nexpr + 1) * sizeof *all);
  if (!all) return ambit_no_memory(s->f);
  for (size_t k = 0; k < c->n + c->npure; k++) all[k] = c->row[k].g;
  memcpy(all + c->n + c->npure, c->velocity, c->n * c->nu * sizeof *all);
  s->nin = ambit_graph_leaves(s->g, nexpr, all, 0, NULL);
  ambit_expr *found = ambit_arena_alloc(s->arena, (s->nin + 1) * sizeof *found);
  s->leaf = ambit_arena_alloc(s->arena, (s->nin + 1) * sizeof *s->leaf);
  s->whole = ambit_arena_alloc(s->arena, (s->nin + 1) * sizeof *s->whole);
  if (!found || !s->leaf || !s->whole) return ambit_no_memory(s->f);
  ambit_graph_leaves(s->g, nexpr, all, s->nin, found);
  size_t n = 0;
  for (int data = 0; data < 2; data++) /* coordinates and time first */
    for (size_t i = 0; i < s->nin; i++) {
      const ambit_node *node = ambit_graph_node(s->g, found[i]);
      if (ambit_leaf_is_uncertain(node->op) != (data == 1)) continue;
      s->leaf[n] = found[i];
      ambit_status status = range_of(q, c, node, found[i], &s->whole[n++], s->f);
      if (status != AMBIT_OK) return status;
      s->nvar = data == 0 ? n : s->nvar;
    }
  return AMBIT_OK;
}

/* -- tapes */

static ambit_status open_contractor(certificate *s, ambit_scope *scope) {
  size_t n = s->c->n + s->c->npure;
  ambit_expr *g = ambit_arena_alloc(s->arena, (n + 1) * sizeof *g);
  if (!g) return ambit_no_memory(s->f);
  for (size_t k = 0; k < n; k++) g[k] = s->c->row[k].g;
  ambit_status status = ambit_tape_seal(s->g, s->arena, n, g, s->nin, s->leaf, 0, 0, &s->residual, s->f);
  if (status != AMBIT_OK) return status;
  return ambit_contract_service_v1.open(&scope->host, s->residual, &s->contractor) == AMBIT_OK ? AMBIT_OK
                                                                                               : ambit_no_memory(s->f);
}

/* Entry (k, l) of G_d is output k * rank + l. */
static ambit_status seal_matrix(certificate *s) {
  size_t rank = s->p->rank, most = 0;
  ambit_expr *e = ambit_arena_alloc(s->arena, (rank * rank + 1) * sizeof *e);
  if (!e) return ambit_no_memory(s->f);
  for (size_t k = 0; k < rank; k++)
    for (size_t l = 0; l < rank; l++) e[k * rank + l] = s->c->velocity[s->p->row[k] * s->c->nu + s->p->column[l]];
  for (size_t i = 0; i < s->p->nblock; i++) {
    size_t n = s->p->block[i + 1] - s->p->block[i];
    most = n > most ? n : most;
  }
  ambit_status status = ambit_tape_seal(s->g, s->arena, rank * rank, e, s->nin, s->leaf, 0, 0, &s->matrix, s->f);
  if (status != AMBIT_OK) return status;
  s->slot = ambit_arena_alloc(s->arena, (s->matrix->nslot + 1) * sizeof *s->slot);
  s->stack = ambit_arena_alloc(s->arena, (ROOM * s->nin + 1) * sizeof *s->stack);
  s->lo = ambit_arena_alloc(s->arena, (2 * s->nin + 1) * sizeof *s->lo);
  s->entry = ambit_arena_alloc(s->arena, (most * most + 1) * sizeof *s->entry);
  s->scratch = ambit_arena_alloc(s->arena, (2 * most * most + 1) * sizeof *s->scratch);
  if (!s->slot || !s->stack || !s->lo || !s->entry || !s->scratch) return ambit_no_memory(s->f);
  s->hi = s->lo + s->nin;
  return AMBIT_OK;
}

/* -- one box */

/* Narrows the box to where the loops may be closed; false: nowhere. */
static bool narrow(certificate *s, ambit_interval *box) {
  double before = INFINITY, now = 0;
  for (;; before = now) {
    for (size_t i = 0; i < s->nin; i++) s->lo[i] = box[i].lo, s->hi[i] = box[i].hi;
    if (ambit_contract_service_v1.narrow(s->contractor, s->lo, s->hi, NULL, NULL) == AMBIT_DOMAIN) return false;
    now = 0;
    for (size_t i = 0; i < s->nin; i++) {
      box[i] = (ambit_interval) { s->lo[i], s->hi[i] };
      if (i < s->nvar) now += ambit_interval_width(box[i]);
    }
    if (!(now < SHARE * before)) return true;
  }
}

/* G's block number i at the box last evaluated -> s->entry; its size */
static size_t read_block(const certificate *s, uint32_t i) {
  size_t first = s->p->block[i], n = s->p->block[i + 1] - first;
  for (size_t k = 0; k < n; k++)
    for (size_t l = 0; l < n; l++) s->entry[k * n + l] = s->slot[s->matrix->out[(first + k) * s->p->rank + first + l]];
  return n;
}

/* All blocks regular over the box? Else s->failed is one that was not proved. */
static bool regular(certificate *s, const ambit_interval *box) {
  s->failed = 0;
  if (ambit_hull(s->matrix, box, s->slot) & AMBIT_F_PARTIAL) return false; /* G is not defined all over the box */
  for (uint32_t i = 0; i < s->p->nblock; i++) {
    size_t n = read_block(s, i);
    if (ambit_is_regular(n, s->entry, s->scratch)) continue;
    s->failed = i;
    return false;
  }
  return true;
}

/* Is a block singular at every point of the box? A proof at single points only. */
static bool singular(certificate *s, const ambit_interval *box) {
  if (ambit_hull(s->matrix, box, s->slot) & AMBIT_F_PARTIAL) return false;
  for (uint32_t i = 0; i < s->p->nblock; i++) {
    size_t n = read_block(s, i);
    if (!ambit_is_singular(n, s->entry)) continue;
    s->failed = i;
    return true;
  }
  return false;
}

/* -- subdivision */

static size_t widest(const certificate *s, const ambit_interval *box) {
  size_t best = s->nvar;
  double most = 0;
  for (size_t i = 0; i < s->nvar; i++) {
    double width = ambit_interval_width(box[i]), mid = ambit_interval_mid(box[i]);
    if (width > most && mid > box[i].lo && mid < box[i].hi) most = width, best = i;
  }
  return best;
}

/* Depth first: the stack holds one box of each depth. */
static bool prove(certificate *s) {
  size_t waiting = 1;
  memcpy(s->stack, s->whole, s->nin * sizeof *s->whole);
  while (waiting) {
    ambit_interval *box = s->stack + (waiting - 1) * s->nin;
    if (s->boxes++ >= s->budget) return false;
    if (!narrow(s, box)) {
      waiting--;
      continue;
    }
    s->any = true;
    if (regular(s, box)) {
      waiting--;
      continue;
    }
    size_t at = widest(s, box);
    if (at == s->nvar || waiting == ROOM) return false;
    double mid = ambit_interval_mid(box[at]);
    memcpy(box + s->nin, box, s->nin * sizeof *box);
    box[at].lo = box[s->nin + at].hi = mid;
    waiting++;
  }
  return true;
}

static ambit_status certify(certificate *s, const ambit_partition *p, ambit_rank *r) {
  s->p = p;
  s->any = false;
  ambit_status status = seal_matrix(s);
  if (status != AMBIT_OK) return status;
  bool proved = prove(s);
  r->partition = *p;
  r->outcome = !proved ? AMBIT_RANK_UNDECIDED : s->any ? AMBIT_RANK_PROVED : AMBIT_RANK_EMPTY;
  if (!proved && singular(s, s->whole)) r->outcome = AMBIT_RANK_SINGULAR;
  r->row = proved ? NULL : p->row + p->block[s->failed];
  r->nrow = proved ? 0 : p->block[s->failed + 1] - p->block[s->failed];
  return AMBIT_OK;
}

/* Pivots chosen at the middle of the box: the loops' own may be bad there. Same rank, or false. */
static bool choose_here(certificate *s, const ambit_rank_request *q, const ambit_loops *loops, ambit_partition *p) {
  const ambit_constraints *c = s->c;
  ambit_loop_point point_at;
  double *middle = ambit_arena_alloc(s->arena, (c->nq + 1) * sizeof *middle);
  bool *nonzero = ambit_arena_alloc(s->arena, (c->n * c->nu + 1) * sizeof *nonzero);
  if (!middle || !nonzero || ambit_loop_point_open(c, s->arena, &point_at, NULL) != AMBIT_OK) return false;
  for (size_t j = 0; j < c->nq; j++) middle[j] = loops->reference[j];
  for (size_t i = 0; i < s->nvar; i++)
    for (size_t j = 0; j < c->nq; j++)
      if (s->leaf[i] == c->coordinate[j].q) middle[j] = ambit_interval_mid(s->whole[i]);
  double t = 0.5 * (q->time_lo + q->time_hi);
  if (!ambit_loop_point_close(&point_at, middle, t)) return false;
  for (size_t i = 0; i < c->n * c->nu; i++) nonzero[i] = c->velocity[i] != 0;
  return ambit_partition_choose(s->arena, c->n, c->nu, point_at.velocity, nonzero, NULL, p, NULL) == AMBIT_OK &&
         p->rank == loops->partition.rank;
}

ambit_status ambit_rank_certify(const ambit_rank_request *q, ambit_arena *arena, ambit_rank *r, ambit_failure *f) {
  *r = (ambit_rank) { .outcome = AMBIT_RANK_UNDECIDED };
  ambit_status status = ambit_loops_build(q->mechanism, arena, &r->loops, f);
  if (status != AMBIT_OK) return status;
  certificate s = {
    .c = &r->loops.constraints, .g = ambit_mechanism_graph(q->mechanism), .arena = arena, .f = f, .budget = q->budget
  };
  ambit_scope *scope = NULL;
  status = ambit_scope_open(&scope, NULL, NULL);
  if (status != AMBIT_OK) return ambit_no_memory(f);
  status = read_leaves(&s, q);
  if (status == AMBIT_OK) status = open_contractor(&s, scope);
  if (status == AMBIT_OK) status = certify(&s, &r->loops.partition, r);
  ambit_partition other;
  bool proved = r->outcome == AMBIT_RANK_PROVED || r->outcome == AMBIT_RANK_EMPTY;
  if (status == AMBIT_OK && !proved && choose_here(&s, q, &r->loops, &other)) {
    ambit_rank own = *r;
    size_t spent = s.boxes;
    s.boxes = 0;
    status = certify(&s, &other, r);
    if (status == AMBIT_OK && r->outcome != AMBIT_RANK_PROVED) *r = own;
    s.boxes += spent;
  }
  r->boxes = s.boxes;
  ambit_scope_close(scope);
  return status;
}
