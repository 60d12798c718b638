/* crew.c -- a solver that wants a context for each thread, checks what it gets, and lets a pool use all of them at
** once: right for x' = 0. A step is made only if each item was done once. */
#include <ambit/pool.h>
#include <ambit/solver.h>

enum { ITEMS = 200, BYTES = 4096 };

typedef struct crew {
  const ambit_host *host;
  const ambit_problem *p;
  const ambit_pool_service *service;
  ambit_pool *pool;
  void *element[64]; /* one for each worker */
  uint32_t done[ITEMS];
} crew;

static ambit_status start(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  (void)option;
  crew *c = h->alloc(h, sizeof *c);
  if (!c) return AMBIT_NOMEM;
  c->host = h;
  c->p = p;
  c->service = h->service(h, AMBIT_POOL_SERVICE);
  if (!c->service) return h->fail(h, AMBIT_INVALID, "no pool");
  if (!p->worker || p->nworker < 1 || p->nworker > 64) return h->fail(h, AMBIT_INVALID, "no workers");
  if (p->worker[0] != p->actx) return h->fail(h, AMBIT_INVALID, "worker 0 is not the context");
  for (uint32_t i = 1; i < p->nworker; i++)
    if (p->worker[i] == p->worker[i - 1]) return h->fail(h, AMBIT_INVALID, "a context is shared");
  for (uint32_t i = 0; i < p->nworker; i++)
    if (!(c->element[i] = h->alloc(h, BYTES))) return AMBIT_NOMEM;
  *self = c;
  return c->service->open(h, p->nworker, &c->pool);
}

static ambit_status item(void *user, uint32_t number, uint32_t worker) {
  crew *c = user;
  const ambit_arithmetic *a = c->p->arithmetic;
  void *ctx = c->p->worker[worker];
  double lo = number, hi = number + 1, back_lo, back_hi;
  a->set(ctx, c->element[worker], 1, &lo, &hi, -1);
  a->bounds(ctx, c->element[worker], 1, &back_lo, &back_hi);
  c->done[number]++;
  return back_lo <= lo && hi <= back_hi ? AMBIT_OK : AMBIT_BROKEN;
}

static ambit_status run(void *self, ambit_sink *s) {
  crew *c = self;
  const ambit_problem *p = c->p;
  for (uint32_t k = 1; k < p->ntime; k++) {
    ambit_status status = c->service->run(c->pool, ITEMS, item, c, NULL);
    if (status != AMBIT_OK) return status;
    for (uint32_t i = 0; i < ITEMS; i++)
      if (c->done[i] != k) return c->host->fail(c->host, AMBIT_BROKEN, "item %u was done %u times", i, c->done[i]);
    const ambit_record r = { .size = sizeof r,
      .kind = AMBIT_REC_STEP,
      .t_from = p->time[k - 1],
      .t_to = p->time[k],
      .nx = p->nx,
      .rigorous = 1,
      .lo = p->x0_lo,
      .hi = p->x0_hi,
      .tube_lo = p->x0_lo,
      .tube_hi = p->x0_hi };
    if (s->emit(s, &r)) return AMBIT_STOPPED;
  }
  return AMBIT_OK;
}

static void finish(void *self) { (void)self; /* the pool ends with its host */ }

static const ambit_solver crew_solver = { .size = sizeof crew_solver,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_WORKERS,
  .needs_rigorous = 1,
  .open = start,
  .run = run,
  .close = finish };
static const void *get(const char *id) { return id[6] == 's' ? &crew_solver : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.crew", "1", "", get };
