/* jets_open.c -- from a tape to slots and steps, all in one allocation. */
#include "jets.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { REVERSED = 1, MOVING = 2, MEAN = 4 };

static int is_pair(uint32_t op) {
  return op == AMBIT_OP_SIN || op == AMBIT_OP_COS || op == AMBIT_OP_SINH || op == AMBIT_OP_COSH;
}

static int is_cosine(uint32_t op) { return op == AMBIT_OP_COS || op == AMBIT_OP_COSH; }

static int is_known(uint32_t op) {
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_NEG:
  case AMBIT_OP_MUL:
  case AMBIT_OP_SQR:
  case AMBIT_OP_DIV:
  case AMBIT_OP_SQRT:
  case AMBIT_OP_EXP:
  case AMBIT_OP_LOG:
  case AMBIT_OP_TANH:
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ATAN2:
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return 1;
  default: return is_pair(op);
  }
}

static int needs_aux(uint32_t op) {
  return is_pair(op) || op == AMBIT_OP_TANH || op == AMBIT_OP_ATAN || op == AMBIT_OP_ATAN2;
}

static int is_partner(const ambit_tape *t, uint32_t i) {
  static const uint8_t partner[AMBIT_OP_COUNT] = { [AMBIT_OP_SIN] = AMBIT_OP_COS,
    [AMBIT_OP_COS] = AMBIT_OP_SIN,
    [AMBIT_OP_SINH] = AMBIT_OP_COSH,
    [AMBIT_OP_COSH] = AMBIT_OP_SINH };
  uint32_t source = t->nconst + t->nin, aux = t->aux[i];
  return aux >= source && t->op[aux - source] == partner[t->op[i]] && t->a[aux - source] == t->a[i];
}

static ambit_status check(const ambit_host *h, const ambit_tape *t) {
  if (!(t->flags & AMBIT_TAPE_SERIES))
    return h->fail(h, AMBIT_INVALID, "interval: this tape was not sealed for power series");
  for (uint32_t i = 0; i < t->ninstr; i++) {
    if (!is_known(t->op[i]))
      return h->fail(h, AMBIT_INVALID, "interval: opcode %u has no rule for power series", t->op[i]);
    if (needs_aux(t->op[i]) && (t->aux[i] >= t->nslot || (is_pair(t->op[i]) && !is_partner(t, i))))
      return h->fail(h, AMBIT_INVALID, "interval: instruction %u of the tape lacks its helper slot", i);
  }
  return AMBIT_OK;
}

/* Which copies of its operands the rule of an instruction reads (jets_values.h, jets_slopes.h). */
static void mark(uint8_t *need, const ambit_tape *t, uint32_t i) {
  uint32_t r = t->dst[i], a = t->a[i], b = t->b[i], aux = t->aux[i];
  switch (t->op[i]) {
  case AMBIT_OP_MUL: need[a] |= MEAN, need[b] |= MEAN | REVERSED; break;
  case AMBIT_OP_SQR: need[a] |= MEAN | REVERSED; break;
  case AMBIT_OP_DIV: need[r] |= MEAN, need[b] |= MEAN | REVERSED; break;
  case AMBIT_OP_SQRT: need[r] |= MEAN | REVERSED; break;
  case AMBIT_OP_LOG: need[a] |= MEAN | REVERSED, need[r] |= MEAN | MOVING; break;
  case AMBIT_OP_ATAN: need[aux] |= MEAN | REVERSED, need[r] |= MEAN | MOVING; break;
  case AMBIT_OP_ATAN2:
    need[aux] |= MEAN | REVERSED, need[r] |= MEAN | MOVING;
    need[a] |= MEAN | REVERSED | MOVING, need[b] |= MEAN | REVERSED | MOVING;
    break;
  case AMBIT_OP_TANH: need[a] |= MEAN | MOVING, need[aux] |= MEAN | REVERSED; break;
  case AMBIT_OP_EXP:
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: need[a] |= MEAN | MOVING, need[r] |= MEAN | REVERSED; break;
  default: break;
  }
}

