/* multibody_flow.c -- Gragg's rule (the modified midpoint rule), extrapolated in the square of the step [Hairer,
** Norsett, Wanner, Solving Ordinary Differential Equations I, II.9]: order 2 COLUMNS, the step chosen by the last two
** columns.
*/
#include "multibody.h"
#include <string.h>

typedef multibody_real real;
#define FN MULTIBODY_FN
enum { COLUMNS = 8 };

typedef struct vector {
  real at[MULTIBODY_STATES];
} vector;

static bool rate(multibody *m, real t, const vector *x, vector *f) {
  int n = m->n;
  memcpy(f->at, x->at + n, (size_t)n * sizeof(real));
  return multibody_accelerations(m, x->at, x->at + n, t, f->at + n);
}

/* x at t + h by `steps` steps of the midpoint rule; f0: the rate at t. */
static bool gragg(multibody *m, real t, real h, int steps, const vector *x, const vector *f0, vector *out) {
  int n = 2 * m->n;
  vector before = *x, now, f;
  real d = h / steps;
  for (int i = 0; i < n; i++) now.at[i] = x->at[i] + d * f0->at[i];
  for (int k = 1; k < steps; k++) {
    if (!rate(m, t + k * d, &now, &f)) return false;
    for (int i = 0; i < n; i++) {
      real next = before.at[i] + 2 * d * f.at[i];
      before.at[i] = now.at[i];
      now.at[i] = next;
    }
  }
  *out = now;
  return true;
}

/* One step: *error relative to the tolerance. */
static bool extrapolate(multibody *m, real t, real h, real tolerance, vector *x, real *error) {
  int n = 2 * m->n;
  vector f0, row[COLUMNS], previous;
  if (!rate(m, t, x, &f0)) return false;
  for (int k = 0; k < COLUMNS; k++) {
    vector now;
    if (!gragg(m, t, h, 2 * (k + 1), x, &f0, &now)) return false;
    for (int j = 0; j < k; j++) { /* Aitken and Neville; row[j] holds column j of the line before */
      real ratio = (real)(k + 1) / (real)(k - j);
      vector old = row[j];
      row[j] = now;
      for (int i = 0; i < n; i++) now.at[i] += (now.at[i] - old.at[i]) / (ratio * ratio - 1);
    }
    if (k == COLUMNS - 1) previous = row[k - 1];
    row[k] = now;
  }
  *error = 0;
  for (int i = 0; i < n; i++) {
    real y = row[COLUMNS - 1].at[i], e = FN(fabs)(y - previous.at[i]) / (tolerance * (1 + FN(fabs)(y)));
    if (!(e <= *error)) *error = e;
  }
  *x = row[COLUMNS - 1];
  return *error == *error;
}

bool multibody_integrate(multibody *m, real t, real to, real tolerance, real *q, real *v) {
  int n = m->n;
  vector x;
  memcpy(x.at, q, (size_t)n * sizeof(real));
  memcpy(x.at + n, v, (size_t)n * sizeof(real));
  real h = FN(fmin)(to - t, (real)0.05);
  while (t < to) {
    bool last = t + h >= to;
    real step = last ? to - t : h, error = 0;
    vector y = x;
    bool good = extrapolate(m, t, step, tolerance, &y, &error);
    real by = good ? FN(pow)(error + (real)1e-30, (real)-1 / (2 * COLUMNS - 1)) * (real)0.8 : (real)0.25;
    if (good && error <= 1) {
      x = y;
      t = last ? to : t + step;
    }
    if (!last || error > 1 || !good) h = step * FN(fmin)(FN(fmax)(by, (real)0.1), (real)2);
    if (!(h > 1e-9)) return false;
  }
  memcpy(q, x.at, (size_t)n * sizeof(real));
  memcpy(v, x.at + n, (size_t)n * sizeof(real));
  return true;
}
