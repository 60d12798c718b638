/* gsl.c -- the steppers of the GNU Scientific Library's odeiv2: one curve from the middle of the data, which proves
** nothing.
**
** It serves as a reference and for sampling. Right-hand side and Jacobian are tapes in the arithmetic `real`; the
** derivative with respect to time, which only the method bsimp reads, is a central difference. GSL allocates its own
** memory in open(); its error handler, which would end the process, is switched off there. The implicit methods also
** allocate while they run: GSL's LU decomposition does, from 2.6 on. Where the right-hand side jumps back and forth the
** control of steps would go on for ever in tiny steps: `steps_max` ends that.
*/
#include <ambit/block.h>
#include <ambit/code.h>
#include <ambit/solver.h>
#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <string.h>

/* in the order of the words of the option `method`; 1: reads the Jacobian */
#define METHODS(X)                                                                                                     \
  X(rk2, 0)                                                                                                            \
  X(rk4, 0)                                                                                                            \
  X(rkf45, 0)                                                                                                          \
  X(rkck, 0)                                                                                                           \
  X(rk8pd, 0)                                                                                                          \
  X(rk2imp, 1)                                                                                                         \
  X(rk4imp, 1)                                                                                                         \
  X(bsimp, 1)                                                                                                          \
  X(msadams, 0)                                                                                                        \
  X(msbdf, 1)

enum { OPTION_METHOD, OPTION_RELATIVE, OPTION_ABSOLUTE, OPTION_STEP_MAX, OPTION_STEPS_MAX };

static const ambit_param param[] = {
  { "method", "1", "rk2|rk4|rkf45|rkck|rk8pd|rk2imp|rk4imp|bsimp|msadams|msbdf", "rk8pd",
      "stepper: rk2 to rk8pd are explicit Runge-Kutta, msadams is for smooth problems; rk2imp, rk4imp, bsimp and msbdf "
      "for stiff ones" },
  { "relative", "1", "", "1e-10", "local error allowed, relative to the state" },
  { "absolute", "1", "", "1e-12", "local error allowed besides, in the units of the state" },
  { "step_max", "s", "", "inf", "longest step" },
  { "steps_max", "1", "", "2e6", "most steps" },
  { NULL, NULL, NULL, NULL, NULL },
};

typedef struct solver {
  const ambit_host *host;
  ambit_problem problem;
  ambit_lane rhs, jacobian, *jump;        /* jump [njump] */
  double *x, *start, *p, *before, *after; /* [nx] [nx] [np] [nx] [nx] */
  double step_max, steps_max;
  ambit_work *counted;
  gsl_odeiv2_system system;
  gsl_odeiv2_driver *driver;
} solver;

/* Outputs at (t, x); GSL_EDOM if one of them is no number: GSL then tries a shorter step. */
static int evaluate(const solver *s, const ambit_lane *lane, double t, const double *x, double *out) {
  const ambit_problem *p = &s->problem;
  ambit_lane at = *lane;
  for (uint32_t i = 0; i < p->nx; i++) ambit_lane_set(&at, i, x[i], x[i]);
  for (uint32_t i = 0; i < p->np; i++) ambit_lane_set(&at, p->nx + i, s->p[i], s->p[i]);
  if (p->uses_time) ambit_lane_set(&at, p->nx + p->np, t, t);
  if (ambit_lane_run(&at) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY)) return GSL_EDOM;
  for (uint32_t i = 0; i < at.tape->nout; i++) {
    double lo, hi;
    ambit_lane_get(&at, i, &lo, &hi);
    if (!(lo <= hi) || !isfinite(lo) || !isfinite(hi)) return GSL_EDOM;
    out[i] = 0.5 * lo + 0.5 * hi;
  }
  return GSL_SUCCESS;
}

static int rates(double t, const double y[], double dydt[], void *self) {
  const solver *s = self;
  return evaluate(s, &s->rhs, t, y, dydt);
}

