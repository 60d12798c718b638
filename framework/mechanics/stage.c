/* stage.c -- one stage of the articulated-body method: I, p, S, B, E and e are read off its formulas, its speeds are
** eliminated, the rest is handed on (articulated.c has the equations).
*/
#include "mechanics/stage.h"
#include "mechanics/factor.h"
#include "mechanics/pivot.h"

static ambit_expr op(const ambit_tree *t, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(t->g, code, a, b);
}

static ambit_status read_affine(const ambit_tree *t, const ambit_stage *s, size_t ne, const ambit_expr *e, size_t n,
    const ambit_expr *symbol, ambit_expr *coefficient, ambit_expr *constant) {
  ambit_status status = ambit_affine_in(t->affine, ne, e, n, symbol, coefficient, constant);
  if (status == AMBIT_NOMEM) return ambit_no_memory(t->f);
  return status == AMBIT_OK
             ? status
             : ambit_stage_misfit(t, s, "its forces depend on accelerations in another way than linearly");
}

typedef struct joint {
  const ambit_tree *t;
  ambit_stage *s;
  ambit_expr inertia[6][6], bias[6];                                     /* I, p */
  ambit_expr on[AMBIT_STAGE_DOF * 6];                                    /* B by rows */
  ambit_expr own[AMBIT_STAGE_DOF * AMBIT_STAGE_DOF], e[AMBIT_STAGE_DOF]; /* E, e */
  ambit_expr felt[AMBIT_STAGE_DOF * 6];                                  /* B I by rows */
  ambit_expr pull[6][AMBIT_STAGE_DOF];                                   /* I S */
} joint;

static ambit_status read_inertia(joint *j) {
  const ambit_tree *t = j->t;
  ambit_expr wrench[6], slope[36], rest[6];
  ambit_status status = ambit_stage_pull(t, ambit_stage_frame(j->s), AMBIT_WRENCH, 6, wrench);
  if (status == AMBIT_OK) status = read_affine(t, j->s, 6, wrench, 6, j->s->symbol, slope, rest);
  for (size_t i = 0; status == AMBIT_OK && i < 6; i++) {
    j->bias[i] = op(t, AMBIT_OP_NEG, rest[i], 0);
    for (size_t k = i; k < 6; k++) j->inertia[i][k] = j->inertia[k][i] = op(t, AMBIT_OP_NEG, slope[6 * i + k], 0);
  }
  return status;
}

/* Splits the acceleration into a and S. */
static ambit_status read_motion(joint *j) {
  ambit_stage *s = j->s;
  ambit_expr du[AMBIT_STAGE_DOF], rest[6];
  for (size_t k = 0; k < s->d; k++) du[k] = j->t->v->du[s->speed[k]];
  ambit_status status = read_affine(j->t, s, 6, s->accel, s->d, du, s->along, rest);
  if (status == AMBIT_OK) memcpy(s->accel, rest, sizeof rest);
  return status;
}

/* The balances of the part's speeds, as functions of the wrench at its OUT frame. */
static ambit_status pull_balances(joint *j, ambit_expr *balance) {
  const ambit_tree *t = j->t;
  const ambit_element *e = t->m->part[j->s->part].element;
  ambit_status status = ambit_cut_give(t->cut, ambit_stage_frame(j->s), AMBIT_WRENCH, t->wrench, t->f);
  uint32_t first = 0;
  size_t k = 0;
  for (uint32_t i = 0; status == AMBIT_OK && i < e->nport; i++) {
    if (e->port[i].kind != AMBIT_PORT_JOINT || e->port[i].role != AMBIT_ROLE_OUT) continue;
    ambit_expr row[AMBIT_QUANTITY_MAX];
    uint32_t dof = ambit_port_dof(&e->port[i]);
    status = ambit_stage_pull(t, (ambit_frame) { j->s->part, i }, AMBIT_BALANCE, dof, row);
    for (uint32_t r = 0; status == AMBIT_OK && r < dof && k < j->s->d; r++)
      if (t->v->speed[j->s->speed[k]].index == first + r) balance[k++] = row[r];
    first += dof;
  }
  return status;
}

