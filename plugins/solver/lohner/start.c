/* start.c -- memory, options and the initial set.
**
** The initial states and the parameters are functions g of the unknowns u = mid + radius xi, so g(u) = g(mid) + sum_j
** s_j radius_j xi_j with slopes s about the midpoint: the midpoints of s_j radius_j are the columns of the set, what
** remains goes into boxes. A box that is not thin, of an initial value given as a plain interval, becomes a column of
** its own, because columns are never condensed; so does every box of a parameter, which must stay the same number for
** all time.
*/
#include "lohner.h"
#include <ambit/code.h>
#include <string.h>

#define SHORT 0x1p-10          /* of the time span: the least first guess of a step */
#define THIN 0x1p-40           /* relative radius up to which an initial box is a matter of rounding */
#define LEAST_TOLERANCE 1e-22  /* far below the rounding errors of a step */
#define LEAST_HISTORY 4        /* so that the older half is at least two groups, and condensing makes fewer of them */
#define LARGEST_FOR_HISTORY 48 /* states; beyond it, moving the history would dominate */

enum {
  OPTION_ORDER,
  OPTION_SLOPE_ORDER,
  OPTION_TOLERANCE,
  OPTION_SET,
  OPTION_HISTORY,
  OPTION_PIECES,
  OPTION_FORMULA,
  OPTION_STEP_MAX,
  OPTION_STEP_MIN,
  OPTION_WIDTH_MAX
};
enum { SET_AUTO, SET_QR, SET_HISTORY };

/* -- options */

static ambit_status refuse(const ambit_host *h, const char *option, const char *expected, double got) {
  return h->fail(h, AMBIT_INVALID, "lohner: option `%s` must be %s, not %g", option, expected, got);
}

static ambit_status check_options(const ambit_host *h, const double *o) {
  double order = o[OPTION_ORDER], slopes = o[OPTION_SLOPE_ORDER], pieces = o[OPTION_PIECES];
  if (order != 0 && !(order >= 4 && order <= 60)) return refuse(h, "order", "0 (automatic) or 4 to 60", order);
  if (slopes != 0 && !(slopes >= 3 && slopes <= 60 && (order == 0 || slopes <= order)))
    return refuse(h, "jacobian_order", "0 (automatic) or 3 to the order", slopes);
  if (!(o[OPTION_TOLERANCE] >= 0 && o[OPTION_TOLERANCE] <= 1))
    return refuse(h, "tolerance", "in [0, 1]", o[OPTION_TOLERANCE]);
  if (!(o[OPTION_HISTORY] >= 0 && o[OPTION_HISTORY] <= 1024))
    return refuse(h, "history", "0 to 1024", o[OPTION_HISTORY]);
  if (!(pieces >= 1 && pieces <= PIECES_MAX)) return refuse(h, "pieces", "1 to 16", pieces);
  if (!(o[OPTION_STEP_MAX] > 0)) return refuse(h, "step_max", "greater than 0", o[OPTION_STEP_MAX]);
  if (!(o[OPTION_STEP_MIN] >= 0 && o[OPTION_STEP_MIN] <= o[OPTION_STEP_MAX]))
    return refuse(h, "step_min", "0 (automatic) to step_max", o[OPTION_STEP_MIN]);
  if (!(o[OPTION_WIDTH_MAX] >= 0)) return refuse(h, "width_max", "0 (automatic) or greater", o[OPTION_WIDTH_MAX]);
  return AMBIT_OK;
}

/* Orders: with errors going like (h/R)^p, R the radius of convergence, a step to tolerance e has h/R = e^(1/p), and
** work per unit of time goes like p^a / (h/R); that is least at p = ln(1/e) / a, flat around it; measured, 1/a =
** 0.54. Slopes over the box need only be as sharp as the set's own growth: (h/R)^(q+1) about 1e-6. */
static uint32_t automatic_order(double tolerance) {
  double order = log(1 / tolerance) * 0.54;
  return order < 4 ? 4 : order > 40 ? 40 : (uint32_t)order;
}

static uint32_t automatic_slope_order(uint32_t order, double tolerance) {
  double q = order * 13.8 / log(1 / tolerance);
  return q < 3 ? 3 : q > order ? order : (uint32_t)q;
}