static size_t round_up(size_t n, size_t to) { return (n + to - 1) / to * to; }

/* Bump allocation in two passes: with no base the sizes are added up. */
typedef struct pool {
  char *base;
  size_t used;
} pool;

static void *take(pool *p, size_t bytes) {
  void *place = p->base ? p->base + p->used : NULL;
  p->used += round_up(bytes, 64);
  return place;
}

static row take_row(pool *p, size_t n) {
  double *mid = take(p, n * sizeof(double));
  return (row) { mid, take(p, n * sizeof(double)) };
}

static void lay_slot(pool *p, const jets *j, slot *s, uint8_t need) {
  size_t room = round_up(j->order + 1u, 4) + 4;
  size_t directions = (size_t)j->blocks * j->width * (j->order + 1u);
  s->u = take_row(p, room);
  if (need & REVERSED) s->reversed = take_row(p, room);
  if (need & MOVING) s->moving = take_row(p, room);
  s->mean = s->u, s->mean_moving = s->moving;
  if (j->ndir && j->centre && (need & MEAN)) s->mean = take_row(p, room);
  if (j->ndir && j->centre && (need & MOVING)) s->mean_moving = take_row(p, room);
  if (s->varies && directions) s->slope = take_row(p, directions);
  if (s->varies && directions && (need & MOVING)) s->slope_moving = take_row(p, directions);
}

/* Does an input reach each slot? */
static void trace(const ambit_tape *t, slot *s) {
  for (uint32_t v = 0; v < t->nin; v++) s[t->nconst + v].varies = 1;
  for (uint32_t i = 0; i < t->ninstr; i++) s[t->dst[i]].varies = s[t->a[i]].varies | s[t->b[i]].varies;
}

static void add_product(step *s, row a, uint32_t da, const slot *b) {
  s->product[s->nproduct++] = (factors) { a, b->reversed, da, b->degree };
}

/* in the order in which jets_values.h names them */
static void add_products(step *s) {
  const slot *r = s->r, *a = s->a, *b = s->b;
  switch (s->op) {
  case AMBIT_OP_MUL: add_product(s, a->u, a->degree, b); return;
  case AMBIT_OP_SQR: add_product(s, a->u, a->degree, a); return;
  case AMBIT_OP_DIV: add_product(s, r->u, r->degree, b); return;
  case AMBIT_OP_SQRT: add_product(s, r->u, r->degree, r); return;
  case AMBIT_OP_EXP: add_product(s, a->moving, a->degree, r); return;
  case AMBIT_OP_LOG: add_product(s, r->moving, r->degree, a); return;
  case AMBIT_OP_TANH: add_product(s, a->moving, a->degree, s->aux); return;
  case AMBIT_OP_ATAN: add_product(s, r->moving, r->degree, s->aux); return;
  case AMBIT_OP_SIN:
  case AMBIT_OP_SINH: add_product(s, a->moving, a->degree, s->other), add_product(s, a->moving, a->degree, r); return;
  case AMBIT_OP_ATAN2:
    add_product(s, r->moving, r->degree, s->aux);
    add_product(s, a->moving, a->degree, b), add_product(s, b->moving, b->degree, a);
    return;
  default: return;
  }
}

static void add_step(
    jets *j, const ambit_tape *t, uint32_t op, uint32_t r, uint32_t other, uint32_t a, uint32_t b, uint32_t aux) {
  slot *s = j->slot;
  const slot *helper = aux < t->nslot ? &s[aux] : NULL;
  step *at = &j->step[j->nstep++];
  *at = (step) { op, s[r].degree, &s[r], &s[other], &s[a], &s[b], helper, r, other, a, b, .nproduct = 0 };
  add_products(at);
  if (at->degree) j->moving[j->nmoving++] = at;
}

