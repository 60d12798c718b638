/* open.c -- options and memory. */
#include "stiff.h"
#include "nodes.h"
#include <string.h>

enum { OPTION_NODES, OPTION_DEGREE, OPTION_TOLERANCE, OPTION_STEP_MAX, OPTION_STEP_MIN, OPTION_WIDTH_MAX };

#define LEAST_TOLERANCE 1e-22
#define DEGREE_MAX 20
#define MOST_ROWS 4e5 /* of all slots of both tapes: memory and time */

static ambit_status refuse(const ambit_host *h, const char *option, const char *expected, double got) {
  return h->fail(h, AMBIT_INVALID, "stiff: option `%s` must be %s, not %g", option, expected, got);
}

static ambit_status check_options(const ambit_host *h, const double *o) {
  double nodes = o[OPTION_NODES];
  if (nodes != 0 && !(nodes >= 4 && nodes <= NODES_MAX)) return refuse(h, "nodes", "0 (automatic) or 4 to 20", nodes);
  if (!(o[OPTION_DEGREE] >= 0 && o[OPTION_DEGREE] <= DEGREE_MAX))
    return refuse(h, "degree", "0 (automatic) to 20", o[OPTION_DEGREE]);
  if (!(o[OPTION_TOLERANCE] >= 0 && o[OPTION_TOLERANCE] <= 1))
    return refuse(h, "tolerance", "in [0, 1]", o[OPTION_TOLERANCE]);
  if (!(o[OPTION_STEP_MAX] > 0)) return refuse(h, "step_max", "greater than 0", o[OPTION_STEP_MAX]);
  if (!(o[OPTION_STEP_MIN] >= 0 && o[OPTION_STEP_MIN] <= o[OPTION_STEP_MAX]))
    return refuse(h, "step_min", "0 (automatic) to step_max", o[OPTION_STEP_MIN]);
  if (!(o[OPTION_WIDTH_MAX] >= 0)) return refuse(h, "width_max", "0 (automatic) or greater", o[OPTION_WIDTH_MAX]);
  return AMBIT_OK;
}

/* One node for each digit of the tolerance, and one: measured, the least work for 1e-15 is at 14 to 16. */
static options choose_options(const double *o) {
  options r = { .tolerance = fmax(o[OPTION_TOLERANCE], LEAST_TOLERANCE),
    .step_max = o[OPTION_STEP_MAX],
    .step_min = o[OPTION_STEP_MIN],
    .width_max = o[OPTION_WIDTH_MAX] };
  double automatic = fmin(fmax(1 - log10(r.tolerance), 6), NODES_MAX);
  r.degree = (uint32_t)o[OPTION_DEGREE];
  r.nodes = (uint32_t)(o[OPTION_NODES] != 0 ? o[OPTION_NODES] : automatic);
  return r;
}

/* -- memory */

static void *take(const stiff *s, size_t count, size_t size) {
  return s->host->alloc(s->host, count ? count * size : size);
}

static int open_vectors(stiff *s) {
  size_t n = s->n, nx = s->nx, w = s->q.N + 1, count = s->spread ? s->terms.count : 1;
  const struct {
    double **array;
    size_t count;
  } list[] = { { &s->start_column, n * s->problem.nu }, { &s->start_rest, s->inputs }, { &s->about, s->problem.nu },
    { &s->scale, s->problem.nu }, { &s->end_error, n }, { &s->saved_error, n }, { &s->rate, (PIECES_MAX + 1) * n * n },
    { &s->slopes.coefficient, nx * n * (SLOPE_ORDER + 1) }, { &s->slopes.tail, nx * n }, { &s->box, n },
    { &s->defect, nx * w * count }, { &s->defect_tail, nx }, { &s->gap, n }, { &s->gap_error, n }, { &s->radius, n },
    { &s->shift, n }, { &s->below, n }, { &s->lo, nx }, { &s->hi, nx }, { &s->tube_lo, nx }, { &s->tube_hi, nx },
    { &s->limit, nx }, { &s->dense_mid, nx * w }, { &s->dense_rad, nx * w }, { &s->set_middle, nx },
    { &s->set_rest, nx } };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (!(*list[i].array = take(s, list[i].count, sizeof(double)))) return 0;
  s->slopes.count = take(s, nx * n, sizeof *s->slopes.count);
  s->start = take(s, s->inputs, sizeof *s->start);
  s->end = take(s, n, sizeof *s->end);
  s->saved_end = take(s, n, sizeof *s->saved_end);
  s->spectrum = take(s, PIECES_MAX + 1, sizeof *s->spectrum);
  s->table = take(s, pieces_table_size(s->q.N), sizeof *s->table);
  s->P = take(s, s->inputs, sizeof *s->P);
  s->dense_sum = take(s, nx * w, sizeof *s->dense_sum);
  s->exponent = take(s, s->problem.nu, sizeof *s->exponent);
  if (!s->slopes.count || !s->start || !s->end || !s->saved_end || !s->spectrum || !s->table || !s->P ||
      !s->dense_sum || !s->exponent)
    return 0;
  for (size_t i = 0; i < s->inputs; i++) {
    s->P[i].hi = take(s, 2 * w, sizeof(double));
    if (!s->P[i].hi) return 0;
    s->P[i].lo = s->P[i].hi + w;
  }
  return 1;
}

