/* tail.h -- what is beyond the coefficients: bounds of the tail of every slot of a tape over a step.
**
** With s = t/h in [0, 1] every slot is the polynomial sum_{k<=K} U_k s^k plus a tail T, |T(s)| <= tau s^(K+1);
** between two points x, c of the box the tail changes by at most sum_j sigma_j |x_j - c_j| s^(K+1). Everything is
** computed from magnitudes of coefficients in upward mode. Proofs: docs/numerics/series.md.
*/
#ifndef AMBIT_TAIL_H
#define AMBIT_TAIL_H
#include <ambit/jet.h>
#include <stdbool.h>

typedef double ambit_four __attribute__((vector_size(32), aligned(8), may_alias)); /* four doubles anywhere */

typedef struct ambit_tails {
  const ambit_tape *tape;
  uint32_t order, ndir;
  size_t stride;    /* doubles per row: order + 1, padded with zeros to a multiple of 4 */
  uint32_t fetched; /* orders whose magnitudes are here; 0: none */
  uint32_t K;       /* of the arrays below, with the step |h|; meaningless unless scaled */
  double h;
  bool scaled;
  uint32_t nactive, *active;  /* instructions whose slots move in time */
  uint8_t *moving, *flows;    /* [nslot] degree > 0; some rule needs k U_k */
  double *lo, *hi;            /* [nslot] bounds of coefficient 0 */
  double *mag, *dmag;         /* [nslot rows], [nslot rows x ndir] |u_k| */
  double *U, *V;              /* the same times |h|^k, of values and of slopes */
  double *W;                  /* k U_k */
  double *R, *RW;             /* sums of the highest: R[i] = sum of U_j, K+1-i <= j <= K; RW the same of W */
  double *sum, *swing, *vsum; /* [nslot] all of U; all but U_0; [nslot x ndir] all of V */
  double *tau, *sigma;        /* [nslot], [nslot x ndir] the result */
  double *power, *weight;     /* [stride] |h|^k; scratch */
  double *lane;               /* [ndir] scratch */
} ambit_tails;

ambit_status ambit_tails_open(
    const ambit_host *h, const ambit_tape *t, uint32_t order, uint32_t ndir, ambit_tails **tails);
/* Contract of ambit_jet_service.tail for arguments that it does not refuse; the coefficients come from `jets`. No
** allocation. */
void ambit_tails_run(ambit_tails *t, const ambit_jets *jets, const void *self, uint32_t K, double h,
    const double *tail_in, const double *dtail_in, double *tail_out, double *dtail_out);

/* -- between the files of the pass; upward mode */

/* Where slot v can be on the step: as the function that it is; all along the segment from polynomial to function. */
typedef struct ambit_span {
  double lo, hi;
} ambit_span;
ambit_span ambit_tails_value(const ambit_tails *t, uint32_t v);
ambit_span ambit_tails_segment(const ambit_tails *t, uint32_t v);
double ambit_tails_gap(ambit_span x); /* min |x| if 0 is outside, else 0 */
double ambit_tails_exp(double x);     /* >= e^x, x >= 0 */

/* sum_k a_k r_k over rows: with r = R of b, the sum of U_a,i U_b,j over i + j > K */
double ambit_tails_dot(const ambit_tails *t, const double *a, const double *r);
static inline const double *ambit_tails_row(const ambit_tails *t, const double *array, uint32_t v) {
  return array + (size_t)v * t->stride;
}
/* sum of U_a,i U_b,j over i + j > K */
double ambit_tails_product(const ambit_tails *t, uint32_t a, uint32_t b);
/* bound D of the part of order >= K of U_u' U_v: |.| <= D s^K */
double ambit_tails_flow(const ambit_tails *t, uint32_t u, uint32_t v);
/* below 1 + (P + theta T)^2 of ATAN; below the same of a^2 + b^2 of ATAN2, 0 unless the cut is excluded */
double ambit_tails_atan_floor(const ambit_tails *t, uint32_t i);
double ambit_tails_atan2_floor(const ambit_tails *t, uint32_t i);
double ambit_tails_sqrt_floor(const ambit_tails *t, uint32_t u); /* below sqrt u */
/* above 1 - tanh(P + theta T)^2 of TANH */
double ambit_tails_tanh_slope(const ambit_tails *t, uint32_t u);
/* TANH: the integral over the step of |tanh P + P_y| |P'|, and what P_y fails its differential equation by */
double ambit_tails_tanh_swing(const ambit_tails *t, uint32_t i);
double ambit_tails_tanh_defect(const ambit_tails *t, uint32_t i);
/* ABS, MIN, MAX: the operand whose branch holds on the whole step, on which both are defined; or AMBIT_NO_SLOT */
uint32_t ambit_tails_branch(const ambit_tails *t, uint32_t i);

/* tau of instruction i's slot; sigma of its directions, after tau */
void ambit_tails_values(ambit_tails *t, uint32_t i);
void ambit_tails_slopes(ambit_tails *t, uint32_t i);
#endif
