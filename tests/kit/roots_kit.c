/* roots_kit.c -- searches, and what was reported against what is there. */
#include "kit/roots_kit.h"
#include "kit/conduct.h"
#include "kit/roots_kit_systems.h"
#include <ambit/roots.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BOXES = 2048, MESSAGES = 5, PATIENCE = 2000 }; /* calls of progress, then a search is too long for the kit */

typedef struct search {
  ambit_sink sink; /* first */
  roots_kit *kit;
  const roots_system *s;
  uint32_t count, calls, stop_after, stop_progress_after;
  bool stopped, over; /* over: all was searched */
  double done;
  size_t first_count, last_count;
  uint32_t kind[BOXES];
  ambit_interval box[BOXES][ROOTS_UNKNOWNS];
  ambit_roots_result result;
} search;

static void find(roots_kit *k, const roots_system *s, const char *format, ...) AMBIT_PRINTF(3, 4);
static void find(roots_kit *k, const roots_system *s, const char *format, ...) {
  char message[400];
  va_list arguments;
  if (k->findings++ >= MESSAGES) return;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  k->finding(k->user, s->name, message);
}

/* -- the sink */

static void note_allocations(search *r) {
  r->last_count = r->kit->allocations ? r->kit->allocations() : 0;
  if (r->count == 0 && r->calls == 0) r->first_count = r->last_count;
}

static int32_t emit(ambit_sink *sink, const ambit_record *record) {
  search *r = (search *)(void *)sink;
  roots_kit *k = r->kit;
  note_allocations(r);
  k->judged++, k->boxes++;
  if (r->stopped) find(k, r->s, "a record after the sink asked to stop");
  if (record->kind != AMBIT_REC_ROOT || record->nx != r->s->n || record->rigorous != 1 ||
      record->event > AMBIT_ROOT_PARTLY) {
    find(k, r->s, "a record of kind %u with %u unknowns, rigorous %u, that says %u", record->kind, record->nx,
        record->rigorous, record->event);
    return 1;
  }
  for (uint32_t i = 0; i < r->s->n; i++) {
    ambit_interval x = { record->lo[i], record->hi[i] }, all = r->s->box[i];
    if (!(x.lo <= x.hi && x.lo >= all.lo && x.hi <= all.hi))
      find(k, r->s, "unknown %u in [%a, %a], not a part of [%a, %a]", i, x.lo, x.hi, all.lo, all.hi);
    if (r->count < BOXES) r->box[r->count][i] = x;
  }
  if (r->count < BOXES) r->kind[r->count] = record->event;
  r->stopped = ++r->count == r->stop_after || r->count >= BOXES;
  return r->stopped;
}

static int32_t progress(ambit_sink *sink, double done, const char *message) {
  search *r = (search *)(void *)sink;
  (void)message;
  note_allocations(r);
  r->kit->judged++;
  if (r->stopped) find(r->kit, r->s, "progress after the sink asked to stop");
  if (!(done >= r->done && done <= 1)) find(r->kit, r->s, "progress %g after %g", done, r->done);
  r->done = done;
  r->stopped = ++r->calls == r->stop_progress_after;
  return r->stopped;
}

static void run(search *r) {
  static const char *const name[ROOTS_UNKNOWNS] = { "a", "b", "c", "d", "e", "f" };
  const roots_system *s = r->s;
  ambit_failure f = { 0 };
  ambit_equations e = { .graph = s->graph, .ne = s->n, .equation = s->f, .nx = s->n, .unknown = s->x, .name = name };
  r->sink = (ambit_sink) { sizeof r->sink, emit, progress };
  ambit_roots_request q = { .equations = &e,
    .box = s->box,
    .registry = r->kit->registry,
    .solver = r->kit->name,
    .nsolver_option = r->kit->noption,
    .solver_option = r->kit->option,
    .sink = &r->sink };
  unsigned floating = conduct_floating();
  if (ambit_roots(&q, &r->result, NULL, &f) != AMBIT_OK) {
    r->result.status = AMBIT_INVALID;
    find(r->kit, s, "it cannot start: %s", f.message);
  }
  if (conduct_floating() != floating) find(r->kit, s, "it changes the rounding mode");
  r->kit->searches++, r->kit->judged += 2;
}

/* -- what was found */

static bool holds(const search *r, uint32_t b, const ambit_interval *x, bool certainly) {
  for (uint32_t i = 0; i < r->s->n; i++) {
    ambit_interval y = r->box[b][i];
    if (certainly ? !(y.lo <= x[i].lo && x[i].hi <= y.hi) : !(y.lo <= x[i].hi && x[i].lo <= y.hi)) return false;
  }
  return true;
}

static bool meets_another(const search *r, uint32_t b) {
  for (uint32_t c = 0; c < r->count; c++)
    if (c != b && holds(r, c, r->box[b], false)) return true;
  return false;
}

static bool is_inside(const roots_system *s, const ambit_interval *x) {
  for (uint32_t i = 0; i < s->n; i++)
    if (!(s->box[i].lo <= x[i].lo && x[i].hi <= s->box[i].hi)) return false;
  return true;
}

