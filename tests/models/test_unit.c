/* Units: exact factors against their definitions (MPFR), grammar, dimensions, messages. */
#include "graph/tape.h"
#include "graph/hull.h"
#include "models/unit.h"
#include "num/decimal.h"
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

static ambit_graph *g;

static int open_graph(void **state) {
  (void)state;
  g = ambit_graph_open();
  return g ? 0 : -1;
}

static int close_graph(void **state) {
  (void)state;
  ambit_graph_close(g);
  return 0;
}

/* The enclosure that a tape gives for a constant expression. */
static ambit_interval value_of(ambit_expr e) {
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  if (ambit_tape_seal(g, arena, 1, &e, 0, NULL, 0, 0, &tape, &f) != AMBIT_OK) fail_msg("%s", f.message);
  ambit_interval slot[16];
  assert_true(tape->nslot <= 16);
  ambit_hull(tape, NULL, slot);
  ambit_interval x = slot[tape->out[0]];
  ambit_arena_close(arena);
  return x;
}

static ambit_expr quantity(const char *text, const char *wanted) {
  ambit_expr e;
  ambit_failure f = { 0 };
  if (ambit_unit_quantity(g, text, wanted, &e, &f) != AMBIT_OK) fail_msg("%s: %s", text, f.message);
  return e;
}

/* Is numerator/denominator * pi^pi inside, and the enclosure at most `ulps` wide? */
static void check(
    const char *text, const char *wanted, const char *numerator, const char *denominator, int pi, int ulps) {
  ambit_interval x = value_of(quantity(text, wanted));
  mpfr_t v, w;
  mpfr_init2(v, 300), mpfr_init2(w, 300);
  mpfr_set_str(v, numerator, 10, MPFR_RNDN);
  mpfr_set_str(w, denominator, 10, MPFR_RNDN);
  mpfr_div(v, v, w, MPFR_RNDN);
  mpfr_const_pi(w, MPFR_RNDN);
  for (int k = 0; k < pi; k++) mpfr_mul(v, v, w, MPFR_RNDN);
  double near = mpfr_get_d(v, MPFR_RNDN), down = mpfr_get_d(v, MPFR_RNDD), up = mpfr_get_d(v, MPFR_RNDU);
  mpfr_clear(v), mpfr_clear(w);
  double ulp = nextafter(fabs(near), INFINITY) - fabs(near);
  if (!(x.lo <= down && up <= x.hi && x.hi - x.lo <= ulps * ulp))
    fail_msg("%s: [%.17g, %.17g] for %.17g", text, x.lo, x.hi, near);
}

static void factors_are_exact(void **state) {
  (void)state;
  check("35 mm", "m", "35", "1000", 0, 1);
  check("0.1", "m", "1", "10", 0, 1);
  check("-1.5e3 mm", "m", "-1.5", "1", 0, 0);
  check("2.5 km", "m", "2500", "1", 0, 0);
  check("12 in", "m", "3048", "10000", 0, 3);
  check("1 ft", "m", "3048", "10000", 0, 3);
  check("3 g", "kg", "3", "1000", 0, 1);
  check("1 t", "kg", "1000", "1", 0, 0);
  check("1 lb", "kg", "0.45359237", "1", 0, 3);
  check("1 lbf", "N", "4.4482216152605", "1", 0, 3);
  check("1 lbf ft", "N m", "1.3558179483314004", "1", 0, 3);
  check("15 ms", "s", "15", "1000", 0, 1);
  check("2 min", "s", "120", "1", 0, 0);
  check("2 h", "s", "7200", "1", 0, 0);
  check("36 km/h", "m/s", "10", "1", 0, 1);
  check("7 kN", "N", "7000", "1", 0, 0);
  check("210 GPa", "Pa", "210000000000", "1", 0, 0);
  check("3 \xc2\xb5m", "m", "3", "1000000", 0, 1);
  check("30 deg", "rad", "1", "6", 1, 3);
  check("2 rev", "rad", "4", "1", 1, 2);
  check("3000 rpm", "rad/s", "100", "1", 1, 2);
  check("5 mrad", "rad", "5", "1000", 0, 1);
  check("50 Hz", "1/s", "50", "1", 0, 0);
  check("3 N m/rad", "N*m", "3", "1", 0, 0);
  check("1/3 mm", "m", "1", "3000", 0, 4);
  check("2 kg*m^2", "kg m^2", "2", "1", 0, 0);
  check("2 g cm^2", "kg m^2", "2", "10000000", 0, 3);
  check("9.81 m/s^2", "m/s^2", "981", "100", 0, 1);
  check("9.81 m s^-2", "m/s^2", "981", "100", 0, 1);
  check("4 J/(kg.K)", "m^2/(s^2 K)", "4", "1", 0, 0);
  check("4 m^2.kg", "kg m^2", "4", "1", 0, 0);
  check("4 m/s/s", "m/s^2", "4", "1", 0, 0);
  check("1 V", "kg*m^2/s^3/A", "1", "1", 0, 0);
  check("4.7 uF", "F", "4.7", "1000000", 0, 1);
  check("22 nF", "A s/V", "22", "1000000000", 0, 1);
  check("10 pF", "A^2 s^4/(kg m^2)", "1", "100000000000", 0, 1);
  check("2 kohm", "ohm", "2000", "1", 0, 0);
  check("2 k\xce\xa9", "\xe2\x84\xa6", "2000", "1", 0, 0);
  check("5 mS", "1/ohm", "5", "1000", 0, 1);
  check("3 L/min", "m^3/s", "1", "20000", 0, 4);
  check("3 ml", "cm^3", "3", "1000000", 0, 1);
  check("1013.25 hPa", "atm", "101325", "1", 0, 0);
  check("1 psi", "Pa", "44482216152605", "6451600000", 0, 4);
  check("3 THz", "Hz", "3000000000000", "1", 0, 0);
  check("2 dag", "kg", "2", "100", 0, 1);
  check("1 eV", "J", "1.602176634e-19", "1", 0, 1);
  check("3 kWh", "J", "10800000", "1", 0, 0);
  check("60 arcmin", "rad", "1", "180", 1, 3);
  check("36 kn", "m/s", "18.52", "1", 0, 3);
  check("2 kcal", "J", "8368", "1", 0, 0);
  check("7 d", "s", "604800", "1", 0, 0);
  check("  2\tm ", "m", "2", "1", 0, 0);
  check("1e310 nm", "m", "1e301", "1", 0, 1);
}