static options choose_options(const ambit_problem *p, const double *o) {
  options r = { .history = (uint32_t)o[OPTION_HISTORY],
    .pieces = (uint32_t)o[OPTION_PIECES],
    .formula = (uint32_t)o[OPTION_FORMULA],
    .step_max = o[OPTION_STEP_MAX],
    .step_min = o[OPTION_STEP_MIN],
    .width_max = o[OPTION_WIDTH_MAX],
    .patient = o[OPTION_STEP_MIN] != 0 };
  r.tolerance = larger(o[OPTION_TOLERANCE], LEAST_TOLERANCE);
  double counted = smaller(r.tolerance, 1e-3);
  r.order = o[OPTION_ORDER] != 0 ? (uint32_t)o[OPTION_ORDER] : automatic_order(counted);
  r.slope_order =
      o[OPTION_SLOPE_ORDER] != 0 ? (uint32_t)o[OPTION_SLOPE_ORDER] : automatic_slope_order(r.order, counted);
  if (r.order < r.slope_order) r.order = r.slope_order; /* the centre's series serve the slopes */
  r.slope_order_max = o[OPTION_SLOPE_ORDER] != 0 ? r.slope_order : r.order;
  int classical = o[OPTION_SET] == SET_QR || (o[OPTION_SET] == SET_AUTO && p->nx > LARGEST_FOR_HISTORY);
  if (classical)
    r.history = 0;
  else if (o[OPTION_SET] == SET_HISTORY && r.history == 0)
    r.history = 32;
  if (r.history > 0 && r.history < LEAST_HISTORY) r.history = LEAST_HISTORY;
  return r;
}

/* -- the initial set */

typedef struct origin { /* scratch of open() */
  ambit_jet *centre, *box;
  double *mid, *rad, *slope_mid, *slope_rad, *seed, *no_radius;
} origin;

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, count ? count * size : size); }

static ambit_status no_memory(const ambit_host *h) { return h->fail(h, AMBIT_NOMEM, "lohner: out of memory"); }

static ambit_status open_origin(const lohner *s, origin *o) {
  const ambit_host *h = s->host;
  const ambit_problem *p = &s->problem;
  size_t n = (size_t)p->nx + p->np, nu = p->nu;
  *o = (origin) { .mid = room(h, n, 8),
    .rad = room(h, n, 8),
    .slope_mid = room(h, n * nu, 8),
    .slope_rad = room(h, n * nu, 8),
    .seed = room(h, nu, 8),
    .no_radius = room(h, nu, 8) };
  if (!o->mid || !o->rad || !o->slope_mid || !o->slope_rad || !o->seed || !o->no_radius) return no_memory(h);
  ambit_status status = s->jet->open(h, p->initial, p->arithmetic, p->actx, 1, 0, NULL, &o->centre);
  if (status != AMBIT_OK) return status;
  return s->jet->open(h, p->initial, p->arithmetic, p->actx, 1, p->nu, o->centre, &o->box);
}

static void close_origin(const lohner *s, origin *o) {
  if (o->centre) s->jet->close(o->centre);
  if (o->box) s->jet->close(o->box);
}

/* g and its slopes at u = mid + radius xi; AMBIT_F_* */
static AMBIT_WORKER uint32_t evaluate_origin(lohner *s, origin *o) {
  const ambit_problem *p = &s->problem;
  for (uint32_t i = 0; i < p->nu; i++) {
    ball u = ball_of(-p->u_lo[i], p->u_hi[i]);
    s->about[i] = u.mid, s->scale[i] = u.rad;
    for (uint32_t j = 0; j < p->nu; j++) o->seed[j] = i == j ? u.rad : 0;
    s->jet->put(o->centre, i, 0, u.mid, 0, NULL, NULL);
    s->jet->put(o->box, i, 0, u.mid, u.rad, o->seed, o->no_radius);
  }
  uint32_t flags = s->jet->advance(o->centre, 0);
  flags |= s->jet->advance(o->box, 0); /* slopes build on the centre */
  for (uint32_t i = 0; i < p->nx + p->np && !flags; i++) {
    double mid, rad;
    size_t row = (size_t)i * p->nu;
    s->jet->get(o->centre, p->initial->out[i], 0, &o->mid[i], &o->rad[i], NULL, NULL);
    s->jet->get(o->box, p->initial->out[i], 0, &mid, &rad, o->slope_mid + row, o->slope_rad + row);
    for (uint32_t j = 0; j < p->nu; j++) o->rad[i] += o->slope_rad[row + j];
  }
  return flags;
}

