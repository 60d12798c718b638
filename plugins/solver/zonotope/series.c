/* series.c -- phase 1: rows of all slots, order by order, instruction by instruction.
**
** At order k, slots that do not depend on the unknowns a come first. Then, stage by stage, the equations are evaluated
** with a_k = 0, solved for a_k, and everything that depends on it is made again: of a product, only the part that is
** new.
*/
#include "basis.h"
#include "implicit.h"
#include "kink.h"

/* -- one instruction */

/* terms of order k of a b, with (last) or without those that have order k of an operand that depends on stage
** `level` */
static void add_convolution(const zono *z, terms *sum, uint32_t a, uint32_t b, uint32_t k, uint32_t level, int inner) {
  const shape *s = &z->shape;
  int skip_a = !inner && z->program.level[a] == level, skip_b = !inner && z->program.level[b] == level;
  uint32_t na = orders(z, a), nb = orders(z, b);
  for (uint32_t j = 0; j <= k; j++) {
    if (j >= na || k - j >= nb || (skip_a && j == k) || (skip_b && j == 0)) continue;
    terms_product(s, sum, 1, row_at(z, a, j), row_at(z, b, k - j));
  }
}

static void add_square(const zono *z, terms *sum, uint32_t a, uint32_t k) {
  const shape *s = &z->shape;
  if (orders(z, a) <= k) return;
  for (uint32_t j = 0; 2 * j < k; j++) terms_product(s, sum, 2, row_at(z, a, j), row_at(z, a, k - j));
  if (k % 2 == 0) terms_product(s, sum, 1, row_at(z, a, k / 2), row_at(z, a, k / 2));
}

/* the part of a product that does not change when the unknowns of its stage are found */
static void put_partial(zono *z, uint32_t i, uint32_t k) {
  const ambit_tape *t = z->program.tape;
  terms sum;
  terms_clear(&sum);
  add_convolution(z, &sum, t->a[i], t->b[i], k, z->program.level[t->dst[i]], 0);
  terms_sum(&z->shape, &sum, implicit_partial(z, i), row_parts(&z->shape, k));
}

static void put_product(zono *z, uint32_t i, uint32_t k) {
  const ambit_tape *t = z->program.tape;
  uint32_t a = t->a[i], b = t->b[i], level = z->program.level[t->dst[i]];
  const shape *s = &z->shape;
  terms sum;
  terms_clear(&sum);
  double *partial = k ? implicit_partial(z, i) : NULL;
  if (!partial)
    add_convolution(z, &sum, a, b, k, level, 1);
  else {
    terms_row(s, &sum, 1, partial);
    if (z->program.level[a] == level) terms_product(s, &sum, 1, coefficient(z, a, k), row_at(z, b, 0));
    if (z->program.level[b] == level) terms_product(s, &sum, 1, row_at(z, a, 0), coefficient(z, b, k));
  }
  terms_sum(s, &sum, row_at(z, t->dst[i], k), row_parts(&z->shape, k));
}

static int evaluate(zono *z, uint32_t i, uint32_t k) {
  const ambit_tape *t = z->program.tape;
  const shape *s = &z->shape;
  uint32_t op = t->op[i], dst = t->dst[i];
  if (k > t->degree[dst]) return 1;
  if (op == AMBIT_OP_MUL) return put_product(z, i, k), 1;
  if (op == AMBIT_OP_TANH && k == 0) tanh_choose(z, i);
  if (is_line(z, i)) return kink_row(z, i, k), 1;
  terms sum;
  terms_clear(&sum);
  switch (op) {
  case AMBIT_OP_ADD:
    terms_row(s, &sum, 1, coefficient(z, t->a[i], k)), terms_row(s, &sum, 1, coefficient(z, t->b[i], k));
    break;
  case AMBIT_OP_SUB:
    terms_row(s, &sum, 1, coefficient(z, t->a[i], k)), terms_row(s, &sum, -1, coefficient(z, t->b[i], k));
    break;
  case AMBIT_OP_NEG: terms_row(s, &sum, -1, coefficient(z, t->a[i], k)); break;
  case AMBIT_OP_SQR: add_square(z, &sum, t->a[i], k); break;
  default: return k ? zono_function(z, i, k) : zono_function_order0(z, i);
  }
  terms_sum(s, &sum, row_at(z, dst, k), row_parts(&z->shape, k));
  return 1;
}

/* -- inputs */

