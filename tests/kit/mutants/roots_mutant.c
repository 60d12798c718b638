/* roots_mutant.c -- solvers that find roots, each with one fault: in the boxes it reports, in the equations it solves,
** in how it ends, or in its conduct. */
#include "kit/mutants/mutant_conduct.h"
#include "kit/mutants/solver_mutant.h"
#include <ambit/root_finder.h>
#include <math.h>

enum { ROOM = 4096, UNKNOWNS = 16 };

typedef struct liar {
  ambit_sink sink; /* first */
  ambit_sink *outer;
  const ambit_host *host;
  ambit_root_problem problem;
  ambit_tape tape;
  uint32_t roots, out[ROOM];
  double constant_lo[ROOM], constant_hi[ROOM];
  double lo[UNKNOWNS], hi[UNKNOWNS], box_lo[UNKNOWNS], box_hi[UNKNOWNS], p_lo[UNKNOWNS], p_hi[UNKNOWNS];
  double kept_lo[UNKNOWNS], kept_hi[UNKNOWNS];
  int32_t stopped;
  void *inner;
} liar;

typedef struct selection {
  const char *name;
  void (*conduct)(void);
  ambit_root_finder base;
  uint64_t searches;
} selection;

static selection *chosen;

static bool is(const char *name) { return strcmp(chosen->name, name) == 0; }

/* -- boxes */

static void scale(double *lo, double *hi, double by) {
  double mid = 0.5 * *lo + 0.5 * *hi, radius = 0.5 * (*hi - *lo);
  *lo = mid - by * radius, *hi = mid + by * radius;
}

static void spoil_box(liar *l, ambit_record *r) {
  uint32_t n = r->nx, last = n - 1;
  bool data = l->problem.np > 0;
  if (is("boxes cut by 10 %"))
    for (uint32_t i = 0; i < n; i++) scale(&l->lo[i], &l->hi[i], 0.9);
  if (is("boxes cut by 10 % with data") && data)
    for (uint32_t i = 0; i < n; i++) scale(&l->lo[i], &l->hi[i], 0.9);
  if (is("boxes cut to their middle from 3 unknowns on") && n >= 3)
    for (uint32_t i = 0; i < n; i++) scale(&l->lo[i], &l->hi[i], 0);
  if (is("last unknown moved from 5 unknowns on") && n >= 5) l->lo[last] += 1e-6, l->hi[last] += 1e-6;
  if (is("first unknown moved by its width")) l->lo[0] += 1e-9 + l->hi[0] - l->lo[0], l->hi[0] = l->lo[0] + 1e-12;
  if (is("two unknowns exchanged") && n > 1) {
    double lo = l->lo[0], hi = l->hi[0];
    l->lo[0] = l->lo[last], l->hi[0] = l->hi[last], l->lo[last] = lo, l->hi[last] = hi;
  }
  if (is("wrong sign of the last unknown with 4 or more") && n >= 4) {
    double lo = l->lo[last];
    l->lo[last] = -l->hi[last], l->hi[last] = -lo;
  }
  if (is("bounds exchanged") && l->roots == 1) {
    double lo = l->lo[0];
    l->lo[0] = l->hi[0] + 1e-12, l->hi[0] = lo;
  }
  if (is("a bound that is NaN") && l->roots == 1) l->hi[last] = NAN;
  if (is("an infinite bound") && l->roots == 1) l->hi[0] = INFINITY;
  if (is("boxes beyond the searched one")) l->hi[0] = l->problem.x_hi[0] + 1;
  if (is("undecided boxes say unique")) r->event = AMBIT_ROOT_UNIQUE;
  if (is("unique boxes say undecided")) r->event = AMBIT_ROOT_UNDECIDED;
  if (is("boxes of an unknown kind")) r->event = 7;
  if (is("records that prove nothing")) r->rigorous = 0;
  if (is("one unknown too many")) r->nx++;
  if (is("records of another kind")) r->kind = AMBIT_REC_STEP;
  if (is("the same box for every root") && l->roots > 1)
    memcpy(l->lo, l->kept_lo, sizeof l->lo), memcpy(l->hi, l->kept_hi, sizeof l->hi);
  if (is("another answer the second time") && chosen->searches % 2 == 0) l->hi[0] = nextafter(l->hi[0], INFINITY);
}

