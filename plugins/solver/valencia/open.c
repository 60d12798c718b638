/* open.c -- options, memory, the initial set. */
#include "valencia.h"
#include <ambit/code.h>
#include <string.h>

enum { ORDER, DEGREE, TOLERANCE, EXPONENTIAL, STEP_MAX, STEP_MIN, WIDTH_MAX };

#define ORDER_MAX 20
#define DEGREE_MAX 16

static ambit_status no_memory(const ambit_host *h) { return h->fail(h, AMBIT_NOMEM, "valencia: out of memory"); }

static ambit_status refuse(const ambit_host *h, int option, const char *expected, double value) {
  return h->fail(
      h, AMBIT_INVALID, "valencia: option `%s` must be %s, not %g", valencia_param[option].name, expected, value);
}

static ambit_status check_options(const ambit_host *h, const double *o) {
  if (o[ORDER] != 0 && !(o[ORDER] >= 4 && o[ORDER] <= ORDER_MAX)) return refuse(h, ORDER, "0 or 4 to 20", o[ORDER]);
  if (!(o[DEGREE] >= 0 && o[DEGREE] <= DEGREE_MAX)) return refuse(h, DEGREE, "0 to 16", o[DEGREE]);
  if (!(o[TOLERANCE] >= 0 && o[TOLERANCE] < INFINITY)) return refuse(h, TOLERANCE, "0 or greater", o[TOLERANCE]);
  if (!(o[STEP_MAX] > 0)) return refuse(h, STEP_MAX, "greater than 0", o[STEP_MAX]);
  if (!(o[STEP_MIN] >= 0 && o[STEP_MIN] < INFINITY)) return refuse(h, STEP_MIN, "0 or greater", o[STEP_MIN]);
  if (!(o[WIDTH_MAX] >= 0)) return refuse(h, WIDTH_MAX, "0 (automatic) or greater", o[WIDTH_MAX]);
  return AMBIT_OK;
}

static options choose_options(const double *o) {
  return (options) { .order = o[ORDER] > 0 ? (uint32_t)o[ORDER] : 10,
    .degree = (uint32_t)o[DEGREE],
    .tolerance = o[TOLERANCE] > 0 ? o[TOLERANCE] : 1e-12,
    .exponential = (enum exponential)o[EXPONENTIAL],
    .step_max = o[STEP_MAX],
    .step_min = o[STEP_MIN],
    .width_max = o[WIDTH_MAX] };
}

/* what the arithmetic keeps, as monomials beyond that would not cancel in the defect; many unknowns get less */
static void choose_degree(valencia *s) {
  static const uint32_t most[] = { 1, 12, 8, 5, 4 };
  uint32_t wanted = s->options.degree, kept = s->symbols.degree;
  if (!wanted) wanted = s->nu < 5 ? most[s->nu] : 2;
  s->options.degree = kept < 2 || wanted < 2 ? 1 : wanted < kept ? wanted : kept;
}

static int allocate(valencia *s) {
  size_t nx = s->nx, np = s->np, nu = s->nu, nt = s->terms.n, n1 = s->stages.n + 1u, sq = nx * nx;
  const struct {
    double **array;
    size_t count;
  } list[] = { { &s->middle, np }, { &s->reach, np * nu }, { &s->loose, np }, { &s->p, nx * nt }, { &s->b, sq },
    { &s->w, nx }, { &s->start_p, nx * nt }, { &s->start_w, nx }, { &s->curve, nx * nt * n1 }, { &s->frame, sq * n1 },
    { &s->start, nx }, { &s->rounding, nx }, { &s->kept, sq }, { &s->tail, 2 * (nx + 1) * (s->ncolumn + 2) + 2 * nx },
    { &s->reach_z, nx }, { &s->omega, nx }, { &s->top, nx }, { &s->eta, nx }, { &s->forcing, nx }, { &s->growth, sq },
    { &s->last, nx }, { &s->error, nx }, { &s->over, nx }, { &s->shift, nx }, { &s->steerable, nx }, { &s->radius, nx },
    { &s->generator, 3 * sq }, { &s->size, nx }, { &s->scale, nx }, { &s->shape, 3 * sq }, { &s->sum, 3 * nx },
    { &s->directions, sq }, { &s->next_w, nx }, { &s->scratch, sq + 4 * nx + 2 * np + n1 + 4 }, { &s->magnitude, nx },
    { &s->noise, nx }, { &s->spectrum, n1 * nx }, { &s->coefficients, n1 + nx * (2 + s->ndir) },
    { &s->fitted, nx * nt * n1 }, { &s->sampled, nx * n1 * s->terms.nsample }, { &s->limit, nx }, { &s->face_lo, nx },
    { &s->face_hi, nx }, { &s->lo, nx }, { &s->hi, nx }, { &s->tube_lo, nx }, { &s->tube_hi, nx },
    { &s->dense_mid, nx * n1 }, { &s->dense_rad, nx * n1 }, { &s->rest, nx }, { &s->set_about, nu },
    { &s->set_scale, nu }, { &s->eigen_room, 3 * sq + 4 * nx }, { &s->basis.v, sq } };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (!(*list[i].array = s->host->alloc(s->host, (list[i].count + 1) * sizeof(double)))) return 0;
  const struct {
    interval **array;
    size_t count;
  } intervals[] = { { &s->jacobian, nx * s->ndir }, { &s->defect, nx }, { &s->rate, nx }, { &s->matrix, sq },
    { &s->column, 3 * nx + n1 }, { &s->residual, s->ncolumn * nx }, { &s->basis.inverse, sq } };
  for (size_t i = 0; i < sizeof intervals / sizeof *intervals; i++)
    if (!(*intervals[i].array = s->host->alloc(s->host, (intervals[i].count + 1) * sizeof(interval)))) return 0;
  s->basis.first = s->host->alloc(s->host, (nx + 1) * sizeof *s->basis.first);
  return s->basis.first != NULL;
}