/* a box that gets a column of its own */
static int is_column(const lohner *s, const origin *o, uint32_t i) {
  return i < s->nx ? o->rad[i] > THIN * fabs(o->mid[i]) + 0x1p-1000 : o->rad[i] > 0;
}

static uint32_t count_columns(const lohner *s, const origin *o) {
  uint32_t count = s->problem.nu;
  for (uint32_t i = 0; i < s->nx + s->np; i++) count += is_column(s, o, i) != 0;
  return count;
}

static void keep_origin(lohner *s, const origin *o) {
  uint32_t nu = s->problem.nu, own = nu;
  for (uint32_t i = 0; i < s->nx + s->np; i++) {
    double *row = i < s->nx ? s->start_column + (size_t)i * s->nc : s->fixed_column + (size_t)(i - s->nx) * s->nc;
    if (nu) memcpy(row, o->slope_mid + (size_t)i * nu, nu * sizeof *row);
    int column = is_column(s, o, i);
    if (column) row[own++] = o->rad[i];
    if (i >= s->nx)
      s->fixed[i - s->nx] = o->mid[i];
    else
      s->start[i] = o->mid[i], s->start_rest[i] = column ? 0 : o->rad[i];
  }
}

/* -- memory */

static int allocate_vectors(lohner *s) {
  size_t nx = s->nx, np = s->np, nc = s->nc, nd = s->ndir, nin = s->problem.rhs->nin, p = s->options.order,
         q = s->options.slope_order_max, m = s->options.pieces;
  const struct {
    double **array;
    size_t count;
  } list[] = { { &s->start, nx }, { &s->start_rest, nx }, { &s->start_column, nx * nc }, { &s->fixed, np },
    { &s->fixed_column, np * nc }, { &s->centre, nx }, { &s->low, nx }, { &s->column, nx * nc }, { &s->new_centre, nx },
    { &s->new_low, nx }, { &s->rest, nx }, { &s->radius, nx }, { &s->size, nx }, { &s->unit, nx }, { &s->grown, nx },
    { &s->euler, nx * (nx + 2) }, { &s->limit, nx }, { &s->series_mid, nx * (p + 1) }, { &s->series_rad, nx * (p + 1) },
    { &s->slope_mid, nx * (q + 1) * nd }, { &s->slope_rad, nx * (q + 1) * nd }, { &s->excess, nx },
    { &s->box_excess, nx }, { &s->slope_excess, nx * nd }, { &s->slope_guess, nx * nd }, { &s->tail_in, nin },
    { &s->dtail_in, nin * nd }, { &s->tail_out, nx }, { &s->dtail_out, nx * nd }, { &s->transfer_mid, m * nx * nd },
    { &s->transfer_rad, m * nx * nd }, { &s->whole_mid, nx * nd }, { &s->whole_rad, nx * nd }, { &s->matrix, nx * nd },
    { &s->seed, nd }, { &s->no_radius, nd }, { &s->added, nx }, { &s->curvature, nc }, { &s->all_from, nc },
    { &s->all_to, nc }, { &s->piece_from, m * nc }, { &s->piece_to, m * nc }, { &s->lo, nx }, { &s->hi, nx },
    { &s->tube_lo, nx }, { &s->tube_hi, nx } };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (!(*list[i].array = room(s->host, list[i].count, sizeof(double)))) return 0;
  for (size_t j = 0; j < nc; j++) s->all_from[j] = -1, s->all_to[j] = 1;
  s->cuts = room(s->host, nc, sizeof *s->cuts);
  return s->cuts && history_open(s->host, &s->history, s->nx, s->options.history);
}

