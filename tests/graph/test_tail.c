/* Tails: the true functions, sampled over the step, must lie within the polynomial and the tail; changes of the tail
** over the box within its slopes. Without the tail the check must fail. */
#include "graph/series_scene.h"
#include "graph/tail.h"
#include <setjmp.h>
#include <stddef.h>
#include <cmocka.h>

static const ambit_jet_service *const service = &ambit_jet_service_v1;

/* One step of one scene: tails of the inputs, and what came out for every slot. */
typedef struct step {
  double h;
  double weight[SCENE_INPUTS], lean[SCENE_INPUTS][SCENE_DIRECTIONS]; /* T_i = (weight + sum lean xi) wave(s) s^(K+1) */
  double tail_in[SCENE_INPUTS], dtail_in[SCENE_INPUTS * SCENE_DIRECTIONS];
  double tail[FIXTURE_MAX], dtail[FIXTURE_MAX * SCENE_DIRECTIONS];
} step;

typedef struct tally {
  int points, needed;     /* checked with a finite tail; of these beyond the polynomial by far more than rounding */
  real closest, steepest; /* largest part of the tail, of its slopes, that was used */
} tally;

static void fill_step(const scene *s, step *p, uint64_t *state, double h, double size) {
  p->h = h;
  for (uint32_t i = 0; i < s->nin; i++) {
    bool moves = s->x->degree[s->x->tape.nconst + i] != 0;
    p->weight[i] = moves ? size * oracle_uniform(state, -1, 1) : 0;
    p->tail_in[i] = fabs(p->weight[i]);
    for (int d = 0; d < SCENE_DIRECTIONS; d++) {
      p->lean[i][d] = moves ? size * oracle_uniform(state, -1, 1) : 0;
      p->dtail_in[i * SCENE_DIRECTIONS + (uint32_t)d] = fabs(p->lean[i][d]);
      p->tail_in[i] += fabs(p->lean[i][d]) * s->radius[d];
    }
    p->tail_in[i] *= 1 + 1e-14;
  }
}

/* Continuous, not smooth, within [-1, 1]: all that a tail may be. */
static real wave(real s) { return s < 0.7L ? 1 : 1 - fabsl(sinl(40 * (s - 0.7L))); }

/* value of every slot minus its polynomial, at s of the step, for the point xi */
static void true_tails(
    const scene *s, const step *p, const double *xi, real at, const judge_series *series, real *tail, real *scale) {
  const ambit_tape *t = &s->x->tape;
  static real value[FIXTURE_MAX];
  real time = at * p->h, top = powl(at, s->K + 1);
  for (uint32_t v = 0; v < t->nslot; v++) {
    tail[v] = scale[v] = 0;
    for (uint32_t k = s->K + 1; k-- > 0;)
      tail[v] = tail[v] * time + series[v].c[k], scale[v] = scale[v] * fabsl(time) + fabsl(series[v].c[k]);
  }
  for (uint32_t i = 0; i < s->nin; i++) {
    real push = p->weight[i];
    for (int d = 0; d < SCENE_DIRECTIONS; d++) push += (real)p->lean[i][d] * xi[d];
    value[t->nconst + i] = tail[t->nconst + i] + push * wave(at) * top;
  }
  judge_tape_values(t, value);
  for (uint32_t v = 0; v < t->nslot; v++) tail[v] = value[v] - tail[v], scale[v] += fabsl(value[v]);
}

static void check_value(uint32_t op, uint32_t v, real truth, real bound, real slack, tally *sum) {
  if (bound == INFINITY) return;
  if (!(fabsl(truth) <= bound + slack)) fail_msg("op %u slot %u: tail %Lg beyond %Lg", op, v, truth, bound);
  sum->points++;
  if (fabsl(truth) > 100 * slack) {
    sum->needed++;
    sum->closest = fmaxl(sum->closest, fabsl(truth) / bound);
  }
}

