#include "num/elementary.h"
#include "num/rounding.h"
#include <float.h>
#include <stdatomic.h>

#define PI_UP 0x1.921fb54442d19p+1
typedef ambit_interval interval;

static _Atomic(ambit_elementary_point) slow_path;
void ambit_elementary_set_slow(ambit_elementary_point point) { atomic_store(&slow_path, point); }

void ambit_elementary_coarse(uint32_t op, double x, double y, double *lo, double *hi) {
  (void)x, (void)y;
  *lo = -INFINITY, *hi = INFINITY;
  if (op == AMBIT_OP_SIN || op == AMBIT_OP_COS) *lo = -1, *hi = 1;
}

static double steps(double v, double to) {
  for (int i = 0; i < 6; i++) v = nextafter(v, to);
  return v;
}

static double clamp(double v, double lo, double hi) { return v < lo ? lo : v > hi ? hi : v; }

static double glibc(uint32_t op, double x) {
  switch (op) {
  case AMBIT_OP_EXP: return exp(x);
  case AMBIT_OP_LOG: return log(x);
  case AMBIT_OP_SIN: return sin(x);
  case AMBIT_OP_COS: return cos(x);
  case AMBIT_OP_TAN: return tan(x);
  case AMBIT_OP_ASIN: return asin(x);
  case AMBIT_OP_ACOS: return acos(x);
  case AMBIT_OP_ATAN: return atan(x);
  case AMBIT_OP_SINH: return sinh(x);
  case AMBIT_OP_COSH: return cosh(x);
  default: return tanh(x);
  }
}

static double low(uint32_t op, double x) {
  double v = glibc(op, x);
  if (v == 0 && op != AMBIT_OP_EXP) return v;
  return v == INFINITY ? (x == INFINITY ? v : DBL_MAX) : steps(v, -INFINITY);
}
static double high(uint32_t op, double x) {
  double v = glibc(op, x);
  if (v == 0 && op != AMBIT_OP_EXP) return v;
  if (v == 0 && x == -INFINITY) return 0;
  return v == -INFINITY ? (x == -INFINITY ? v : -DBL_MAX) : steps(v, INFINITY);
}

static interval periodic(uint32_t op, interval a) {
  interval none = op == AMBIT_OP_TAN ? AMBIT_ENTIRE : (interval) { -1, 1 };
  if (!(a.lo > -1e5 && a.hi < 1e5 && a.hi - a.lo < 6.3)) return none;
  double shift = op == AMBIT_OP_COS ? 0 : 0.5; /* special points: (k + shift) pi */
  double p = a.lo / (PI_UP) - shift, q = a.hi / (PI_UP)-shift;
  double first = ceil(p - 1e-9), last = floor(q + 1e-9);
  if (op == AMBIT_OP_TAN)
    return first <= last ? AMBIT_ENTIRE : (interval) { low(op, a.lo), high(op, a.hi) };
  interval r = { fmin(low(op, a.lo), low(op, a.hi)), fmax(high(op, a.lo), high(op, a.hi)) };
  for (double k = first; k <= last; k++) {
    if (fmod(k, 2) == 0) r.hi = 1;
    else r.lo = -1;
  }
  return (interval) { clamp(r.lo, -1, 1), clamp(r.hi, -1, 1) };
}

static interval angle(interval y, interval x) {
  if (y.lo == 0 && y.hi == 0 && x.lo == 0 && x.hi == 0) return AMBIT_EMPTY;
  if (y.lo < 0 && y.hi >= 0 && x.lo < 0) return (interval) { -PI_UP, PI_UP };
  if (y.lo < 0 && y.hi <= 0) {
    interval r = angle((interval) { -y.hi, -y.lo }, x);
    return (interval) { -r.hi, -r.lo };
  }
  if (y.lo < 0) return (interval) { steps(atan2(y.lo, x.lo), -4), steps(atan2(y.hi, x.lo), 4) };
  if (y.hi == 0) return (interval) { x.hi > 0 ? 0 : nextafter(PI_UP, 0), x.lo < 0 ? PI_UP : 0 };
  double least = atan2(x.hi > 0 ? y.lo : y.hi, x.hi), most = atan2(x.lo < 0 ? y.lo : y.hi, x.lo);
  return (interval) { clamp(steps(least, -4), 0, 4), most == 0 ? 0x1p-1074 : clamp(steps(most, 4), 0, PI_UP) };
}

static interval one(uint32_t op, interval a, interval b) {
  if (op == AMBIT_OP_ATAN2) return angle(a, b);
  if (op == AMBIT_OP_LOG) a.lo = a.lo > 0 ? a.lo : 0;
  if (op == AMBIT_OP_LOG && a.hi <= 0) return AMBIT_EMPTY;
  if (op == AMBIT_OP_ASIN || op == AMBIT_OP_ACOS) {
    if (a.hi < -1 || a.lo > 1) return AMBIT_EMPTY;
    a = (interval) { clamp(a.lo, -1, 1), clamp(a.hi, -1, 1) };
  }
  switch (op) {
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_TAN: return periodic(op, a);
  case AMBIT_OP_ACOS: return (interval) { clamp(low(op, a.hi), 0, 4), high(op, a.lo) };
  case AMBIT_OP_EXP: return (interval) { clamp(low(op, a.lo), 0, INFINITY), high(op, a.hi) };
  case AMBIT_OP_TANH: return (interval) { clamp(low(op, a.lo), -1, 1), clamp(high(op, a.hi), -1, 1) };
  case AMBIT_OP_COSH: {
    double most = fmax(fabs(a.lo), fabs(a.hi)), least = a.lo > 0 ? a.lo : a.hi < 0 ? -a.hi : 0;
    return (interval) { clamp(low(op, least), 1, INFINITY), high(op, most) };
  }
  default: return (interval) { low(op, a.lo), high(op, a.hi) };
  }
}

static AMBIT_WORKER void all(uint32_t op, size_t n, const double *alo, const double *ahi, const double *blo,
    const double *bhi, double *rlo, double *rhi) {
  bool binary = op == AMBIT_OP_ATAN2;
  for (size_t i = 0; i < n; i++) {
    interval a = { alo[i], ahi[i] }, b = binary ? (interval) { blo[i], bhi[i] } : a;
    interval r = AMBIT_EMPTY;
    if (a.lo <= a.hi && b.lo <= b.hi) r = one(op, a, b);
    rlo[i] = r.lo, rhi[i] = r.hi;
  }
}

void ambit_elementary(uint32_t op, size_t n, const double *alo, const double *ahi, const double *blo, const double *bhi,
    double *rlo, double *rhi) {
  ambit_rounding old = ambit_round_nearest();
  all(op, n, alo, ahi, blo, bhi, rlo, rhi);
  ambit_rounding_restore(old);
}