static ambit_status open_series(lohner *s) {
  const ambit_problem *p = &s->problem;
  ambit_status status =
      s->jet->open(s->host, p->rhs, p->arithmetic, p->actx, s->options.order, 0, NULL, &s->centre_jet);
  if (status != AMBIT_OK) return status;
  return s->jet->open(
      s->host, p->rhs, p->arithmetic, p->actx, s->options.slope_order_max, s->ndir, s->centre_jet, &s->box_jet);
}

static ambit_status open_set(lohner *s, origin *o) {
  s->about = room(s->host, s->problem.nu, sizeof(double));
  s->scale = room(s->host, s->problem.nu, sizeof(double));
  if (!s->about || !s->scale) return no_memory(s->host);
  ambit_rounding old = ambit_round_up();
  uint32_t flags = evaluate_origin(s, o);
  ambit_rounding_restore(old);
  if (flags)
    return s->host->fail_code(s->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_INITIAL,
        "at t = %.9g s the initial values could not be bounded for all values of their uncertain data; narrow the "
        "ranges of the data in `initial`",
        s->problem.time[0]);
  s->nc = count_columns(s, o);
  s->ndir = s->nc + s->nx;
  if (!allocate_vectors(s) || !lohner_open_extras(s)) return no_memory(s->host);
  keep_origin(s, o);
  ambit_status status = open_series(s);
  if (status == AMBIT_OK && s->options.formula != FORMULA_TAYLOR) status = lohner_open_corrector(s);
  return status == AMBIT_OK ? lohner_open_invariants(s) : status;
}

ambit_status lohner_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  *self = NULL;
  ambit_status status = check_options(h, option);
  if (status != AMBIT_OK) return status;
  lohner *s = h->alloc(h, sizeof *s);
  if (!s) return no_memory(h);
  *s = (lohner) { .host = h, .jet = h->service(h, AMBIT_JET_SERVICE), .nx = p->nx, .np = p->np };
  memcpy(&s->problem, p, p->size < sizeof s->problem ? p->size : sizeof s->problem);
  s->counted = ambit_work_open(h);
  if (!s->jet) return h->fail(h, AMBIT_INVALID, "lohner: this kernel does not lend `%s`", AMBIT_JET_SERVICE);
  s->options = choose_options(p, option);
  origin o;
  status = open_origin(s, &o);
  if (status == AMBIT_OK) status = open_set(s, &o);
  close_origin(s, &o);
  if (status == AMBIT_OK)
    *self = s;
  else
    lohner_close(s);
  return status;
}

void lohner_close(void *self) {
  lohner *s = self;
  if (s->centre_jet) s->jet->close(s->centre_jet);
  if (s->box_jet) s->jet->close(s->box_jet);
  lohner_close_corrector(s);
  lohner_close_invariants(s);
}

enum why lohner_start(lohner *s) {
  const ambit_problem *p = &s->problem;
  size_t bytes = s->nx * sizeof(double);
  memcpy(s->centre, s->start, bytes);
  memset(s->low, 0, bytes);
  if (s->nc) memcpy(s->column, s->start_column, bytes * s->nc);
  history_clear(&s->history);
  history_push(&s->history, s->start_rest);
  s->t = s->t_next = p->time[0];
  lohner_hull(s);
  /* of the set as given: the hull of a cut set may be far smaller than the set that is kept (meet_hull) */
  double given = s->options.width_max, factor = given > 0 ? given : AMBIT_WIDTH;
  for (uint32_t i = 0; i < s->nx; i++) s->limit[i] = factor * larger(given > 0, larger(fabs(s->lo[i]), fabs(s->hi[i])));
  if (lohner_contract(s, s->t, 1) != WHY_NOTHING) return WHY_APART;
  lohner_note_rank(s);
  for (uint32_t i = 0; i < s->nx; i++) s->size[i] = larger(fabs(s->lo[i]), fabs(s->hi[i]));
  lohner_start_pace(s);
  s->next = 1;
  s->wide = 0, s->varies = 0;
  s->lenient = LENIENT_NOT;
  s->longest = INFINITY;
  s->next_slope_order = s->options.slope_order;
  /* an instant that is asked for close to the start says nothing about steps */
  double first = fabs(p->time[1] - p->time[0]), span = fabs(p->time[p->ntime - 1] - p->time[0]);
  s->guess = smaller(larger(first, SHORT * span), s->options.step_max);
  return WHY_NOTHING;
}
