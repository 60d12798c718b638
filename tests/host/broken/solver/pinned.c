/* pinned.c -- a solver that works with two arithmetics only, wants the Jacobian, and shows what the kernel built:
** the record holds, for every state, the numbers of parameters, unknowns and tape inputs. */
#include <ambit/solver.h>

typedef struct pinned {
  const ambit_problem *p;
  double *value;
} pinned;

static ambit_status start(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  (void)option;
  pinned *s = h->alloc(h, sizeof *s);
  double *value = h->alloc(h, p->nx * sizeof *value);
  if (!s || !value) return AMBIT_NOMEM;
  if (p->initial || !p->jacobian || !p->rhs) return h->fail(h, AMBIT_BROKEN, "the kernel built what was not wanted");
  if (p->jacobian->nout != p->nx * p->nx || p->jacobian->nin != p->nx + p->np + p->uses_time)
    return h->fail(h, AMBIT_BROKEN, "the Jacobian has the wrong shape");
  for (uint32_t i = 0; i < p->nx; i++) value[i] = p->np + 10.0 * p->nu + 100.0 * p->rhs->nin;
  *s = (pinned) { p, value };
  *self = s;
  return AMBIT_OK;
}

static ambit_status run(void *self, ambit_sink *sink) {
  pinned *s = self;
  const ambit_problem *p = s->p;
  ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = p->time[0],
    .t_to = p->time[p->ntime - 1],
    .nx = p->nx,
    .lo = s->value,
    .hi = s->value };
  return sink->emit(sink, &r) ? AMBIT_STOPPED : AMBIT_OK;
}

static void finish(void *self) { (void)self; }

static const ambit_solver solver = { .size = sizeof solver,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_JACOBIAN,
  .needs_rigorous = 0,
  .arithmetics = "newer small",
  .open = start,
  .run = run,
  .close = finish };
static const void *get(const char *id) { return id[6] == 's' && id[7] == 'o' ? &solver : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.pinned", "1", "", get };
