/* implicit.c -- M_0 column by column, its factors L U in the order of pivots, and the solution at one order.
**
** All of it is arithmetic in the ring of rows, where the inverse of a row with a constant part is exact: what is left
** of R_k is rounding only.
*/
#include "implicit.h"

static double *at(const zono *z, double *rows, size_t n) { return rows + n * z->shape.stride; }
static uint32_t stage_start(const zono *z, uint32_t stage) { return stage ? z->program.stage_end[stage - 1] : 0; }
static uint32_t stage_size(const zono *z, uint32_t stage) {
  return z->program.stage_end[stage] - stage_start(z, stage);
}
static double *entry(const zono *z, uint32_t stage, uint32_t row, uint32_t column) {
  const implicit *m = z->implicit;
  return at(z, m->factor, m->stage_at[stage] + (size_t)row * stage_size(z, stage) + column);
}
static double *inverse_of(const zono *z, uint32_t stage, uint32_t q) {
  return at(z, z->implicit->inverse, stage_start(z, stage) + q);
}

/* -- memory */

static uint32_t count_partials(zono *z) {
  const program *p = &z->program;
  uint32_t n = 0;
  for (uint32_t i = 0; i < p->tape->ninstr; i++) {
    uint32_t dst = p->tape->dst[i];
    if (p->tape->op[i] == AMBIT_OP_MUL && p->level[dst] && p->needed[dst]) z->implicit->has_partial[i] = ++n;
  }
  return n;
}

int zono_open_implicit(zono *z) {
  const ambit_host *h = z->host;
  const program *p = &z->program;
  size_t row = z->shape.stride * sizeof(double), squares = 0;
  implicit *m = z->implicit = h->alloc(h, sizeof *m);
  if (!m) return 0;
  m->has_partial = h->alloc(h, (p->tape->ninstr + 1u) * sizeof *m->has_partial);
  m->changed = h->alloc(h, (z->nslot + 1u) * sizeof *m->changed);
  m->stage_at = h->alloc(h, (p->nstage + 1u) * sizeof *m->stage_at);
  if (!m->has_partial || !m->changed || !m->stage_at) return 0;
  for (uint32_t s = 0; s < p->nstage; s++) {
    m->stage_at[s] = squares;
    squares += (size_t)stage_size(z, s) * stage_size(z, s);
  }
  m->partial = h->alloc(h, (count_partials(z) + 1u) * row), m->change = h->alloc(h, (z->nslot + 1u) * row);
  m->factor = h->alloc(h, (squares + 1) * row);
  m->inverse = h->alloc(h, (z->na + 1u) * row), m->y = h->alloc(h, (z->na + 1u) * row);
  return m->partial && m->change && m->factor && m->inverse && m->y;
}

/* -- M_0 */

/* the change of instruction i's result by the unknown that changed its operands; 0: it is not affine */
static int change(zono *z, uint32_t i, uint32_t stamp) {
  const ambit_tape *t = z->program.tape;
  const shape *s = &z->shape;
  implicit *m = z->implicit;
  uint32_t a = t->a[i], b = t->b[i], dst = t->dst[i];
  int of_a = m->changed[a] == stamp, of_b = t->op[i] != AMBIT_OP_NEG && m->changed[b] == stamp;
  if (!of_a && !of_b) return 1;
  const double *da = at(z, m->change, a), *db = at(z, m->change, b);
  terms sum;
  terms_clear(&sum);
  switch (t->op[i]) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
    if (of_a) terms_row(s, &sum, 1, da);
    if (of_b) terms_row(s, &sum, t->op[i] == AMBIT_OP_ADD ? 1 : -1, db);
    break;
  case AMBIT_OP_NEG: terms_row(s, &sum, -1, da); break;
  case AMBIT_OP_MUL:
    if (of_a && of_b) return 0;
    terms_product(s, &sum, 1, of_a ? da : db, row_at(z, of_a ? b : a, 0));
    break;
  case AMBIT_OP_DIV:
    if (of_b) return 0;
    terms_product(s, &sum, 1, da, inverse_at(z, i));
    break;
  default: return 0;
  }
  terms_sum(s, &sum, at(z, m->change, dst), row_parts(s, 0));
  m->changed[dst] = stamp;
  return 1;
}

/* column `column` (in the order of pivots) of M_0 */
static int find_column(zono *z, uint32_t stage, uint32_t column) {
  const program *p = &z->program;
  implicit *m = z->implicit;
  uint32_t start = stage_start(z, stage), unknown = p->pivot[start + column], stamp = unknown + 1;
  m->changed[slot_a(z, unknown)] = stamp;
  row_constant(&z->shape, at(z, m->change, slot_a(z, unknown)), 1);
  for (uint32_t n = p->of_level[stage + 1]; n < p->of_level[stage + 2]; n++) {
    uint32_t i = p->sorted[n];
    if (p->needed[p->tape->dst[i]] && !change(z, i, stamp)) {
      z->why = WHY_PIVOT, z->blamed = unknown;
      return 0;
    }
  }
  for (uint32_t r = 0; r < stage_size(z, stage); r++) {
    uint32_t slot = slot_out(z)[z->nx + p->pivot[start + r]];
    const double *from = m->changed[slot] == stamp ? at(z, m->change, slot) : z->zero;
    memcpy(entry(z, stage, r, column), from, z->shape.stride * sizeof(double));
  }
  return 1;
}