static void check_change(uint32_t op, uint32_t v, real truth, real bound, real slack, tally *sum) {
  if (bound == INFINITY) return;
  if (!(fabsl(truth) <= bound + slack)) fail_msg("op %u slot %u: change of tail %Lg beyond %Lg", op, v, truth, bound);
  if (fabsl(truth) > 100 * slack) sum->steepest = fmaxl(sum->steepest, fabsl(truth) / bound);
}

static void check_step(const scene *s, const step *p, uint64_t *state, uint32_t op, tally *sum) {
  static judge_series here[FIXTURE_MAX], middle[FIXTURE_MAX];
  static real tail[FIXTURE_MAX], tail0[FIXTURE_MAX], scale[FIXTURE_MAX], scale0[FIXTURE_MAX];
  const double zero[SCENE_DIRECTIONS] = { 0 };
  scene_judge(s, zero, middle);
  for (int point = 0; point < 3; point++) {
    double xi[SCENE_DIRECTIONS];
    scene_point(s, state, xi);
    scene_judge(s, xi, here);
    for (real at = 0.125L; at <= 1; at += 0.125L) {
      real top = powl(at, s->K + 1);
      true_tails(s, p, xi, at, here, tail, scale);
      true_tails(s, p, zero, at, middle, tail0, scale0);
      real slack = 0;
      for (uint32_t v = 0; v < s->x->tape.nslot; v++)
        slack = fmaxl(slack, 1e-17L * (scale[v] + scale0[v])); /* the judge's */
      for (uint32_t v = 0; v < s->x->tape.nslot; v++) {
        real change = 0;
        bool input = v < s->x->tape.nconst + s->nin;
        tally unused = { 0 };
        check_value(op, v, tail[v], p->tail[v] * top, slack, input ? &unused : sum);
        for (int d = 0; d < SCENE_DIRECTIONS; d++)
          if (xi[d] != 0) change += p->dtail[v * SCENE_DIRECTIONS + (uint32_t)d] * (real)fabs(xi[d]);
        check_change(op, v, tail[v] - tail0[v], change * top, slack, input ? &unused : sum);
      }
    }
  }
}

/* Opens, runs and tails a scene for several steps; false if the coefficients prove nothing. */
static bool check_scene(
    fixture_host *host, const scene *s, uint64_t *state, uint32_t op, double h, double size, bool centred, tally *sum) {
  ambit_arithmetic full = fixture_arithmetic();
  ambit_jet *centre, *jet;
  step p;
  assert_int_equal(service->open(&host->host, &s->x->tape, &full, NULL, s->K, 0, NULL, &centre), AMBIT_OK);
  if (scene_run(s, centre, false)) return false;
  assert_int_equal(
      service->open(&host->host, &s->x->tape, &full, NULL, s->K, SCENE_DIRECTIONS, centred ? centre : NULL, &jet),
      AMBIT_OK);
  if (scene_run(s, jet, true)) return false;
  for (int turn = 0; turn < 2; turn++) { /* twice on the same coefficients: nothing stale */
    fill_step(s, &p, state, turn ? -h / 2 : h, turn ? 0 : size);
    assert_int_equal(service->tail(jet, s->K, p.h, p.tail_in, p.dtail_in, p.tail, p.dtail), AMBIT_OK);
    for (uint32_t v = 0; v < s->x->tape.nout; v++) {
      assert_true(p.tail[v] >= 0);
      for (uint32_t d = 0; d < SCENE_DIRECTIONS; d++) assert_true(p.dtail[v * SCENE_DIRECTIONS + d] >= 0);
    }
    check_step(s, &p, state, op, sum);
  }
  return true;
}