static ambit_status read_balances(joint *j) {
  const ambit_tree *t = j->t;
  size_t d = j->s->d, n = 6 + d;
  ambit_expr balance[AMBIT_STAGE_DOF], symbol[6 + AMBIT_STAGE_DOF], slope[AMBIT_STAGE_DOF * (6 + AMBIT_STAGE_DOF)];
  memcpy(symbol, t->wrench, sizeof t->wrench);
  for (size_t k = 0; k < d; k++) symbol[6 + k] = t->v->du[j->s->speed[k]];
  ambit_status status = pull_balances(j, balance);
  if (status == AMBIT_OK) status = read_affine(t, j->s, d, balance, n, symbol, slope, j->e);
  for (size_t r = 0; status == AMBIT_OK && r < d; r++) {
    memcpy(&j->on[6 * r], &slope[n * r], 6 * sizeof *slope);
    memcpy(&j->own[d * r], &slope[n * r + 6], d * sizeof *slope);
  }
  return status;
}

/* B I and I S */
static void project(joint *j) {
  const ambit_tree *t = j->t;
  for (size_t r = 0; r < j->s->d; r++)
    for (size_t i = 0; i < 6; i++) {
      ambit_expr felt = 0, load = 0;
      for (size_t k = 0; k < 6; k++) {
        felt = ambit_stage_plus(t, felt, j->on[6 * r + k], j->inertia[k][i]);
        load = ambit_stage_plus(t, load, j->inertia[i][k], j->s->along[j->s->d * k + r]);
      }
      j->felt[6 * r + i] = felt;
      j->pull[i][r] = load;
    }
}

typedef struct pivots {
  ambit_tree *t;
  const joint *j;
} pivots;

static ambit_status note_pivot(void *user, size_t k, ambit_expr pivot) {
  pivots *p = user;
  ambit_tree *t = p->t;
  const ambit_speed *speed = &t->v->speed[p->j->s->speed[k]];
  if (pivot == 0) return ambit_pivot_massless(speed, t->f);
  ambit_expr scale = 0;
  for (size_t i = 0; i < 6; i++) scale = op(t, AMBIT_OP_ADD, scale, p->j->inertia[i][i]);
  if (pivot == AMBIT_NO_EXPR || scale == AMBIT_NO_EXPR) return ambit_no_memory(t->f);
  t->pivot_speed[t->npivot] = *speed;
  t->pivot[t->npivot] = pivot;
  t->scale[t->npivot++] = scale;
  return AMBIT_OK;
}

/* Is column r of S the unit vector i, and does no u' act on the balances by itself? Then (I - I S K) S = 0 says that
** row and column i of the reduced inertia vanish.
*/
static bool is_freed(const joint *j, size_t r, size_t i) {
  size_t d = j->s->d;
  for (size_t k = 0; k < 6; k++) {
    ambit_expr e = j->s->along[d * k + r];
    if (k == i ? e != ambit_graph_number(j->t->g, 1) : e != 0) return false;
  }
  for (size_t k = 0; k < d; k++)
    if (j->own[d * k + r] != 0) return false;
  return true;
}

/* D := B I S - E */
static void write_mass(const joint *j, ambit_expr *mass) {
  const ambit_tree *t = j->t;
  size_t d = j->s->d;
  for (size_t r = 0; r < d; r++)
    for (size_t c = 0; c < d; c++) {
      ambit_expr sum = 0;
      for (size_t k = 0; k < 6; k++) sum = ambit_stage_plus(t, sum, j->felt[6 * r + k], j->s->along[d * k + c]);
      mass[d * r + c] = op(t, AMBIT_OP_SUB, sum, j->own[d * r + c]);
    }
}

/* x := D^-1 x; one degree of freedom: by the reciprocal of D, which all columns share. A zero stays one. */
static void divide(const ambit_factor *a, ambit_expr *x) {
  bool zero = true;
  for (size_t r = 0; r < a->n; r++) zero = zero && x[r] == 0;
  if (zero) return;
  if (a->n > 1)
    ambit_factor_solve(a, x);
  else
    x[0] = ambit_graph_op(
        a->g, AMBIT_OP_MUL, x[0], ambit_graph_op(a->g, AMBIT_OP_DIV, ambit_graph_number(a->g, 1), a->u[0]));
}

