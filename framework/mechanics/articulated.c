/* articulated.c -- the articulated-body method, for any elements.
**
** Each element that carries motion on is a stage; its OUT frame gets six fresh symbols A for its acceleration, so that
** everything beyond hangs on them alone (cut.h). From the tips to the root, for each stage:
**
**   the wrench at the frame is                      -(I A + p)      I: 6 x 6, symmetric: the articulated inertia
**   the acceleration that the element writes is     a + S u'        a: a function of the A of the frame before
**   the balances that it writes are                 B w + E u' + e  w: the wrench, B = S^T for an ideal joint
**
** all read off the formulas (affine_in.h). The balances vanish, so with D = B I S - E
**
**   D u' = e + tau - B (I a + p),   u' = y - K a,   K = D^-1 B I,   y = D^-1 (e + tau - B p)
**
** and what the frame before feels is the wrench -((I - I S K) a + p + I S y), which the element then transports. From
** the root to the tips, u' and A become values. [Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 7]
**
** I is symmetric, so its upper triangle is all that is used. Every step is an identity where no pivot of D is 0.
*/
#include "mechanics/articulated.h"
#include "mechanics/pivot.h"
#include "mechanics/stage.h"

ambit_status ambit_stage_misfit(const ambit_tree *t, const ambit_stage *s, const char *why) {
  char who[AMBIT_WHO_MAX];
  return ambit_fail(t->f, AMBIT_INVALID, "the articulated-body form does not fit: %s: %s; use the form \"mass_matrix\"",
      ambit_part_who(&t->m->part[s->part], who), why);
}

/* -- the stages */

/* Does the element carry motion from one frame to another? */
static bool is_stage(const ambit_element *e, ambit_stage *s) {
  uint32_t in = 0, out = 0;
  for (uint32_t i = 0; i < e->nport; i++) {
    if (e->port[i].kind != AMBIT_PORT_FRAME) continue;
    if (e->port[i].role == AMBIT_ROLE_IN)
      in++, s->from = i;
    else
      out++, s->to = i;
  }
  return in == 1 && out == 1;
}

static ambit_status find_stages(ambit_tree *t) {
  t->stage = ambit_arena_alloc(t->arena, (t->m->count + 1) * sizeof *t->stage);
  if (!t->stage) return ambit_no_memory(t->f);
  for (uint32_t part = 0; part < t->m->count; part++) {
    ambit_stage s = { .part = part, .before = AMBIT_STAGE_ROOT };
    if (!is_stage(t->m->part[part].element, &s)) continue;
    for (uint32_t i = 0; i < t->m->part[part].dof; i++) {
      size_t k = ambit_variables_find(t->v, part, i);
      if (k == t->v->n) continue;
      if (s.d == AMBIT_STAGE_DOF) return ambit_stage_misfit(t, &s, "it has more than six degrees of freedom");
      s.speed[s.d++] = k;
    }
    t->stage[t->n++] = s;
  }
  return AMBIT_OK;
}

static ambit_expr fresh(const ambit_tree *t) { return ambit_graph_unknown(t->g, NULL, AMBIT_ENTIRE); }

static ambit_status make_symbols(ambit_tree *t) {
  size_t n = t->v->n, k = 0, all = n + 6 + 6 * (size_t)t->n;
  ambit_expr *list = ambit_expressions(t->arena, all);
  t->pivot = ambit_expressions(t->arena, n);
  t->scale = ambit_expressions(t->arena, n);
  t->pivot_speed = ambit_arena_alloc(t->arena, n * sizeof *t->pivot_speed);
  if (!list || !t->pivot || !t->scale || !t->pivot_speed) return ambit_no_memory(t->f);
  for (size_t i = 0; i < n; i++) list[k++] = t->v->du[i];
  for (size_t i = 0; i < 6; i++) list[k++] = t->wrench[i] = fresh(t);
  for (uint32_t j = 0; j < t->n; j++)
    for (size_t i = 0; i < 6; i++) list[k++] = t->stage[j].symbol[i] = fresh(t);
  for (size_t i = 0; i < k; i++)
    if (list[i] == AMBIT_NO_EXPR) return ambit_no_memory(t->f);
  t->affine = ambit_affine_open(t->g, k, list);
  return t->affine ? AMBIT_OK : ambit_no_memory(t->f);
}

/* The stage that carries this one: parts come after those that they are attached to. */
static uint32_t find_before(const ambit_tree *t, uint32_t j) {
  ambit_joined from = t->m->part[t->stage[j].part].joined[t->stage[j].from];
  uint32_t lo = 0, hi = j;
  while (lo < hi) {
    uint32_t mid = lo + (hi - lo) / 2;
    if (t->stage[mid].part < from.part)
      lo = mid + 1;
    else
      hi = mid;
  }
  bool found = lo < j && t->stage[lo].part == from.part && !t->stage[lo].known;
  return found ? lo : AMBIT_STAGE_ROOT;
}

