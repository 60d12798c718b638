/* piece.c -- a solver on a part of the data, its steps gathered between the instants of the problem. */
#include "verbs/split/piece.h"
#include "graph/hull.h"
#include "verbs/run/allocation.h"
#include "verbs/run/context.h"
#include "verbs/run/pair.h"
#include "verbs/run/tally.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* -- steps */

static void begin_interval(ambit_piece *p) {
  ambit_merge_part *part = &p->part;
  part->flags = part->order = 0;
  part->has_tube = true;
  for (uint32_t i = 0; i < p->problem.nx; i++) {
    part->tube_lo[i] = INFINITY;
    part->tube_hi[i] = -INFINITY;
  }
}

static void add_step(ambit_piece *p, const ambit_record *r) {
  ambit_merge_part *part = &p->part;
  part->flags |= r->flags;
  if (r->order > part->order) part->order = r->order;
  part->has_tube = part->has_tube && r->tube_lo && r->tube_hi;
  for (uint32_t i = 0; part->has_tube && i < r->nx; i++) {
    if (r->tube_lo[i] < part->tube_lo[i]) part->tube_lo[i] = r->tube_lo[i];
    if (r->tube_hi[i] > part->tube_hi[i]) part->tube_hi[i] = r->tube_hi[i];
  }
}

static void end_interval(ambit_piece *p, const ambit_record *r) {
  memcpy(p->part.lo, r->lo, r->nx * sizeof *r->lo);
  memcpy(p->part.hi, r->hi, r->nx * sizeof *r->hi);
  ambit_merge_put(p->merge, p->completed++, &p->part);
  begin_interval(p);
}

static bool is_too_much(const ambit_piece *p) {
  return p->allowed > 0 && p->scope && (double)ambit_scope_work(p->scope).operations > p->allowed;
}

static int32_t go_on(ambit_piece *p) {
  p->spent = p->spent || is_too_much(p);
  if (p->look(p->user) || p->spent || ambit_merge_is_over(p->merge, p->number, p->completed)) p->over = true;
  return p->over;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  ambit_piece *p = (ambit_piece *)(void *)s;
  const ambit_problem *q = &p->problem;
  if (r->kind != AMBIT_REC_STEP || p->completed + 1 >= q->ntime) return 0;
  double next = q->time[p->completed + 1];
  add_step(p, r);
  if (r->t_to == next)
    end_interval(p, r);
  else
    p->skipped = (r->t_to > next) == (next > q->time[p->completed]);
  return go_on(p) || p->skipped;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  (void)done, (void)message;
  return go_on((ambit_piece *)(void *)s);
}

/* -- data */

ambit_status ambit_piece_prepare(ambit_piece *p, const ambit_split *s, ambit_context *context, ambit_arena *arena) {
  const ambit_problem *whole = s->problem;
  uint32_t nx = whole->nx, n = nx + whole->np, nu = whole->nu;
  double *room = ambit_arena_alloc(arena, (2u * nu + 2u * n + 4u * nx) * sizeof *room);
  p->u = ambit_arena_alloc(arena, (nu + 1u) * sizeof *p->u);
  p->slot = ambit_arena_alloc(arena, s->initial->nslot * sizeof *p->slot);
  if (!room || !p->u || !p->slot) return AMBIT_NOMEM;
  double **array[] = { &p->u_lo, &p->u_hi, &p->x_lo, &p->x_hi, &p->part.lo, &p->part.hi, &p->part.tube_lo,
    &p->part.tube_hi };
  const uint32_t length[] = { nu, nu, n, n, nx, nx, nx, nx };
  for (size_t i = 0; i < sizeof length / sizeof *length; room += length[i++]) *array[i] = room;
  p->sink = (ambit_sink) { sizeof(ambit_sink), emit, progress };
  p->split = s;
  p->problem = *whole;
  p->problem.extras = 0; /* a union is neither a polynomial nor a set over the unknowns */
  p->context = context;
  p->problem.nworker = 1;
  if (p->problem.worker) p->problem.worker = &p->problem.actx;
  p->problem.u_lo = p->u_lo;
  p->problem.u_hi = p->u_hi;
  p->problem.x0_lo = p->x_lo;
  p->problem.x0_hi = p->x_hi;
  p->problem.p_lo = p->x_lo + nx;
  p->problem.p_hi = p->x_hi + nx;
  return AMBIT_OK;
}

static void narrow(ambit_piece *p) {
  const ambit_split *s = p->split;
  ambit_pieces_range(s->pieces, p->number, p->u_lo, p->u_hi);
  for (uint32_t j = 0; j < p->problem.nu; j++) p->u[j] = (ambit_interval) { p->u_lo[j], p->u_hi[j] };
  ambit_hull(s->initial, p->u, p->slot);
  for (uint32_t i = 0; i < s->initial->nout; i++) {
    p->x_lo[i] = p->slot[s->initial->out[i]].lo;
    p->x_hi[i] = p->slot[s->initial->out[i]].hi;
  }
}

/* -- messages */

/* The range of a datum as the user knows it: that of the state or parameter of its name, if it has one. */
static ambit_interval range_of(const ambit_piece *p, uint32_t j) {
  const char *name = p->split->unknown[j];
  for (uint32_t i = 0; name && i < p->problem.nx + p->problem.np; i++)
    if (strcmp(p->problem.name[i], name) == 0) return (ambit_interval) { p->x_lo[i], p->x_hi[i] };
  return (ambit_interval) { p->u_lo[j], p->u_hi[j] };
}