static void every_operation(void **unused) {
  (void)unused;
  uint64_t state = 11;
  const double level[] = { 1, 0.4, -1, 3, 1e-2 }, width[] = { 0, 1e-6, 0.05, 0.4 }, size[] = { 0, 1e-6, 0.05, 0.4 };
  for (size_t o = 0; o < SERIES_OPS; o++) {
    tally sum = { 0 };
    for (int round = 0; round < 500; round++) {
      fixture_host host;
      fixture_host_open(&host);
      scene s = {
        .x = scene_single(&host, series_op[o]), .nin = 3, .K = (uint32_t)(oracle_random(&state) % (round % 2 ? 3 : 9))
      };
      scene_fill(&s, &state, level[round % 5], width[oracle_random(&state) % 4]);
      double h = oracle_uniform(&state, 0.05, round % 7 ? 0.8 : 2) * (round % 2 ? 1 : -1);
      check_scene(&host, &s, &state, series_op[o], h, fabs(level[round % 5]) * size[oracle_random(&state) % 4],
          round % 3, &sum);
      fixture_host_close(&host);
    }
    if (sum.points < 15000) fail_msg("op %u: only %d points had a finite tail", series_op[o], sum.points);
    if (sum.needed < 2500) fail_msg("op %u: without a tail only %d points would have failed", series_op[o], sum.needed);
    if (!(sum.closest > 0.9L)) fail_msg("op %u: tails at least %Lg times too wide", series_op[o], 1 / sum.closest);
    if (!(sum.steepest > 0.9L))
      fail_msg("op %u: slopes of tails at least %Lg times too wide", series_op[o], 1 / sum.steepest);
  }
}

static void random_programs(void **unused) {
  (void)unused;
  uint64_t state = 12;
  tally sum = { 0 };
  for (int round = 0; round < 150; round++) {
    fixture_host host;
    fixture_host_open(&host);
    scene s = { .x = scene_random(&host, &state, 10), .nin = 3, .K = 3 + (uint32_t)round % 5 };
    scene_fill(&s, &state, round % 2 ? 0.7 : -0.4, round % 3 ? 0.01 : 0);
    check_scene(
        &host, &s, &state, AMBIT_OP_COUNT, oracle_uniform(&state, -0.4, 0.4), round % 4 ? 1e-4 : 0, round % 2, &sum);
    fixture_host_close(&host);
  }
  if (sum.points < 150000 || sum.needed < 80000)
    fail_msg("%d points, %d of them prove something", sum.points, sum.needed);
}

/* -- edges of domains: a tail is finite only if the step provably keeps off the edge */

static double tail_of(uint32_t op, double start, double speed, double h, double other, bool positive_range) {
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t one = fixture_constant(x, 1, 1), c = fixture_constant(x, other, other),
           u = fixture_input(x, AMBIT_DEGREE_ANY);
  uint32_t v = positive_range ? fixture_op(x, AMBIT_OP_ADD, one, fixture_op(x, AMBIT_OP_SQR, u, u)) : u;
  bool divides = op == AMBIT_OP_DIV;
  fixture_output(x, fixture_function(x, op, divides ? one : v, divides ? v : c, one));
  ambit_jet *jet;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 8, 1, NULL, &jet), AMBIT_OK);
  const double one_slope = 1, no_radius = 0, tail_in = 1e-9, dtail_in = 1e-9;
  service->put(jet, 0, 0, start, 0, &one_slope, &no_radius);
  service->put(jet, 0, 1, speed, 0, NULL, NULL);
  uint32_t flags = 0;
  for (uint32_t k = 0; k <= 8; k++) flags |= service->advance(jet, k);
  double tail = -1, change = -1;
  assert_int_equal(service->tail(jet, 8, h, &tail_in, &dtail_in, &tail, &change), AMBIT_OK);
  assert_true(tail >= 0 && change >= 0 && (tail < INFINITY || change == INFINITY));
  if (flags) assert_true(tail == INFINITY);
  fixture_host_close(&host);
  return tail;
}

