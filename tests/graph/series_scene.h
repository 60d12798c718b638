/* series_scene.h -- random problems for the tests of series and tails.
**
** Input i is sum_k X_ik t^k with X_ik = mid_ik + sum_d slope_ikd xi_d, |xi_d| <= radius_d: a box with its centre at
** xi = 0 and known, constant slopes. The judge knows every slot's series at any xi.
*/
#ifndef AMBIT_TEST_SERIES_SCENE_H
#define AMBIT_TEST_SERIES_SCENE_H
#include "graph/series_fixture.h"

#define SCENE_INPUTS 3
#define SCENE_DIRECTIONS 5 /* a group of four and a rest */

typedef struct scene {
  fixture_tape *x;
  uint32_t nin, K;
  double mid[SCENE_INPUTS][JUDGE_ORDER + 1], slope[SCENE_INPUTS][JUDGE_ORDER + 1][SCENE_DIRECTIONS];
  double radius[SCENE_DIRECTIONS];
} scene;

static const uint32_t series_op[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_NEG, AMBIT_OP_MUL, AMBIT_OP_SQR,
  AMBIT_OP_DIV, AMBIT_OP_SQRT, AMBIT_OP_EXP, AMBIT_OP_LOG, AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_ATAN, AMBIT_OP_ATAN2,
  AMBIT_OP_SINH, AMBIT_OP_COSH, AMBIT_OP_TANH, AMBIT_OP_ABS, AMBIT_OP_MIN, AMBIT_OP_MAX };
#define SERIES_OPS (sizeof series_op / sizeof *series_op)

/* Inputs u, v (functions of time), p (a parameter); operation op of u and v, of u and p, of p and u, and so on. */
static inline fixture_tape *scene_single(fixture_host *host, uint32_t op) {
  fixture_tape *x = fixture_tape_open(host);
  uint32_t one = fixture_constant(x, 1, 1);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY), v = fixture_input(x, AMBIT_DEGREE_ANY), p = fixture_input(x, 0);
  const uint32_t first[] = { u, u, p, p, one, u }, second[] = { v, p, u, p, v, u };
  for (int i = 0; i < 6; i++) {
    bool same_kind = i == 5 && (op == AMBIT_OP_MIN || op == AMBIT_OP_MAX); /* never decided */
    if (!same_kind) fixture_function(x, op, first[i], second[i], one);
  }
  fixture_output_all(x);
  return x;
}

/* A random program over u, v, p that is defined everywhere: sqrt, log and divisors get 1 plus a square. */
static inline fixture_tape *scene_random(fixture_host *host, uint64_t *state, uint32_t length) {
  static const uint32_t op[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_NEG, AMBIT_OP_MUL, AMBIT_OP_SQR, AMBIT_OP_DIV,
    AMBIT_OP_SQRT, AMBIT_OP_LOG, AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_ATAN, AMBIT_OP_SINH, AMBIT_OP_COSH, AMBIT_OP_TANH,
    AMBIT_OP_EXP };
  fixture_tape *x = fixture_tape_open(host);
  uint32_t one = fixture_constant(x, 1, 1), tenth = fixture_constant(x, 0.125, 0.125);
  for (int i = 0; i < SCENE_INPUTS; i++) fixture_input(x, i < 2 ? AMBIT_DEGREE_ANY : 0);
  for (uint32_t n = 0; n < length; n++) {
    uint32_t o = op[oracle_random(state) % (sizeof op / sizeof *op)];
    uint32_t a = 2 + (uint32_t)(oracle_random(state) % (x->tape.nslot - 2)),
             b = 2 + (uint32_t)(oracle_random(state) % (x->tape.nslot - 2));
    if (o == AMBIT_OP_SQRT || o == AMBIT_OP_LOG || o == AMBIT_OP_DIV) {
      b = fixture_op(x, AMBIT_OP_ADD, one, fixture_op(x, AMBIT_OP_SQR, b, b));
      if (o != AMBIT_OP_DIV) a = b;
    }
    /* keep arguments of growing functions small */
    if (o == AMBIT_OP_EXP || o == AMBIT_OP_SINH || o == AMBIT_OP_COSH) {
      uint32_t s = fixture_function(x, AMBIT_OP_SIN, a, a, one);
      a = fixture_op(x, AMBIT_OP_ADD, s, s);
    }
    uint32_t y = fixture_function(x, o, a, b, one);
    if (o == AMBIT_OP_MUL || o == AMBIT_OP_SQR) fixture_op(x, AMBIT_OP_MUL, y, tenth);
  }
  fixture_output_all(x);
  return x;
}

/* coefficient k of an input of size 1/2^k, its value near `level`, uncertain by a fraction `width` */
static inline void scene_fill(scene *s, uint64_t *state, double level, double width) {
  for (uint32_t i = 0; i < s->nin; i++)
    for (uint32_t k = 0; k <= JUDGE_ORDER; k++) {
      bool used = k <= s->K && (k == 0 || s->x->degree[s->x->tape.nconst + i] != 0);
      double size = used ? ldexp(level, -(int)k) : 0;
      s->mid[i][k] = k == 0 ? size * oracle_uniform(state, 0.7, 1.3) : size * oracle_uniform(state, -0.5, 0.5);
      for (int d = 0; d < SCENE_DIRECTIONS; d++) s->slope[i][k][d] = size * oracle_uniform(state, -1, 1);
    }
  for (int d = 0; d < SCENE_DIRECTIONS; d++) s->radius[d] = width / 2 * oracle_uniform(state, 0, 1);
}

static inline void scene_point(const scene *s, uint64_t *state, double *xi) {
  for (int d = 0; d < SCENE_DIRECTIONS; d++) {
    uint64_t kind = oracle_random(state) % 4;
    xi[d] = kind == 0 ? s->radius[d] : kind == 1 ? -s->radius[d] : oracle_uniform(state, -s->radius[d], s->radius[d]);
  }
}

static inline real scene_coefficient(const scene *s, uint32_t i, uint32_t k, const double *xi) {
  real c = s->mid[i][k];
  for (int d = 0; d < SCENE_DIRECTIONS; d++) c += (real)s->slope[i][k][d] * xi[d];
  return c;
}

static inline void scene_judge(const scene *s, const double *xi, judge_series *series) {
  const ambit_tape *t = &s->x->tape;
  for (uint32_t i = 0; i < s->nin; i++)
    for (uint32_t k = 0; k <= JUDGE_ORDER; k++) series[t->nconst + i].c[k] = scene_coefficient(s, i, k, xi);
  judge_tape_series(t, series, s->K);
}

/* Puts the box (box: true) or the centre into a jet and computes all orders; returns the flags. */
static inline uint32_t scene_run(const scene *s, ambit_jet *jet, bool box) {
  const ambit_jet_service *service = &ambit_jet_service_v1;
  uint32_t flags = 0;
  for (uint32_t k = 0; k <= s->K; k++) {
    for (uint32_t i = 0; i < s->nin; i++) {
      double rad = 0, zero[SCENE_DIRECTIONS] = { 0 };
      for (int d = 0; d < SCENE_DIRECTIONS && box; d++) rad += fabs(s->slope[i][k][d]) * s->radius[d];
      service->put(jet, i, k, s->mid[i][k], rad * (1 + 1e-15), s->slope[i][k], zero);
    }
    flags |= service->advance(jet, k);
  }
  return flags;
}
#endif
