/* faulty.c -- a solver that says it is rigorous and ends in the way its option names: what the kernel and the command
** make of that is in outcome_spec.lua. */
#include <ambit/code.h>
#include <ambit/solver.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

enum {
  FINE,
  INVERTED,
  NAN_BOUND,
  GAP,
  EARLY,
  NOTHING,
  UNSURE,
  OWN_CODE,
  BAD_CODE,
  NO_CODE,
  LEAVE,
  TERM,
  HANG_UP,
  SENSELESS
};

static const ambit_param params[] = {
  { "fault", "1", "fine|inverted|nan|gap|early|nothing|unsure|own_code|bad_code|no_code|leave|term|hang_up|senseless",
      "fine", "how it ends" },
  { NULL, NULL, NULL, NULL, NULL },
};

typedef struct faulty {
  const ambit_host *host;
  const ambit_problem *problem;
  double *lo, *hi;
  int fault;
} faulty;

static ambit_status open_faulty(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  faulty *f = h->alloc(h, sizeof *f);
  if (!f) return AMBIT_NOMEM;
  *f = (faulty) { h, p, h->alloc(h, p->nx * sizeof(double)), h->alloc(h, p->nx * sizeof(double)), (int)option[0] };
  *self = f;
  return f->lo && f->hi ? AMBIT_OK : AMBIT_NOMEM;
}

static int emit(faulty *f, ambit_sink *s, double from, double to, double lo, double hi) {
  for (uint32_t i = 0; i < f->problem->nx; i++) f->lo[i] = lo, f->hi[i] = hi;
  ambit_record r = { .size = sizeof r, .kind = AMBIT_REC_STEP, .t_from = from, .t_to = to, .nx = f->problem->nx };
  r.lo = f->lo, r.hi = f->hi, r.rigorous = 1;
  return s->emit(s, &r) || s->progress(s, 0.5, NULL);
}

static ambit_status run(void *self, ambit_sink *s) {
  faulty *f = self;
  const ambit_host *h = f->host;
  double from = f->problem->time[0], to = f->problem->time[f->problem->ntime - 1], middle = 0.5 * (from + to);
  if (emit(f, s, from, middle, -1e9, 1e9)) return AMBIT_STOPPED;
  switch (f->fault) {
  case INVERTED: return emit(f, s, middle, to, 1, -1) ? AMBIT_STOPPED : AMBIT_OK;
  case NAN_BOUND: return emit(f, s, middle, to, (double)NAN, 1) ? AMBIT_STOPPED : AMBIT_OK;
  case GAP: return emit(f, s, to, to, 0, 1) ? AMBIT_STOPPED : AMBIT_OK;
  case EARLY: return AMBIT_OK;
  case NOTHING: return h->fail_code(h, AMBIT_DOMAIN, AMBIT_CODE_DOMAIN_CONSTRAINT, "there is no solution");
  case UNSURE: return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_WIDTH, "it got too wide");
  case OWN_CODE: return h->fail_code(h, AMBIT_UNABLE, "unable.my-own", "it has a code of its own");
  case BAD_CODE: return h->fail_code(h, AMBIT_UNABLE, "ok.all-is-well", "it says that all is well");
  case NO_CODE: return h->fail(h, AMBIT_UNABLE, "it gives no code");
  case LEAVE: exit(EXIT_SUCCESS);
  case TERM: raise(SIGTERM); break;
  case HANG_UP: raise(SIGHUP); break;
  case SENSELESS: return 77;
  default: break;
  }
  return emit(f, s, middle, to, -1e9, 1e9) ? AMBIT_STOPPED : AMBIT_OK;
}

static void close_faulty(void *self) { (void)self; }

static const ambit_solver solver = { .size = sizeof solver,
  .needs_rigorous = 1,
  .arithmetics = "interval",
  .param = params,
  .open = open_faulty,
  .run = run,
  .close = close_faulty };

static const void *get(const char *id) { return strcmp(id, AMBIT_SOLVER) == 0 ? &solver : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.faulty", "1.0", "Ends as its option says.",
  get };