static void edges(void **unused) {
  (void)unused;
  /* u = 1 - t reaches the edge at 1 */
  const uint32_t op[] = { AMBIT_OP_DIV, AMBIT_OP_LOG, AMBIT_OP_SQRT, AMBIT_OP_ABS };
  for (size_t o = 0; o < 4; o++) {
    assert_true(tail_of(op[o], 1, -1, 0.4, 0, false) < 1e-1);
    assert_true(tail_of(op[o], 1, -1, 1, 0, false) == INFINITY);
    assert_true(tail_of(op[o], 1, -1, 1.5, 0, false) == INFINITY);
    assert_true(tail_of(op[o], 1, 1, -1.5, 0, false) == INFINITY);
    assert_true(tail_of(op[o], 1, -1, 1e200, 0, false) == INFINITY);
  }
  /* known range 1 + u^2 >= 1: the step may be longer than the coefficients alone can tell */
  assert_true(tail_of(AMBIT_OP_DIV, 0.5, -2, 0.8, 0, true) < INFINITY);
  assert_true(tail_of(AMBIT_OP_ABS, 0.5, -2, 0.8, 0, true) < INFINITY);
  assert_true(tail_of(AMBIT_OP_LOG, 0.5, -2, 0.8, 0, true) < INFINITY);
  /* branches: u = 1 - t against 0.5, and the angle of (-1, u) on its way to the cut */
  assert_true(tail_of(AMBIT_OP_MIN, 1, -1, 0.4, 0.5, false) < 1e-8);
  assert_true(tail_of(AMBIT_OP_MAX, 1, -1, 0.6, 0.5, false) == INFINITY);
  assert_true(tail_of(AMBIT_OP_ATAN2, 1, -1, 0.4, -1, false) < 1e-2);
  assert_true(tail_of(AMBIT_OP_ATAN2, 1, -1, 1.5, -1, false) == INFINITY);
  assert_true(tail_of(AMBIT_OP_ATAN2, 0.5, -1, 0.8, 1, false) < INFINITY); /* through a = 0 in front of the origin */
  /* growth that overflows, steps that are no steps */
  assert_true(tail_of(AMBIT_OP_EXP, 1, 1, 1e3, 0, false) == INFINITY);
  assert_true(tail_of(AMBIT_OP_SINH, 1, 1, 1e3, 0, false) == INFINITY);
  assert_true(tail_of(AMBIT_OP_SIN, 1, 1, 1e300, 0, false) == INFINITY);
  assert_true(tail_of(AMBIT_OP_SIN, 1, 1, 0, 0, false) <= 1.1e-9);
}

static void refusals(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY), p = fixture_input(x, 0);
  fixture_output(x, fixture_op(x, AMBIT_OP_MUL, u, p));
  ambit_jet *jet;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 3, 0, NULL, &jet), AMBIT_OK);
  service->put(jet, 0, 0, 1, 0, NULL, NULL), service->put(jet, 1, 0, 2, 0, NULL, NULL);
  for (uint32_t k = 0; k < 3; k++) assert_int_equal(service->advance(jet, k), 0);
  double in[] = { 1, 0 }, still[] = { 0, 1 }, negative[] = { -1, 0 }, no_number[] = { NAN, 0 }, out;
  assert_int_equal(service->tail(jet, 2, 0.5, in, NULL, &out, NULL), AMBIT_OK);
  assert_true(out == 2);
  assert_int_equal(service->tail(jet, 2, 0.5, NULL, NULL, &out, NULL), AMBIT_OK);
  assert_true(out == 0);
  assert_int_equal(service->tail(jet, 3, 0.5, in, NULL, &out, NULL), AMBIT_INVALID); /* order 3 is not computed */
  assert_int_equal(service->tail(jet, 2, NAN, in, NULL, &out, NULL), AMBIT_INVALID);
  assert_int_equal(service->tail(jet, 2, INFINITY, in, NULL, &out, NULL), AMBIT_INVALID);
  assert_int_equal(service->tail(jet, 2, 0.5, still, NULL, &out, NULL), AMBIT_INVALID); /* a constant has no tail */
  assert_int_equal(service->tail(jet, 2, 0.5, negative, NULL, &out, NULL), AMBIT_INVALID);
  assert_int_equal(service->tail(jet, 2, 0.5, no_number, NULL, &out, NULL), AMBIT_INVALID);
  service->put(jet, 0, 0, 5, 0, NULL, NULL); /* new coefficients: the old ones are void */
  assert_int_equal(service->tail(jet, 2, 0.5, in, NULL, &out, NULL), AMBIT_INVALID);
  fixture_host_close(&host);
}

