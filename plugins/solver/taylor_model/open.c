/* open.c -- memory: pieces, contexts of threads, records. */
#include "flow.h"
#include "start.h"
#include <string.h>

#define LEAVES 128 /* boxes of a search for a hull beside the sub-ranges */

static double *doubles(const ambit_host *h, size_t n) { return h->alloc(h, (n ? n : 1) * sizeof(double)); }

static ambit_status no_memory(const ambit_host *h) {
  return h->fail(h, AMBIT_NOMEM, "taylor_model: out of memory; lower `pieces_max` or `order`");
}

/* -- sub-ranges: more of them for fewer unknowns */

/* how much of the set depends on unknown v, by linear terms, relative */
static double share_of(const flow *f, uint32_t v) {
  const space *s = &f->space;
  double share = 0;
  for (uint32_t i = 0; i < f->nx + f->np; i++) {
    const double *c = i < f->nx ? f->start_x + i * s->size : f->start_p + (i - f->nx) * s->size;
    double middle = fabs(c[s->row[0].at]), move = fabs(c[polynomial_linear(s, v)]);
    if (move > 0) share += move / (middle + move);
  }
  return share;
}

static int choose_cuts(flow *f) {
  f->cuts = f->host->alloc(f->host, (f->m + 1u) * sizeof *f->cuts);
  if (!f->cuts) return 0;
  for (uint32_t v = 0; v < f->m; v++) f->cuts[v] = f->m == 1 ? 16 : f->m == 2 ? 4 : f->m == 3 ? 2 : 1;
  for (uint32_t k = 0; k < 3 && f->m > 3; k++) {
    uint32_t best = UINT32_MAX;
    for (uint32_t v = 0; v < f->m; v++)
      if (f->cuts[v] == 1 && (best == UINT32_MAX || share_of(f, v) > share_of(f, best))) best = v;
    f->cuts[best] = 2;
  }
  f->ns = 1;
  for (uint32_t v = 0; v < f->m; v++) f->ns *= f->cuts[v];
  f->sub_about = doubles(f->host, (size_t)f->ns * f->m), f->sub_reach = doubles(f->host, f->m);
  f->middle = doubles(f->host, f->m), f->whole = doubles(f->host, f->m);
  if (!f->sub_about || !f->sub_reach || !f->middle || !f->whole) return 0;
  for (uint32_t v = 0; v < f->m; v++) f->middle[v] = 0, f->whole[v] = 1;
  for (uint32_t n = 0; n < f->ns; n++)
    for (uint32_t v = 0, left = n; v < f->m; left /= f->cuts[v++])
      f->sub_about[(size_t)n * f->m + v] = (2.0 * (left % f->cuts[v]) + 1) / f->cuts[v] - 1;
  for (uint32_t v = 0; v < f->m; v++) f->sub_reach[v] = 1.0 / f->cuts[v];
  return 1;
}

/* level l takes 2^l parts of each unknown together, as far as it has so many */
static int choose_groups(flow *f) {
  uint32_t most = 1;
  for (uint32_t v = 0; v < f->m; v++) most = f->cuts[v] > most ? f->cuts[v] : most;
  for (f->levels = 1; most > 1; most /= 2) f->levels++;
  f->ngroup = f->host->alloc(f->host, f->levels * sizeof *f->ngroup);
  f->group = f->host->alloc(f->host, (size_t)f->levels * f->ns * sizeof *f->group);
  if (!f->ngroup || !f->group) return 0;
  for (uint32_t l = 0; l < f->levels; l++) {
    for (uint32_t n = 0; n < f->ns; n++) {
      uint32_t stride = 1, left = n, group = 0;
      for (uint32_t v = 0; v < f->m; v++) {
        uint32_t cuts = f->cuts[v] > 1 ? f->cuts[v] : 1, parts = cuts >> l ? cuts >> l : 1, digit = left % cuts;
        group += stride * (digit / (cuts / parts));
        stride *= parts, left /= cuts;
      }
      f->group[(size_t)l * f->ns + n] = group;
      f->ngroup[l] = stride;
    }
  }
  return 1;
}

/* -- pieces: one block each */

static size_t piece_doubles(const flow *f, size_t zonotope) {
  size_t nx = f->nx, np = f->np, nb = f->ns * (nx + np);
  return (nx + np) * f->space.size + 4 * (size_t)f->m + np + 2 * nb + f->ns * zonotope + 5 * nx + 32;
}

static double *take(double **at, size_t n) {
  double *from = *at;
  *at += (n + 3) / 4 * 4; /* keeps vectors aligned */
  return from;
}

