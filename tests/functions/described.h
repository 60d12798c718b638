/* described.h -- MPFR's function of the same name for each of AMBIT_FUNCTIONS, and arguments that are hard for it. */
#ifndef DESCRIBED_H
#define DESCRIBED_H
#include "num/function.h"
#include "oracle.h"

typedef int (*judge)(mpfr_ptr r, mpfr_srcptr x, mpfr_rnd_t rounding);
typedef int (*judge_of_pair)(mpfr_ptr r, mpfr_srcptr x, mpfr_srcptr y, mpfr_rnd_t rounding);
#define ONE_1(symbol) mpfr_##symbol
#define ONE_2(symbol) 0
#define TWO_1(symbol) 0
#define TWO_2(symbol) mpfr_##symbol
static const struct {
  const char *name;
  judge one;
  judge_of_pair two;
} described[] = {
#define AMBIT_X(NAME, arity, symbol) { #symbol, ONE_##arity(symbol), TWO_##arity(symbol) },
  AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
};
#define EACH_FUNCTION(op) for (uint32_t op = AMBIT_OP_FUNCTIONS; op < AMBIT_OP_END; op++)

static inline const char *name_of(uint32_t op) { return described[op - AMBIT_OP_FUNCTIONS].name; }

static inline int judge_value(mpfr_ptr r, uint32_t op, mpfr_srcptr x, mpfr_srcptr y, mpfr_rnd_t rounding) {
  if (ambit_op_arity(op) == 2) return described[op - AMBIT_OP_FUNCTIONS].two(r, x, y, rounding);
  return described[op - AMBIT_OP_FUNCTIONS].one(r, x, rounding);
}

/* the value rounded to a double, subnormal ones too */
static inline double judge_rounded(uint32_t op, double x, double y, mpfr_rnd_t rounding) {
  MPFR_DECL_INIT(a, 53);
  MPFR_DECL_INIT(b, 53);
  MPFR_DECL_INIT(r, 53);
  mpfr_set_emin(-1073), mpfr_set_emax(1024);
  mpfr_set_d(a, x, MPFR_RNDN), mpfr_set_d(b, y, MPFR_RNDN);
  int t = judge_value(r, op, a, b, rounding);
  t = mpfr_check_range(r, t, rounding);
  mpfr_subnormalize(r, t, rounding);
  double value = mpfr_get_d(r, rounding);
  mpfr_set_emin(mpfr_get_emin_min()), mpfr_set_emax(mpfr_get_emax_max());
  return value;
}

static inline bool is_inside(uint32_t op, double x) {
  const ambit_function_facts *f = &ambit_function_of(op)->facts;
  if (f->open && (x == f->least || x == f->most)) return false;
  return x >= f->least && x <= f->most;
}

/* a number of any size */
static inline double hard_number(uint64_t *state) {
  double sign = oracle_random(state) & 1 ? 1 : -1;
  int kind = (int)(oracle_random(state) % 8), exponent = (int)(oracle_random(state) % 2098) - 1074;
  double unit = oracle_uniform(state, 1, 2), whole = (double)(oracle_random(state) % 2200) - 1100;
  if (kind == 0) return ldexp(sign * unit, exponent);
  if (kind == 1) return nextafter(sign, sign * (double)(oracle_random(state) % 3));
  if (kind == 2) return sign * (1 + sign * ldexp(unit, -(int)(oracle_random(state) % 60)));
  if (kind == 3) return whole;
  if (kind == 4) return sign * ldexp(unit, -(int)(oracle_random(state) % 80));
  if (kind == 5) return oracle_double(state);
  return oracle_uniform(state, -20, 20);
}

static inline double hard_argument(uint32_t op, uint64_t *state) {
  for (;;) {
    double x = hard_number(state);
    if (isfinite(x) && is_inside(op, x)) return x;
  }
}
#endif
