/* mock.c -- a minimal solver, right for x' = 0 (the state keeps its hull), that can be told to misbehave in every
** way a solver can. */
#include <ambit/solver.h>
#include <math.h>
#include <stdlib.h>

enum {
  NOTHING,
  FAIL,
  FAIL_SILENTLY,
  GIVE_NAN,
  GIVE_REVERSED,
  STOP_EARLY,
  LEAVE_GAP,
  TURN_BACK,
  REFUSE,
  UNABLE_AT_ONCE,
  IGNORE_STOP,
  ALLOCATE,
  ODD_STATUS,
  WRONG_COUNT,
  DENSE_NAN,
  DENSE_NEGATIVE,
  SET_NEGATIVE,
  OUTSIDE_TUBE
};

typedef struct mock {
  const ambit_host *host;
  const ambit_problem *p;
  int mischief;
  double *lo;    /* [nx] spoiled bounds */
  double *wrong; /* [nx] spoiled coefficients and radii */
  ambit_set set;
} mock;

static ambit_status start(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  if (option[0] == REFUSE) return h->fail(h, AMBIT_INVALID, "this system is not for me");
  if (option[0] == UNABLE_AT_ONCE) return h->fail(h, AMBIT_UNABLE, "no first step; raise `order`");
  mock *m = h->alloc(h, sizeof *m);
  double *lo = h->alloc(h, (p->nx + 1) * sizeof *lo);
  double *wrong = h->alloc(h, (p->nx + p->nu + 1) * sizeof *wrong);
  if (!m || !lo || !wrong) return AMBIT_NOMEM;
  *m = (mock) { h, p, (int)option[0], lo, wrong, { .size = sizeof m->set } };
  for (uint32_t i = 0; i < p->nx; i++) wrong[i] = m->mischief == DENSE_NAN ? NAN : -1;
  m->set.rest = wrong;
  for (uint32_t i = 0; i < p->nx; i++)
    lo[i] = m->mischief == GIVE_NAN ? NAN : m->mischief == GIVE_REVERSED ? p->x0_hi[i] + 1 : p->x0_lo[i];
  h->note(h, "mock solver with %u states", (unsigned)p->nx);
  *self = m;
  return AMBIT_OK;
}

static ambit_record make_step(const mock *m, uint32_t k) {
  const ambit_problem *p = m->p;
  ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = p->time[k - 1],
    .t_to = p->time[k],
    .nx = p->nx,
    .rigorous = 1,
    .lo = m->lo,
    .hi = p->x0_hi,
    .tube_lo = m->lo,
    .tube_hi = p->x0_hi };
  if (m->mischief == LEAVE_GAP) r.t_from += 0.25 * (r.t_to - r.t_from);
  if (m->mischief == TURN_BACK) r.t_to = r.t_from - (r.t_to - r.t_from);
  if (m->mischief == WRONG_COUNT) r.nx++;
  if (m->mischief == DENSE_NAN || m->mischief == DENSE_NEGATIVE)
    r.ndense = 1, r.dense_mid = p->x0_hi, r.dense_rad = m->wrong;
  if (m->mischief == SET_NEGATIVE) r.set = &m->set;
  if (m->mischief == OUTSIDE_TUBE) r.tube_lo = r.tube_hi = m->wrong;
  return r;
}

static ambit_status run(void *self, ambit_sink *s) {
  mock *m = self;
  for (uint32_t k = 1; k < m->p->ntime; k++) {
    if (k == 2 && m->mischief == FAIL)
      return m->host->fail(m->host, AMBIT_UNABLE, "the enclosure blew up; lower `tolerance`");
    if (k == 2 && m->mischief == FAIL_SILENTLY) return AMBIT_UNABLE;
    if (k == 2 && m->mischief == STOP_EARLY) return AMBIT_OK;
    if (k == 2 && m->mischief == ODD_STATUS) return 77;
    if (k == 2 && m->mischief == ALLOCATE) {
      void *volatile place = malloc(m->p->ntime); /* volatile: it must happen */
      free(place);
    }
    ambit_record r = make_step(m, k);
    int32_t stop = s->emit(s, &r);
    stop = s->progress(s, k / (double)(m->p->ntime - 1), "mocking") || stop;
    if (stop && m->mischief != IGNORE_STOP) return AMBIT_STOPPED;
  }
  return AMBIT_OK;
}

static void finish(void *self) { (void)self; }

static const ambit_param option[] = {
  { "does", "1",
      "nothing|fail|fail_silently|nan|reversed|stop_early|gap|turn_back|refuse|unable|ignore_stop|allocate|odd_status|"
      "wrong_count|dense_nan|dense_negative|set_negative|outside_tube",
      "nothing", "What to do wrong." },
  { NULL, NULL, NULL, NULL, NULL },
};
static const ambit_solver solver = { .size = sizeof solver,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_INITIAL,
  .needs_rigorous = 1,
  .param = option,
  .open = start,
  .run = run,
  .close = finish };
static const void *get(const char *id) { return id[6] == 's' && id[7] == 'o' ? &solver : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.mock", "1", "Keeps everything where it is.",
  get };
