/* The integrator's generators: moving them, and condensing them into orthogonal frames, loses no point. The judge is
** long double. */
#include "solver/lohner/frame.c"
#include "solver/lohner/history.c"
#include "host/services.h"
#include "oracle.h"
#include "shared/axes.h"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

typedef struct rig {
  ambit_scope *scope;
  history g;
  uint64_t random;
} rig;

static void open_rig(rig *r, uint32_t n, uint32_t keep) {
  *r = (rig) { .random = 17 + n + keep };
  assert_int_equal(ambit_scope_open(&r->scope, NULL, NULL), AMBIT_OK);
  assert_true(history_open(&r->scope->host, &r->g, n, keep));
  history_clear(&r->g);
}

static void close_rig(rig *r) { ambit_scope_close(r->scope); }

/* the functions under test are workers in upward mode */
static AMBIT_WORKER void push(history *g, const double *box) { history_push(g, box); }
static AMBIT_WORKER void multiply(history *g, const double *M, const double *rest, double *pad) {
  history_multiply(g, M, g->n, rest, pad);
}
static AMBIT_WORKER void sum(const history *g, double *rest) { history_sum(g, rest); }

/* support of the set in direction a: the largest a.z; exact up to long double */
static long double support(const history *g, const long double *a) {
  long double total = 0;
  for (size_t c = 0; c < columns(g); c++) {
    long double along = 0;
    for (uint32_t i = 0; i < g->n; i++) along += a[i] * g->direction[i * g->pitch + c];
    total += fabsl(along) * g->weight[c];
  }
  return total;
}

/* A set of boxes moved by random matrices, beside what it must contain: sum of |a M_k ... M_j| box_j over all steps
** is the support of the exact set, so ours must be as large in every direction, up to the judge's own rounding. */
#define STEPS 300
#define STATES_MAX 6

static void random_matrix(rig *r, double *M) {
  uint32_t n = r->g.n;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) M[i * n + j] = (i == j ? 0.98 : 0) + oracle_uniform(&r->random, -0.2, 0.2) / n;
}

typedef struct step {
  double M[STATES_MAX * STATES_MAX], box[STATES_MAX];
} step;

static long double exact_support(const step *steps, int count, uint32_t n, const long double *a) {
  long double row[STATES_MAX], next[STATES_MAX], total = 0;
  for (uint32_t i = 0; i < n; i++) row[i] = a[i];
  for (int k = count; k-- > 0;) {
    for (uint32_t i = 0; i < n; i++) total += fabsl(row[i]) * steps[k].box[i];
    for (uint32_t j = 0; j < n; j++) {
      next[j] = 0;
      for (uint32_t i = 0; i < n; i++) next[j] += row[i] * steps[k].M[i * n + j];
    }
    memcpy(row, next, sizeof row);
  }
  return total;
}

static void check_supports(rig *r, const step *steps, int count) {
  uint32_t n = r->g.n;
  double rest[STATES_MAX];
  for (int d = 0; d < 12; d++) {
    long double a[STATES_MAX];
    for (uint32_t i = 0; i < n; i++) a[i] = d < (int)n ? d == (int)i : oracle_uniform(&r->random, -1, 1);
    long double ours = support(&r->g, a), exact = exact_support(steps, count, n, a);
    if (!(ours * (1 + 1e-15L) >= exact))
      fail_msg("n = %u, keep = %u, step %d: %Lg < %Lg", n, r->g.keep, count, ours, exact);
  }
  ambit_rounding old = ambit_round_up();
  sum(&r->g, rest);
  ambit_rounding_restore(old);
  for (uint32_t i = 0; i < n; i++) {
    long double a[STATES_MAX] = { 0 };
    a[i] = 1;
    assert_true(rest[i] >= support(&r->g, a) * (1 - 1e-17L));
    assert_true(rest[i] <= support(&r->g, a) * (1 + 1e-12L));
  }
}