/* What is refused says why, and leaves +inf behind for those who do not look. */
static void refusals_claim_nothing(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY), p = fixture_input(x, 0);
  fixture_output(x, fixture_op(x, AMBIT_OP_MUL, u, p));
  ambit_jet *jet;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 3, 2, NULL, &jet), AMBIT_OK);
  service->put(jet, 0, 0, 1, 0, NULL, NULL), service->put(jet, 1, 0, 2, 0, NULL, NULL);
  for (uint32_t k = 0; k < 3; k++) assert_int_equal(service->advance(jet, k), 0);
  const struct {
    uint32_t K;
    double h, in[2], din[4];
    const char *word;
  } bad[] = {
    { 3, 0.5, { 1, 0 }, { 0 }, "beyond order 3" },
    { 2, NAN, { 1, 0 }, { 0 }, "finite step" },
    { 2, 0.5, { -1, 0 }, { 0 }, "input 0 is -1" },
    { 2, 0.5, { 0, 1 }, { 0 }, "input 1 is 1, not 0" },
    { 2, 0.5, { 1, 0 }, { 0, -2, 0, 0 }, "input 0 in direction 1 is -2" },
    { 2, 0.5, { 1, 0 }, { 0, 0, 0, 3 }, "input 1 in direction 1 is 3, not 0" },
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double out = 0, dout[2] = { 0 };
    host.message[0] = 0;
    assert_int_equal(service->tail(jet, bad[i].K, bad[i].h, bad[i].in, bad[i].din, &out, dout), AMBIT_INVALID);
    if (!strstr(host.message, bad[i].word)) fail_msg("`%s` is not in: %s", bad[i].word, host.message);
    assert_true(out == INFINITY && dout[0] == INFINITY && dout[1] == INFINITY);
  }
  fixture_host_close(&host);
}

/* min(sqrt u, -1): where sqrt u is defined its range decides, but u = 1/2 - t leaves its domain. */
static void both_operands_of_a_minimum_must_exist(void **unused) {
  (void)unused;
  const uint32_t op[] = { AMBIT_OP_MIN, AMBIT_OP_MAX };
  for (size_t o = 0; o < 2; o++) {
    fixture_host host;
    fixture_host_open(&host);
    ambit_arithmetic full = fixture_arithmetic();
    fixture_tape *x = fixture_tape_open(&host);
    uint32_t minus = fixture_constant(x, -1, -1), plus = fixture_constant(x, 1, 1),
             u = fixture_input(x, AMBIT_DEGREE_ANY), root = fixture_op(x, AMBIT_OP_SQRT, u, u);
    if (op[o] == AMBIT_OP_MAX) root = fixture_op(x, AMBIT_OP_NEG, root, root);
    fixture_output(x, fixture_op(x, op[o], root, op[o] == AMBIT_OP_MIN ? minus : plus));
    ambit_jet *jet;
    assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 4, 1, NULL, &jet), AMBIT_OK);
    service->put(jet, 0, 0, 0.5, 0, NULL, NULL), service->put(jet, 0, 1, -1, 0, NULL, NULL);
    for (uint32_t k = 0; k <= 4; k++) assert_int_equal(service->advance(jet, k), 0);
    double in = 1e-3, tail, change;
    for (uint32_t K = 1; K <= 4; K += 3) {
      assert_int_equal(service->tail(jet, K, 10, &in, NULL, &tail, &change), AMBIT_OK);
      assert_true(tail == INFINITY && change == INFINITY);
      assert_int_equal(service->tail(jet, K, 0.1, &in, NULL, &tail, &change), AMBIT_OK);
      assert_true(tail == 0 && change == 0);
    }
    fixture_host_close(&host);
  }
}