/* y and K. K S = D^-1 (D + E), so where column r of S is freed, that column of K is a unit vector. */
static ambit_status solve(ambit_tree *t, joint *j) {
  ambit_stage *s = j->s;
  size_t d = s->d;
  ambit_expr mass[AMBIT_STAGE_DOF * AMBIT_STAGE_DOF], x[AMBIT_STAGE_DOF] = { 0 };
  write_mass(j, mass);
  const ambit_factor a = { t->g, d, mass, 0 };
  ambit_status status = ambit_factorise(&a, note_pivot, &(pivots) { t, j });
  if (status != AMBIT_OK) return status;
  for (size_t i = 0; i < 6; i++) {
    size_t free = 0;
    while (free < d && !is_freed(j, free, i)) free++;
    for (size_t r = 0; r < d; r++) x[r] = j->felt[6 * r + i];
    if (free == d) divide(&a, x);
    for (size_t r = 0; r < d; r++) s->k[6 * r + i] = free == d ? x[r] : ambit_graph_number(t->g, r == free ? 1 : 0);
  }
  for (size_t r = 0; r < d; r++) {
    s->y[r] = t->applied ? op(t, AMBIT_OP_ADD, j->e[r], t->applied[s->speed[r]]) : j->e[r];
    for (size_t k = 0; k < 6; k++) s->y[r] = ambit_stage_minus(t, s->y[r], j->on[6 * r + k], j->bias[k]);
  }
  divide(&a, s->y);
  return AMBIT_OK;
}

/* I := I - I S K, p := p + I S y */
static void reduce(joint *j) {
  const ambit_tree *t = j->t;
  const ambit_stage *s = j->s;
  bool freed[6] = { false };
  for (size_t i = 0; i < 6; i++)
    for (size_t r = 0; r < s->d; r++) freed[i] = freed[i] || is_freed(j, r, i);
  for (size_t i = 0; i < 6; i++) {
    for (size_t r = 0; r < s->d; r++) j->bias[i] = ambit_stage_plus(t, j->bias[i], j->pull[i][r], s->y[r]);
    for (size_t k = i; k < 6; k++) {
      ambit_expr e = j->inertia[i][k];
      for (size_t r = 0; r < s->d; r++) e = ambit_stage_minus(t, e, j->pull[i][r], s->k[6 * r + k]);
      j->inertia[i][k] = j->inertia[k][i] = freed[i] || freed[k] ? 0 : e;
    }
  }
}

/* The element finds the reduced wrench at its OUT frame, to be carried on to the frame before. */
static ambit_status give_wrench(const joint *j) {
  const ambit_tree *t = j->t;
  ambit_expr wrench[6];
  for (size_t i = 0; i < 6; i++) {
    ambit_expr sum = j->bias[i];
    for (size_t k = 0; k < 6; k++) sum = ambit_stage_plus(t, sum, j->inertia[i][k], j->s->accel[k]);
    wrench[i] = op(t, AMBIT_OP_NEG, sum, 0);
    if (wrench[i] == AMBIT_NO_EXPR) return ambit_no_memory(t->f);
  }
  return ambit_cut_give(t->cut, ambit_stage_frame(j->s), AMBIT_WRENCH, wrench, t->f);
}

ambit_status ambit_stage_reduce(ambit_tree *t, ambit_stage *s) {
  joint j = { .t = t, .s = s };
  ambit_status status = read_inertia(&j);
  if (status == AMBIT_OK) status = read_motion(&j);
  if (status == AMBIT_OK && s->d > 0) {
    status = read_balances(&j);
    project(&j);
    if (status == AMBIT_OK) status = solve(t, &j);
  }
  if (status != AMBIT_OK || s->before == AMBIT_STAGE_ROOT) return status;
  reduce(&j);
  return give_wrench(&j);
}
