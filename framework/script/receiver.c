/* receiver.c -- records on their way from a solver to Lua and to JSON lines. */
#include "script/receiver.h"
#include "script/limit.h"
#include "script/request.h"
#include "verbs/run/context.h"
#include <math.h>
#include <stdio.h>

#define HOPELESS 20 /* times what a run has taken until now, that the rest of it would take */
#define STEADY 0.5  /* of what was covered in the time before: a run that covers less is getting stuck */

/* How long the rest will take, in parts of the time that `covered` took, for a run that is `faster` times as fast as in
** the interval before: it gets faster by as much in each further one, as a run from rest does, whose first steps are
** as short as its set is small. One that gets slower is taken to keep its pace. */
static double rest_of(double left, double covered, double faster) {
  if (!(faster > 1) || !(covered > 0)) return left / covered;
  return log1p(left * (1 - 1 / faster) / covered) / log(faster);
}

static bool is_hopeless(ambit_pace *p) {
  if (!(p->patience > 0) || !p->has_moved) return false; /* pieces write nothing until all have passed an instant */
  double spent = ambit_context_seconds() - p->began;
  if (!p->has_half && spent >= 0.5 * p->look) {
    p->t_half = p->t, p->has_half = true;
    if (spent >= p->look) p->look = 2 * spent; /* it has only just begun to move */
  }
  if (spent < p->look) return p->is_hopeless;
  double covered = fabs(p->t - p->t_half), left = fabs(p->last - p->t), before = fabs(p->t_half - p->t_quarter);
  double as_long = p->has_quarter ? 2 : 1; /* times as long as `before` */
  p->is_hopeless = rest_of(left, covered, covered / (as_long * before)) * 0.5 * p->look > HOPELESS * spent;
  p->look *= 2;
  p->t_quarter = p->t_half, p->has_quarter = true;
  p->t_half = p->t;
  return p->is_hopeless;
}

static bool is_overdue(ambit_pace *p) {
  if (!(p->due > 0) || p->is_overdue) return p->is_overdue;
  double spent = ambit_context_seconds() - p->began;
  if (!p->has_middle && spent >= 0.5 * p->due) p->t_middle = p->t, p->has_middle = true;
  if (spent < p->due) return false;
  double covered = fabs(p->t - p->t_middle), before = fabs(p->t_middle - p->first), left = fabs(p->last - p->t);
  p->is_overdue = !(covered > 0 && covered >= STEADY * before && 0.5 * left <= p->reach * covered);
  p->t_middle = p->t;
  p->due *= 2;
  return p->is_overdue;
}

static bool is_to_stop(ambit_receiver *r) {
  return is_hopeless(&r->pace) || is_overdue(&r->pace) || ambit_interrupt_pending() ||
         (r->deadline > 0 && ambit_context_seconds() >= r->deadline);
}

static int32_t emit(ambit_sink *s, const ambit_record *record) {
  ambit_receiver *r = (ambit_receiver *)(void *)s;
  if (r->failure.status != AMBIT_OK) return 1;
  r->pace.t = record->t_to, r->pace.has_moved = true;
  if (!ambit_track_append(r->track, record)) {
    ambit_fail(&r->failure, AMBIT_NOMEM, "out of memory for the records of this run");
    return 1;
  }
  if (r->records) {
    if (ambit_records_solver(r->records, record, r->name, &r->failure) != AMBIT_OK) return 1;
    ambit_limit_recorded(r->records);
  }
  return is_to_stop(r);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  ambit_receiver *r = (ambit_receiver *)(void *)s;
  if (!r->track) r->pace.t = done, r->pace.has_moved = true; /* of a silent receiver, the whole is 1 */
  ambit_progress_draw(&r->progress, done, message);
  return is_to_stop(r);
}

void ambit_receiver_prepared(void *user, size_t nu, const ambit_expr *unknown) {
  ambit_receiver *r = user;
  if (!ambit_held_set_begin(&r->track->set, r->graph, nu, unknown))
    ambit_fail(&r->failure, AMBIT_NOMEM, "out of memory for the records of this run");
}

ambit_receiver ambit_receiver_push(lua_State *L, size_t nx, const char *const *name, uint32_t keep) {
  return (ambit_receiver) { .sink = { sizeof(ambit_sink), emit, progress },
    .track = ambit_track_push(L, nx, keep),
    .graph = AMBIT_LUA(L)->graph,
    .records = AMBIT_LUA(L)->records,
    .name = name };
}

ambit_receiver ambit_receiver_silent(void) {
  return (ambit_receiver) { .sink = { sizeof(ambit_sink), NULL, progress }, .pace = { .last = 1 } };
}

void ambit_receiver_begin(lua_State *L, ambit_receiver *r) {
  ambit_progress_begin(&r->progress, AMBIT_LUA(L)->progress);
  ambit_interrupt_begin(&r->interrupt);
  r->deadline = AMBIT_LUA(L)->deadline;
  r->pace.began = ambit_context_seconds();
  r->pace.look = r->pace.patience;
  r->pace.t = r->pace.t_half = r->pace.t_quarter = r->pace.first;
}

void ambit_receiver_end(ambit_receiver *r) {
  ambit_interrupt_end(&r->interrupt);
  ambit_progress_end(&r->progress);
}

static const char *word_of(ambit_status status) {
  switch (status) {
  case AMBIT_OK: return "complete";
  case AMBIT_DOMAIN: return "impossible";
  case AMBIT_STOPPED: return "stopped";
  case AMBIT_BROKEN: return "broken";
  default: return "unable";
  }
}

void ambit_receiver_tell(
    lua_State *L, const ambit_receiver *r, ambit_status status, const char *code, const char *reason) {
  char whole[AMBIT_CODE_MAX], slow[128];
  bool own = r->failure.status != AMBIT_OK;
  if (own) status = AMBIT_STOPPED;
  if (!own && status == AMBIT_STOPPED && r->deadline > 0 && !ambit_interrupt_pending()) code = AMBIT_CODE_STOPPED_LIMIT;
  if (!own && status == AMBIT_STOPPED && (r->pace.is_hopeless || r->pace.is_overdue) && !ambit_interrupt_pending()) {
    status = AMBIT_UNABLE;
    code = AMBIT_CODE_UNABLE_SHORT_STEPS;
    snprintf(slow, sizeof slow, "at t = %.9g s steps are so short, or take so long, that the end is out of reach",
        r->pace.t);
    reason = slow;
  }
  ambit_code_set(whole, status, own ? AMBIT_CODE_STOPPED_WRITE : code);
  ambit_lua_set_text(L, "status", word_of(status));
  ambit_lua_set_text(L, "code", whole);
  ambit_lua_set_text(L, "reason", own ? r->failure.message : reason);
}