static bool leaves_out(const liar *l, const ambit_record *r) {
  if (is("first root lost")) return l->roots == 1;
  if (is("every fourth root lost")) return l->roots % 4 == 0;
  if (is("roots beyond the sixth lost")) return l->roots > 6;
  if (is("undecided boxes left out")) return r->event == AMBIT_ROOT_UNDECIDED;
  if (is("negative roots lost")) return r->hi[0] < 0;
  if (is("roots of 6 unknowns lost")) return r->nx == 6;
  if (is("roots with data lost")) return l->problem.np > 0;
  return is("no root is reported");
}

static int32_t emit(ambit_sink *s, const ambit_record *record) {
  liar *l = (liar *)(void *)s;
  ambit_record r = *record;
  if (record->kind != AMBIT_REC_ROOT) {
    if (is("never says that the search is over")) return 0;
    if (is("has looked at no box")) r.ncoef = 0;
    return l->outer->emit(l->outer, &r);
  }
  l->roots++;
  if (leaves_out(l, record)) return 0;
  memcpy(l->lo, record->lo, record->nx * sizeof(double)), memcpy(l->hi, record->hi, record->nx * sizeof(double));
  r.lo = l->lo, r.hi = l->hi;
  if (l->roots == 1) memcpy(l->kept_lo, l->lo, sizeof l->lo), memcpy(l->kept_hi, l->hi, sizeof l->hi);
  spoil_box(l, &r);
  if (is("allocates at each root")) conduct_allocates();
  int32_t stop = l->outer->emit(l->outer, &r);
  if (stop) l->stopped = 1;
  return is("goes on after the sink has stopped it") ? 0 : stop;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  liar *l = (liar *)(void *)s;
  if (is("no progress")) return 0;
  if (is("progress beyond 1")) done = 1.5;
  if (is("progress that falls back") && l->roots) done = 0;
  if (is("allocates at each progress")) conduct_allocates();
  int32_t stop = l->outer->progress(l->outer, done, message);
  if (stop) l->stopped = 1;
  return is("goes on after progress has stopped it") ? 0 : stop;
}

/* -- equations */

static void spoil_problem(liar *l, ambit_root_problem *p) {
  l->tape = *p->f;
  memcpy(l->out, p->f->out, p->f->nout * sizeof *l->out);
  memcpy(l->constant_lo, p->f->lo, p->f->nconst * sizeof(double));
  memcpy(l->constant_hi, p->f->hi, p->f->nconst * sizeof(double));
  l->tape.out = l->out, l->tape.lo = l->constant_lo, l->tape.hi = l->constant_hi;
  p->f = &l->tape;
  uint32_t last = p->nx - 1;
  if (is("last equation taken twice from 3 unknowns on") && p->nx >= 3) l->out[0] = l->out[last];
  if (is("a constant off by 1e-7") && l->tape.nconst > 1) {
    uint32_t c = l->tape.nconst - 1;
    l->constant_lo[c] *= 1 + 1e-7, l->constant_hi[c] *= 1 + 1e-7;
  }
  if (is("parameters at their middle"))
    for (uint32_t i = 0; i < p->np; i++) l->p_lo[i] = l->p_hi[i] = 0.5 * p->p_lo[i] + 0.5 * p->p_hi[i];
  if (is("parameters of half their width"))
    for (uint32_t i = 0; i < p->np; i++) l->p_lo[i] = p->p_lo[i], l->p_hi[i] = 0.5 * p->p_lo[i] + 0.5 * p->p_hi[i];
  if (strstr(chosen->name, "parameters") && p->np) p->p_lo = l->p_lo, p->p_hi = l->p_hi;
  memcpy(l->box_lo, p->x_lo, p->nx * sizeof(double)), memcpy(l->box_hi, p->x_hi, p->nx * sizeof(double));
  if (is("searches the upper half only")) l->box_lo[0] = 0.5 * (l->box_lo[0] + l->box_hi[0]);
  if (is("searches 90 % of the last unknown's range")) scale(&l->box_lo[last], &l->box_hi[last], 0.7);
  if (is("searches the middle only from 4 unknowns on") && p->nx >= 4)
    for (uint32_t i = 0; i < p->nx; i++) scale(&l->box_lo[i], &l->box_hi[i], 0.2);
  p->x_lo = l->box_lo, p->x_hi = l->box_hi;
}

