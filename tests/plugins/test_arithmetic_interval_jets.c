/* The interval plugin's own Taylor series against 300-bit series: values, slopes and derivatives over random tapes,
** and tightness. */
#include "kit/arithmetic_loader.h"
#include "kit/series_oracle.h"
#include "kit/tape_builder.h"
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define NIN 3
#define NDIR_MAX 7
#define ORDER_MAX 14

static arithmetic_loader loader;

static int load_as(const char *interface_id) {
  const char *problem = arithmetic_load_as(&loader, "interval", interface_id);
  if (problem) print_error("%s\n", problem);
  return problem != NULL;
}

static int load(void **state) { return (void)state, load_as(AMBIT_ARITHMETIC); }
static int load_portable(void **state) { return (void)state, load_as("ambit.arithmetic.portable/1"); }

static int unload(void **state) {
  (void)state;
  arithmetic_unload(&loader);
  return 0;
}

/* A random tape over three states, time and a parameter whose values stay where all functions are defined. */
static const ambit_tape *random_tape(tape_builder *t, uint64_t *state) {
  static const uint32_t any[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_NEG, AMBIT_OP_MUL, AMBIT_OP_MUL, AMBIT_OP_SQR,
    AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_ATAN, AMBIT_OP_TANH };
  tape_begin(t);
  uint32_t one = tape_constant(t, 1, 1), four = tape_constant(t, 4, 4),
           third = tape_constant(t, 1.0 / 3, nextafter(1.0 / 3, 1));
  for (int i = 0; i < NIN; i++) tape_input(t, AMBIT_DEGREE_ANY);
  tape_input(t, 1), tape_input(t, 0);
  for (int i = 0; i < 10; i++) {
    uint32_t a = (uint32_t)(oracle_random(state) % t->tape.nslot), b = (uint32_t)(oracle_random(state) % t->tape.nslot);
    uint32_t op = any[oracle_random(state) % (sizeof any / sizeof *any)];
    if (op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL)
      b = tape_op(t, op, a, b);
    else
      b = tape_unary(t, op, a);
    uint32_t tame = tape_op(t, AMBIT_OP_MUL, tape_unary(t, AMBIT_OP_SIN, b), third); /* within 1/3 */
    uint32_t positive = tape_op(t, AMBIT_OP_ADD, tame, one);
    switch (oracle_random(state) % 8) {
    case 0: tape_op(t, AMBIT_OP_DIV, a, positive); break;
    case 1: tape_unary(t, AMBIT_OP_SQRT, positive); break;
    case 2: tape_unary(t, AMBIT_OP_LOG, positive); break;
    case 3: tape_op(t, AMBIT_OP_ATAN2, tame, positive); break;
    case 4: tape_unary(t, AMBIT_OP_EXP, tame), tape_unary(t, AMBIT_OP_SINH, tame); break;
    case 5:
      tape_unary(t, AMBIT_OP_ABS, tape_unary(t, AMBIT_OP_NEG, positive)), tape_unary(t, AMBIT_OP_COSH, tame);
      break;
    case 6: tape_op(t, AMBIT_OP_MIN, positive, four), tape_op(t, AMBIT_OP_MAX, tame, four); break;
    default:
      tape_op(t, AMBIT_OP_DIV, tape_op(t, AMBIT_OP_ATAN2, positive, tame), tape_unary(t, AMBIT_OP_NEG, positive));
      break;
    }
    if (t->tape.nslot > TAPE_ROOM / 3) break; /* sealing adds helpers */
  }
  return tape_seal(t, one);
}

/* One curve of a family: input coefficient k of x is centre + sum_d slope_d * delta_d. */
typedef struct family {
  uint32_t order, ndir;
  double radius; /* of the box, in each direction */
  double centre[8][ORDER_MAX + 1], slope[8][ORDER_MAX + 1][NDIR_MAX], slope_rad;
  double delta[NDIR_MAX];
  double width[8][ORDER_MAX + 1]; /* radius of the input over the box */
} family;

