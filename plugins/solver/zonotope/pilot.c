/* pilot.c -- before the first step, by an unproved run of low degree: how much each datum matters, by its linear terms
** in the states, and how wide states get. Data that matter most are numbered first, since parts of the rows and terms
** of degree 4 are held for the first data only. What states get to tells what is next to nothing beside it, for states
** that start at rest or stay there for a while: what they get to soon, since what is added early grows as long as the
** run, and where sets grow by orders of magnitude their end is no measure of it. No proof depends on anything here.
*/
#include "zonotope.h"

#define STEPS 200
#define ORDER 8
#define PARTS 100      /* of the whole time, that a step is at most: it looks for kinks at the starts of steps only */
#define SOON 0.1       /* of the whole time */
#define LAST_TERM 1e-3 /* of a state, that the last order in time may make in a step */

/* x_i at s = h, constant and linear terms; the rest := 0 */
static void move(const zono *z, uint32_t i, double h, double *to) {
  double power = 1;
  memset(to, 0, z->shape.stride * sizeof *to);
  for (uint32_t k = 0; k < orders(z, slot_x(z, i)); k++, power *= h)
    for (uint32_t v = 0; v < z->shape.eps; v++) to[v] += power * row_at(z, slot_x(z, i), k)[v];
  row_norms_all(&z->shape, to);
}

static int fits(const zono *z, double h) {
  for (uint32_t i = 0; i < z->nx; i++) {
    double sum = 0, last = 0, power = 1;
    for (uint32_t k = 0; k < orders(z, slot_x(z, i)); k++, power *= fabs(h))
      sum += last = row_total(&z->shape, row_at(z, slot_x(z, i), k)) * power;
    if (!(last <= LAST_TERM * sum)) return 0;
  }
  return 1;
}

static void note_widths(const zono *z) {
  for (uint32_t i = 0; i < z->nx; i++) {
    double width = row_moving(&z->shape, z->P + (size_t)i * z->shape.stride);
    if (width < INFINITY) z->expected[i] = fmax(z->expected[i], width);
  }
}

/* weight of each unknown += length of the step times the shares of the states' linear terms */
static void weigh(const zono *z, double h, double *weight) {
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *x = z->P + (size_t)i * z->shape.stride;
    for (uint32_t j = 0; j < z->m && row_l(&z->shape, x) > 0; j++)
      if (z->unknown[j] != AMBIT_NO_SLOT) weight[z->unknown[j]] += fabs(h) * fabs(x[1 + j]) / row_l(&z->shape, x);
  }
}

void zono_pilot(zono *z, double *weight, int may_wait) {
  const shape whole = z->shape;
  double first = z->problem.time[0], end = z->problem.time[z->problem.ntime - 1], part = (end - first) / PARTS;
  double soon = SOON * fabs(end - first);
  zono_start(z);
  memset(z->E, 0, z->nx * sizeof *z->E);
  z->K = ORDER < z->K_max ? ORDER : z->K_max;
  z->shape.paired = 1, z->shape.mixing = z->shape.cubed = 0;
  for (uint32_t n = 0; n < STEPS && z->t != end && zono_series(z); n++) {
    if (!weight && !may_wait && fabs(z->t - first) >= soon) break;
    double h = fabs(end - z->t) > fabs(part) ? part : end - z->t;
    for (int halved = 0; halved < 60 && !fits(z, h); halved++) h *= 0.5;
    for (uint32_t i = 0; i < z->nx; i++) move(z, i, h, z->P + (size_t)i * z->shape.stride);
    if (weight) weigh(z, h, weight);
    if (may_wait || fabs(z->t - first) < soon) note_widths(z);
    z->t = h == end - z->t ? end : z->t + h;
  }
  z->shape = whole;
}
