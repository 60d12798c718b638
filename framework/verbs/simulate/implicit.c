/* implicit.c -- sealing the implicit form, and the proof that it is one: by the rules for sums, products and quotients
** no instruction can be of a higher degree in the unknowns of a stage than is promised.
*/
#include "verbs/simulate/implicit.h"
#include "graph/tape.h"
#include <string.h>

/* Degree in the unknowns of one stage: 0, 1, or 2 for everything that is not affine. */
static uint8_t degree_of(const ambit_tape *t, uint32_t i, const uint8_t *degree) {
  uint8_t a = degree[t->a[i]], b = t->op[i] == AMBIT_OP_POWN ? 0 : degree[t->b[i]], sum = (uint8_t)(a + b);
  switch (t->op[i]) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_NEG: return a > b ? a : b;
  case AMBIT_OP_MUL: return sum < 2 ? sum : 2;
  case AMBIT_OP_DIV: return b ? 2 : a;
  default: return sum ? 2 : 0;
  }
}

/* The most that outputs [first, end) may be of. */
static bool is_within(const ambit_tape *t, const uint8_t *degree, uint32_t first, uint32_t end, uint8_t most) {
  for (uint32_t i = first; i < end; i++)
    if (degree[t->out[i]] > most) return false;
  return true;
}

/* F and the equations from this stage on are affine in its unknowns; those before do not depend on them. */
static bool is_staged(const ambit_implicit *p, uint32_t nx, uint32_t stage, uint8_t *degree) {
  const ambit_tape *t = p->tape;
  uint32_t first = stage ? p->stage_end[stage - 1] : 0, end = p->stage_end[stage];
  memset(degree, 0, t->nslot);
  memset(degree + t->nconst + nx + first, 1, end - first);
  for (uint32_t i = 0; i < t->ninstr; i++) degree[t->dst[i]] = degree_of(t, i, degree);
  return is_within(t, degree, 0, nx, 1) && is_within(t, degree, nx, nx + first, 0) &&
         is_within(t, degree, nx + first, nx + end, 1);
}

static ambit_status check(const ambit_implicit *p, uint32_t nx, ambit_arena *arena, ambit_failure *f) {
  uint8_t *degree = ambit_arena_alloc(arena, p->tape->nslot + 1u);
  if (!degree) return ambit_no_memory(f);
  for (uint32_t s = 0; s < p->nstage; s++)
    if (!is_staged(p, nx, s, degree))
      return ambit_fail(f, AMBIT_INVALID,
          "the equations are not linear in their accelerations, dependent speeds and multipliers: choose a solver that "
          "takes x' = f(x, t)");
  return AMBIT_OK;
}

/* Stages follow each other up to the last unknown, and each eliminates its own. */
static bool is_ordered(const ambit_implicit_form *form) {
  size_t first = 0;
  for (size_t s = 0; s < form->nstage; s++) {
    if (form->stage_end[s] <= first || form->stage_end[s] > form->na) return false;
    for (size_t k = first; k < form->stage_end[s]; k++)
      if (form->pivot[k] < first || form->pivot[k] >= form->stage_end[s]) return false;
    first = form->stage_end[s];
  }
  return first == form->na;
}

/* x, a, p, t */
static ambit_expr *inputs(const ambit_implicit_request *q, size_t na, ambit_arena *arena) {
  ambit_expr *in = ambit_arena_alloc(arena, (q->nx + na + q->np + 1) * sizeof *in);
  if (!in) return NULL;
  memcpy(in, q->input, q->nx * sizeof *in);
  if (na) memcpy(in + q->nx, q->form->unknown, na * sizeof *in);
  memcpy(in + q->nx + na, q->input + q->nx, ((size_t)q->np + q->uses_time) * sizeof *in);
  return in;
}

ambit_status ambit_implicit_seal(
    const ambit_implicit_request *q, ambit_arena *arena, const ambit_implicit **implicit, ambit_failure *f) {
  size_t na = q->form ? q->form->na : 0, nstage = q->form ? q->form->nstage : 0;
  if (na && !is_ordered(q->form))
    return ambit_fail(f, AMBIT_INVALID, "the stages of the implicit form do not fit its unknowns");
  ambit_implicit *p = ambit_arena_alloc(arena, sizeof *p);
  uint32_t *number = ambit_arena_alloc(arena, (na + nstage + 1) * sizeof *number);
  ambit_expr *in = inputs(q, na, arena);
  if (!p || !number || !in) return ambit_no_memory(f);
  *p = (ambit_implicit) {
    .size = sizeof *p, .na = (uint32_t)na, .nstage = (uint32_t)nstage, .stage_end = number, .pivot = number + nstage
  };
  if (na) memcpy(number, q->form->stage_end, nstage * sizeof *number);
  if (na) memcpy(number + nstage, q->form->pivot, na * sizeof *number);
  ambit_status status = ambit_tape_seal(q->graph, arena, q->nx + na, q->e, q->nx + na + q->np + q->uses_time, in,
      q->nx + na, AMBIT_TAPE_SERIES | q->seal, &p->tape, f);
  *implicit = p;
  return status == AMBIT_OK ? check(p, q->nx, arena, f) : status;
}