static void random_family(family *f, const ambit_tape *t, uint64_t *state) {
  static const double extreme[] = { -1, 1 };
  for (uint32_t d = 0; d < f->ndir; d++)
    f->delta[d] =
        f->radius * (oracle_random(state) % 4 ? extreme[oracle_random(state) % 2] : oracle_uniform(state, -1, 1));
  for (uint32_t i = 0; i < t->nin; i++)
    for (uint32_t k = 0; k <= f->order; k++) {
      int vanishes = k > t->degree[t->nconst + i];
      f->centre[i][k] = vanishes ? 0 : oracle_uniform(state, -1, 1);
      f->width[i][k] = 0;
      for (uint32_t d = 0; d < f->ndir; d++) {
        f->slope[i][k][d] = vanishes || oracle_random(state) % 3 == 0 ? 0 : oracle_uniform(state, -1, 1);
        f->width[i][k] += vanishes ? 0 : (fabs(f->slope[i][k][d]) + f->slope_rad) * f->radius * (1 + 0x1p-40);
      }
    }
}

static void put(void *jets, const family *f, const ambit_tape *t, uint32_t k, int box) {
  double spread[NDIR_MAX];
  for (uint32_t d = 0; d < f->ndir; d++) spread[d] = f->slope_rad;
  for (uint32_t i = 0; i < t->nin; i++) {
    int vanishes = k > t->degree[t->nconst + i];
    loader.plugin->jets->put(jets, i, k, f->centre[i][k], box ? f->width[i][k] : 0,
        box && !vanishes ? f->slope[i][k] : NULL, box && !vanishes ? spread : NULL);
  }
}

/* the curve at the centre (scale 0) or at delta (scale 1), with slopes somewhere in their ranges */
static void run_oracle(series_oracle *s, const family *f, const ambit_tape *t, int scale, uint64_t *state) {
  for (uint32_t c = 0; c < t->nconst; c++) mpfr_set_d(*series_u(s, c, 0), t->lo[c], MPFR_RNDN);
  for (uint32_t i = 0; i < t->nin; i++)
    for (uint32_t k = 0; k <= f->order; k++) {
      mpfr_t *x = series_u(s, t->nconst + i, k);
      mpfr_set_d(*x, f->centre[i][k], MPFR_RNDN);
      for (uint32_t d = 0; scale && d < f->ndir && k <= t->degree[t->nconst + i]; d++) {
        mpfr_set_d(s->term, f->slope[i][k][d], MPFR_RNDN);
        mpfr_add_d(s->term, s->term, f->slope_rad * oracle_uniform(state, -1, 1), MPFR_RNDN);
        mpfr_mul_d(s->term, s->term, f->delta[d], MPFR_RNDN);
        mpfr_add(*x, *x, s->term, MPFR_RNDN);
      }
    }
  series_run(s);
}

static int inside(mpfr_t truth, double mid, double rad) {
  mpfr_t distance;
  mpfr_init2(distance, SERIES_BITS);
  mpfr_sub_d(distance, truth, mid, MPFR_RNDN);
  mpfr_abs(distance, distance, MPFR_RNDN);
  int yes = mpfr_cmp_d(distance, rad) <= 0 && !isnan(mid) && !isnan(rad);
  mpfr_clear(distance);
  return yes;
}

static void check_value(const void *jets, series_oracle *truth, const ambit_tape *t, uint32_t k) {
  for (uint32_t s = 0; s < t->nslot; s++) {
    double mid, rad;
    loader.plugin->jets->get(jets, s, k, &mid, &rad, NULL, NULL);
    if (!inside(*series_u(truth, s, k), mid, rad))
      fail_msg("slot %u (op %u) order %u: %a +- %a misses %a", s,
          s >= t->nconst + t->nin ? t->op[s - t->nconst - t->nin] : 99, k, mid, rad,
          mpfr_get_d(*series_u(truth, s, k), MPFR_RNDN));
  }
}