static void one_step(rig *r, step *s) {
  uint32_t n = r->g.n;
  double rest[STATES_MAX], pad[STATES_MAX];
  random_matrix(r, s->M);
  ambit_rounding old = ambit_round_up();
  sum(&r->g, rest);
  for (uint32_t i = 0; i < n; i++) pad[i] = s->box[i] = oracle_uniform(&r->random, 0, 1) * ldexp(1, -(int)(10 * i));
  multiply(&r->g, s->M, rest, pad);
  push(&r->g, pad);
  ambit_rounding_restore(old);
  assert_true(r->g.group <= r->g.room);
}

static void no_point_is_lost(void **unused) {
  (void)unused;
  static step steps[STEPS];
  static const uint32_t keep[] = { 0, 4, 8, 32 };
  for (uint32_t n = 1; n <= STATES_MAX; n++)
    for (size_t k = 0; k < 4; k++) {
      rig r;
      open_rig(&r, n, keep[k]);
      for (int i = 0; i < STEPS; i++) {
        one_step(&r, &steps[i]);
        if (i % 7 == 0 || i > STEPS - 3) check_supports(&r, steps, i + 1);
      }
      close_rig(&r);
    }
}

/* the pad of a product covers its rounding: entries are judged one by one, where the set alone would hide it */
static void rounding_is_paid_for(void **unused) {
  (void)unused;
  for (int round = 0; round < 200; round++) {
    rig r;
    double M[STATES_MAX * STATES_MAX], before[STATES_MAX * STATES_MAX], rest[STATES_MAX], pad[STATES_MAX] = { 0 };
    double box[STATES_MAX];
    uint32_t n = 1 + (uint32_t)round % STATES_MAX;
    open_rig(&r, n, 8);
    r.random += (uint64_t)round * 1000;
    ambit_rounding old = ambit_round_up();
    for (uint32_t i = 0; i < n; i++) box[i] = oracle_uniform(&r.random, 0, 1);
    push(&r.g, box);
    random_matrix(&r, M);
    sum(&r.g, rest);
    multiply(&r.g, M, rest, pad);
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t c = 0; c < n; c++) before[i * n + c] = r.g.direction[i * r.g.pitch + c];
    sum(&r.g, rest);
    for (uint32_t i = 0; i < n; i++) pad[i] = 0;
    random_matrix(&r, M);
    multiply(&r.g, M, rest, pad);
    ambit_rounding_restore(old);
    for (uint32_t i = 0; i < n; i++) {
      long double lost = 0;
      for (uint32_t c = 0; c < n; c++) {
        long double exact = 0;
        for (uint32_t j = 0; j < n; j++) exact += (long double)M[i * n + j] * before[j * n + c];
        lost += fabsl(exact - r.g.direction[i * r.g.pitch + c]) * r.g.weight[c];
      }
      assert_true(lost <= pad[i]);
      if (n > 1) assert_true(lost > 0);
    }
    close_rig(&r);
  }
}

/* what products lose that are below the smallest number: heavy columns make more of it than one rounding */
static void underflow_is_paid_for(void **unused) {
  (void)unused;
  rig r;
  enum { N = 3 };
  double M[N * N], before[N * N], rest[N], pad[N] = { 0 }, box[N] = { 1e6, 2e6, 3e6 };
  open_rig(&r, N, 8);
  ambit_rounding old = ambit_round_up();
  push(&r.g, box);
  random_matrix(&r, M);
  for (uint32_t i = 0; i < N * N; i++) M[i] *= 0x1p-500;
  sum(&r.g, rest);
  multiply(&r.g, M, rest, pad);
  for (uint32_t i = 0; i < N; i++)
    for (uint32_t c = 0; c < N; c++) before[i * N + c] = r.g.direction[i * r.g.pitch + c];
  random_matrix(&r, M);
  for (uint32_t i = 0; i < N * N; i++) M[i] *= 0x1p-574;
  for (uint32_t i = 0; i < N; i++) pad[i] = 0;
  sum(&r.g, rest);
  multiply(&r.g, M, rest, pad);
  ambit_rounding_restore(old);
  for (uint32_t i = 0; i < N; i++) {
    long double lost = 0;
    for (uint32_t c = 0; c < N; c++) {
      long double exact = 0;
      for (uint32_t j = 0; j < N; j++) exact += (long double)M[i * N + j] * before[j * N + c];
      lost += fabsl(exact - r.g.direction[i * r.g.pitch + c]) * r.g.weight[c];
    }
    assert_true(lost <= pad[i] && lost > 0x1p-1060L);
  }
  close_rig(&r);
}