static int open_piece(const flow *f, piece *p, size_t zonotope) {
  size_t nx = f->nx, np = f->np, nb = f->ns * (nx + np);
  *p = (piece) { .block = doubles(f->host, piece_doubles(f, zonotope) + 13 * 4) };
  if (!p->block) return 0;
  double *at = p->block;
  p->x = take(&at, nx * f->space.size), p->p = take(&at, np * f->space.size);
  p->zonotope = take(&at, f->ns * zonotope);
  p->mid = take(&at, nb), p->rad = take(&at, nb);
  p->from = take(&at, f->m), p->to = take(&at, f->m), p->parameter_rad = take(&at, np);
  p->lo = take(&at, nx), p->hi = take(&at, nx), p->tube_lo = take(&at, nx), p->tube_hi = take(&at, nx);
  p->pad = take(&at, nx);
  return 1;
}

static int open_pieces(flow *f) {
  size_t zonotope = f->worker[0].shape.size;
  if (!f->options.pieces_max)
    f->options.pieces_max = flow_automatic_pieces(piece_doubles(f, zonotope) * sizeof(double), f->space.count);
  uint32_t n = f->m ? f->options.pieces_max : 1;
  f->piece = f->host->alloc(f->host, (n + 1u) * sizeof *f->piece);
  f->todo = f->host->alloc(f->host, (n + 1u) * sizeof *f->todo);
  if (!f->piece || !f->todo) return 0;
  for (uint32_t i = 0; i <= n; i++)
    if (!open_piece(f, &f->piece[i], zonotope)) return 0;
  return 1;
}

/* -- threads */

static int open_arrays(flow *f, worker *w) {
  size_t nx = f->nx, nin = f->problem.rhs->nin, q = f->options.slope_order + 1, ns = f->ns, size = f->space.size;
  const struct {
    double **array;
    size_t count;
  } list[] = { { &w->tail_in, nin }, { &w->dtail_in, nin * nx }, { &w->tail_out, nx }, { &w->dtail_out, nx * nx },
    { &w->local, nx }, { &w->truncation, nx }, { &w->size, nx }, { &w->eps, nx }, { &w->deps, nx * nx },
    { &w->excess, nx }, { &w->dexcess, nx * nx }, { &w->box_mid, nx * q }, { &w->box_rad, nx * q },
    { &w->slope_mid, nx * q * nx }, { &w->slope_rad, nx * q * nx }, { &w->near_mid, nx }, { &w->near_rad, nx },
    { &w->A, nx * nx }, { &w->unit, nx }, { &w->weight, nx }, { &w->rate, nx * nx }, { &w->group_mid, nx + f->np },
    { &w->group_rad, nx + f->np }, { &w->group_rest, nx }, { &w->transfer_mid, ns * nx * nx },
    { &w->transfer_rad, ns * nx * nx }, { &w->apart, ns * nx }, { &w->reach, ns * nx }, { &w->x, nx * size },
    { &w->q, size }, { &w->scratch, 4 * nx }, { &w->seed, nx }, { &w->zero, nx }, { &w->tube_lo, nx },
    { &w->tube_hi, nx }, { &w->rounding, nx } };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (!(*list[i].array = doubles(f->host, list[i].count))) return 0;
  return zonotope_open(f->host, &w->shape, f->nx, f->options.keep) &&
         search_open(f->host, &w->search, &f->space, f->ns + LEAVES);
}

static ambit_status open_worker(flow *f, worker *w, void *actx) {
  const ambit_problem *p = &f->problem;
  const ambit_jet_service *j = f->jet;
  w->flow = f;
  w->counted = ambit_work_open(f->host);
  w->source = (series_source) { &f->space, f->num, NULL };
  w->polynomials = (ambit_arithmetic) { .size = sizeof w->polynomials, .rigorous = 1, .jets = &series_jets };
  if (!open_arrays(f, w)) return no_memory(f->host);
  ambit_status status = j->open(f->host, p->rhs, &w->polynomials, &w->source, f->options.time_order, 0, NULL, &w->jet);
  if (status != AMBIT_OK) return status;
  w->series = w->source.made;
  status = j->open(f->host, p->rhs, p->arithmetic, actx, f->options.slope_order, f->nx, NULL, &w->box);
  if (status != AMBIT_OK) return status;
  return j->open(f->host, p->rhs, p->arithmetic, actx, 0, f->nx, NULL, &w->near);
}

