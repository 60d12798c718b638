/* options.c -- the options of the solver, and what is chosen where they leave it open. */
#include "flow.h"
#include "start.h"

#define LEAST_TOLERANCE 1e-20 /* far below the rounding errors of a step */
#define MONOMIALS 130         /* that an automatic order stays below, whatever the set */
#define MONOMIALS_MOST 800    /* ... if a wide set in many unknowns asks for more */
#define MANY 4                /* unknowns: pieces multiply so that they are the last resort */
#define NEGLECTED 1e-6        /* relative size of terms that such an order leaves out */
#define MEMORY (96u << 20)    /* bytes that an automatic number of pieces stays below */
#define PIECES 256
#define FULL 260 /* monomials up to which there may be as many */

enum {
  OPTION_ORDER,
  OPTION_TIME_ORDER,
  OPTION_SLOPE_ORDER,
  OPTION_TOLERANCE,
  OPTION_SPLIT_TOLERANCE,
  OPTION_PIECES_MAX,
  OPTION_OUTPUTS,
  OPTION_STEP_MAX,
  OPTION_STEP_MIN,
  OPTION_WIDTH_MAX
};

static ambit_status refuse(const ambit_host *h, const char *option, const char *expected, double got) {
  return h->fail(h, AMBIT_INVALID, "taylor_model: option `%s` must be %s, not %g", option, expected, got);
}

static ambit_status check(const ambit_host *h, const double *o) {
  double time = o[OPTION_TIME_ORDER], slopes = o[OPTION_SLOPE_ORDER];
  if (!(o[OPTION_ORDER] >= 0 && o[OPTION_ORDER] <= DEGREE_MAX))
    return refuse(h, "order", "0 (automatic) or 1 to 31", o[OPTION_ORDER]);
  if (time != 0 && !(time >= 4 && time <= 40)) return refuse(h, "time_order", "0 (automatic) or 4 to 40", time);
  if (slopes != 0 && !(slopes >= 3 && slopes <= 20))
    return refuse(h, "jacobian_order", "0 (automatic) or 3 to 20", slopes);
  if (!(o[OPTION_TOLERANCE] >= 0 && o[OPTION_TOLERANCE] <= 1))
    return refuse(h, "tolerance", "in [0, 1]", o[OPTION_TOLERANCE]);
  if (!(o[OPTION_SPLIT_TOLERANCE] >= 0))
    return refuse(h, "split_tolerance", "0 (automatic) or greater", o[OPTION_SPLIT_TOLERANCE]);
  if (!(o[OPTION_PIECES_MAX] >= 0 && o[OPTION_PIECES_MAX] <= 1e6))
    return refuse(h, "pieces_max", "0 (automatic) to 1000000", o[OPTION_PIECES_MAX]);
  if (!(o[OPTION_OUTPUTS] >= 1 && o[OPTION_OUTPUTS] <= 1e9)) return refuse(h, "outputs", "1 to 1e9", o[OPTION_OUTPUTS]);
  if (!(o[OPTION_STEP_MAX] > 0)) return refuse(h, "step_max", "greater than 0", o[OPTION_STEP_MAX]);
  if (!(o[OPTION_STEP_MIN] >= 0 && o[OPTION_STEP_MIN] <= o[OPTION_STEP_MAX]))
    return refuse(h, "step_min", "0 (automatic) to step_max", o[OPTION_STEP_MIN]);
  if (!(o[OPTION_WIDTH_MAX] >= 0)) return refuse(h, "width_max", "0 (automatic) or greater", o[OPTION_WIDTH_MAX]);
  return AMBIT_OK;
}

/* Terms of degree d go like the set's relative width to the power of d. */
uint32_t flow_automatic_order(uint32_t m, double width) {
  uint32_t order = m <= 1 ? 15 : 10;
  while (order > 1 && space_count(m, order) > MONOMIALS) order--;
  if (m < MANY) return order;
  double left = pow(width, order + 1.0);
  for (; left > NEGLECTED && space_count(m, order + 1) <= MONOMIALS_MOST; left *= width) order++;
  return order;
}

/* Errors go like (h/R)^p, R the radius of convergence: a step to tolerance e has h/R = e^(1/p). Slopes over sub-ranges
** are most of the work of a step and do not grow with p, so p is rather high. */
static uint32_t automatic_time_order(double tolerance) {
  double order = log(1 / tolerance) * 0.66;
  return order < 6 ? 6 : order > 32 ? 32 : (uint32_t)order;
}

ambit_status flow_choose(const ambit_host *h, const ambit_problem *p, const double *o, options *r) {
  ambit_status status = check(h, o);
  if (status != AMBIT_OK) return status;
  *r = (options) { .order = (uint32_t)o[OPTION_ORDER],
    .time_order = (uint32_t)o[OPTION_TIME_ORDER],
    .slope_order = o[OPTION_SLOPE_ORDER] != 0 ? (uint32_t)o[OPTION_SLOPE_ORDER] : 5,
    .pieces_max = (uint32_t)o[OPTION_PIECES_MAX],
    .outputs = (uint32_t)o[OPTION_OUTPUTS],
    .keep = p->nx <= 24 ? 32 : 16,
    .tolerance = o[OPTION_TOLERANCE],
    .split_tolerance = o[OPTION_SPLIT_TOLERANCE],
    .step_max = o[OPTION_STEP_MAX],
    .step_min = o[OPTION_STEP_MIN],
    .width_max = o[OPTION_WIDTH_MAX] };
  return AMBIT_OK;
}

/* With one unknown a piece more is cheap, and remainders that start small stay small for long. With more, pieces
** multiply, and all of them are soon in use. */
static double automatic_split_tolerance(uint32_t m) { return m <= 1 ? 1e-11 : m == 2 ? 1e-8 : m < MANY ? 1e-6 : 1e-5; }

/* many unknowns and a wide set truncate so much in the unknowns that exactness in time is wasted */
static double automatic_tolerance(uint32_t m, double width) {
  return m < MANY ? 1e-11 : smaller(larger(1e-6 * width, 1e-11), 1e-7);
}

void flow_choose_tolerances(options *o, uint32_t m, double width) {
  if (o->tolerance == 0) o->tolerance = automatic_tolerance(m, width);
  o->tolerance = larger(o->tolerance, LEAST_TOLERANCE);
  if (o->split_tolerance == 0) o->split_tolerance = automatic_split_tolerance(m);
  if (!o->time_order) o->time_order = automatic_time_order(smaller(o->tolerance, 1e-3));
}

uint32_t flow_automatic_pieces(size_t bytes_of_piece, size_t monomials) {
  size_t most = MEMORY / (bytes_of_piece + 1), few = monomials > FULL ? PIECES * FULL / monomials : PIECES;
  return most > few ? (uint32_t)few : most < 2 ? 2 : (uint32_t)most;
}

double flow_least_step(const flow *f, double t) {
  const double *time = f->problem.time;
  return ambit_least_step(f->options.step_min, t, time[0], time[f->problem.ntime - 1]);
}
