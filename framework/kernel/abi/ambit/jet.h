/* jet.h -- service "ambit.jet/1": Taylor series of a tape over any arithmetic, with slopes and proved tails.
**
** A solver asks for "the series of this tape at a point to order p", "the slopes over a box to order q" and "what is
** beyond order p over a step h" and contains no coefficient arithmetic: it reads like the algorithm in its paper. All
** pointers: [ctx].
*/
#ifndef AMBIT_JET_H
#define AMBIT_JET_H
#include "arithmetic.h"

#define AMBIT_JET_SERVICE "ambit.jet/1"

typedef struct ambit_jet ambit_jet; /* opaque: series of every slot */

typedef struct ambit_jet_service {
  uint32_t size;
  /* Opens series of `t` (a SERIES tape) to the given order, with ndir slope directions about `centre` (see
  ** ambit_jets; NULL: derivatives). Uses the arithmetic's own jets, else the kernel's general ones over run[]. Freed
  ** with the host object. */
  ambit_status (*open)(const ambit_host *h, const ambit_tape *t, const ambit_arithmetic *arithmetic, void *actx,
      uint32_t order, uint32_t ndir, const ambit_jet *centre, ambit_jet **jet);
  void (*close)(ambit_jet *jet);
  /* coefficient k of input `in`; dmid, drad [ndir] (NULL: zero). Orders >= k of all slots are void then. k above the
  ** order: ignored. */
  void (*put)(ambit_jet *jet, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad);
  /* Computes order k of every slot; returns AMBIT_F_*. UNBOUNDED, and nothing computed: k is above the order, a lower
  ** order is missing or void, or the centre lacks order k. */
  uint32_t (*advance)(ambit_jet *jet, uint32_t k);
  /* coefficient k of a slot, mid +- rad, and of its slopes; dmid, drad [ndir]: either may be NULL, mid and rad not */
  void (*get)(const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad);
  /* Solves x' = f: for k = 0..order-1: advance(k), then coefficient k+1 of input i (i < nx) := coefficient k of
  ** output i, divided by k+1. Coefficients 0 of all inputs (and order 1 of time: 1) must have been put. Returns
  ** AMBIT_F_*. */
  uint32_t (*solve)(ambit_jet *jet, uint32_t nx, uint32_t order);
  /* What is beyond order K: over a step h (of either sign) let every slot be sum_{k<=K} u_k (s h)^k + tau s^(K+1), s
  ** = t/h in [0, 1], |tau| bounded by its tail. Given the tails of the inputs (tail_in [nin]; of direction j of input
  ** i: dtail_in[i*ndir + j]; NULL: all zero) writes those of the outputs (tail_out [nout], dtail_out [nout*ndir]);
  ** +inf where nothing can be said. Orders 0..K must have been computed. An input polynomial of finite degree above K
  ** has coefficients K+1..degree: as far as they were put, tail() adds them to the input's tail by itself (degree
  ** above the order: +inf). INVALID, with a message and +inf written: orders missing, h not finite, tails of inputs
  ** that are negative, NaN, or not 0 where the input is constant in time (degree 0). Picard: for x' = f put tail_in =
  ** |x_(K+1)| |h|^(K+1) + eps; if |h| tail_out / (K+2) <= eps componentwise, then the solution exists on the step and
  ** equals sum_{k<=K+1} x_k (s h)^k +- |h| tail_out / (K+2) s^(K+2) (proof: docs/numerics/series.md). */
  ambit_status (*tail)(ambit_jet *jet, uint32_t K, double h, const double *tail_in, const double *dtail_in,
      double *tail_out, double *dtail_out);
  /* An ABS, MIN or MAX that coefficients of order 0 leave undecided (where the function has a kink), as the tape names
  ** it; NULL: there is none. */
  const char *(*kink)(const ambit_jet *jet);
} ambit_jet_service;
#endif