static ambit_status open_workers(flow *f) {
  const ambit_problem *p = &f->problem;
  /* a context that remembers (affine: which symbols are taken) would make results depend on who does which piece */
  int forgets = !p->arithmetic->open;
  f->nworker = p->worker && p->nworker > 1 && f->m && f->pool_service && forgets ? p->nworker : 1;
  f->worker = f->host->alloc(f->host, f->nworker * sizeof *f->worker);
  if (!f->worker) return no_memory(f->host);
  for (uint32_t i = 0; i < f->nworker; i++) {
    ambit_status status = open_worker(f, &f->worker[i], p->worker ? p->worker[i] : p->actx);
    if (status != AMBIT_OK) return status;
  }
  return f->nworker > 1 ? f->pool_service->open(f->host, f->nworker, &f->pool) : AMBIT_OK;
}

/* -- records */

static int open_set(flow *f) {
  const space *s = &f->space;
  uint32_t nu = f->problem.nu, at = 0;
  double *scale = doubles(f->host, nu);
  f->exponent = f->host->alloc(f->host, ((size_t)s->count * nu + 1) * sizeof *f->exponent);
  f->coefficient = doubles(f->host, (size_t)f->nx * s->count), f->rest = doubles(f->host, f->nx);
  if (!scale || !f->exponent || !f->coefficient || !f->rest) return 0;
  for (uint32_t v = 0; v < nu; v++) scale[v] = f->unit_rad[v] > 0 ? f->unit_rad[v] : 1;
  for (uint32_t r = 0; r < s->nrow; r++)
    for (uint32_t j = 0; j < s->row[r].length; j++) {
      const uint32_t *e = s->exponent + (size_t)r * s->m;
      int own = nu == 0 && j > 0;
      for (uint32_t v = nu > 0 ? nu : 1; v < s->m; v++) own |= e[v] != 0;
      if (own) continue;
      for (uint32_t v = 0; v < nu; v++) f->exponent[(size_t)at * nu + v] = v ? e[v] : j;
      at++;
    }
  f->set = (ambit_set) { .size = sizeof f->set,
    .nu = nu,
    .nterm = at,
    .about = f->unit_mid,
    .scale = scale,
    .exponent = f->exponent,
    .coefficient = f->coefficient,
    .rest = f->rest };
  return 1;
}

static int open_records(flow *f) {
  size_t nx = f->nx;
  f->lo = doubles(f->host, nx), f->hi = doubles(f->host, nx), f->limit = doubles(f->host, nx);
  f->tube_lo = doubles(f->host, nx), f->tube_hi = doubles(f->host, nx);
  if (!f->lo || !f->hi || !f->limit || !f->tube_lo || !f->tube_hi || !open_set(f)) return 0;
  return !(f->problem.extras & AMBIT_EXTRA_DENSE) || flow_open_dense(f);
}

static ambit_status open_all(flow *f) {
  ambit_status status = start_open(f);
  if (status == AMBIT_NOMEM) return no_memory(f->host);
  if (status != AMBIT_OK) return status;
  if (!choose_cuts(f) || !choose_groups(f)) return no_memory(f->host);
  status = open_workers(f);
  if (status != AMBIT_OK) return status;
  return open_pieces(f) && open_records(f) ? AMBIT_OK : no_memory(f->host);
}

ambit_status flow_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  *self = NULL;
  options o;
  ambit_status status = flow_choose(h, p, option, &o);
  if (status != AMBIT_OK) return status;
  flow *f = h->alloc(h, sizeof *f);
  if (!f) return no_memory(h);
  *f = (flow) { .host = h, .options = o, .nx = p->nx, .np = p->np };
  memcpy(&f->problem, p, p->size < sizeof f->problem ? p->size : sizeof f->problem);
  f->jet = h->service(h, AMBIT_JET_SERVICE), f->num = h->service(h, AMBIT_NUM_SERVICE);
  f->pool_service = h->service(h, AMBIT_POOL_SERVICE);
  if (!f->jet || !f->num)
    return h->fail(h, AMBIT_INVALID, "taylor_model: this kernel does not lend `%s` and `%s`", AMBIT_JET_SERVICE,
        AMBIT_NUM_SERVICE);
  status = open_all(f);
  if (status == AMBIT_OK)
    *self = f;
  else
    flow_close(f);
  return status;
}

void flow_close(void *self) {
  flow *f = self;
  if (f->pool) f->pool_service->close(f->pool);
  for (uint32_t i = 0; i < f->nworker && f->worker; i++) {
    worker *w = &f->worker[i];
    if (w->jet) f->jet->close(w->jet);
    if (w->box) f->jet->close(w->box);
    if (w->near) f->jet->close(w->near);
  }
}
