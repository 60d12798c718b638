/* Dimensions: fractional powers and units against MPFR, texts that read back, rules of operations. */
#include "graph/hull.h"
#include "graph/tape.h"
#include "models/unit.h"
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

static ambit_unit read(const char *text) {
  ambit_unit unit;
  ambit_failure f = { 0 };
  if (ambit_unit_read(text, &unit, &f) != AMBIT_OK) fail_msg("%s: %s", text, f.message);
  return unit;
}

static ambit_dimension of(const char *text) { return ambit_dimension_known(read(text).power); }

/* base^(p/q) of a text "1 unit", to 1e-15 of it and enclosed. */
static void check(const char *text, const char *wanted, const char *base, unsigned long p, unsigned long q) {
  ambit_failure f = { 0 };
  ambit_graph *g = ambit_graph_open();
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  ambit_expr e;
  ambit_interval slot[16];
  if (ambit_unit_quantity(g, text, wanted, &e, &f) != AMBIT_OK) fail_msg("%s: %s", text, f.message);
  assert_int_equal(ambit_tape_seal(g, arena, 1, &e, 0, NULL, 0, 0, &tape, &f), AMBIT_OK);
  assert_true(tape->nslot <= 16);
  ambit_hull(tape, NULL, slot);
  ambit_interval x = slot[tape->out[0]];
  mpfr_t v, w;
  mpfr_init2(v, 300), mpfr_init2(w, 300);
  mpfr_set_str(v, base, 10, MPFR_RNDN);
  mpfr_set_ui(w, p, MPFR_RNDN);
  mpfr_div_ui(w, w, q, MPFR_RNDN);
  mpfr_pow(v, v, w, MPFR_RNDN);
  double down = mpfr_get_d(v, MPFR_RNDD), up = mpfr_get_d(v, MPFR_RNDU);
  mpfr_clear(v), mpfr_clear(w);
  if (!(x.lo <= down && up <= x.hi && x.hi - x.lo <= 4e-15 * up)) fail_msg("%s: [%.17g, %.17g]", text, x.lo, x.hi);
  ambit_arena_close(arena);
  ambit_graph_close(g);
}

static void fractional_powers(void **state) {
  (void)state;
  check("1 N/m^1.5", "N/m^(3/2)", "1", 1, 1);
  check("1 mm^-1.5", "m^-1.5", "1000", 3, 2);
  check("1 km^0.5", "m^0.5", "1000", 1, 2);
  check("1 kN/mm^1.5", "N/m^1.5", "100000", 3, 2);
  check("1 km^(1/3)", "m^(1/3)", "1000", 1, 3);
  check("1 mm^0.5 mm^0.5 km", "m^2", "1", 1, 1);
  check("1 (km^0.5)^2", "m", "1000", 1, 1);
  check("1 (km^(1/3))^0.75", "m^0.25", "1000", 1, 4);
  check("1 ft^0.5/in^0.5", "1", "12", 1, 2);
  check("1 (deg/rev)^-0.5", "1", "360", 1, 2);
  assert_memory_equal(read("m^0.5").power, read("(m^(1/4))^2").power, sizeof read("m").power);
  assert_memory_equal(read("Pa^1.5 m^3").power, read("N^(3/2)").power, sizeof read("m").power);
}

static void bad_powers_are_named(void **state) {
  (void)state;
  static const char *const bad[][2] = { { "m^0.123", "after ^" }, { "m^(1/7)", "after ^" }, { "m^(1/0)", "after ^" },
    { "m^(1/3", "after ^" }, { "m^9.5", "after ^" }, { "m^.5", "after ^" }, { "m^--1", "after ^" },
    { "(m^(1/60))^0.5", "too fine" }, { "km^0.5 kg^0.5 mm^0.5 in^0.5 ft^0.5 lb^0.5 deg^0.5", "too large" } };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ambit_unit unit;
    ambit_failure f = { 0 };
    assert_int_equal(ambit_unit_read(bad[i][0], &unit, &f), AMBIT_INVALID);
    if (!strstr(f.message, bad[i][1])) fail_msg("%s: %s", bad[i][0], f.message);
  }
}