static int derivatives(double t, const double y[], double *dfdy, double dfdt[], void *self) {
  const solver *s = self;
  uint32_t nx = s->problem.nx;
  int status = evaluate(s, &s->jacobian, t, y, dfdy);
  memset(dfdt, 0, nx * sizeof *dfdt);
  if (status != GSL_SUCCESS || !s->problem.uses_time) return status;
  double d = 0x1p-17 * fmax(1, fabs(t)); /* about the cube root of the precision */
  status = evaluate(s, &s->rhs, t - d, y, s->before);
  if (status == GSL_SUCCESS) status = evaluate(s, &s->rhs, t + d, y, s->after);
  for (uint32_t i = 0; i < nx; i++) dfdt[i] = (s->after[i] - s->before[i]) / (2 * d);
  return status;
}

/* -- life */

static uint32_t want_for(const double *option) {
#define METHOD(name, jacobian) jacobian,
  static const int reads_jacobian[] = { METHODS(METHOD) };
#undef METHOD
  return AMBIT_WANT_RHS | AMBIT_WANT_JUMP | (reads_jacobian[(size_t)option[OPTION_METHOD]] ? AMBIT_WANT_JACOBIAN : 0);
}

static double middle(double lo, double hi) { return lo == hi ? lo : 0.5 * lo + 0.5 * hi; }

static ambit_status check_options(const ambit_host *h, const double *o) {
  static const int bound[] = { OPTION_RELATIVE, OPTION_ABSOLUTE };
  for (size_t i = 0; i < 2; i++)
    if (!(o[bound[i]] >= 0 && o[bound[i]] < INFINITY))
      return h->fail(
          h, AMBIT_INVALID, "gsl: option `%s` must be 0 or greater, not %g", param[bound[i]].name, o[bound[i]]);
  if (o[OPTION_RELATIVE] == 0 && o[OPTION_ABSOLUTE] == 0)
    return h->fail(h, AMBIT_INVALID, "gsl: one of the options `relative` and `absolute` must be greater than 0");
  if (!(o[OPTION_STEP_MAX] > 0))
    return h->fail(h, AMBIT_INVALID, "gsl: option `step_max` must be greater than 0, not %g", o[OPTION_STEP_MAX]);
  if (!(o[OPTION_STEPS_MAX] >= 1))
    return h->fail(h, AMBIT_INVALID, "gsl: option `steps_max` must be 1 or greater, not %g", o[OPTION_STEPS_MAX]);
  return AMBIT_OK;
}

static int allocate(solver *s) {
  s->counted = ambit_work_open(s->host);
  const ambit_problem *p = &s->problem;
  size_t state = (p->nx + 1u) * sizeof(double);
  double **const array[] = { &s->x, &s->start, &s->before, &s->after };
  for (size_t i = 0; i < sizeof array / sizeof *array; i++)
    if (!(*array[i] = s->host->alloc(s->host, state))) return 0;
  s->p = s->host->alloc(s->host, (p->np + 1u) * sizeof(double));
  if (!s->p || ambit_lane_open(&s->rhs, s->host, p->rhs, p->arithmetic, p->actx) != AMBIT_OK) return 0;
  if (p->njump) s->jump = s->host->alloc(s->host, p->njump * sizeof *s->jump);
  for (uint32_t i = 0; i < p->njump; i++)
    if (!s->jump || ambit_lane_open(&s->jump[i], s->host, p->jump[i], p->arithmetic, p->actx) != AMBIT_OK) return 0;
  return !p->jacobian || ambit_lane_open(&s->jacobian, s->host, p->jacobian, p->arithmetic, p->actx) == AMBIT_OK;
}

static void close(void *self) {
  solver *s = self;
  if (s->driver) gsl_odeiv2_driver_free(s->driver);
  ambit_lane_close(&s->rhs);
  ambit_lane_close(&s->jacobian);
  for (uint32_t i = 0; s->jump && i < s->problem.njump; i++) ambit_lane_close(&s->jump[i]);
}