/* -- the plugin */

static ambit_status open_liar(const ambit_host *h, const ambit_root_problem *p, const double *option, void **self) {
  liar *l = h->alloc(h, sizeof *l);
  mutant_host *own = mutant_lend(h);
  if (!l || !own) return AMBIT_NOMEM;
  *self = l;
  chosen->searches++;
  l->host = h, l->problem = *p;
  if (p->nx <= UNKNOWNS && p->np <= UNKNOWNS && p->f->nconst <= ROOM && p->f->nout <= ROOM)
    spoil_problem(l, &l->problem);
  if (is("always gives up, with a reason"))
    return h->fail(h, AMBIT_UNABLE, "these equations are too hard for this method");
  return chosen->base.open(&own->host, &l->problem, option, &l->inner);
}

static ambit_status run(void *self, ambit_sink *sink) {
  liar *l = self;
  l->sink = (ambit_sink) { sizeof l->sink, emit, progress };
  l->outer = sink;
  ambit_status status = chosen->base.run(l->inner, &l->sink);
  if (chosen->conduct) chosen->conduct();
  if (is("says OK with undecided boxes") && status == AMBIT_UNABLE) return AMBIT_OK;
  if (is("says that there is no answer") && status == AMBIT_OK) return AMBIT_DOMAIN;
  if (is("stops by itself") && status == AMBIT_OK) return AMBIT_STOPPED;
  return status;
}

static void close_liar(void *self) { chosen->base.close(((liar *)self)->inner); }

static const char *const faults[] = { "boxes cut by 10 % with data", "boxes cut to their middle from 3 unknowns on",
  "last unknown moved from 5 unknowns on", "first unknown moved by its width", "two unknowns exchanged",
  "wrong sign of the last unknown with 4 or more", "bounds exchanged", "a bound that is NaN", "an infinite bound",
  "boxes beyond the searched one", "undecided boxes say unique", "unique boxes say undecided",
  "boxes of an unknown kind", "records that prove nothing", "one unknown too many", "records of another kind",
  "the same box for every root", "another answer the second time", "first root lost", "every fourth root lost",
  "roots beyond the sixth lost", "undecided boxes left out", "negative roots lost", "roots of 6 unknowns lost",
  "roots with data lost", "no root is reported", "never says that the search is over", "has looked at no box",
  "allocates at each root", "goes on after the sink has stopped it", "no progress", "progress beyond 1",
  "progress that falls back", "allocates at each progress", "goes on after progress has stopped it",
  "last equation taken twice from 3 unknowns on", "a constant off by 1e-7", "parameters at their middle",
  "parameters of half their width", "searches the upper half only", "searches 90 % of the last unknown's range",
  "searches the middle only from 4 unknowns on", "always gives up, with a reason", "says OK with undecided boxes",
  "says that there is no answer", "stops by itself" };
enum { FAULTS = sizeof faults / sizeof *faults };

AMBIT_EXPORT const char *ambit_mutant_name(size_t i);
const char *ambit_mutant_name(size_t i) {
  return i < FAULTS ? faults[i] : i < FAULTS + CONDUCT_FAULTS ? conduct_faults[i - FAULTS].name : NULL;
}

__attribute__((constructor)) static void choose(void);
static void choose(void) {
  chosen = calloc(1, sizeof *chosen);
  chosen->name = strdup(mutant_wanted());
  chosen->conduct = conduct_of(chosen->name);
  ambit_root_finder *own = mutant_wrap(AMBIT_ROOT_FINDER, "krawczyk", &chosen->base, sizeof chosen->base);
  own->open = open_liar, own->run = run, own->close = close_liar;
}

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.roots_mutant", "1.0",
  "A root finder with one fault.", mutant_get };