static void texts_read_back(void **state) {
  (void)state;
  static const char *const unit[] = { "1", "m", "N", "N/m^1.5", "m^0.5", "m^(1/3)/s^(2/3)", "kg*m^2/s^3/A", "1/s",
    "m^0.05", "m^(1/60)", "mol/cd^9", "K^-0.25" };
  for (size_t i = 0; i < sizeof unit / sizeof *unit; i++) {
    char text[AMBIT_DIMENSION_TEXT_MAX];
    ambit_dimension d = of(unit[i]);
    ambit_dimension_text(d.power, text);
    if (!ambit_dimension_agree(of(text), d)) fail_msg("%s: %s", unit[i], text);
  }
}

static void names(void **state) {
  (void)state;
  static const char *const pair[][2] = { { "N", "a force (N)" }, { "mm", "a length (m)" },
    { "J", "a torque or energy" }, { "deg", "a number or angle (rad)" }, { "N/m^1.5", "a value in kg/m^0.5/s^2" },
    { "mol", "a value in mol" }, { "uF", "a capacitance (F)" }, { "mWb", "a magnetic flux (Wb)" },
    { "mS", "a conductance (S)" }, { "T", "a magnetic flux density (T)" }, { "rpm", "angular speed (rad/s)" },
    { "m^(1/3)", "m^(1/3)" } };
  for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
    char text[AMBIT_DIMENSION_TEXT_MAX];
    ambit_dimension_name(of(pair[i][0]).power, text);
    if (!strstr(text, pair[i][1])) fail_msg("%s: %s", pair[i][0], text);
  }
}

static ambit_dimension result(uint32_t op, ambit_dimension a, ambit_dimension b) {
  ambit_dimension out;
  assert_true(ambit_dimension_op(op, a, b, &out));
  return out;
}

static bool fits(uint32_t op, ambit_dimension a, ambit_dimension b) {
  ambit_dimension out;
  return ambit_dimension_op(op, a, b, &out);
}

static void assert_is(ambit_dimension d, int state, const char *unit) {
  assert_int_equal(d.state, state);
  assert_memory_equal(d.power, of(unit).power, sizeof d.power);
}

/* A number beside a state may be a coefficient: -100 * x is an acceleration. So may one beside what states are in. */
static void coefficients_of_states(void **state) {
  (void)state;
  ambit_dimension bare = { .state = AMBIT_DIMENSION_BARE }, m = of("m"), s = of("m"), angle = of("rad");
  s.of_state = angle.of_state = true;
  const ambit_dimension made[] = { s, result(AMBIT_OP_ADD, m, s), result(AMBIT_OP_SUB, s, bare),
    result(AMBIT_OP_MUL, s, m), result(AMBIT_OP_DIV, m, s), result(AMBIT_OP_SQRT, s, s),
    result(AMBIT_OP_SIN, angle, angle), result(AMBIT_OP_ATAN2, s, m), ambit_dimension_power(s, 2 * AMBIT_POWER_ONE) };
  for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
    assert_int_equal(made[i].state, AMBIT_DIMENSION_KNOWN);
    assert_is(result(AMBIT_OP_MUL, bare, made[i]), AMBIT_DIMENSION_OPEN, "1");
    assert_is(result(AMBIT_OP_DIV, made[i], bare), AMBIT_DIMENSION_OPEN, "1");
  }
  assert_false(fits(AMBIT_OP_ADD, s, of("kg")));
}