/* u(x) - u(c) - sum_d mid_d delta_d lies within sum_d rad_d |delta_d| */
static void check_slope(const void *jets, const family *f, series_oracle *x, series_oracle *c, uint32_t s, uint32_t k) {
  double mid, rad, dmid[NDIR_MAX], drad[NDIR_MAX], dmag[(ORDER_MAX + 1) * NDIR_MAX], mag[ORDER_MAX + 1];
  loader.plugin->jets->get(jets, s, k, &mid, &rad, dmid, drad);
  loader.plugin->jets->magnitude(jets, s, k + 1, mag, dmag);
  mpfr_t rest, room;
  mpfr_init2(rest, SERIES_BITS), mpfr_init2(room, SERIES_BITS);
  mpfr_sub(rest, *series_u(x, s, k), *series_u(c, s, k), MPFR_RNDN);
  mpfr_set_zero(room, 1);
  for (uint32_t d = 0; d < f->ndir; d++) {
    mpfr_set_d(x->term, dmid[d], MPFR_RNDN), mpfr_mul_d(x->term, x->term, f->delta[d], MPFR_RNDN);
    mpfr_sub(rest, rest, x->term, MPFR_RNDN);
    mpfr_set_d(x->term, drad[d], MPFR_RNDN), mpfr_mul_d(x->term, x->term, fabs(f->delta[d]), MPFR_RNDN);
    mpfr_add(room, room, x->term, MPFR_RNDN);
    assert_true(dmag[k * f->ndir + d] >= fabs(dmid[d]) && dmag[k * f->ndir + d] >= drad[d]);
  }
  assert_true(mag[k] >= fabs(mid) && mag[k] >= rad);
  mpfr_mul_2si(x->term, room, -200, MPFR_RNDN),
      mpfr_add(room, room, x->term, MPFR_RNDN); /* the oracle's own rounding */
  if (mpfr_cmpabs(rest, room) > 0)
    fail_msg("slope of slot %u order %u: off by %g, allowed %g", s, k, mpfr_get_d(rest, MPFR_RNDN),
        mpfr_get_d(room, MPFR_RNDN));
  mpfr_clear(rest), mpfr_clear(room);
}

typedef struct twin { /* series at the centre and over the box, and the truth at both points */
  void *centre, *box;
  ambit_scope *scope;
  series_oracle at_centre, at_point;
} twin;

static void twin_open(twin *w, const ambit_tape *t, const family *f, int slopes) {
  const ambit_jets *jets = loader.plugin->jets;
  assert_int_equal(ambit_scope_open(&w->scope, NULL, NULL), AMBIT_OK);
  assert_int_equal(jets->open(&w->scope->host, loader.ctx, t, f->order, 0, NULL, &w->centre), AMBIT_OK);
  assert_int_equal(
      jets->open(&w->scope->host, loader.ctx, t, f->order, f->ndir, slopes ? w->centre : NULL, &w->box), AMBIT_OK);
  series_open(&w->at_centre, t, f->order), series_open(&w->at_point, t, f->order);
}

static void twin_close(twin *w) {
  loader.plugin->jets->close(w->centre), loader.plugin->jets->close(w->box);
  series_close(&w->at_centre), series_close(&w->at_point);
  ambit_scope_close(w->scope);
}

static uint32_t advance(twin *w, const family *f, const ambit_tape *t) {
  uint32_t flags = 0;
  for (uint32_t k = 0; k <= f->order; k++) {
    put(w->centre, f, t, k, 0), put(w->box, f, t, k, 1);
    flags |= loader.plugin->jets->advance(w->centre, k);
    flags |= loader.plugin->jets->advance(w->box, k);
  }
  return flags;
}