/* Slopes about the middle are twice as tight as derivatives, but bound the sum over all columns only: none of them may
** be intersected with another bound, nor the sum over the unknowns be replaced. So they serve where there is no
** other. */
static int open_series(valencia *s) {
  const ambit_problem *p = &s->problem;
  uint32_t n = s->stages.n;
  s->centred = s->terms.n <= 1 + s->nu && !s->symbols.keeps;
  return s->jet->open(s->host, p->rhs, p->arithmetic, p->actx, n + 2, 0, NULL, &s->centre) == AMBIT_OK &&
         s->jet->open(s->host, p->rhs, p->arithmetic, p->actx, n, s->ncolumn, s->centred ? s->centre : NULL, &s->box) ==
             AMBIT_OK;
}

static ambit_status open_origin(valencia *s) {
  const ambit_problem *p = &s->problem;
  ambit_lane lane = { 0 };
  size_t nslot = p->initial->nslot;
  interval *range = s->host->alloc(s->host, nslot * sizeof *range);
  interval *slope = s->host->alloc(s->host, (nslot * s->nu + 1) * sizeof *slope);
  if (!range || !slope || ambit_lane_open(&lane, s->host, p->initial, p->arithmetic, p->actx) != AMBIT_OK)
    return no_memory(s->host);
  ambit_rounding old = ambit_round_up();
  uint32_t flags = valencia_origin(s, &lane, range, slope);
  ambit_rounding_restore(old);
  ambit_lane_close(&lane);
  if (flags)
    return s->host->fail_code(s->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_INITIAL,
        "at t = %.9g s the initial values could not be bounded for all values of their uncertain data; narrow the "
        "ranges of the data in `initial`",
        s->problem.time[0]);
  memcpy(s->start_p, s->p, s->nx * s->terms.n * sizeof *s->p);
  memcpy(s->start_w, s->w, s->nx * sizeof *s->w);
  return AMBIT_OK;
}

static AMBIT_WORKER int open_parts(valencia *s) {
  if (!valencia_symbols_open(s)) return 0;
  choose_degree(s);
  if (!valencia_terms_open(s)) return 0;
  s->ncolumn = s->nx + (s->terms.n <= 1 + s->nu ? s->nu : 0);
  return valencia_stages_open(s) && allocate(s) && open_series(s);
}

ambit_status valencia_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  *self = NULL;
  ambit_status status = check_options(h, option);
  if (status != AMBIT_OK) return status;
  valencia *s = h->alloc(h, sizeof *s);
  if (!s) return no_memory(h);
  *s = (valencia) { .host = h, .nx = p->nx, .np = p->np, .nu = p->nu, .ndir = p->nx + p->np };
  memcpy(&s->problem, p, p->size < sizeof s->problem ? p->size : sizeof s->problem);
  s->counted = ambit_work_open(h), s->meter = h->service(h, AMBIT_METER_SERVICE);
  s->num = h->service(h, AMBIT_NUM_SERVICE), s->jet = h->service(h, AMBIT_JET_SERVICE);
  if (!s->num || !s->jet)
    return h->fail(
        h, AMBIT_INVALID, "valencia: this kernel does not lend `%s`", s->num ? AMBIT_JET_SERVICE : AMBIT_NUM_SERVICE);
  s->options = choose_options(option);
  status = open_parts(s) ? open_origin(s) : no_memory(h);
  if (status == AMBIT_OK)
    *self = s;
  else
    valencia_close(s);
  return status;
}

void valencia_close(void *self) {
  valencia *s = self;
  if (s->box) s->jet->close(s->box);
  if (s->centre) s->jet->close(s->centre);
  valencia_symbols_close(s);
}