static void right_angles_fold(void **state) {
  (void)state;
  ambit_expr right = quantity("90 deg", "rad"), half = quantity("180 deg", "rad"), turn = quantity("1 rev", "rad");
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_COS, right, right), 0);
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_SIN, right, right), ambit_graph_number(g, 1));
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_COS, half, half), ambit_graph_number(g, -1));
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_SIN, turn, turn), 0);
}

static void equal_dimensions(void **state) {
  (void)state;
  static const char *const pair[][2] = { { "J", "N m" }, { "W", "J/s" }, { "Pa", "N/m^2" }, { "N", "kg m/s^2" },
    { "V", "W/A" }, { "ohm", "V/A" }, { "H", "Wb/A" }, { "T", "Wb/m^2" }, { "C", "A s" }, { "bar", "Pa" },
    { "rpm", "Hz" }, { "F", "C/V" }, { "S", "A/V" }, { "Wb", "V s" }, { "lm", "cd sr" }, { "lx", "lm/m^2" },
    { "Bq", "1/s" }, { "Gy", "J/kg" }, { "Sv", "Gy" }, { "kat", "mol/s" }, { "sr", "1" }, { "L", "dm^3" },
    { "psi", "Pa" }, { "kgf", "N" }, { "rad", "1" }, { "", "1" }, { "(m)", "m" }, { "((m)^2)^2", "m^4" },
    { "m^0", "1" }, { "1/s", "Hz" } };
  for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
    ambit_unit a, b;
    ambit_failure f = { 0 };
    if (ambit_unit_read(pair[i][0], &a, &f) != AMBIT_OK || ambit_unit_read(pair[i][1], &b, &f) != AMBIT_OK)
      fail_msg("%s", f.message);
    assert_memory_equal(a.power, b.power, sizeof a.power);
  }
}

static void bad_units_are_named(void **state) {
  (void)state;
  static const struct {
    const char *text, *wanted, *message;
  } bad[] = {
    { "5 kgg", "kg", "did you mean `kg`" },
    { "5 Newton", "N", "unknown unit `Newton`" },
    { "5 Nm", "N m", "did you mean `N m`" },
    { "5 kt", "kg", "unknown unit `kt`" },
    { "5 degC", "K", "offset" },
    { "5 \xc2\xb0\x43", "K", "offset" },
    { "5 mmin", "s", "unknown unit `mmin`" },
    { "5 kg", "m", "`5 kg` is in kg, but m is expected" },
    { "5 N", "N m", "but N m is expected" },
    { "5 m", "1", "a number without dimension" },
    { "5 m^", "m", "after ^" },
    { "5 m^99", "m", "after ^" },
    { "5 m//s", "m", "expected the name of a unit" },
    { "5 m)", "m", "closed but not opened" },
    { "5 (m", "m", "not closed" },
    { "5 ((((((((((m))))))))))", "m", "too many brackets" },
    { "5 m & s", "m", "expected a blank" },
    { "5 m2", "m^2", "expected a blank" },
    { "5 mm^9^9", "m", "expected a blank" },
    { "5 lbf^9", "N", "too large" },
    { "5 (m^9)^9 (m^9)^9", "m", "too large" },
    { "five m", "m", "five" },
    { "[1, 2] m", "m", "not one number" },
    { "inf m", "m", "is no number" },
    { "5 aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", "m", "unknown unit" },
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ambit_expr e;
    ambit_failure f = { 0 };
    assert_int_equal(ambit_unit_quantity(g, bad[i].text, bad[i].wanted, &e, &f), AMBIT_INVALID);
    if (!strstr(f.message, bad[i].message)) fail_msg("%s: %s", bad[i].text, f.message);
    assert_int_equal(e, AMBIT_NO_EXPR);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(factors_are_exact),
    cmocka_unit_test(right_angles_fold),
    cmocka_unit_test(equal_dimensions),
    cmocka_unit_test(bad_units_are_named),
  };
  return cmocka_run_group_tests(tests, open_graph, close_graph);
}