static void random_tapes(int slopes, uint64_t seed) {
  static tape_builder builder;
  static family f;
  uint64_t state = seed;
  int useful = 0, rounds = 150;
  for (int i = 0; i < rounds; i++) {
    const ambit_tape *t = random_tape(&builder, &state);
    f = (family) { .order = (uint32_t)(oracle_random(&state) % ORDER_MAX) + 1,
      .ndir = (uint32_t)(oracle_random(&state) % NDIR_MAX) + 1,
      .radius = ldexp(1, -(int)(oracle_random(&state) % 40) - 3),
      .slope_rad = oracle_random(&state) % 2 ? 0 : 0x1p-20 };
    twin w;
    twin_open(&w, t, &f, slopes);
    for (int again = 0; again < 3; again++) { /* the same objects, new series */
      random_family(&f, t, &state);
      uint32_t flags = advance(&w, &f, t);
      run_oracle(&w.at_centre, &f, t, 0, &state), run_oracle(&w.at_point, &f, t, 1, &state);
      for (uint32_t k = 0; k <= f.order; k++) {
        check_value(w.centre, &w.at_centre, t, k), check_value(w.box, &w.at_centre, t, k);
        check_value(w.box, &w.at_point, t, k);
        for (uint32_t s = 0; s < t->nslot; s++) check_slope(w.box, &f, &w.at_point, &w.at_centre, s, k);
      }
      useful += flags == 0;
    }
    twin_close(&w);
  }
  assert_true(useful > 2 * rounds); /* of 3 per round; the rest were too wide, and said so */
}

static void slopes_hold_over_random_tapes(void **state) {
  (void)state;
  random_tapes(1, 11);
}

static void derivatives_hold_over_random_tapes(void **state) {
  (void)state;
  random_tapes(0, 12);
}

/* -- single rules */

typedef struct single { /* y = op(x, x2) and its series; x and x2 are inputs 0 and 1 */
  tape_builder builder;
  const ambit_tape *tape;
  uint32_t slot;
  ambit_scope *scope;
  void *jets;
} single;

static void single_open(single *s, uint32_t op, uint32_t order) {
  tape_begin(&s->builder);
  uint32_t one = tape_constant(&s->builder, 1, 1);
  uint32_t x = tape_input(&s->builder, AMBIT_DEGREE_ANY), y = tape_input(&s->builder, AMBIT_DEGREE_ANY);
  tape_input(&s->builder, 1);
  int binary = op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 || op == AMBIT_OP_MIN;
  s->slot = tape_op(&s->builder, op, x, binary ? y : x);
  s->tape = tape_seal(&s->builder, one);
  assert_int_equal(ambit_scope_open(&s->scope, NULL, NULL), AMBIT_OK);
  assert_int_equal(loader.plugin->jets->open(&s->scope->host, loader.ctx, s->tape, order, 1, NULL, &s->jets), AMBIT_OK);
}

static void single_close(single *s) {
  loader.plugin->jets->close(s->jets);
  ambit_scope_close(s->scope);
}

static void single_put(single *s, uint32_t k, double x, double xr, double y, double yr) {
  const double slope = 1, none = 0;
  loader.plugin->jets->put(s->jets, 0, k, x, xr, k ? NULL : &slope, k ? NULL : &none);
  loader.plugin->jets->put(s->jets, 1, k, y, yr, NULL, NULL);
  loader.plugin->jets->put(s->jets, 2, k, k == 1, 0, NULL, NULL);
}

/* from `from` on nothing is known; before, everything is */
static void assert_lost(single *s, uint32_t from, uint32_t order) {
  for (uint32_t k = 0; k <= order; k++) {
    double mid, rad, dmid, drad, mag[8], dmag[8];
    loader.plugin->jets->get(s->jets, s->slot, k, &mid, &rad, &dmid, &drad);
    loader.plugin->jets->magnitude(s->jets, s->slot, k + 1, mag, dmag);
    if (k >= from)
      assert_true(mid == 0 && rad == INFINITY && dmid == 0 && drad == INFINITY);
    else
      assert_true(isfinite(mid) && isfinite(rad) && isfinite(dmid) && isfinite(drad));
    assert_true((mag[k] == INFINITY) == (k >= from) && (dmag[k] == INFINITY) == (k >= from));
  }
}

