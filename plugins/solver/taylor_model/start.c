/* start.c -- the initial set as polynomials: the problem's initial expressions, evaluated over its unknowns.
**
** An initial value that is an interval rather than a function of unknowns leaves a radius; if that is more than
** rounding, it becomes an unknown of this solver's own, because polynomials do not wrap and parameters stay what they
** are.
*/
#include "flow.h"
#include "start.h"
#include <ambit/code.h>
#include <string.h>

#define THIN 0x1p-40 /* relative radius up to which an initial box is a matter of rounding */

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, count ? count * size : size); }

static AMBIT_WORKER uint32_t evaluate(flow *f, ambit_jet *jet, series *s) {
  const ambit_problem *p = &f->problem;
  double *c = f->start_x; /* free until the end */
  for (uint32_t i = 0; i < p->nu; i++) {
    double mid = 0.5 * (p->u_lo[i] + p->u_hi[i]);
    f->unit_mid[i] = mid, f->unit_rad[i] = larger(p->u_hi[i] - mid, mid - p->u_lo[i]);
    memset(c, 0, f->space.size * sizeof *c);
    c[f->space.row[0].at] = mid;
    c[polynomial_linear(&f->space, i)] = f->unit_rad[i];
    series_put(s, i, c, 0);
  }
  return f->jet->advance(jet, 0);
}

static int is_thin(double rad, double mid) { return rad <= THIN * fabs(mid) + 0x1p-900; }

/* outputs of the initial tape; `own` counts those that become unknowns, written with number m0 and on if m > m0 */
static uint32_t keep(flow *f, const series *s, uint32_t m0) {
  const ambit_problem *p = &f->problem;
  size_t size = f->space.size;
  uint32_t own = 0;
  for (uint32_t i = 0; i < p->nx + p->np; i++) {
    int state = i < p->nx;
    double *to = state ? f->start_x + i * size : f->start_p + (i - p->nx) * size;
    double *rad = state ? f->start_x_rad + i : f->start_p_rad + (i - p->nx);
    cell x = series_cell(s, p->initial->out[i], 0);
    memcpy(to, x.c, size * sizeof *to);
    *rad = cell_rad(x);
    if (is_thin(*rad, cell_norm(x))) continue;
    if (m0 + own < f->m) to[polynomial_linear(&f->space, m0 + own)] = *rad, *rad = 0;
    own++;
  }
  return own;
}

static int allocate(flow *f) {
  const ambit_host *h = f->host;
  size_t size = f->space.size;
  f->start_x = room(h, (f->nx + 1) * size, 8), f->start_p = room(h, (f->np + 1) * size, 8);
  f->start_x_rad = room(h, f->nx, 8), f->start_p_rad = room(h, f->np, 8);
  f->unit_mid = room(h, f->m, 8), f->unit_rad = room(h, f->m, 8);
  return f->start_x && f->start_p && f->start_x_rad && f->start_p_rad && f->unit_mid && f->unit_rad;
}

/* relative width of the set; what is about zero has none */
static double width_of(const flow *f) {
  double sum = 0, count = 0;
  for (uint32_t i = 0; i < f->nx + f->np; i++) {
    int state = i < f->nx;
    const double *c = state ? f->start_x + i * f->space.size : f->start_p + (i - f->nx) * f->space.size;
    double middle = fabs(c[f->space.row[0].at]), all = polynomial_norm(&f->space, c), reach = all - middle;
    reach += state ? f->start_x_rad[i] : f->start_p_rad[i - f->nx];
    if (middle > reach && !is_thin(reach, middle)) sum += log(reach / (middle + reach)), count++;
  }
  return count > 0 ? exp(sum / count) : 0;
}

/* the set over m polynomial unknowns of this degree; *own: how many more it should be */
static ambit_status evaluate_over(flow *f, uint32_t m, uint32_t order, uint32_t *own) {
  const ambit_problem *p = &f->problem;
  const ambit_host *h = f->host;
  f->m = m;
  if (m > UNKNOWNS_MAX || space_count(m, order) > MONOMIALS_MAX)
    return h->fail(h, AMBIT_INVALID,
        "taylor_model: polynomials of degree %u in %u uncertain data have too many terms (at most %d); lower `order`, "
        "or make some data points",
        order, m, MONOMIALS_MAX);
  ambit_status status = space_open(h, &f->space, m, order);
  if (status != AMBIT_OK) return status;
  if (!allocate(f)) return AMBIT_NOMEM;
  series_source source = { &f->space, f->num, NULL };
  ambit_arithmetic polynomials = { .size = sizeof polynomials, .rigorous = 1, .jets = &series_jets };
  ambit_jet *jet = NULL;
  status = f->jet->open(h, p->initial, &polynomials, &source, 0, 0, NULL, &jet);
  if (status != AMBIT_OK) return status;
  ambit_rounding old = ambit_round_up();
  uint32_t flags = evaluate(f, jet, source.made);
  ambit_rounding_restore(old);
  if (!flags) *own = keep(f, source.made, p->nu);
  f->jet->close(jet);
  if (flags)
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_INITIAL,
        "at t = %.9g s the initial values could not be bounded for all values of their uncertain data; narrow the "
        "ranges of the data in `initial`",
        p->time[0]);
  return AMBIT_OK;
}

ambit_status start_open(flow *f) {
  uint32_t own = 0, m = f->problem.nu, asked = f->options.order;
  uint32_t order = asked ? asked : flow_automatic_order(m, 0);
  ambit_status status = evaluate_over(f, m, order, &own);
  if (status != AMBIT_OK) return status;
  double width = width_of(f);
  m += own;
  uint32_t better = asked ? asked : flow_automatic_order(m, width);
  if (own || better != order) status = evaluate_over(f, m, better, &own);
  if (status == AMBIT_OK) flow_choose_tolerances(&f->options, m, width);
  return status;
}

void flow_start(flow *f) {
  worker *w = &f->worker[0];
  piece *p = &f->piece[0];
  size_t size = f->space.size;
  f->npiece = 1, f->next = 1, f->t = f->problem.time[0], f->failed = 0;
  p->t = f->t, p->depth = 0, p->level = f->levels - 1, p->done = p->tolerant = 0, p->parent_rest = p->futile = 0,
  p->blamed = 0, p->kink = NULL;
  p->guess = smaller(fabs(f->problem.time[1] - f->t), f->options.step_max);
  for (uint32_t v = 0; v < f->m; v++) p->from[v] = -1, p->to[v] = 1;
  memcpy(p->x, f->start_x, f->nx * size * sizeof(double));
  memcpy(p->p, f->start_p, f->np * size * sizeof(double));
  memcpy(p->parameter_rad, f->start_p_rad, f->np * sizeof(double));
  memset(p->pad, 0, f->nx * sizeof(double));
  for (uint32_t n = 0; n < f->ns; n++) {
    zonotope z = zonotope_at(&w->shape, p->zonotope, n);
    zonotope_clear(&w->shape, z);
    zonotope_push(&w->shape, z, f->start_x_rad);
  }
  flow_boxes(w, p);
  flow_hull(w, p);
  for (uint32_t i = 0; i < f->nx; i++) /* 0: not known yet */
    f->limit[i] = f->options.width_max * larger(1, larger(fabs(p->lo[i]), fabs(p->hi[i])));
}