static void judge_box(search *r, uint32_t b, const double *u) {
  ambit_interval x[ROOTS_UNKNOWNS];
  uint32_t certain = 0, possible = 0;
  const roots_system *s = r->s;
  for (size_t k = 0; roots_system_root(s, k, u, x); k++)
    certain += holds(r, b, x, true), possible += holds(r, b, x, false);
  r->kit->judged++;
  if (r->kind[b] == AMBIT_ROOT_UNIQUE && (possible == 0 || s->twice))
    find(r->kit, s, "box %u says it has one root: %s", b, s->twice ? "it is a double one" : "there is none");
  if (r->kind[b] != AMBIT_ROOT_UNDECIDED && certain > 1 && !meets_another(r, b))
    find(r->kit, s, "box %u says it has one root, but has %u", b, certain);
}

static void judge_data(search *r, const double *u) {
  ambit_interval x[ROOTS_UNKNOWNS];
  for (size_t k = 0; roots_system_root(r->s, k, u, x); k++) {
    bool found = false;
    for (uint32_t b = 0; b < r->count; b++) found = found || holds(r, b, x, false);
    r->kit->judged++, r->kit->roots++;
    if (r->over && !found && is_inside(r->s, x))
      find(r->kit, r->s, "the root at (%.9g, ...), for data (%a, ...), is in no box", x[0].lo, u[0]);
  }
  for (uint32_t b = 0; b < r->count; b++) judge_box(r, b, u);
}

static void judge(search *r) {
  const roots_system *s = r->s;
  double u[ROOTS_DATA] = { 0 };
  uint32_t undecided = 0;
  for (uint32_t b = 0; b < r->count; b++) undecided += r->kind[b] == AMBIT_ROOT_UNDECIDED;
  r->over = r->result.status == AMBIT_OK || r->result.status == AMBIT_UNABLE;
  if (r->result.status == AMBIT_OK && undecided) find(r->kit, s, "it says OK with %u boxes undecided", undecided);
  if (r->result.status == AMBIT_OK && s->twice) find(r->kit, s, "a double root is decided");
  bool too_long = r->calls == PATIENCE && r->result.status == AMBIT_STOPPED;
  if (r->result.status != AMBIT_OK && r->result.status != AMBIT_UNABLE && !too_long)
    find(r->kit, s, "status %d: %s", r->result.status, r->result.reason);
  if (r->result.status == AMBIT_UNABLE && strlen(r->result.reason) < 10)
    find(r->kit, s, "no reason why it gave up: `%s`", r->result.reason);
  if (r->result.status == AMBIT_OK && r->result.boxes == 0) find(r->kit, s, "it has looked at no box");
  r->kit->complete += r->result.status == AMBIT_OK;
  r->kit->judged += 5;
  for (uint32_t corner = 0; corner < 1u << s->nu; corner++) {
    for (uint32_t j = 0; j < s->nu; j++) u[j] = corner >> j & 1 ? s->u[j].hi : s->u[j].lo;
    judge_data(r, u);
  }
  for (uint32_t j = 0; j < s->nu; j++) u[j] = 0.5 * s->u[j].lo + 0.5 * s->u[j].hi;
  if (s->nu) judge_data(r, u);
}

static void search_all(roots_kit *k, const roots_system *s, search *r, search *again) {
  *r = (search) { .kit = k, .s = s, .stop_progress_after = s->twice ? 0 : PATIENCE }, *again = *r;
  run(r);
  judge(r);
  k->judged += 2;
  if (r->last_count != r->first_count) find(k, s, "%zu allocations during the search", r->last_count - r->first_count);
  if (s->twice) return; /* long enough */
  run(again);
  if (again->count != r->count || memcmp(again->box, r->box, sizeof r->box) != 0 ||
      memcmp(again->kind, r->kind, sizeof r->kind) != 0)
    find(k, s, "another result the second time");
  bool boxes = r->count > 0;
  *again = (search) { .kit = k, .s = s, .stop_progress_after = 1 };
  run(again);
  if (again->calls == 0) find(k, s, "no progress");
  if (again->calls && again->result.status != AMBIT_STOPPED)
    find(k, s, "stopped by progress: status %d", again->result.status);
  *again = (search) { .kit = k, .s = s, .stop_after = 1 };
  if (boxes) run(again);
  if (boxes && again->result.status != AMBIT_STOPPED) find(k, s, "stopped at a box: status %d", again->result.status);
}

size_t roots_kit_run(roots_kit *k, size_t systems) {
  roots_system s = { .name = "random equations" };
  search *r = malloc(sizeof *r), *again = malloc(sizeof *again);
  for (size_t i = 0; r && again && k->findings == 0 && i < systems; i++) {
    roots_system_make(&s, k->seed, i);
    roots_system_open(&s);
    search_all(k, &s, r, again);
    roots_system_close(&s);
  }
  if (k->findings == 0 && k->complete * 2 < systems) find(k, &s, "it gives up on most random equations");
  for (size_t i = 0; r && again && k->findings == 0 && roots_system_special(&s, i); i++) {
    roots_system_open(&s);
    search_all(k, &s, r, again);
    roots_system_close(&s);
  }
  free(r), free(again);
  return k->findings;
}