static void what_cannot_be_bounded_is_said(void **state) {
  (void)state;
  const uint32_t P = AMBIT_F_PARTIAL, U = AMBIT_F_UNBOUNDED;
  static const double any = 0.25;
  const struct {
    uint32_t op;
    double x, xr, y, yr;
    uint32_t from, flags; /* first order that is lost, flags that must be among those returned */
  } cases[] = {
    { AMBIT_OP_DIV, 1, 0, 0, 0.5, 0, P | U },
    { AMBIT_OP_DIV, 1, 0, 0, 0, 0, P | U },
    { AMBIT_OP_SQRT, 0.1, 0.2, 0, 0, 0, P },
    { AMBIT_OP_SQRT, 0, 0, 0, 0, 0, U },
    { AMBIT_OP_LOG, 0, 0, 0, 0, 0, P },
    { AMBIT_OP_LOG, 1, 2, 0, 0, 0, P },
    { AMBIT_OP_ABS, 0.1, 0.2, 0, 0, 0, U },
    { AMBIT_OP_ABS, 0, 0, 0, 0, 0, U },
    { AMBIT_OP_MIN, 1, 0.5, 1.5, 0.5, 0, U },
    { AMBIT_OP_ATAN2, 0, 1, -1, 0, 0, U },
    { AMBIT_OP_ATAN2, 0, 0, -1, 0, 0, U },
    { AMBIT_OP_ATAN2, 0, 0, 0, 0, 0, P },
    { AMBIT_OP_EXP, 1000, 0, 0, 0, 0, U },
    { AMBIT_OP_MUL, 1e200, 0, 1e200, 0, 0, U },
    { AMBIT_OP_MUL, 1, INFINITY, 1, 0, 0, U },
    { AMBIT_OP_MUL, NAN, 0, 1, 0, 0, U },
    { AMBIT_OP_MUL, 1, NAN, 1, 0, 0, U },
    { AMBIT_OP_MUL, 1, -1, 1, 0, 0, U },
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    single s;
    single_open(&s, cases[i].op, 4);
    single_put(&s, 0, cases[i].x, cases[i].xr, cases[i].y, cases[i].yr);
    uint32_t flags = loader.plugin->jets->advance(s.jets, 0);
    if ((flags & cases[i].flags) != cases[i].flags)
      fail_msg("case %zu: flags %u lack some of %u", i, flags, cases[i].flags);
    for (uint32_t k = 1; k <= 4; k++) {
      single_put(&s, k, any, 0, any, 0);
      assert_int_equal(loader.plugin->jets->advance(s.jets, k), flags);
    }
    assert_lost(&s, cases[i].from, 4);
    single_close(&s);
  }
}

static void later_orders_can_be_lost(void **state) {
  (void)state;
  single s;
  single_open(&s, AMBIT_OP_MUL, 4);
  single_put(&s, 0, 1, 0, 1, 0);
  assert_int_equal(loader.plugin->jets->advance(s.jets, 0), 0);
  single_put(&s, 1, 1e160, 0, 1e160, 0);
  assert_int_equal(loader.plugin->jets->advance(s.jets, 1), 0);
  single_put(&s, 2, 0, 0, 0, 0); /* 1e320 */
  assert_int_equal(loader.plugin->jets->advance(s.jets, 2), AMBIT_F_UNBOUNDED);
  assert_lost(&s, 2, 4);
  loader.plugin->jets->put(s.jets, 2, 3, 1, 0, NULL, NULL); /* time has no coefficient 3 */
  single_put(&s, 0, 1, 0, 1, 0);
  assert_int_equal(loader.plugin->jets->advance(s.jets, 0), 0);
  single_put(&s, 1, 0, 0, 0, 0), single_put(&s, 2, 0, 0, 0, 0);
  assert_int_equal(loader.plugin->jets->advance(s.jets, 1), 0);
  assert_int_equal(loader.plugin->jets->advance(s.jets, 2), 0);
  assert_int_equal(loader.plugin->jets->advance(s.jets, 3), AMBIT_F_UNBOUNDED);
  assert_lost(&s, 3, 4);
  single_close(&s);
}