/* A joint that follows speeds of others takes part in their balances, which this method does not see. */
static ambit_status check_joint(void *user, ambit_frame joint, uint32_t first, uint32_t dof) {
  ambit_tree *t = user;
  ambit_stage s = { .part = joint.part };
  const ambit_expr *rate = NULL;
  for (uint32_t k = 0; k < dof; k++) {
    if (ambit_variables_find(t->v, joint.part, first + k) < t->v->n) continue;
    rate = rate ? rate : ambit_mechanism_pull(t->m, joint, AMBIT_RATE, t->f);
    if (!rate) return AMBIT_INVALID;
    for (size_t i = 0; i < t->v->n && !ambit_graph_node(t->g, rate[k])->constant; i++)
      if (ambit_graph_derivative(t->g, rate[k], t->v->u[i], t->f) != 0)
        return ambit_stage_misfit(t, &s, "it follows other joints");
  }
  return AMBIT_OK;
}

/* I is symmetric where elements are ideal; what a law makes of accelerations need not be. */
static ambit_status check_laws(ambit_tree *t) {
  ambit_stage s = { .part = ambit_laws_find(t->m, t->affine) };
  return s.part == t->m->count ? AMBIT_OK : ambit_stage_misfit(t, &s, "its data depend on accelerations");
}

/* Accelerations from the root outwards, each as a function of the symbols of the frame before. */
static ambit_status pull_accelerations(ambit_tree *t) {
  ambit_status status = AMBIT_OK;
  for (uint32_t j = 0; status == AMBIT_OK && j < t->n; j++) {
    ambit_stage *s = &t->stage[j];
    status = ambit_stage_pull(t, ambit_stage_frame(s), AMBIT_ACCEL, 6, s->accel);
    if (status != AMBIT_OK) return status;
    s->before = find_before(t, j);
    s->known = !ambit_affine_varies(t->affine, 6, s->accel);
    if (!s->known) status = ambit_cut_give(t->cut, ambit_stage_frame(s), AMBIT_ACCEL, s->symbol, t->f);
  }
  return status;
}

/* -- from the root to the tips */

static ambit_status solve_outwards(ambit_tree *t, ambit_expr *du) {
  for (uint32_t j = 0; j < t->n; j++) {
    ambit_stage *s = &t->stage[j];
    if (s->known) continue;
    if (s->before != AMBIT_STAGE_ROOT) {
      const ambit_stage *before = &t->stage[s->before]; /* its accel holds values by now */
      if (ambit_affine_put(t->affine, 6, s->accel, 6, before->symbol, before->accel, s->accel) != AMBIT_OK)
        return ambit_no_memory(t->f);
    }
    for (size_t r = 0; r < s->d; r++) {
      ambit_expr x = s->y[r];
      for (size_t k = 0; k < 6; k++) x = ambit_stage_minus(t, x, s->k[6 * r + k], s->accel[k]);
      if (x == AMBIT_NO_EXPR) return ambit_no_memory(t->f);
      if (ambit_affine_varies(t->affine, 1, &x))
        return ambit_stage_misfit(t, s, "what acts on it depends on accelerations elsewhere");
      du[s->speed[r]] = x;
    }
    for (size_t k = 0; k < 6; k++)
      for (size_t r = 0; r < s->d; r++)
        s->accel[k] = ambit_stage_plus(t, s->accel[k], s->along[s->d * k + r], du[s->speed[r]]);
  }
  return AMBIT_OK;
}

static ambit_status run(ambit_tree *t, ambit_expr *du) {
  for (size_t i = 0; i < t->v->n; i++) du[i] = AMBIT_NO_EXPR;
  ambit_status status = find_stages(t);
  if (status == AMBIT_OK) status = ambit_joints_visit(t->m, check_joint, t);
  if (status == AMBIT_OK) status = make_symbols(t);
  if (status == AMBIT_OK) status = check_laws(t);
  if (status == AMBIT_OK) status = pull_accelerations(t);
  for (uint32_t j = t->n; status == AMBIT_OK && j-- > 0;)
    if (!t->stage[j].known) status = ambit_stage_reduce(t, &t->stage[j]);
  if (status == AMBIT_OK) status = ambit_pivots_check(t->g, t->npivot, t->pivot_speed, t->pivot, t->scale, t->f);
  if (status == AMBIT_OK) status = solve_outwards(t, du);
  for (size_t i = 0; status == AMBIT_OK && i < t->v->n; i++) {
    ambit_stage s = { .part = t->v->speed[i].part };
    if (du[i] == AMBIT_NO_EXPR) status = ambit_stage_misfit(t, &s, "it has several frames");
  }
  return status;
}

ambit_status ambit_articulated_accelerations(
    ambit_mechanism *m, const ambit_variables *v, const ambit_expr *applied, ambit_expr *du, ambit_failure *f) {
  ambit_tree t = { .m = m, .g = ambit_mechanism_graph(m), .v = v, .applied = applied, .f = f };
  t.arena = ambit_arena_open();
  t.cut = t.arena ? ambit_cut_open(m) : NULL;
  ambit_status status = t.cut ? run(&t, du) : ambit_no_memory(f);
  ambit_cut_close(t.cut);
  ambit_affine_close(t.affine);
  ambit_arena_close(t.arena);
  return status;
}