/* A sine and the cosine that names it as its helper are one step, written at the first of the two. A tape may hold
** the same sine twice: the one that its cosine does not name is a copy of the one it does. */
static void write_pair(jets *j, const ambit_tape *t, uint32_t i) {
  uint32_t r = t->dst[i], partner = t->aux[i], twin = t->aux[partner - j->nsource];
  if (partner < r && twin == r) return;
  if (partner < r)
    add_step(j, t, STEP_COPY, r, r, twin, twin, AMBIT_NO_SLOT);
  else if (is_cosine(t->op[i]))
    add_step(j, t, t->op[partner - j->nsource], partner, r, t->a[i], t->a[i], AMBIT_NO_SLOT);
  else
    add_step(j, t, t->op[i], r, partner, t->a[i], t->a[i], AMBIT_NO_SLOT);
}

static void write_step(jets *j, const ambit_tape *t, uint32_t i) {
  if (is_pair(t->op[i]))
    write_pair(j, t, i);
  else
    add_step(j, t, t->op[i], t->dst[i], t->dst[i], t->a[i], t->b[i], t->aux[i]);
}

/* upward mode */
static AMBIT_WORKER void write_constants(jets *j, const ambit_tape *t) {
  for (uint32_t c = 0; c < t->nconst; c++) {
    double mid = 0.5 * (t->hi[c] + t->lo[c]);
    double above = t->hi[c] - mid, below = mid - t->lo[c], rad = above > below ? above : below;
    int bounded = fabs(mid) <= DBL_MAX && rad < DBL_MAX;
    j->slot[c].u.mid[0] = bounded ? mid : 0;
    j->slot[c].u.rad[0] = bounded ? rad : DBL_MAX;
  }
}

static jets *lay(pool *p, const jets *shape, const ambit_tape *t, uint8_t *need) {
  jets *j = take(p, sizeof *j);
  slot *s = take(p, t->nslot * sizeof *s);
  step *steps = take(p, t->ninstr * sizeof *steps);
  const step **moving = take(p, t->ninstr * sizeof(step *));
  if (p->base) *j = *shape, j->slot = s, j->step = steps, j->moving = moving;
  slot scratch = { .varies = 1 };
  if (p->base) trace(t, s);
  for (uint32_t i = 0; i < t->nslot; i++) {
    slot *at = p->base ? &s[i] : &scratch;
    at->degree = t->degree[i];
    lay_slot(p, shape, at, need[i]);
  }
  return j;
}

ambit_status jets_open(const ambit_host *h, void *ctx, const ambit_tape *t, uint32_t order, uint32_t ndir,
    const void *centre, uint32_t width, void **self) {
  ambit_status status = check(h, t);
  if (status) return status;
  uint32_t blocks = (ndir + width - 1) / width;
  jets shape = { .num = ((interval_context *)ctx)->num,
    .meter = ((interval_context *)ctx)->meter,
    .order = order,
    .ndir = ndir,
    .width = width,
    .blocks = blocks,
    .nslot = t->nslot,
    .nsource = t->nconst + t->nin,
    .nin = t->nin,
    .centre = centre,
    .failed = order + 1 };
  if (shape.centre && (shape.centre->nslot != t->nslot || shape.centre->order < order))
    return h->fail(h, AMBIT_INVALID, "interval: the centre's series are of another tape or a lower order");
  uint8_t *need = h->alloc(h, t->nslot);
  if (!need) return h->fail(h, AMBIT_NOMEM, "interval: out of memory");
  for (uint32_t i = 0; i < t->ninstr; i++) mark(need, t, i);
  pool measure = { 0 };
  lay(&measure, &shape, t, need);
  pool real = { h->alloc(h, measure.used), 0 };
  if (!real.base) return h->fail(h, AMBIT_NOMEM, "interval: out of memory for %zu bytes of series", measure.used);
  jets *j = lay(&real, &shape, t, need);
  for (uint32_t i = 0; i < t->ninstr; i++) write_step(j, t, i);
  ambit_rounding old = ambit_round_up();
  write_constants(j, t);
  ambit_rounding_restore(old);
  *self = j;
  return AMBIT_OK;
}

void jets_close(void *self) { (void)self; } /* the memory belongs to the host object */
