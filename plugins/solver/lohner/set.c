/* set.c -- moving the set over a step, x(t+h) = phi(m) + M_l low + M_xi xi + M_z z + (S - M) v (slopes.c). */
#include "set.h"
#include <string.h>

int set_open(const field *f, set *x) {
  size_t nx = f->nx;
  const request list[] = { { &x->centre, nx }, { &x->low, nx }, { &x->column, nx * f->nc }, { &x->rest, nx },
    { &x->radius, nx }, { &x->lo, nx }, { &x->hi, nx }, { &x->new_centre, nx }, { &x->new_low, nx }, { &x->box, nx } };
  return field_allocate(f->host, sizeof list / sizeof *list, list) &&
         history_open(f->host, &x->history, f->nx, f->options.history);
}

void set_shift(set *x, uint32_t i, double step, ball shift) {
  double sum;
  shift = ball_add(shift, ball_two_sum(x->centre[i], step, &sum));
  ball left = ball_two_sum(sum, shift.mid, &x->new_centre[i]);
  x->new_low[i] = left.mid;
  x->box[i] = left.rad + shift.rad;
}

/* phi(m) + M_l low, and the middle of (S - M) v */
static void move_centre(const field *f, set *x, const flow *phi, const slopes *S, uint32_t i) {
  const double *M_l = S->matrix + (size_t)i * f->ndir + f->nc;
  ball shift = slopes_nonlinear(f, x, S, i), step = flow_increment(phi, i);
  for (uint32_t j = 0; j < f->nx; j++)
    if (x->low[j] != 0) shift = ball_add(shift, ball_of((-M_l[j]) * x->low[j], M_l[j] * x->low[j]));
  set_shift(x, i, step.mid, shift);
  x->box[i] += step.rad;
}

void set_move(const field *f, set *x, const flow *phi, const slopes *S) {
  for (uint32_t i = 0; i < f->nx; i++) move_centre(f, x, phi, S, i);
  for (uint32_t i = 0; i < f->nx && f->nc; i++) /* M_xi xi */
    memcpy(x->column + (size_t)i * f->nc, S->matrix + (size_t)i * f->ndir, f->nc * sizeof(double));
  set_settle(f, x, S->matrix + f->nc, f->ndir); /* M_z z */
  x->t = phi->t_next;
}

void set_settle(const field *f, set *x, const double *M, size_t pitch) {
  memcpy(x->centre, x->new_centre, f->nx * sizeof(double));
  memcpy(x->low, x->new_low, f->nx * sizeof(double));
  history_multiply(&x->history, M, pitch, x->rest, x->box);
  history_push(&x->history, x->box);
}

void set_hull(const field *f, set *x) {
  history_sum(&x->history, x->rest);
  for (uint32_t i = 0; i < f->nx; i++) {
    double radius = x->rest[i];
    for (uint32_t j = 0; j < f->nc; j++) radius += fabs(x->column[(size_t)i * f->nc + j]);
    x->lo[i] = -((radius - x->low[i]) - x->centre[i]);
    x->hi[i] = x->centre[i] + (x->low[i] + radius);
    x->radius[i] = radius + fabs(x->low[i]);
  }
}
