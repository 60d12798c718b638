/* gsl.c -- the GNU Scientific Library's ordinary differential equation steppers: reference solutions that prove nothing.
**
** One trajectory from the midpoint of the initial set, in floating-point numbers; records are points and say that they are not
** rigorous. Error control is the library's (gsl_odeiv2_control_y_new): local error below abs + rel |x| per step.
*/
#include <ambit/block.h>
#include <ambit/solver.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { METHOD, ABS, REL, STEP_MAX, STEPS_MAX };

static const ambit_param params[] = {
  { "method", "1", "rk8pd|rk4|rk2|rkf45|rkck|rk2imp|rk4imp|bsimp|msadams|msbdf", "rk8pd",
    "stepper; rk2imp, rk4imp, bsimp and msbdf are for stiff systems" },
  { "abs", "1", "", "1e-12", "absolute local error" },
  { "rel", "1", "", "1e-12", "relative local error" },
  { "step_max", "s", "", "inf", "largest step" },
  { "steps_max", "1", "integer", "10000000", "steps after which the run gives up" },
  { NULL, NULL, NULL, NULL, NULL },
};

typedef struct trajectory {
  const ambit_host *host;
  const ambit_problem *problem;
  ambit_lane rhs, jacobian;
  double *x, *lo;                /* [nx] state; lower bounds handed to the sink */
  double step_max, steps_max;
  gsl_odeiv2_system system;
  gsl_odeiv2_driver *driver;
} trajectory;

/* -- the right-hand side and its Jacobian at a point */

static int evaluate(const trajectory *t, ambit_lane *lane, double time, const double *x) {
  const ambit_problem *p = t->problem;
  for (uint32_t i = 0; i < p->nx; i++) {
    if (!isfinite(x[i])) return GSL_EBADFUNC;
    ambit_lane_set(lane, i, x[i], x[i]);
  }
  for (uint32_t i = 0; i < p->np; i++) ambit_lane_set(lane, p->nx + i, p->p_lo[i], p->p_hi[i]);
  if (p->uses_time) ambit_lane_set(lane, p->nx + p->np, time, time);
  return ambit_lane_run(lane) & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY) ? GSL_EBADFUNC : GSL_SUCCESS;
}

static double value_of(const ambit_lane *lane, uint32_t out) {
  double lo, hi;
  ambit_lane_get(lane, out, &lo, &hi);
  return 0.5 * lo + 0.5 * hi;
}

static int slope(double time, const double x[], double dxdt[], void *self) {
  trajectory *t = self;
  int status = evaluate(t, &t->rhs, time, x);
  for (uint32_t i = 0; i < t->problem->nx && status == GSL_SUCCESS; i++) {
    dxdt[i] = value_of(&t->rhs, i);
    if (!isfinite(dxdt[i])) status = GSL_EBADFUNC;
  }
  return status;
}

/* df/dt by a central difference: it only steers the implicit steppers' convergence */
static int time_slope(trajectory *t, double time, const double *x, double *dfdt) {
  uint32_t n = t->problem->nx;
  memset(dfdt, 0, n * sizeof *dfdt);
  if (!t->problem->uses_time) return GSL_SUCCESS;
  double h = 1e-6 * (1 + fabs(time));
  if (evaluate(t, &t->rhs, time + h, x) != GSL_SUCCESS) return GSL_EBADFUNC;
  for (uint32_t i = 0; i < n; i++) dfdt[i] = value_of(&t->rhs, i);
  if (evaluate(t, &t->rhs, time - h, x) != GSL_SUCCESS) return GSL_EBADFUNC;
  for (uint32_t i = 0; i < n; i++) dfdt[i] = (dfdt[i] - value_of(&t->rhs, i)) / (2 * h);
  return GSL_SUCCESS;
}

static int jacobian(double time, const double x[], double *dfdx, double dfdt[], void *self) {
  trajectory *t = self;
  uint32_t n = t->problem->nx;
  int status = evaluate(t, &t->jacobian, time, x);
  if (status != GSL_SUCCESS) return status;
  for (uint32_t i = 0; i < n * n; i++) dfdx[i] = value_of(&t->jacobian, i);
  return time_slope(t, time, x, dfdt);
}

/* -- life */

static const gsl_odeiv2_step_type *stepper(int method) {
  switch (method) {
  case 1: return gsl_odeiv2_step_rk4;
  case 2: return gsl_odeiv2_step_rk2;
  case 3: return gsl_odeiv2_step_rkf45;
  case 4: return gsl_odeiv2_step_rkck;
  case 5: return gsl_odeiv2_step_rk2imp;
  case 6: return gsl_odeiv2_step_rk4imp;
  case 7: return gsl_odeiv2_step_bsimp;
  case 8: return gsl_odeiv2_step_msadams;
  case 9: return gsl_odeiv2_step_msbdf;
  default: return gsl_odeiv2_step_rk8pd;
  }
}

/* only the implicit steppers read the Jacobian */
static uint32_t want_for(const double *option) {
  int method = (int)option[METHOD];
  return AMBIT_WANT_RHS | ((method >= 5 && method <= 7) || method == 9 ? AMBIT_WANT_JACOBIAN : 0);
}

static void close_trajectory(void *self) {
  trajectory *t = self;
  ambit_lane_close(&t->rhs);
  ambit_lane_close(&t->jacobian);
  if (t->driver) gsl_odeiv2_driver_free(t->driver);
}