/* t = 1/4 + 2 t beyond K = 0: its coefficient of order 1 is all tail. */
static void polynomials_above_the_order(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t t = fixture_input(x, 1);
  fixture_output(x, t), fixture_output(x, fixture_op(x, AMBIT_OP_SQR, t, t));
  ambit_jet *jet;
  double tail[2], change[2], one = 1, three = 3, none = 0, in = 0.5;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 2, 1, NULL, &jet), AMBIT_OK);
  service->put(jet, 0, 0, 0.25, 0, &one, &none), service->put(jet, 0, 1, 2, 0, &three, &none);
  assert_int_equal(service->advance(jet, 0), 0);
  assert_int_equal(service->tail(jet, 0, -0.5, NULL, NULL, tail, change), AMBIT_OK);
  assert_true(tail[0] == 1 && change[0] == 1.5);
  assert_true(tail[1] >= 1.5 * 1 && tail[1] < 1.51); /* (1/4 + s)^2 - 1/16 = s/2 + s^2 */
  assert_int_equal(service->tail(jet, 0, 0.5, &in, NULL, tail, change), AMBIT_OK);
  assert_true(tail[0] == 1.5); /* beside what the caller knows */
  service->put(jet, 0, 1, -4, 0, NULL, NULL);
  assert_int_equal(service->tail(jet, 0, 0.5, NULL, NULL, tail, change), AMBIT_OK);
  assert_true(tail[0] == 2 && change[0] == 0); /* the new coefficient counts */
  assert_int_equal(service->advance(jet, 1), 0);
  assert_int_equal(service->tail(jet, 1, 0.5, NULL, NULL, tail, NULL), AMBIT_OK);
  assert_true(tail[0] == 0 && tail[1] == 4);
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, 0, 1, NULL, &jet), AMBIT_OK);
  service->put(jet, 0, 0, 0.25, 0, NULL, NULL), service->put(jet, 0, 1, 2, 0, NULL, NULL);
  assert_int_equal(service->advance(jet, 0), 0);
  assert_int_equal(service->tail(jet, 0, 0.5, NULL, NULL, tail, change), AMBIT_OK);
  assert_true(tail[0] == INFINITY && change[0] == INFINITY); /* order 1 could not be kept */
  fixture_host_close(&host);
}

/* -- an arithmetic that cannot bound everything it computes, and says so without a flag */

static uint32_t blind_slot;

static void blind_magnitude(const void *self, uint32_t slot, uint32_t n, double *mag, double *dmag) {
  ambit_jets_general.magnitude(self, slot, n, mag, dmag);
  for (uint32_t k = 2; k < n && slot == blind_slot; k++) mag[k] = INFINITY;
}

static void blind_get(
    const void *self, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  ambit_jets_general.get(self, slot, k, mid, rad, dmid, drad);
  if (slot == blind_slot) *mid = INFINITY, *rad = 0;
}

/* tail of op(u), u = start + t/10 + 0 t^2, with jets that are blind for one slot: op's operand or its helper */
static double blind_tail(uint32_t op, double start, ambit_jets jets, bool operand) {
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic(), blind = full;
  ambit_jet_source source = { &full, NULL };
  blind.jets = &jets;
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY), y = fixture_function(x, op, u, u, 0);
  fixture_output(x, y);
  blind_slot = operand ? u : x->aux[0];
  ambit_jet *jet;
  assert_int_equal(service->open(&host.host, &x->tape, &blind, &source, 2, 0, NULL, &jet), AMBIT_OK);
  service->put(jet, 0, 0, start, 0, NULL, NULL), service->put(jet, 0, 1, 0.1, 0, NULL, NULL);
  for (uint32_t k = 0; k <= 2; k++) assert_int_equal(service->advance(jet, k), 0);
  double tail;
  assert_int_equal(service->tail(jet, 2, 1, NULL, NULL, &tail, NULL), AMBIT_OK);
  fixture_host_close(&host);
  return tail;
}

