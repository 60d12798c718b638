/* elementary.c -- "ambit.elementary/1" by GNU MPFR: correctly rounded functions at a point, for the arguments that
** the kernel's own functions decline.
**
** Why the bounds hold: MPFR rounds correctly [Fousse et al., ACM TOMS 33(2), 2007]. The value rounded downward to 53
** bits and its successor have no double between them, so that converting them downward and upward gives the tightest
** doubles, subnormal and overflowing ones included. An exact value is told by the ternary result.
** MPFR's exponent range and flags are per thread and may be the host program's: they are set for the call and put back.
*/
#include <ambit/elementary.h>
#include <mpfr.h>
#include <string.h>

/* v := op(x, y) rounded downward; the sign of v - op(x, y), 0 if exact */
static int evaluate(mpfr_t v, uint32_t op, mpfr_t x, mpfr_t y) {
  switch (op) {
  case AMBIT_OP_EXP: return mpfr_exp(v, x, MPFR_RNDD);
  case AMBIT_OP_LOG: return mpfr_log(v, x, MPFR_RNDD);
  case AMBIT_OP_SIN: return mpfr_sin(v, x, MPFR_RNDD);
  case AMBIT_OP_COS: return mpfr_cos(v, x, MPFR_RNDD);
  case AMBIT_OP_TAN: return mpfr_tan(v, x, MPFR_RNDD);
  case AMBIT_OP_ASIN: return mpfr_asin(v, x, MPFR_RNDD);
  case AMBIT_OP_ACOS: return mpfr_acos(v, x, MPFR_RNDD);
  case AMBIT_OP_ATAN: return mpfr_atan(v, x, MPFR_RNDD);
  case AMBIT_OP_ATAN2: return mpfr_atan2(v, x, y, MPFR_RNDD);
  case AMBIT_OP_SINH: return mpfr_sinh(v, x, MPFR_RNDD);
  case AMBIT_OP_COSH: return mpfr_cosh(v, x, MPFR_RNDD);
  default: return mpfr_tanh(v, x, MPFR_RNDD);
  }
}

static void enclose(uint32_t op, double x, double y, double *lo, double *hi) {
  MPFR_DECL_INIT(a, 53);
  MPFR_DECL_INIT(b, 53);
  MPFR_DECL_INIT(v, 53);
  mpfr_set_d(a, x == 0 ? 0 : x, MPFR_RNDN); /* the reals have one zero: the angle of (-1, -0) is pi */
  mpfr_set_d(b, y, MPFR_RNDN);
  int inexact = evaluate(v, op, a, b);
  *lo = mpfr_get_d(v, MPFR_RNDD);
  if (inexact) mpfr_nextabove(v);
  *hi = mpfr_get_d(v, MPFR_RNDU);
}

static void point(uint32_t op, double x, double y, double *lo, double *hi) {
  mpfr_exp_t least = mpfr_get_emin(), most = mpfr_get_emax();
  mpfr_flags_t flags = mpfr_flags_save();
  mpfr_set_emin(mpfr_get_emin_min());
  mpfr_set_emax(mpfr_get_emax_max());
  enclose(op, x, y, lo, hi);
  mpfr_set_emin(least);
  mpfr_set_emax(most);
  mpfr_flags_restore(flags, MPFR_FLAGS_ALL);
}

static const ambit_elementary_service service = { sizeof service, point };

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_ELEMENTARY_SERVICE) == 0 ? &service : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.elementary", "1.0",
  "Elementary functions at a point, correctly rounded outward by GNU MPFR. The kernel loads it by itself at the first "
  "argument "
  "that its own functions decline: in practice the sine of a huge angle.",
  get };