static ambit_status check(const ambit_host *h, const double *option) {
  if (!(option[ABS] >= 0) || !(option[REL] >= 0) || !(option[ABS] + option[REL] > 0))
    return h->fail(h, AMBIT_INVALID, "`abs` and `rel` must not be negative, and one of them must be positive");
  if (!(option[STEP_MAX] > 0)) return h->fail(h, AMBIT_INVALID, "`step_max` must be positive");
  if (!(option[STEPS_MAX] > 0)) return h->fail(h, AMBIT_INVALID, "`steps_max` must be positive");
  return AMBIT_OK;
}

static ambit_status open_driver(trajectory *t, const double *option) {
  const double *time = t->problem->time;
  double span = time[1] - time[0], first = copysign(fmin(fmin(fabs(span), option[STEP_MAX]), 1e-6 * (1 + fabs(span))), span);
  t->driver = gsl_odeiv2_driver_alloc_y_new(&t->system, stepper((int)option[METHOD]), first, option[ABS], option[REL]);
  if (!t->driver) return t->host->fail(t->host, AMBIT_NOMEM, "out of memory for the stepper");
  if (isfinite(option[STEP_MAX])) gsl_odeiv2_driver_set_hmax(t->driver, option[STEP_MAX]);
  return AMBIT_OK;
}

static ambit_status open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  gsl_set_error_handler_off();
  ambit_status status = check(h, option);
  if (status != AMBIT_OK) return status;
  trajectory *t = h->alloc(h, sizeof *t);
  if (!t) return h->fail(h, AMBIT_NOMEM, "out of memory");
  *t = (trajectory) { .host = h, .problem = p, .step_max = option[STEP_MAX], .steps_max = option[STEPS_MAX] };
  t->x = h->alloc(h, p->nx * sizeof *t->x);
  t->lo = h->alloc(h, p->nx * sizeof *t->lo);
  t->system = (gsl_odeiv2_system) { slope, p->jacobian ? jacobian : NULL, p->nx, t };
  if (!t->x || !t->lo) return h->fail(h, AMBIT_NOMEM, "out of memory");
  status = ambit_lane_open(&t->rhs, h, p->rhs, p->arithmetic, p->actx);
  if (status == AMBIT_OK && p->jacobian) status = ambit_lane_open(&t->jacobian, h, p->jacobian, p->arithmetic, p->actx);
  if (status == AMBIT_OK) status = open_driver(t, option);
  if (status != AMBIT_OK) {
    close_trajectory(t);
    return status;
  }
  *self = t;
  return AMBIT_OK;
}

/* -- running */

static int32_t emit(trajectory *t, ambit_sink *s, double from, double to) {
  uint32_t n = t->problem->nx;
  memcpy(t->lo, t->x, n * sizeof *t->lo);
  ambit_record r = { .size = sizeof r, .kind = AMBIT_REC_STEP, .t_from = from, .t_to = to, .nx = n, .lo = t->lo, .hi = t->lo };
  return s->emit(s, &r);
}

static ambit_status stuck(trajectory *t, int code, double time) {
  if (code == GSL_EBADFUNC || code == GSL_EFAILED)
    return t->host->fail(t->host, AMBIT_UNABLE, "the right-hand side has no finite value near t = %.6g", time);
  return t->host->fail(t->host, AMBIT_UNABLE, "the stepper failed at t = %.6g: %s; try another `method` or a larger `abs`", time,
      gsl_strerror(code));
}

static bool is_finite_state(const trajectory *t) {
  for (uint32_t i = 0; i < t->problem->nx; i++)
    if (!isfinite(t->x[i])) return false;
  return true;
}

/* one accepted step towards `end` */
static ambit_status advance(trajectory *t, ambit_sink *s, double *time, double end) {
  gsl_odeiv2_driver *d = t->driver;
  double before = *time, first = t->problem->time[0], span = t->problem->time[t->problem->ntime - 1] - first;
  if (fabs(d->h) > t->step_max) d->h = copysign(t->step_max, d->h);
  int code = gsl_odeiv2_evolve_apply(d->e, d->c, d->s, &t->system, time, end, &d->h, t->x);
  if (code != GSL_SUCCESS) return stuck(t, code, before);
  if (*time == before || !is_finite_state(t))
    return t->host->fail(t->host, AMBIT_UNABLE, "the solution grows without bound or the step became too small near t = %.6g", before);
  if (emit(t, s, before, *time)) return AMBIT_STOPPED;
  return s->progress(s, (*time - first) / span, NULL) ? AMBIT_STOPPED : AMBIT_OK;
}

static ambit_status run(void *self, ambit_sink *s) {
  trajectory *t = self;
  const ambit_problem *p = t->problem;
  for (uint32_t i = 0; i < p->nx; i++) t->x[i] = 0.5 * p->x0_lo[i] + 0.5 * p->x0_hi[i];
  double time = p->time[0], steps = 0;
  for (uint32_t k = 1; k < p->ntime; k++)
    while (time != p->time[k]) {
      if (++steps > t->steps_max)
        return t->host->fail(t->host, AMBIT_UNABLE, "gave up after %.0f steps at t = %.6g; raise `steps_max`", t->steps_max, time);
      ambit_status status = advance(t, s, &time, p->time[k]);
      if (status != AMBIT_OK) return status;
    }
  return AMBIT_OK;
}

static const ambit_solver solver = {
  .size = sizeof solver,
  .want = AMBIT_WANT_RHS,
  .needs_rigorous = 0,
  .arithmetics = "real",
  .param = params,
  .open = open,
  .run = run,
  .close = close_trajectory,
  .want_for = want_for,
};

static const void *get(const char *interface_id) { return strcmp(interface_id, AMBIT_SOLVER) == 0 ? &solver : NULL; }

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.gsl", "1.0",
  "Reference trajectories by the GNU Scientific Library's steppers; they prove nothing.", get };