static int open_tapes(stiff *s) {
  const ambit_host *h = s->host;
  const ambit_problem *p = &s->problem;
  if (!series_open(h, s->num, p->rhs, s->q.N, &s->rhs) || !real_open(h, &s->rhs, &s->rhs_real)) return 0;
  if (!series_open(h, s->num, p->jacobian, SLOPE_ORDER, &s->jacobian)) return 0;
  if (!real_open(h, &s->jacobian, &s->jacobian_real)) return 0;
  if (s->np == 0) return 1;
  return series_open(h, s->num, p->slope, SLOPE_ORDER, &s->slope) && real_open(h, &s->slope, &s->slope_real);
}

static int open_memory(stiff *s) {
  s->q = (collocation) { .N = s->options.nodes,
    .nx = s->nx,
    .np = s->problem.np,
    .uses_time = s->problem.uses_time,
    .rhs = &s->rhs_real,
    .jacobian = &s->jacobian_real };
  if (!open_vectors(s) || !open_tapes(s) || !collocation_open(s->host, &s->q) || !nodes_fill(&s->q)) return 0;
  if (s->spread && (!spread_open(s) || !natural_open(s))) return 0;
  pieces_fill(s->table, s->q.N);
  return 1;
}

/* parameters, and how fast things are at the start */
static void prepare(stiff *s) {
  collocation *q = &s->q;
  uint32_t nx = s->nx;
  square J;
  double slowest = INFINITY;
  q->tolerance = s->options.tolerance;
  for (uint32_t i = 0; i < s->inputs; i++) q->x[i] = dd_long(s->start[i]);
  for (uint32_t i = nx; i < s->n; i++) {
    double reach = 1e-3 * fabs(s->start[i].hi) + s->start_rest[i];
    for (uint32_t j = 0; j < s->problem.nu; j++) reach += fabs(s->start_column[i * s->problem.nu + j]);
    q->size[i] = q->scale[i] = reach > 0 ? reach : 1;
  }
  memcpy(real_input(q->jacobian, 0), q->x, s->inputs * sizeof *q->x);
  memcpy(real_input(q->rhs, 0), q->x, s->inputs * sizeof *q->x);
  if (q->uses_time) *real_input(q->jacobian, s->inputs) = *real_input(q->rhs, s->inputs) = s->problem.time[0];
  real_run(q->rhs);
  real_run(q->jacobian);
  for (uint32_t i = 0; i < nx * nx; i++) J[i] = (double)real_output(q->jacobian, i);
  for (uint32_t i = 0; i < nx; i++) { /* the slowest state that moves: a fast one may only be near zero */
    double rate = fabs((double)real_output(q->rhs, i)) / fabs(s->start[i].hi);
    if (rate > 0 && rate < slowest) slowest = rate;
  }
  s->first_rate = matrix_radius(nx, J) + (slowest < INFINITY ? slowest : 0);
}

/* a polynomial of the unknowns, where their number allows it; then parameters need not be followed */
static int open_terms(stiff *s) {
  uint32_t nu = s->problem.nu, degree = nu ? terms_degree(nu) : 0;
  if (degree == 0) return 1;
  if (s->options.degree && s->options.degree < degree) degree = s->options.degree;
  if (nu == 1 && s->options.degree) degree = s->options.degree;
  double slots = (double)s->problem.rhs->nslot + s->problem.jacobian->nslot;
  while (degree > 1 && slots * terms_count(nu, degree) > MOST_ROWS) degree--;
  s->spread = 1, s->np = 0, s->n = s->nx;
  return terms_open(s->host, nu, degree, &s->terms);
}

static ambit_status fill(stiff *s, const ambit_host *h, const ambit_problem *p) {
  if (!open_terms(s)) return h->fail(h, AMBIT_NOMEM, "stiff: out of memory");
  if (s->n > N_MAX)
    return h->fail(h, AMBIT_INVALID,
        "stiff: %u states and %u uncertain parameters, but no more than %d can be followed", s->nx, s->np, N_MAX);
  if (s->np && !p->slope)
    return h->fail(h, AMBIT_INVALID, "stiff: the right-hand side has no derivative by its uncertain parameters");
  if (!s->num) return h->fail(h, AMBIT_INVALID, "stiff: this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  if (!open_memory(s)) return h->fail(h, AMBIT_NOMEM, "stiff: out of memory");
  ambit_status status = start_read(s);
  if (status == AMBIT_OK) prepare(s);
  return status;
}

ambit_status stiff_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  *self = NULL;
  ambit_status status = check_options(h, option);
  if (status != AMBIT_OK) return status;
  stiff *s = h->alloc(h, sizeof *s);
  if (!s) return h->fail(h, AMBIT_NOMEM, "stiff: out of memory");
  s->host = h, s->num = h->service(h, AMBIT_NUM_SERVICE), s->counted = ambit_work_open(h);
  memcpy(&s->problem, p, p->size < sizeof s->problem ? p->size : sizeof s->problem);
  s->nx = p->nx, s->np = p->np, s->n = s->inputs = p->nx + p->np;
  s->options = choose_options(option);
  ambit_rounding old = ambit_round_nearest();
  status = fill(s, h, p);
  ambit_rounding_restore(old);
  if (status == AMBIT_OK)
    *self = s;
  else
    stiff_close(s);
  return status;
}

void stiff_close(void *self) { (void)self; } /* all memory is the arena's */
