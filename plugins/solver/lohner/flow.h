/* flow.h -- all solutions over one step, from a set at t: Taylor coefficients, slopes, and what is beyond both.
**
** For s in [0, h] the solution from the midpoint is sum_{k<=p} x_k s^k +- excess, and any other one of the set is away
** from it by sum_j (sum_{k<=q} s_jk s^k +- slope_excess_j) v_j, where v = (xi, z + low) are the coordinates of its
** start.
*/
#ifndef LOHNER_FLOW_H
#define LOHNER_FLOW_H
#include "field.h"

struct set;

typedef struct flow {
  double t, t_next;
  span step;                       /* h */
  uint32_t p, q;                   /* orders, of the midpoint and of slopes */
  ambit_jet *centre_jet, *box_jet; /* the series of every operation, from the midpoint and over the set */
  balls centre;                    /* [nx x (p + 1)] x_k */
  balls slope;                     /* [nx x (q + 1) x ndir] s_jk */
  double *excess, *slope_excess;   /* [nx] [nx x ndir] what the polynomials lack on the step */
  double *box_excess;              /* [nx] the same of a series to order q over the set */
  double *tube_lo, *tube_hi;       /* [nx] of all solutions over the step */
  double *eps, *slope_eps;         /* [nx] [nx x ndir] scratch of the proof (inclusion.c), as the next ones */
  double *tail_in, *dtail_in;      /* [nin] [nin x ndir] */
  double *tail_out, *dtail_out;    /* [nx] [nx x ndir] */
} flow;

ambit_status flow_open(const field *f, flow *phi);
void flow_close(const field *f, flow *phi);

/* -- series; AMBIT_F_* */

uint32_t flow_centre_series(const field *f, const struct set *x, flow *phi);
/* over a part of the set, about the midpoint of the whole */
uint32_t flow_box_series(const field *f, const struct set *x, part of, flow *phi);
void flow_put_centre(const field *f, const struct set *x, ambit_jet *jet);
void flow_put_box(const field *f, const struct set *x, part of, ambit_jet *jet); /* with seeds of slopes */
void flow_put_parameter(const field *f, part of, ambit_jet *jet, uint32_t i);    /* the same for parameter i */

/* -- polynomials, with their excess */

ball flow_increment(const flow *phi, uint32_t i);                  /* of the midpoint over the step */
void flow_slopes_at_end(const field *f, const flow *phi, balls S); /* [nx x ndir] */
ball flow_slope_over_step(const field *f, const flow *phi, uint32_t i, uint32_t j);
void flow_tube(const field *f, const struct set *x, flow *phi);
/* that of the step in the run, 1 if it is a large one */
double flow_share_of_time(const field *f, const flow *phi);

/* -- inclusion.c: existence on the step, and what the polynomials lack there */

/* excess, as it is where |x - polynomial| <= eps (NULL: 0); 0: it could not be bounded */
int flow_centre_excess(const field *f, flow *phi, const double *eps);
/* 1: proved, and excess, box_excess, slope_excess hold. unit [nx]: about how large states are */
int flow_is_proved(const field *f, flow *phi, const double *unit);
#endif
