/* real.h -- a tape at a point, in long double: for what needs no proof. */
#ifndef STIFF_REAL_H
#define STIFF_REAL_H
#include "series.h"

typedef struct real {
  const ambit_tape *tape;
  long double *slot;
  double *terms; /* [nslot] see real_terms */
  ambit_work *counted;
} real;

/* 0: no memory. Constants are those of `s`, a series of the same tape. */
int real_open(const ambit_host *h, const series *s, real *r);
/* the inputs have been set; NaN and infinities pass through */
void real_run(real *r);
static inline long double *real_input(real *r, uint32_t in) { return &r->slot[r->tape->nconst + in]; }
static inline long double real_output(const real *r, uint32_t out) { return r->slot[r->tape->out[out]]; }
/* After real_run: how large the terms are that output i is the sum of, which may cancel: what its rounding is in
** proportion to. A guess. */
void real_terms(real *r);
static inline double real_term(const real *r, uint32_t out) { return r->terms[r->tape->out[out]]; }
#endif
