/* worth.c -- are discs worth it? No proof depends on it.
**
** They are tried where older errors' dependence on the data makes most of all errors: columns are boxed then sooner
** than they die out. They cost what discs around columns are wider than the columns themselves will ever be: little
** where modes oscillate, much where they are damped so that they are nearly one. That does not matter if they are thin
** beside the sets, and shrink. And discs must not grow too much themselves.
*/
#include "modes.h"
#include "proof.h"
#include "quartic.h"

#define MOSTLY 0.5 /* of the errors, that must come from how older ones depend on the data */
#define EXCESS 4.5 /* most that discs are wider by: 2 to 3.4 where they help, 5.7 and more where they harm */
#define URGENT 0.5 /* of its set: from errors of a state so large on they will not stay in generators for long, and */
#define BEARABLE 16.0   /* discs may be wider by so much */
#define BESIDE_SET 0.05 /* of each state's set: discs that are no wider, and shrink, cost next to nothing */
#define GROWTH 10.0     /* logarithm: most by which discs may grow to the end of the run */
#define DOUBLINGS 24

static double time_left(const zono *z) { return fabs(z->problem.time[z->problem.ntime - 1] - z->t); }

int worth_trying(const zono *z) {
  const proof *p = z->proof;
  double mixed = 0, all = 0;
  for (uint32_t c = 0; c < z->ngen; c++)
    for (uint32_t i = 0; i < z->nx; i++) {
      double part = fabs(z->G[(size_t)c * z->nx + i]) / p->spread[i];
      all += part, mixed += p->from[c] == FROM_MIXED ? part : 0;
    }
  return mixed > MOSTLY * all;
}

/* most [nx] := the most of |Y^n G| for n = 0, 1, 2, 4, ... to the end of the run; Y, square [nx x nx] */
static void find_reach(const zono *z, double *Y, double *square, double *most) {
  uint32_t n = z->nx;
  memset(most, 0, n * sizeof *most);
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t k = 0; k < n; k++) Y[i * n + k] = modes_flow(z, i, k);
    for (uint32_t c = 0; c < z->ngen; c++) most[i] += fabs(z->G[(size_t)c * n + i]);
  }
  for (double time = fabs(z->h); time <= time_left(z); time *= 2) {
    for (uint32_t i = 0; i < n; i++) {
      double sum = 0;
      for (uint32_t c = 0; c < z->ngen; c++) {
        double x = 0;
        for (uint32_t k = 0; k < n; k++) x += Y[i * n + k] * z->G[(size_t)c * n + k];
        sum += fabs(x);
      }
      most[i] = fmax(most[i], sum);
    }
    memset(square, 0, (size_t)n * n * sizeof *square);
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t k = 0; k < n; k++)
        for (uint32_t l = 0; l < n; l++) square[i * n + l] += Y[i * n + k] * Y[k * n + l];
    memcpy(Y, square, (size_t)n * n * sizeof *Y);
  }
}

/* b [nx] := radii of discs around all of G */
static void enclose(const zono *z, double *b) {
  const modes *m = z->modes;
  uint32_t n = z->nx;
  memset(b, 0, n * sizeof *b);
  for (uint32_t k = 0; k < n; k++)
    for (uint32_t c = 0; c < z->ngen; c++) {
      number x = 0;
      for (uint32_t i = 0; i < n; i++) x += m->now.W[k * n + i] * z->G[(size_t)c * n + i];
      b[k] += modulus(x);
    }
}

static int is_urgent(const zono *z) {
  for (uint32_t i = 0; i < z->nx; i++)
    if (z->E[i] - quartic_size(z, i) > URGENT * z->proof->spread[i]) return 1;
  return 0;
}

enum worth worth_enclosing(zono *z) {
  const modes *m = z->modes;
  uint32_t n = z->nx;
  double *Y = m->work, *most = Y + 2 * (size_t)n * n, *b = most + n, reach = 0, width = 0, widest = 0;
  find_reach(z, Y, Y + (size_t)n * n, most), enclose(z, b);
  for (uint32_t i = 0; i < n; i++) {
    double own = 0;
    reach += most[i] / z->proof->spread[i];
    for (uint32_t k = 0; k < n; k++)
      own += (modulus(m->now.V[i * n + k]) + m->now.S[i * n + k]) * b[k] / z->proof->spread[i];
    width += own, widest = fmax(widest, own);
  }
  if (width < (is_urgent(z) ? BEARABLE : EXCESS) * reach) return WORTH_KEEPING;
  return widest < BESIDE_SET ? WORTH_IF_SHRINKING : WORTH_NOTHING;
}

/* how fast discs grow at most, per second: by the largest eigenvalue of m->growth, from its powers */
static double rate_of(const zono *z) {
  const modes *m = z->modes;
  uint32_t n = z->nx;
  size_t square = (size_t)n * n;
  double *power = m->work, *next = power + square, size = 0; /* the power is e^size of this */
  memcpy(power, m->growth, square * sizeof *power);
  for (int k = 0; k < DOUBLINGS; k++) {
    double most = 0;
    for (size_t e = 0; e < square; e++) most = fmax(most, power[e]);
    for (size_t e = 0; e < square; e++) power[e] /= most;
    size = 2 * (size + log(most));
    memset(next, 0, square * sizeof *next);
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t l = 0; l < n; l++)
        for (uint32_t c = 0; c < n; c++) next[i * n + c] += power[i * n + l] * power[l * n + c];
    memcpy(power, next, square * sizeof *power);
  }
  return ldexp(size, -DOUBLINGS) / fabs(z->h);
}

int worth_keeping(zono *z) {
  z->modes->rate = rate_of(z);
  return z->modes->rate * time_left(z) < GROWTH;
}