/* "piece 3 of 16 (beta1 in [2.33, 2.34]): why" */
static void tell_where(const ambit_piece *p, const char *why, char text[AMBIT_MESSAGE_MAX]) {
  const ambit_pieces *all = p->split->pieces;
  size_t room = AMBIT_MESSAGE_MAX / 2, used = 0; /* the other half is for the reason */
  used = (size_t)snprintf(text, room, "piece %u of %u", p->number + 1, all->count);
  const char *separator = " (";
  for (uint32_t j = 0; j < all->nu && used < room; j++) {
    char number[24];
    snprintf(number, sizeof number, "datum %u", j + 1);
    if (p->u_lo[j] == p->split->problem->u_lo[j] && p->u_hi[j] == p->split->problem->u_hi[j]) continue;
    const char *name = p->split->unknown[j] ? p->split->unknown[j] : number;
    ambit_interval x = range_of(p, j);
    used += (size_t)snprintf(text + used, room - used, "%s%s in [%.9g, %.9g]", separator, name, x.lo, x.hi);
    separator = ", ";
  }
  if (used >= room) used = room - 1;
  used += (size_t)snprintf(text + used, AMBIT_MESSAGE_MAX - used, "%s: ", *separator == ',' ? ")" : "");
  strncat(text, why, AMBIT_MESSAGE_MAX - used - 1);
}

static void report_failure(ambit_piece *p, const ambit_failure *why) {
  ambit_failure told = *why;
  tell_where(p, why->message, told.message);
  if (told.status == AMBIT_DOMAIN && p->problem.ninvariant)
    ambit_merge_put_nothing(p->merge, p->number, p->completed, &told); /* no state of it satisfies the constraints */
  else
    ambit_merge_fail(p->merge, p->number, p->completed, &told);
}

/* -- the run */

static ambit_status run(ambit_piece *p, ambit_scope *scope) {
  const ambit_split *s = p->split;
  void *self = NULL;
  ambit_failure why;
  ambit_stage_enter("open", AMBIT_FRAME_SOLVER, s->solver_name);
  ambit_status status = s->solver->open(&scope->host, &p->problem, s->option, &self);
  ambit_stage_leave();
  if (status != AMBIT_OK) {
    ambit_guard_explain(status, s->solver_name, &scope->failure, "could not start and gave no reason", &why);
    report_failure(p, &why);
    return status == AMBIT_UNABLE || status == AMBIT_DOMAIN ? AMBIT_OK : status;
  }
  ambit_guard g = ambit_guard_make(&p->problem, &p->sink);
  ambit_tally tally = { 0 };
  ambit_tally_run(&tally, scope, 1, p->context);
  ambit_stage_enter("run", AMBIT_FRAME_SOLVER, s->solver_name);
  ambit_status said = s->solver->run(self, &g.sink);
  ambit_stage_leave();
  ambit_allocation_forbid(0);
  ambit_tally_ran(&tally, scope, 1, p->context);
  ambit_work_add(&p->work, &tally.work);
  s->solver->close(self);
  status = ambit_guard_judge(&g, said, s->solver_name, &scope->failure, &why);
  if (p->skipped) {
    ambit_failure_clear(&why);
    status = ambit_fail_code(&why, AMBIT_BROKEN, AMBIT_CODE_BROKEN_TIME,
        "the solver is broken: it stepped over an instant that was asked for");
  }
  bool cut_off = p->spent && status != AMBIT_BROKEN && !ambit_merge_is_complete(p->merge);
  if (cut_off) {
    ambit_failure_clear(&why);
    status = ambit_fail_code(&why, AMBIT_UNABLE, AMBIT_CODE_UNABLE_SHORT_STEPS,
        "the work that cutting the data may take was done before they had been followed whole");
  }
  if (status != AMBIT_OK && (p->skipped || cut_off || !p->over)) report_failure(p, &why);
  return AMBIT_OK;
}

ambit_status ambit_piece_run(ambit_piece *p, const ambit_split *s, ambit_merge *merge, uint32_t number,
    int32_t (*look)(void *user), void *user) {
  ambit_scope *scope;
  ambit_failure f = { 0 };
  ambit_allocation_forbid(0);
  p->merge = merge;
  p->number = number;
  p->completed = 0;
  p->over = p->skipped = p->spent = false;
  p->scope = NULL;
  p->done = 0;
  p->look = look;
  p->user = user;
  if (go_on(p)) return AMBIT_OK;
  narrow(p);
  begin_interval(p);
  ambit_status status = ambit_context_renew(s->registry, p->context, &f);
  p->problem.actx = p->context->ctx;
  if (status == AMBIT_OK) status = ambit_context_scope(s->registry, &scope, &f);
  if (status != AMBIT_OK) {
    report_failure(p, &f);
    return status;
  }
  p->scope = scope;
  status = run(p, scope);
  p->scope = NULL;
  ambit_work work = ambit_scope_work(scope);
  p->done = work.operations;
  ambit_work_add(&p->work, &work);
  ambit_scope_close(scope);
  return status;
}