static void put_errors(const zono *z, uint32_t i, double *x) {
  const shape *s = &z->shape;
  const basis *b = z->basis;
  x[s->eps + i] = x[s->norms + NORM_R] = z->E[i];
  if (!b || !b->is_turned) return;
  x[s->norms + NORM_R] = 0;
  for (uint32_t k = 0; k < z->nx; k++) {
    double c = b->columns[(size_t)i * z->nx + k];
    x[s->eps + k] = c, x[s->norms + NORM_R] += fabs(c);
  }
}

static void put_inputs(zono *z) {
  const ambit_tape *t = z->program.tape;
  const shape *s = &z->shape;
  for (uint32_t i = 0; i < t->nconst; i++) {
    row_constant(s, row_at(z, i, 0), z->constant[i].hi);
    row_at(z, i, 0)[s->norms + LOW] = z->constant[i].lo;
  }
  for (uint32_t i = 0; i < z->nx; i++) {
    double *x = row_at(z, slot_x(z, i), 0);
    memcpy(x, z->P + (size_t)i * s->stride, s->stride * sizeof *x);
    put_errors(z, i, x);
  }
  for (uint32_t i = 0; i < z->np; i++)
    row_over(s, row_at(z, slot_p(z, i), 0), 1, z->p_row + (size_t)i * s->stride, row_parts(s, 0));
  if (!z->program.uses_time) return;
  row_constant(s, row_at(z, slot_t(z), 0), z->t);
  if (z->K > 0) row_constant(s, row_at(z, slot_t(z), 1), 1);
}

static void integrate(zono *z, uint32_t k) {
  for (uint32_t i = 0; i < z->nx; i++)
    row_over(&z->shape, row_at(z, slot_x(z, i), k + 1), k + 1.0, coefficient(z, slot_out(z)[i], k),
        row_parts(&z->shape, k + 1));
}

/* -- stages */

static int undefined(zono *z, uint32_t slot) {
  z->why = WHY_UNDEFINED, z->blamed = slot;
  return 0;
}

enum pass { ALL, FIRST, AGAIN }; /* all of a level; what is needed to find the unknowns, with products anew or not */

static int evaluate_level(zono *z, uint32_t level, uint32_t k, enum pass pass) {
  const program *p = &z->program;
  for (uint32_t n = p->of_level[level]; n < p->of_level[level + 1]; n++) {
    uint32_t i = p->sorted[n];
    if (pass != ALL && !p->needed[p->tape->dst[i]]) continue;
    if (pass == FIRST && k && implicit_partial(z, i)) put_partial(z, i, k);
    if (!evaluate(z, i, k)) return undefined(z, p->tape->dst[i]);
  }
  return 1;
}

static int solve_stage(zono *z, uint32_t stage, uint32_t k, enum pass pass) {
  if (!evaluate_level(z, stage + 1, k, pass)) return 0;
  if (k == 0 && pass == FIRST && !zono_factor(z, stage)) return 0;
  zono_solve(z, stage, k);
  return 1;
}

static int find_without_triples(zono *z, uint32_t stage) {
  uint32_t cubed = z->shape.cubed;
  z->shape.cubed = 0;
  int found = solve_stage(z, stage, 0, FIRST);
  z->shape.cubed = cubed;
  return found;
}

static int find_unknowns(zono *z, uint32_t stage, uint32_t k) {
  const program *p = &z->program;
  for (uint32_t j = stage ? p->stage_end[stage - 1] : 0; j < p->stage_end[stage]; j++)
    row_constant(&z->shape, row_at(z, slot_a(z, j), k), 0);
  /* M_0 holds no triples. With unknowns that are right but for triples, what is left of the equations has nothing but
  ** triples, and M_0's constants are all that corrects them. */
  int cubed = row_parts(&z->shape, k) & TRIPLES;
  if (!(cubed && k == 0 ? find_without_triples(z, stage) : solve_stage(z, stage, k, FIRST))) return 0;
  if (cubed && !solve_stage(z, stage, k, AGAIN)) return 0;
  return evaluate_level(z, stage + 1, k, ALL);
}

int zono_series(zono *z) {
  put_inputs(z);
  for (uint32_t k = 0; k <= z->K; k++) {
    if (!evaluate_level(z, 0, k, ALL)) return 0;
    for (uint32_t stage = 0; stage < z->program.nstage; stage++)
      if (!find_unknowns(z, stage, k)) return 0;
    for (uint32_t i = 0; i < z->nout; i++)
      if (!(row_total(&z->shape, coefficient(z, slot_out(z)[i], k)) < 1e200)) return undefined(z, slot_out(z)[i]);
    if (k < z->K) integrate(z, k);
  }
  return 1;
}