/* A failed series leaves nothing behind: the next one is bit for bit that of a fresh object. */
static void failure_is_forgotten(void **state) {
  (void)state;
  single used, fresh;
  single_open(&used, AMBIT_OP_DIV, 4), single_open(&fresh, AMBIT_OP_DIV, 4);
  for (uint32_t k = 0; k <= 4; k++) single_put(&used, k, DBL_MAX, INFINITY, k ? DBL_MAX : 2, k ? INFINITY : 0);
  for (uint32_t k = 0; k <= 4; k++) assert_true(loader.plugin->jets->advance(used.jets, k) & AMBIT_F_UNBOUNDED);
  for (uint32_t k = 0; k <= 4; k++) {
    single_put(&used, k, 1.0 / (k + 3), 0x1p-30, 1.0 / (k + 2), 0),
        single_put(&fresh, k, 1.0 / (k + 3), 0x1p-30, 1.0 / (k + 2), 0);
    assert_int_equal(loader.plugin->jets->advance(used.jets, k), 0);
    assert_int_equal(loader.plugin->jets->advance(fresh.jets, k), 0);
    double a[4], b[4];
    loader.plugin->jets->get(used.jets, used.slot, k, &a[0], &a[1], &a[2], &a[3]);
    loader.plugin->jets->get(fresh.jets, fresh.slot, k, &b[0], &b[1], &b[2], &b[3]);
    assert_memory_equal(a, b, sizeof a);
  }
  single_close(&used), single_close(&fresh);
}

static void a_lost_centre_is_no_centre(void **state) {
  (void)state;
  single s;
  void *box;
  single_open(&s, AMBIT_OP_EXP, 4);
  assert_int_equal(loader.plugin->jets->open(&s.scope->host, loader.ctx, s.tape, 4, 1, s.jets, &box), AMBIT_OK);
  single_put(&s, 0, 1000, 0, 0, 0);
  loader.plugin->jets->advance(s.jets, 0);
  loader.plugin->jets->put(box, 0, 0, 1, 0, NULL, NULL);
  assert_int_equal(loader.plugin->jets->advance(box, 0), AMBIT_F_UNBOUNDED);
  loader.plugin->jets->close(box);
  single_close(&s);
}

/* x' = x^2, x(0) = 1: all coefficients of 1 / (1 - t) are 1, and those of its derivative by x(0), 1 / (1 - t)^2, are
** k + 1. */
static void solves_a_riccati_equation(void **state) {
  (void)state;
  single s;
  single_open(&s, AMBIT_OP_SQR, 30);
  single_put(&s, 0, 1, 0, 0, 0);
  loader.plugin->jets->put(s.jets, 2, 1, 1, 0, NULL, NULL);
  for (uint32_t k = 0; k <= 30; k++) {
    double mid, rad, dmid, drad;
    assert_int_equal(loader.plugin->jets->advance(s.jets, k), 0);
    loader.plugin->jets->get(s.jets, s.tape->nconst, k, &mid, &rad, &dmid, &drad);
    assert_true(fabs(mid - 1) <= rad && rad < 1e-13);
    assert_true(fabs(dmid - (k + 1)) <= drad && drad < 1e-12);
    if (k < 30) loader.plugin->jets->integrate(s.jets, 0, s.slot, k);
  }
  loader.plugin->jets->integrate(s.jets, 2, s.slot, 4); /* time is no integral: refused, in that it is unbounded */
  double mid, rad;
  loader.plugin->jets->get(s.jets, s.tape->nconst + 2, 5, &mid, &rad, NULL, NULL);
  assert_true(mid == 0 && rad == INFINITY);
  single_close(&s);
}

