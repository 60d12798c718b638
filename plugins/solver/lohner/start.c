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

/* -- memory */

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, count ? count * size : size); }

ambit_status field_no_memory(const ambit_host *h) { return h->fail(h, AMBIT_NOMEM, "lohner: out of memory"); }

int field_allocate(const ambit_host *h, size_t n, const request *list) {
  for (size_t i = 0; i < n; i++)
    if (!(*list[i].array = room(h, list[i].count, sizeof(double)))) return 0;
  return 1;
}

/* -- the initial set */

typedef struct initial { /* scratch of open() */
  ambit_jet *centre, *box;
  balls value, slope; /* [nx + np] [(nx + np) x nu] */
  double *seed;
} initial;

static ambit_status open_initial(const field *f, initial *g) {
  const ambit_problem *p = &f->problem;
  size_t n = (size_t)p->nx + p->np, nu = p->nu;
  *g = (initial) { 0 };
  const request list[] = { { &g->value.mid, n }, { &g->value.rad, n }, { &g->slope.mid, n * nu },
    { &g->slope.rad, n * nu }, { &g->seed, nu } };
  if (!field_allocate(f->host, sizeof list / sizeof *list, list)) return field_no_memory(f->host);
  ambit_status status = f->jet->open(f->host, p->initial, p->arithmetic, p->actx, 1, 0, NULL, &g->centre);
  if (status != AMBIT_OK) return status;
  return f->jet->open(f->host, p->initial, p->arithmetic, p->actx, 1, p->nu, g->centre, &g->box);
}

static void close_initial(const field *f, initial *g) {
  if (g->centre) f->jet->close(g->centre);
  if (g->box) f->jet->close(g->box);
}

/* g and its slopes at u = about + scale xi; AMBIT_F_* */
static AMBIT_WORKER uint32_t evaluate_initial(const field *f, initial *g, double *about, double *scale) {
  const ambit_problem *p = &f->problem;
  for (uint32_t i = 0; i < p->nu; i++) {
    ball u = ball_of(-p->u_lo[i], p->u_hi[i]);
    about[i] = u.mid, scale[i] = u.rad;
    for (uint32_t j = 0; j < p->nu; j++) g->seed[j] = i == j ? u.rad : 0;
    f->jet->put(g->centre, i, 0, u.mid, 0, NULL, NULL);
    f->jet->put(g->box, i, 0, u.mid, u.rad, g->seed, NULL);
  }
  uint32_t flags = f->jet->advance(g->centre, 0);
  flags |= f->jet->advance(g->box, 0); /* slopes build on the centre */
  for (uint32_t i = 0; i < p->nx + p->np && !flags; i++) {
    double mid, rad;
    balls value = balls_at(g->value, i), slope = balls_at(g->slope, (size_t)i * p->nu);
    f->jet->get(g->centre, p->initial->out[i], 0, value.mid, value.rad, NULL, NULL);
    f->jet->get(g->box, p->initial->out[i], 0, &mid, &rad, slope.mid, slope.rad);
    for (uint32_t j = 0; j < p->nu; j++) *value.rad += slope.rad[j];
  }
  return flags;
}

/* a box that gets a column of its own */
static int is_column(uint32_t nx, balls value, uint32_t i) {
  return i < nx ? value.rad[i] > THIN * fabs(value.mid[i]) + 0x1p-1000 : value.rad[i] > 0;
}

static uint32_t count_columns(const field *f, const initial *g) {
  uint32_t count = f->problem.nu;
  for (uint32_t i = 0; i < f->nx + f->np; i++) count += is_column(f->nx, g->value, i) != 0;
  return count;
}

static void keep_origin(const initial *g, field *f, origin *o) {
  uint32_t nx = f->nx, nc = f->nc, nu = f->problem.nu, own = nu;
  for (uint32_t i = 0; i < nx + f->np; i++) {
    double *row = i < nx ? o->column + (size_t)i * nc : f->fixed_column + (size_t)(i - nx) * nc;
    if (nu) memcpy(row, g->slope.mid + (size_t)i * nu, nu * sizeof *row);
    int column = is_column(nx, g->value, i);
    if (column) row[own++] = g->value.rad[i];
    if (i >= nx)
      f->fixed[i - nx] = g->value.mid[i];
    else
      o->centre[i] = g->value.mid[i], o->rest[i] = column ? 0 : g->value.rad[i];
  }
}

/* -- a run */