static void take_middle(solver *s) {
  const ambit_problem *p = &s->problem;
  for (uint32_t i = 0; i < p->nx; i++) s->start[i] = middle(p->x0_lo[i], p->x0_hi[i]);
  for (uint32_t i = 0; i < p->np; i++) s->p[i] = middle(p->p_lo[i], p->p_hi[i]);
}

/* With the sign of the horizon; neither 0 nor infinite, however short or long that is. */
static double first_step(const ambit_problem *p, double longest) {
  double from = p->time[0], to = p->time[p->ntime - 1];
  double step = fmin(fabs(to * 1e-6 - from * 1e-6), longest);
  return copysign(fmax(step, DBL_TRUE_MIN), to > from ? 1 : -1);
}

static ambit_status open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
#define METHOD(name, jacobian) gsl_odeiv2_step_##name,
  const gsl_odeiv2_step_type *const method[] = { METHODS(METHOD) };
#undef METHOD
  ambit_status status = check_options(h, option);
  if (status != AMBIT_OK) return status;
  solver *s = h->alloc(h, sizeof *s);
  if (!s) return h->fail(h, AMBIT_NOMEM, "gsl: out of memory");
  memcpy(&s->problem, p, p->size < sizeof s->problem ? p->size : sizeof s->problem);
  s->host = h, s->step_max = option[OPTION_STEP_MAX], s->steps_max = option[OPTION_STEPS_MAX];
  s->system = (gsl_odeiv2_system) { rates, p->jacobian ? derivatives : NULL, p->nx, s };
  gsl_set_error_handler_off();
  double first = first_step(p, s->step_max);
  if (allocate(s))
    s->driver = gsl_odeiv2_driver_alloc_y_new(
        &s->system, method[(size_t)option[OPTION_METHOD]], first, option[OPTION_ABSOLUTE], option[OPTION_RELATIVE]);
  if (!s->driver) {
    close(s);
    return h->fail(h, AMBIT_NOMEM, "gsl: out of memory");
  }
  take_middle(s);
  *self = s;
  return AMBIT_OK;
}

/* -- the run */

static ambit_status give_up(const solver *s, double t, int code) {
  const char *what = code == GSL_EDOM ? "the right-hand side gave no finite value beyond here"
                                      : "no step is short enough for the tolerances";
  return s->host->fail_code(s->host, AMBIT_UNABLE,
      code == GSL_EDOM ? AMBIT_CODE_UNABLE_UNDEFINED : AMBIT_CODE_UNABLE_STEP,
      "at t = %.9g s %s (GSL: %s); end before it, loosen `relative` or `absolute`, or try another `method`", t, what,
      gsl_strerror(code));
}

static ambit_status too_many(const solver *s, double t) {
  return s->host->fail_code(s->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_STEPS_MAX,
      "at t = %.9g s %.9g steps were taken: the end was not reached; take a `method` for stiff "
      "problems, end before it, loosen `relative` or `absolute`, or allow more by `steps_max`",
      t, s->steps_max);
}

static int all_finite(const double *x, uint32_t n) {
  for (uint32_t i = 0; i < n; i++)
    if (!isfinite(x[i])) return 0;
  return 1;
}

/* Of the horizon, which may be the smallest double or longer than the largest. */
static double share_done(const ambit_problem *p, double t) {
  double from = p->time[0], to = p->time[p->ntime - 1];
  return isfinite(to - from) ? (t - from) / (to - from) : (0.5 * t - 0.5 * from) / (0.5 * to - 0.5 * from);
}

static int32_t emit(const solver *s, ambit_sink *sink, double from, double to) {
  const ambit_problem *p = &s->problem;
  const ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = from,
    .t_to = to,
    .nx = p->nx,
    .lo = s->x,
    .hi = s->x,
    .order = gsl_odeiv2_step_order(s->driver->s) };
  int32_t stop = sink->emit(sink, &r);
  return !stop && sink->progress ? sink->progress(sink, share_done(p, to), NULL) : stop;
}