static void refuses_other_tapes(void **state) {
  (void)state;
  tape_builder t;
  ambit_scope *scope;
  void *jets;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  tape_begin(&t);
  uint32_t one = tape_constant(&t, 1, 1), x = tape_input(&t, AMBIT_DEGREE_ANY);
  tape_unary(&t, AMBIT_OP_TAN, x);
  const ambit_tape *plain = tape_seal(&t, AMBIT_NO_SLOT);
  assert_int_equal(loader.plugin->jets->open(&scope->host, loader.ctx, plain, 4, 0, NULL, &jets), AMBIT_INVALID);
  assert_non_null(strstr(scope->failure.message, "sealed for power series"));
  ambit_failure_clear(&scope->failure);
  const ambit_tape *tangent = tape_seal(&t, one);
  assert_int_equal(loader.plugin->jets->open(&scope->host, loader.ctx, tangent, 4, 0, NULL, &jets), AMBIT_INVALID);
  assert_non_null(strstr(scope->failure.message, "no rule"));
  ambit_scope_close(scope);
}

static void refuses_a_shorter_centre(void **state) {
  (void)state;
  single s;
  void *box;
  single_open(&s, AMBIT_OP_EXP, 4);
  assert_int_equal(loader.plugin->jets->open(&s.scope->host, loader.ctx, s.tape, 5, 1, s.jets, &box), AMBIT_INVALID);
  assert_non_null(strstr(s.scope->failure.message, "centre"));
  single_close(&s);
}

/* A kink of constants is harmless: |p| for p in [-1/4, 3/4] about 1/4, min(p, q) for q = p + 1/8. */
static void kinks_of_constants_are_kept(void **state) {
  (void)state;
  tape_builder t;
  ambit_scope *scope;
  void *centre, *box;
  const ambit_jets *j = loader.plugin->jets;
  tape_begin(&t);
  uint32_t one = tape_constant(&t, 1, 1), p = tape_input(&t, 0), q = tape_input(&t, 0);
  uint32_t size = tape_unary(&t, AMBIT_OP_ABS, p), least = tape_op(&t, AMBIT_OP_MIN, p, q);
  const ambit_tape *tape = tape_seal(&t, one);
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  assert_int_equal(j->open(&scope->host, loader.ctx, tape, 1, 0, NULL, &centre), AMBIT_OK);
  assert_int_equal(j->open(&scope->host, loader.ctx, tape, 1, 1, centre, &box), AMBIT_OK);
  const double slope_p = 1, slope_q = 0.5, none = 0;
  j->put(centre, 0, 0, 0.25, 0, NULL, NULL), j->put(centre, 1, 0, 0.375, 0, NULL, NULL);
  j->put(box, 0, 0, 0.25, 0.5, &slope_p, &none), j->put(box, 1, 0, 0.375, 0.5, &slope_q, &none);
  assert_int_equal(j->advance(centre, 0) | j->advance(box, 0), 0);
  double mid, rad, dmid, drad;
  j->get(box, size, 0, &mid, &rad, &dmid, &drad);
  assert_true(mid - rad == 0 && mid + rad == 0.75 && dmid == 0 && drad == 1);
  j->get(box, least, 0, &mid, &rad, &dmid, &drad);
  assert_true(mid - rad == -0.25 && mid + rad == 0.75 && dmid == 0.75 && drad == 0.25);
  j->close(centre), j->close(box);
  ambit_scope_close(scope);
}

static void put_point(void *jets, uint32_t k, double x, double slope) {
  const double none = 0;
  loader.plugin->jets->put(jets, 0, k, x, 0, &slope, &none);
}

static void assert_holds(const void *jets, uint32_t slot, uint32_t k, long double value, long double slope) {
  double mid, rad, dmid, drad;
  loader.plugin->jets->get(jets, slot, k, &mid, &rad, &dmid, &drad);
  if (!(fabsl(value - mid) <= rad)) fail_msg("%La is not within %a +- %a", value, mid, rad);
  if (!(fabsl(slope - dmid) <= drad)) fail_msg("slope %La is not within %a +- %a", slope, dmid, drad);
}