static void rules(void **state) {
  (void)state;
  ambit_dimension bare = { .state = AMBIT_DIMENSION_BARE }, open = { .state = AMBIT_DIMENSION_OPEN };
  ambit_dimension m = of("m"), kg = of("kg"), angle = of("rad"), soft = of("m"), pi = of("1");
  soft.state = pi.state = AMBIT_DIMENSION_SOFT;
  soft.of_state = true;
  static const uint32_t sums[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_MIN, AMBIT_OP_MAX };
  for (size_t i = 0; i < sizeof sums / sizeof *sums; i++) {
    assert_false(fits(sums[i], m, kg));
    assert_is(result(sums[i], m, m), AMBIT_DIMENSION_KNOWN, "m");
    assert_is(result(sums[i], bare, m), AMBIT_DIMENSION_KNOWN, "m");
    assert_is(result(sums[i], kg, soft), AMBIT_DIMENSION_KNOWN, "kg");
    assert_is(result(sums[i], open, m), AMBIT_DIMENSION_OPEN, "1");
    assert_is(result(sums[i], soft, bare), AMBIT_DIMENSION_SOFT, "m");
    assert_is(result(sums[i], pi, bare), AMBIT_DIMENSION_BARE, "1");
    assert_is(result(sums[i], pi, soft), AMBIT_DIMENSION_OPEN, "1");
  }
  assert_is(result(AMBIT_OP_MUL, m, kg), AMBIT_DIMENSION_KNOWN, "kg m");
  assert_is(result(AMBIT_OP_DIV, m, m), AMBIT_DIMENSION_KNOWN, "1");
  assert_is(result(AMBIT_OP_MUL, m, pi), AMBIT_DIMENSION_KNOWN, "m");
  assert_is(result(AMBIT_OP_MUL, soft, of("N/m")), AMBIT_DIMENSION_KNOWN, "N");
  assert_is(result(AMBIT_OP_MUL, soft, soft), AMBIT_DIMENSION_SOFT, "m^2");
  assert_is(result(AMBIT_OP_MUL, bare, m), AMBIT_DIMENSION_KNOWN, "m"); /* 2 * length is a length */
  assert_is(result(AMBIT_OP_DIV, m, bare), AMBIT_DIMENSION_KNOWN, "m");
  assert_is(result(AMBIT_OP_DIV, bare, m), AMBIT_DIMENSION_KNOWN, "1/m");
  assert_false(fits(AMBIT_OP_ADD, result(AMBIT_OP_MUL, bare, m), kg));
  assert_is(result(AMBIT_OP_MUL, bare, angle), AMBIT_DIMENSION_BARE, "1"); /* a radius times a cosine */
  assert_is(result(AMBIT_OP_DIV, bare, soft), AMBIT_DIMENSION_OPEN, "1");
  assert_is(result(AMBIT_OP_MUL, bare, pi), AMBIT_DIMENSION_BARE, "1");
  assert_is(result(AMBIT_OP_SQRT, m, m), AMBIT_DIMENSION_KNOWN, "m^0.5");
  assert_is(result(AMBIT_OP_SQR, m, m), AMBIT_DIMENSION_KNOWN, "m^2");
  assert_is(result(AMBIT_OP_ABS, m, m), AMBIT_DIMENSION_KNOWN, "m");
  assert_is(ambit_dimension_power(m, 3 * AMBIT_POWER_ONE / 2), AMBIT_DIMENSION_KNOWN, "m^1.5");
  assert_is(ambit_dimension_power(of("m^(1/60)"), AMBIT_POWER_ONE / 2), AMBIT_DIMENSION_OPEN, "1");
  assert_is(ambit_dimension_power(m, 1000 * AMBIT_POWER_ONE), AMBIT_DIMENSION_OPEN, "1");
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    bool function = (op >= AMBIT_OP_EXP && op <= AMBIT_OP_ATAN) || (op >= AMBIT_OP_SINH && op <= AMBIT_OP_TANH);
    if (!function) continue;
    assert_false(fits(op, m, m));
    assert_is(result(op, angle, angle), AMBIT_DIMENSION_KNOWN, "1");
    assert_is(result(op, open, open), AMBIT_DIMENSION_SOFT, "1");
    assert_is(result(op, soft, soft), AMBIT_DIMENSION_SOFT, "1");
    assert_is(result(op, result(AMBIT_OP_ADD, m, bare), m), AMBIT_DIMENSION_SOFT, "1"); /* sin(x - 1) */
  }
  assert_false(fits(AMBIT_OP_ATAN2, m, kg));
  assert_is(result(AMBIT_OP_ATAN2, m, bare), AMBIT_DIMENSION_KNOWN, "1");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(fractional_powers),
    cmocka_unit_test(bad_powers_are_named),
    cmocka_unit_test(texts_read_back),
    cmocka_unit_test(names),
    cmocka_unit_test(rules),
    cmocka_unit_test(coefficients_of_states),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