/* To an instant that only rounding tells from t, where no method can step: Euler's step, if it moves no state by more
** than 2^-26 of the largest, so that its error is a rounding. */
static int step_over(const solver *s, double *t, double to) {
  uint32_t nx = s->problem.nx;
  double gap = to - *t, size = 0, most = 0;
  if (!(fabs(gap) <= 4 * DBL_EPSILON * fabs(to)) || evaluate(s, &s->rhs, *t, s->x, s->before) != GSL_SUCCESS) return 0;
  for (uint32_t i = 0; i < nx; i++) size = fmax(size, fabs(s->x[i])), most = fmax(most, fabs(gap * s->before[i]));
  if (!(most <= 0x1p-26 * size)) return 0;
  for (uint32_t i = 0; i < nx; i++) s->x[i] += gap * s->before[i];
  return *t = to, 1;
}

/* the instant of jump number `done`; infinite: there is none */
static double jump_at(const ambit_problem *p, uint32_t done) {
  return done < p->njump_time ? p->jump_time[done] : INFINITY;
}

/* All jumps of the instant t. GSL's steppers know what was before, and forget it. */
static int jump(const solver *s, double t, uint32_t *done) {
  const ambit_problem *p = &s->problem;
  int status = GSL_SUCCESS;
  if (jump_at(p, *done) != t) return status;
  for (; jump_at(p, *done) == t && status == GSL_SUCCESS; ++*done) {
    status = evaluate(s, &s->jump[p->jump_number[*done]], t, s->x, s->before);
    memcpy(s->x, s->before, p->nx * sizeof *s->x);
  }
  gsl_odeiv2_evolve_reset(s->driver->e);
  gsl_odeiv2_step_reset(s->driver->s);
  return status;
}

static ambit_status run(void *self, ambit_sink *sink) {
  solver *s = self;
  const ambit_problem *p = &s->problem;
  gsl_odeiv2_driver *d = s->driver;
  double t = p->time[0], h = d->h, steps = 0;
  uint32_t jumped = 0;
  gsl_odeiv2_driver_reset(d);
  memcpy(s->x, s->start, p->nx * sizeof *s->x);
  for (uint32_t next = 1; next < p->ntime; next += t == p->time[next]) {
    double from = t, goal = p->time[next];
    int jumps = jump(s, t, &jumped);
    if (jumps != GSL_SUCCESS) return give_up(s, t, jumps);
    if (jump_at(p, jumped) < goal) goal = jump_at(p, jumped);
    if (steps++ >= s->steps_max) return too_many(s, t);
    int code = GSL_SUCCESS;
    if (fabs(h) > s->step_max) h = copysign(s->step_max, h);
    if (!step_over(s, &t, goal)) code = gsl_odeiv2_evolve_apply(d->e, d->c, d->s, &s->system, &t, goal, &h, s->x);
    if (s->counted) s->counted->tried = d->e->count + d->e->failed_steps;
    if (code != GSL_SUCCESS || t == from || !all_finite(s->x, p->nx))
      return give_up(s, from, code ? code : GSL_EFAILED);
    if (emit(s, sink, from, t)) return AMBIT_STOPPED;
  }
  return AMBIT_OK;
}

static const ambit_solver interface = {
  .size = sizeof interface,
  .want = AMBIT_WANT_RHS | AMBIT_WANT_JUMP,
  .needs_rigorous = 0,
  .arithmetics = "real",
  .param = param,
  .open = open,
  .run = run,
  .close = close,
  .want_for = want_for,
  .compared = "method=rkf45,rk8pd,msbdf relative=1e-6,1e-9,1e-12",
};

static const void *get(const char *interface_id) { return strcmp(interface_id, AMBIT_SOLVER) == 0 ? &interface : NULL; }

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.gsl", "1.0",
  "The steppers of the GNU Scientific Library: one curve from the middle of the uncertain data, which proves nothing. "
  "For reference and for sampling.",
  get };