/* -- factors */

/* `to` - sum_{q < n} L_rq U_qc */
static void subtract(const zono *z, uint32_t stage, uint32_t r, uint32_t c, uint32_t n) {
  const shape *s = &z->shape;
  double *to = entry(z, stage, r, c);
  terms sum;
  terms_clear(&sum);
  for (uint32_t q = 0; q < n; q++) {
    const double *l = entry(z, stage, r, q), *u = entry(z, stage, q, c);
    if (row_total(s, l) > 0 && row_total(s, u) > 0) terms_product(s, &sum, -1, l, u);
  }
  if (!sum.nrow && !sum.nouter && sum.c == 0 && sum.low == 0) return;
  terms_row(s, &sum, 1, to);
  terms_sum(s, &sum, z->scratch, row_parts(s, 0));
  memcpy(to, z->scratch, s->stride * sizeof *to);
}

static int eliminate(zono *z, uint32_t stage, uint32_t q) {
  const shape *s = &z->shape;
  uint32_t n = stage_size(z, stage);
  for (uint32_t c = q; c < n; c++) subtract(z, stage, q, c, q);
  double *pivot = entry(z, stage, q, q), *inverse = inverse_of(z, stage, q);
  if (!(fabs(pivot[0]) > 0 && fabs(pivot[0]) < 1e200 && fabs(1 / pivot[0]) < 1e200)) {
    z->why = WHY_PIVOT, z->blamed = z->program.pivot[stage_start(z, stage) + q];
    return 0;
  }
  row_inverse(s, inverse, pivot);
  for (uint32_t r = q + 1; r < n; r++) {
    subtract(z, stage, r, q, q);
    double *l = entry(z, stage, r, q);
    terms sum;
    terms_clear(&sum);
    if (row_total(s, l) > 0) terms_product(s, &sum, 1, l, inverse);
    terms_sum(s, &sum, z->scratch, row_parts(s, 0));
    memcpy(l, z->scratch, s->stride * sizeof *l);
  }
  return 1;
}

int zono_factor(zono *z, uint32_t stage) {
  memset(z->implicit->changed, 0, z->nslot * sizeof *z->implicit->changed);
  for (uint32_t c = 0; c < stage_size(z, stage); c++)
    if (!find_column(z, stage, c)) return 0;
  for (uint32_t q = 0; q < stage_size(z, stage); q++)
    if (!eliminate(z, stage, q)) return 0;
  return 1;
}

/* -- the solution */

static void add_to(const zono *z, double *to, const double *x, uint32_t parts) {
  const shape *s = &z->shape;
  terms sum;
  terms_clear(&sum);
  terms_row(s, &sum, 1, to), terms_row(s, &sum, 1, x);
  terms_sum(s, &sum, z->scratch, parts);
  memcpy(to, z->scratch, (parts & (s->lean ? ERRORS : TRIPLES) ? s->stride : s->cube) * sizeof *to);
}

void zono_solve(zono *z, uint32_t stage, uint32_t k) {
  const program *p = &z->program;
  const shape *s = &z->shape;
  uint32_t n = stage_size(z, stage), start = stage_start(z, stage);
  terms sum;
  for (uint32_t r = 0; r < n; r++) {
    terms_clear(&sum);
    terms_row(s, &sum, -1, coefficient(z, slot_out(z)[z->nx + p->pivot[start + r]], k));
    for (uint32_t q = 0; q < r; q++) {
      const double *l = entry(z, stage, r, q);
      if (row_total(s, l) > 0) terms_product(s, &sum, -1, l, at(z, z->implicit->y, q));
    }
    terms_sum(s, &sum, at(z, z->implicit->y, r), row_parts(&z->shape, k));
  }
  for (uint32_t r = n; r-- > 0;) {
    terms_clear(&sum);
    terms_row(s, &sum, 1, at(z, z->implicit->y, r));
    for (uint32_t q = r + 1; q < n; q++) {
      const double *u = entry(z, stage, r, q);
      if (row_total(s, u) > 0) terms_product(s, &sum, -1, u, at(z, z->implicit->y, q));
    }
    terms_sum(s, &sum, z->scratch, row_parts(&z->shape, k));
    terms_clear(&sum);
    terms_product(s, &sum, 1, z->scratch, inverse_of(z, stage, r));
    terms_sum(s, &sum, at(z, z->implicit->y, r), row_parts(&z->shape, k));
    add_to(z, row_at(z, slot_a(z, p->pivot[start + r]), k), at(z, z->implicit->y, r), row_parts(&z->shape, k));
  }
}