static void infinite_bounds_claim_nothing(void **unused) {
  (void)unused;
  ambit_jets large = ambit_jets_general, far = ambit_jets_general;
  large.magnitude = blind_magnitude, far.get = blind_get;
  assert_true(blind_tail(AMBIT_OP_SINH, 0, ambit_jets_general, false) < 1e-3);
  assert_true(blind_tail(AMBIT_OP_SINH, 0, large, false) == INFINITY); /* the defect is 0 times infinity */
  assert_true(blind_tail(AMBIT_OP_COSH, 0, large, false) == INFINITY);
  assert_true(blind_tail(AMBIT_OP_LOG, 1, ambit_jets_general, true) < 1e-2);
  assert_true(blind_tail(AMBIT_OP_LOG, 1, far, true) == INFINITY); /* a point at infinity is not far from 0 */
}

/* -- sizes beyond the memory that there can be */

static int allocations;

static void *count_alloc(const ambit_host *h, size_t bytes) {
  allocations++;
  return bytes < 4096 ? fixture_alloc(h, bytes) : NULL;
}

static void sizes_are_checked_before_memory_is_asked_for(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  host.host.alloc = count_alloc;
  fixture_tape *x = fixture_tape_open(&host);
  x->tape.nslot = UINT32_MAX;
  ambit_tails *tails;
  const uint32_t order[] = { UINT32_MAX / 4, UINT32_MAX / 8, 3 }, ndir[] = { 0, 1, UINT32_MAX };
  for (size_t i = 0; i < 3; i++) {
    allocations = 0;
    assert_int_equal(ambit_tails_open(&host.host, &x->tape, order[i], ndir[i], &tails), AMBIT_NOMEM);
    assert_int_equal(allocations, 1); /* the object itself */
  }
  fixture_host_close(&host);
}

/* Picard's inclusion: x' = x^2, x = 1/(1 - t): the step's remainder holds the solution. */
static void picard(void **unused) {
  (void)unused;
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  fixture_tape *x = fixture_tape_open(&host);
  uint32_t u = fixture_input(x, AMBIT_DEGREE_ANY);
  fixture_output(x, fixture_op(x, AMBIT_OP_SQR, u, u));
  ambit_jet *jet;
  const uint32_t order = 10, K = order - 1;
  assert_int_equal(service->open(&host.host, &x->tape, &full, NULL, order, 0, NULL, &jet), AMBIT_OK);
  service->put(jet, 0, 0, 1, 0, NULL, NULL);
  assert_int_equal(service->solve(jet, 1, order), 0);
  for (double h = -0.25; h <= 0.25; h += 0.125) {
    double top = pow(fabs(h), order) * (1 + 1e-14), eps = 0, tail, in;
    for (int i = 0; i < 60; i++) {
      in = top + eps;
      assert_int_equal(service->tail(jet, K, h, &in, NULL, &tail, NULL), AMBIT_OK);
      if (fabs(h) * tail / (order + 1) <= eps) break;
      eps = 2 * fabs(h) * tail / (order + 1);
    }
    double rest = fabs(h) * tail / (order + 1), sum = 0;
    assert_true(rest <= eps);
    for (uint32_t k = order + 1; k-- > 0;) sum = sum * h + 1;
    double truth = 1 / (1 - h) - sum;
    assert_true(fabs(truth) <= rest + 1e-15 && (h == 0 || rest < 6 * fabs(truth) + 1e-15));
  }
  double far = 1; /* x blows up at 1: nothing may be proved there */
  assert_int_equal(service->tail(jet, K, 1, &far, NULL, &far, NULL), AMBIT_OK);
  assert_true(far / (order + 1) > 1);
  fixture_host_close(&host);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_operation),
    cmocka_unit_test(random_programs),
    cmocka_unit_test(edges),
    cmocka_unit_test(refusals),
    cmocka_unit_test(refusals_claim_nothing),
    cmocka_unit_test(both_operands_of_a_minimum_must_exist),
    cmocka_unit_test(polynomials_above_the_order),
    cmocka_unit_test(infinite_bounds_claim_nothing),
    cmocka_unit_test(sizes_are_checked_before_memory_is_asked_for),
    cmocka_unit_test(picard),
  };
  return cmocka_run_group_tests_name("tail", tests, NULL, NULL);
}