/* The rows k u_k and (u(X) + u(c)) / 2 are rounded themselves. Points for which everything else is exact show it:
** with u = v t^3, exp(u) has coefficient 3 v; and the square's slope between the points x and c is x + c. */
static void copies_are_rounded_outward(void **state) {
  (void)state;
  uint64_t random = 21;
  single exponential, square;
  void *exponential_box, *square_box;
  single_open(&exponential, AMBIT_OP_EXP, 3), single_open(&square, AMBIT_OP_SQR, 0);
  const ambit_jets *j = loader.plugin->jets;
  assert_int_equal(
      j->open(&exponential.scope->host, loader.ctx, exponential.tape, 3, 1, exponential.jets, &exponential_box), 0);
  assert_int_equal(j->open(&square.scope->host, loader.ctx, square.tape, 0, 1, square.jets, &square_box), 0);
  for (int i = 0; i < 3000; i++) {
    double v = oracle_uniform(&random, 1, 2), w = oracle_uniform(&random, 1, 2), d = oracle_uniform(&random, 1, 2);
    for (uint32_t k = 0; k <= 3; k++) {
      put_point(exponential.jets, k, k == 3 ? v : 0, k == 3 ? d : 0);
      put_point(exponential_box, k, k == 3 ? w : 0, k == 0);
      j->advance(exponential.jets, k), j->advance(exponential_box, k);
    }
    assert_holds(exponential.jets, exponential.slot, 3, v, d);
    assert_holds(exponential_box, exponential.slot, 3, w, ((long double)v + w) / 2);
    put_point(square.jets, 0, v, 0), put_point(square_box, 0, w, 1);
    j->advance(square.jets, 0), j->advance(square_box, 0);
    assert_holds(square_box, square.slot, 0, (long double)w * w, (long double)v + w);
  }
  j->close(exponential_box), j->close(square_box);
  single_close(&exponential), single_close(&square);
}

/* thin operands stay thin: a relative radius of a few units in the last place for each order */
static void points_stay_thin(void **state) {
  (void)state;
  static const uint32_t op[] = { AMBIT_OP_MUL, AMBIT_OP_SQR, AMBIT_OP_DIV, AMBIT_OP_SQRT, AMBIT_OP_EXP, AMBIT_OP_LOG,
    AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_ATAN, AMBIT_OP_ATAN2, AMBIT_OP_SINH, AMBIT_OP_COSH, AMBIT_OP_TANH };
  for (size_t i = 0; i < sizeof op / sizeof *op; i++) {
    single s;
    single_open(&s, op[i], 4);
    for (uint32_t k = 0; k <= 4; k++) {
      double mid, rad;
      single_put(&s, k, ldexp(0.7, -(int)k), 0, ldexp(1.3, -(int)k), 0);
      assert_int_equal(loader.plugin->jets->advance(s.jets, k), 0);
      loader.plugin->jets->get(s.jets, s.slot, k, &mid, &rad, NULL, NULL);
      if (rad > 1e-15) fail_msg("op %u order %u: %g +- %g", op[i], k, mid, rad);
    }
    single_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(slopes_hold_over_random_tapes),
    cmocka_unit_test(derivatives_hold_over_random_tapes),
    cmocka_unit_test(what_cannot_be_bounded_is_said),
    cmocka_unit_test(later_orders_can_be_lost),
    cmocka_unit_test(failure_is_forgotten),
    cmocka_unit_test(a_lost_centre_is_no_centre),
    cmocka_unit_test(solves_a_riccati_equation),
    cmocka_unit_test(refuses_other_tapes),
    cmocka_unit_test(refuses_a_shorter_centre),
    cmocka_unit_test(kinks_of_constants_are_kept),
    cmocka_unit_test(copies_are_rounded_outward),
    cmocka_unit_test(points_stay_thin),
  };
  int failed = cmocka_run_group_tests_name("interval jets", tests, load, unload);
  return failed + cmocka_run_group_tests_name("interval jets, portable", tests, load_portable, unload);
}