/* -- frames */

static AMBIT_WORKER double defect(uint32_t n, const double *Q) { return frame_defect(n, Q); }
static AMBIT_WORKER void axes(uint32_t n, double *S, double *Q) { shared_axes(n, S, Q); }
static AMBIT_WORKER void gram_schmidt(
    uint32_t n, const double *A, const double *w, double *Q, uint32_t *order, double *size) {
  frame_orthogonal(n, A, n, w, Q, order, size);
}

static long double exact_defect(uint32_t n, const double *Q) {
  long double worst = 0;
  for (uint32_t i = 0; i < n; i++) {
    long double row = 0;
    for (uint32_t j = 0; j < n; j++) {
      long double e = i == j;
      for (uint32_t k = 0; k < n; k++) e -= (long double)Q[k * n + i] * Q[k * n + j];
      row += fabsl(e);
    }
    worst = fmaxl(worst, row);
  }
  return worst;
}

static void frames_are_orthogonal_and_say_how_much(void **unused) {
  (void)unused;
  enum { N = 12 };
  uint64_t random = 3;
  for (int round = 0; round < 300; round++) {
    uint32_t n = 1 + (uint32_t)(oracle_random(&random) % N), order[N];
    double A[N * N], S[N * N], Q[N * N], w[N], size[N];
    int kind = round % 4; /* full rank, rank one, zero, nearly parallel */
    for (uint32_t i = 0; i < n * n; i++) {
      double noise = oracle_uniform(&random, -1, 1);
      A[i] = kind == 0 ? noise : kind == 1 ? (double)(i / n + 1) : kind == 2 ? 0 : (double)(i / n + 1) + 1e-13 * noise;
    }
    for (uint32_t i = 0; i < n; i++) w[i] = oracle_uniform(&random, 0, 1);
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t j = 0; j < n; j++) {
        S[i * n + j] = 0;
        for (uint32_t k = 0; k < n; k++) S[i * n + j] += A[i * n + k] * A[j * n + k];
      }
    ambit_rounding old = ambit_round_up();
    gram_schmidt(n, A, w, Q, order, size);
    double bound = defect(n, Q);
    ambit_rounding_restore(old);
    assert_true(bound < 1e-13 && bound >= exact_defect(n, Q) * (1 - 1e-4L));
    old = ambit_round_up();
    axes(n, S, Q);
    bound = defect(n, Q);
    ambit_rounding_restore(old);
    assert_true(bound < 1e-12 && bound >= exact_defect(n, Q) * (1 - 1e-4L));
  }
}

/* a frame that is far from orthogonal, infinite or no number is seen to be so */
static void bad_frames_are_seen(void **unused) {
  (void)unused;
  const double skew[] = { 1, 1, 0, 1 }, infinite[] = { INFINITY, 0, 0, 1 }, nan[] = { 1, 0, 0, NAN };
  ambit_rounding old = ambit_round_up();
  double a = defect(2, skew), b = defect(2, infinite), c = defect(2, nan);
  ambit_rounding_restore(old);
  assert_true(a >= 1 && b == INFINITY && c == INFINITY);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_point_is_lost),
    cmocka_unit_test(rounding_is_paid_for),
    cmocka_unit_test(underflow_is_paid_for),
    cmocka_unit_test(frames_are_orthogonal_and_say_how_much),
    cmocka_unit_test(bad_frames_are_seen),
  };
  return cmocka_run_group_tests_name("solver lohner history", tests, NULL, NULL);
}