/* of the field, once its columns are counted, and of the origin */
static int allocate(field *f, origin *o) {
  size_t nx = f->nx, np = f->np, nc = f->nc;
  const request list[] = { { &o->centre, nx }, { &o->rest, nx }, { &o->column, nx * nc }, { &f->fixed, np },
    { &f->fixed_column, np * nc }, { &f->seed, f->ndir }, { &f->whole.from, nc }, { &f->whole.to, nc } };
  if (!field_allocate(f->host, sizeof list / sizeof *list, list)) return 0;
  for (size_t j = 0; j < nc; j++) f->whole.from[j] = -1, f->whole.to[j] = 1;
  return 1;
}

static ambit_status open_parts(lohner *s) {
  const field *f = &s->field;
  if (!set_open(f, &s->set) || !control_open(f, &s->control) || !extras_open(f, &s->extras))
    return field_no_memory(f->host);
  ambit_status status = flow_open(f, &s->flow);
  if (status == AMBIT_OK) status = slopes_open(f, &s->slopes);
  return status == AMBIT_OK ? constraint_open(f, &s->set, &s->constraint) : status;
}

static ambit_status open_set(lohner *s, initial *g) {
  field *f = &s->field;
  const ambit_host *h = f->host;
  const request list[] = { { &s->extras.about, f->problem.nu }, { &s->extras.scale, f->problem.nu } };
  if (!field_allocate(h, sizeof list / sizeof *list, list)) return field_no_memory(h);
  ambit_rounding old = ambit_round_up();
  uint32_t flags = evaluate_initial(f, g, s->extras.about, s->extras.scale);
  ambit_rounding_restore(old);
  if (flags)
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_INITIAL,
        "at t = %.9g s the initial values could not be bounded for all values of their uncertain data; narrow the "
        "ranges of the data in `initial`",
        f->problem.time[0]);
  f->nc = count_columns(f, g);
  f->ndir = f->nc + f->nx;
  if (!allocate(f, &s->origin)) return field_no_memory(h);
  keep_origin(g, f, &s->origin);
  return open_parts(s);
}

ambit_status lohner_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  *self = NULL;
  ambit_status status = check_options(h, option);
  if (status != AMBIT_OK) return status;
  lohner *s = h->alloc(h, sizeof *s);
  if (!s) return field_no_memory(h);
  field *f = &s->field;
  *s = (lohner) { .field = { .host = h, .jet = h->service(h, AMBIT_JET_SERVICE), .nx = p->nx, .np = p->np } };
  memcpy(&f->problem, p, p->size < sizeof f->problem ? p->size : sizeof f->problem);
  if (!f->jet) return h->fail(h, AMBIT_INVALID, "lohner: this kernel does not lend `%s`", AMBIT_JET_SERVICE);
  f->options = choose_options(p, option);
  initial g;
  status = open_initial(f, &g);
  if (status == AMBIT_OK) status = open_set(s, &g);
  close_initial(f, &g);
  if (status == AMBIT_OK)
    *self = s;
  else
    lohner_close(s);
  return status;
}

void lohner_close(void *self) {
  lohner *s = self;
  flow_close(&s->field, &s->flow);
  slopes_close(&s->field, &s->slopes);
  constraint_close(&s->field, &s->constraint);
}

enum why lohner_start(lohner *s) {
  const field *f = &s->field;
  set *x = &s->set;
  double *limit = s->control.sizes.limit;
  size_t bytes = f->nx * sizeof(double);
  memcpy(x->centre, s->origin.centre, bytes);
  memset(x->low, 0, bytes);
  if (f->nc) memcpy(x->column, s->origin.column, bytes * f->nc);
  history_clear(&x->history);
  history_push(&x->history, s->origin.rest);
  x->t = s->flow.t = s->flow.t_next = f->problem.time[0];
  set_hull(f, x);
  /* of the set as given: the hull of a cut set may be far smaller than the set that is kept (meet_hull) */
  double given = f->options.width_max, factor = given > 0 ? given : AMBIT_WIDTH;
  for (uint32_t i = 0; i < f->nx; i++) limit[i] = factor * larger(given > 0, larger(fabs(x->lo[i]), fabs(x->hi[i])));
  if (!constraint_cut(f, x, NULL, &s->constraint)) return WHY_APART;
  constraint_note_rank(f, x, &s->constraint);
  control_start(f, x, &s->control);
  s->slopes.wide = 0, s->slopes.varies = 0;
  return WHY_NOTHING;
}
