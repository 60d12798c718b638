/* defect.c -- by how much each operation fails along the polynomials of phase 1: one number for each, over the step.
**
** op(V_a(s), V_b(s)) = V_j(s) + tau_j,  |tau_j| <= r_j  for all s in [0, h], xi, eps in their boxes. Order by order,
** `drop` bounds what a product left out (row_dropped: monomials that rows do not hold) and its rounding; orders beyond
** K are bounded by sizes of rows. For functions that solve a differential equation, the difference u from the true
** function solves it too, with what was dropped as its right-hand side. Quotients and roots are tested afterwards:
** their rows are multiplied out again. Proofs: docs/numerics/zonotope.md, section 4.
*/
#include "kink.h"
#include "proof.h"
#include "turn.h"
#include "value.h"

typedef struct sizes {
  double moving, constant; /* of products, with and without a coefficient that is no constant */
} sizes;

/* A coefficient of a sum of n products takes 10 n + 14 operations (zonotope.h), the constant has twice the digits. */
static double rounding(double n, sizes size) {
  double squared = 16 * (n + 4) * (n + 4) * UNIT * UNIT;
  return (10 * n + 16) * UNIT * size.moving * ABOVE + squared * size.constant;
}
static double total(const zono *z, uint32_t slot, uint32_t k) { return z->proof->total[z->first[slot] + k]; }
static double scaled(const zono *z, uint32_t slot, uint32_t k) { return z->proof->scaled[z->first[slot] + k]; }
static double *drop_at(const zono *z, uint32_t slot) { return z->proof->drop + z->first[slot]; }
static uint32_t last(const zono *z, uint32_t slot) { return orders(z, slot) - 1; }

#define DOUBLE (8 * UNIT) /* what a function's value is off by, if it is one of the kernel's */

/* -- what order k drops */

/* sum_j w_j u_j (*) v_(k-j), w_j = j / k with `weighted`, else 1: monomials that are not held, and the sums of sizes */
static double dropped(const zono *z, uint32_t u, uint32_t v, uint32_t k, int weighted, sizes *size) {
  double sum = 0;
  for (uint32_t j = (uint32_t)weighted; j <= k && j <= last(z, u); j++) {
    if (k - j > last(z, v)) continue;
    double w = weighted ? (double)j / k : 1;
    const double *a = row_at(z, u, j), *b = row_at(z, v, k - j);
    sum += w * row_dropped(&z->shape, a, b, row_parts(&z->shape, k));
    size->moving += w * (row_moving(&z->shape, a) * total(z, v, k - j) + fabs(a[0]) * row_moving(&z->shape, b));
    size->constant += w * fabs(a[0] * b[0]);
  }
  return sum;
}

static void drop_product(zono *z, uint32_t dst, uint32_t u, uint32_t v, int weighted) {
  double *drop = drop_at(z, dst);
  for (uint32_t k = (uint32_t)weighted; k <= last(z, dst); k++) {
    sizes size = { 0, 0 };
    double lost = dropped(z, u, v, k, weighted, &size);
    drop[k] = lost + rounding(k + 1.0, size);
  }
}

typedef struct product {
  double scale;
  uint32_t u, v;
} product;

/* what is left of sum_n scale_n u_n v_n - linear (weighted: of sum_n scale_n u_n' v_n - linear', over k) at each order,
** its rounding, and what its products dropped; constant: added at order 0 */
static void test(zono *z, double *drop, uint32_t count, uint32_t n, const product *p, uint32_t linear, double constant,
    int weighted) {
  const shape *s = &z->shape;
  drop[0] = 0;
  for (uint32_t k = (uint32_t)weighted; k < count; k++) {
    terms sum;
    terms_clear(&sum);
    double lost = 0, *row, *left = z->proof->end;
    sizes size = { 0, 0 };
    if (k == 0) sum.c = constant, size.constant = fabs(constant);
    if (linear != AMBIT_NO_SLOT && k <= last(z, linear)) {
      row = row_at(z, linear, k), terms_row(s, &sum, -1, row);
      size.moving += row_moving(s, row), size.constant += fabs(row[0]);
    }
    for (uint32_t i = 0; i < n; i++) {
      lost += fabs(p[i].scale) * dropped(z, p[i].u, p[i].v, k, weighted, &size);
      for (uint32_t j = (uint32_t)weighted; j <= k && j <= last(z, p[i].u); j++)
        if (k - j <= last(z, p[i].v))
          terms_share(
              s, &sum, p[i].scale, weighted ? j : 1, weighted ? k : 1, row_at(z, p[i].u, j), row_at(z, p[i].v, k - j));
    }
    terms_sum(s, &sum, left, row_parts(&z->shape, k));
    drop[k] = row_total(s, left) * ABOVE + lost + 2 * rounding(n * (k + 1.0) + 2, size);
  }
}

/* -- order 0 of functions: Taylor's remainder of degree 3; g: bounds of derivatives at the constant, the last one over
** the operand's range */

/* What the low part of the constant (low) does beyond its linear term: it is one more term of an operand that moves by
** A, and products with it are left out. g: of the second, third derivative. */
static double beside_low(double low, double A, double g2, double g3) { return low * (A + low) * (g2 + g3 * (A + low)); }

/* off: how much the value at c may be */
static double remainder_of(const zono *z, uint32_t a, double off, double g1, double g2, double g3, double g4) {
  const double *x = row_at(z, a, 0);
  double A = row_moving(&z->shape, x), size = g1 * A + g2 * A * A + g3 * A * A * A, low = fabs(row_low(&z->shape, x));
  double all = A + low;
  return 0.5 * g2 * row_dropped(&z->shape, x, x, row_parts(&z->shape, 0)) + g3 * row_dropped_cube(&z->shape, x) / 6 +
         g4 * all * all * all * all / 24 + 64 * UNIT * (size + g1 * low) + beside_low(low, A, g2, g3) + off;
}

/* atan2: u - u w + u w^2 - u^3 / 3, sizes of u and w at most A / r; the angle's n-th derivative in any direction is at
** most (n - 1)! / r^n */
static double angle_remainder(const zono *z, uint32_t a, uint32_t b) {
  const shape *s = &z->shape;
  const double *y = row_at(z, a, 0), *x = row_at(z, b, 0);
  double A = row_moving(s, x) + row_moving(s, y), r = length_of(x[0], y[0]) * (1 - 8 * UNIT);
  double low = fabs(row_low(s, x)) + fabs(row_low(s, y)), all = A + low, near = r - all;
  if (!(near > 0)) return INFINITY;
  uint32_t parts = row_parts(s, 0);
  double lost = 0.5 * (row_dropped(s, x, x, parts) + row_dropped(s, y, y, parts)) + row_dropped(s, x, y, parts);
  double far = A - (row_l(s, x) + row_l(s, y)) + x[s->norms + NORM_L_FAR] + y[s->norms + NORM_L_FAR] + 8 * UNIT * A;
  if (!(parts & TRIPLES)) far = A;
  double ratio = A / r, size = ratio + ratio * ratio + ratio * ratio * ratio;
  return lost / (r * r) + 4 * ratio * ratio * far / r + all * all * all * all / (4 * near * near * near * near) +
         64 * UNIT * (0.5 + 2 * size + low / r) + beside_low(low, A, 1 / (r * r), 2 / (r * r * r));
}

/* 1 - tanh(x)^2 <= 4 e^-2|x| and 1 */
static double tanh_slope_above(const zono *z, double x) {
  return fmin(1, 4 * value_of(z, AMBIT_OP_EXP, -2 * fabs(x), 0));
}

/* With v = tanh c, q = 1 - v^2: derivatives q, -2 v q, (6 v^2 - 2) q and v (16 - 24 v^2) q, of which the last is below
** 8 q and 4.1. That phase 1 has q as (1 - v) (1 + v), off by 8 units, is in the last terms. */
static double tanh_remainder(const zono *z, uint32_t a) {
  const double *x = row_at(z, a, 0);
  double A = row_moving(&z->shape, x), q = tanh_slope_above(z, x[0]) + 32 * UNIT;
  double near = fmax(fabs(x[0]) - A - fabs(row_low(&z->shape, x)), 0);
  double fourth = fmin(4.1, 8 * tanh_slope_above(z, near));
  return remainder_of(z, a, DOUBLE, q, fmin(0.77, 2 * q) + 32 * UNIT, fmin(2, 4 * q) + 64 * UNIT, fourth * ABOVE) +
         64 * UNIT * (A + A * A + A * A * A);
}

static double order0(const zono *z, uint32_t i) {
  const ambit_tape *t = z->program.tape;
  uint32_t op = t->op[i], a = t->a[i];
  const double *x = row_at(z, a, 0);
  double c = x[0], A = row_moving(&z->shape, x) + fabs(row_low(&z->shape, x)), near = c - A, n = 1 / c, v;
  dd sine, cosine;
  switch (op) {
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
    v = fabs(value_of(z, op, c, 0));
    return remainder_of(z, a, turn_at(c, &sine, &cosine) ? TURN_ERROR : DOUBLE * v, 1, v + 8 * UNIT, 1, 1);
  case AMBIT_OP_EXP:
    v = value_of(z, op, c, 0);
    return remainder_of(z, a, DOUBLE * v, v, v, v, value_of(z, op, c + A, 0));
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
    v = value_of(z, AMBIT_OP_COSH, c, 0);
    return remainder_of(z, a, DOUBLE * v, v, v, v, value_of(z, AMBIT_OP_COSH, fabs(c) + A, 0));
  case AMBIT_OP_TANH: return tanh_remainder(z, a);
  case AMBIT_OP_ATAN: return remainder_of(z, a, DOUBLE * 2, 1, 1, 2, 6);
  case AMBIT_OP_LOG:
    if (!(near > 0)) return INFINITY;
    v = fabs(value_of(z, op, c, 0));
    return remainder_of(z, a, DOUBLE * v, n, n * n, 2 * n * n * n, 6 / (near * near * near * near));
  case AMBIT_OP_ATAN2: return angle_remainder(z, a, t->b[i]);
  default: return 0;
  }
}

/* -- all of it, once a step */

static double size_of(const zono *z, uint32_t slot, uint32_t k) { return k <= last(z, slot) ? total(z, slot, k) : 0; }

static void drop_sum(zono *z, uint32_t i) {
  const ambit_tape *t = z->program.tape;
  uint32_t dst = t->dst[i], a = t->a[i], b = t->op[i] == AMBIT_OP_NEG ? a : t->b[i];
  for (uint32_t k = 0; k <= last(z, dst); k++) {
    double size = size_of(z, a, k) + size_of(z, b, k);
    drop_at(z, dst)[k] = 2 * UNIT * row_moving(&z->shape, row_at(z, dst, k)) + 16 * 36 * UNIT * UNIT * size;
  }
}

/* ATAN, ATAN2: z' q - numerator */
static void drop_angle(zono *z, uint32_t i) {
  const ambit_tape *t = z->program.tape;
  uint32_t a = t->a[i], b = t->b[i], q = t->aux[i], dst = t->dst[i];
  if (t->op[i] == AMBIT_OP_ATAN) {
    product p[1] = { { 1, dst, q } };
    test(z, drop_at(z, dst), orders(z, dst), 1, p, a, 0, 1);
  } else {
    product p[3] = { { 1, dst, q }, { -1, a, b }, { 1, b, a } };
    test(z, drop_at(z, dst), orders(z, dst), 3, p, AMBIT_NO_SLOT, 0, 1);
  }
}

static void prepare(zono *z, uint32_t i) {
  const ambit_tape *t = z->program.tape;
  uint32_t op = t->op[i], a = t->a[i], b = t->b[i], dst = t->dst[i];
  double *drop = drop_at(z, dst);
  product square = { 1, dst, dst }, quotient = { 1, dst, b }, log = { 1, dst, a };
  if (is_line(z, i)) {
    for (uint32_t k = 0; k <= last(z, dst); k++)
      drop[k] = 8 * UNIT * (size_of(z, a, k) + (b == a ? 0 : size_of(z, b, k)));
    return;
  }
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_NEG: drop_sum(z, i); return;
  case AMBIT_OP_MUL: drop_product(z, dst, a, b, 0); return;
  case AMBIT_OP_SQR: drop_product(z, dst, a, a, 0); return;
  case AMBIT_OP_DIV: test(z, drop, orders(z, dst), 1, &quotient, a, 0, 0); return;
  case AMBIT_OP_SQRT: test(z, drop, orders(z, dst), 1, &square, a, 0, 0); return;
  case AMBIT_OP_LOG: test(z, drop, orders(z, dst), 1, &log, a, 0, 1); break;
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ATAN2: drop_angle(z, i); break;
  case AMBIT_OP_EXP: drop_product(z, dst, a, dst, 1); break;
  default: drop_product(z, dst, a, t->aux[i], 1); /* SIN COS SINH COSH TANH */
  }
  drop[0] = order0(z, i);
}

void defect_prepare(zono *z) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t j = 0; j < z->nslot; j++)
    for (uint32_t k = 0; k <= last(z, j); k++)
      z->proof->total[z->first[j] + k] = row_total(&z->shape, row_at(z, j, k)) * ABOVE;
  for (uint32_t i = 0; i < t->ninstr; i++) prepare(z, i);
}

/* -- over the step */

/* orders beyond K of u v, or (weighted) of the integral of u' v */
static double tail(const zono *z, uint32_t u, uint32_t v, int weighted) {
  uint32_t nu = last(z, u), nv = last(z, v), K = z->K;
  double sum = 0, behind = 0; /* behind: orders of v above K - j */
  uint32_t next = nv + 1;
  if (nu + nv <= K) return 0;
  for (uint32_t j = K > nv ? K - nv : 0; j <= nu; j++) {
    while (next > 0 && next + j > K + 1) behind += scaled(z, v, --next);
    sum += (weighted ? (double)j / (K + 1) : 1) * scaled(z, u, j) * behind;
  }
  return sum;
}

static double polynomial(const double *c, uint32_t degree, double length) {
  double sum = 0;
  for (uint32_t k = degree + 1; k-- > 0;) sum = sum * length + c[k];
  return sum;
}

/* |(u, w)(s)| <= |(u, w)(0)| + integral of |(d1, d2)|: sine and cosine turn, they do not stretch */
static double turning(const zono *z, uint32_t i, double length) {
  const ambit_tape *t = z->program.tape;
  uint32_t dst = t->dst[i], other = t->aux[i];
  const double *d = drop_at(z, dst), *e = drop_at(z, other);
  double sum = length_of(tail(z, t->a[i], other, 1), tail(z, t->a[i], dst, 1)), power = 1;
  for (uint32_t k = 0; k <= last(z, dst); k++, power *= length) sum += length_of(d[k], e[k]) * power;
  return sum;
}

/* how far the operand moves from its start */
static double motion(const zono *z, uint32_t a) {
  double sum = 0;
  for (uint32_t k = 1; k <= last(z, a); k++) sum += scaled(z, a, k);
  return sum;
}

static double growing(const zono *z, uint32_t i, double length) {
  const ambit_tape *t = z->program.tape;
  uint32_t dst = t->dst[i], other = t->op[i] == AMBIT_OP_EXP ? dst : t->aux[i], a = t->a[i];
  double sum = polynomial(drop_at(z, dst), last(z, dst), length) + tail(z, a, other, 1);
  if (other != dst) sum += polynomial(drop_at(z, other), last(z, other), length) + tail(z, a, dst, 1);
  return sum * value_of(z, AMBIT_OP_EXP, 2 * motion(z, a), 0);
}

/* q = 1 + a^2 or a^2 + b^2: how far the aux slot is off; near: a lower bound of the true q */
static double aux_error(zono *z, uint32_t i, double length, double *near) {
  const ambit_tape *t = z->program.tape;
  uint32_t a = t->a[i], b = t->b[i], q = t->aux[i];
  double drop[TIME_ORDERS], error;
  if (t->op[i] == AMBIT_OP_ATAN) {
    product p[1] = { { 1, a, a } };
    test(z, drop, z->K + 1, 1, p, q, 1, 0);
    error = polynomial(drop, z->K, length) + tail(z, a, a, 0);
    *near = fmax(1, z->proof->low[q] - error);
  } else {
    product p[2] = { { 1, a, a }, { 1, b, b } };
    test(z, drop, z->K + 1, 2, p, q, 0, 0);
    error = polynomial(drop, z->K, length) + tail(z, a, a, 0) + tail(z, b, b, 0);
    *near = z->proof->low[q] - error;
  }
  return error;
}

/* u' = (z' q - numerator + z' (true q - q)) / true q */
static double angle(zono *z, uint32_t i, double length) {
  const ambit_tape *t = z->program.tape;
  uint32_t a = t->a[i], b = t->b[i], q = t->aux[i], dst = t->dst[i];
  const double *drop = drop_at(z, dst);
  double near, error = aux_error(z, i, length, &near);
  if (!(near > 0)) return INFINITY;
  double sum = polynomial(drop, last(z, dst), length) - drop[0] + tail(z, dst, q, 1), moved = 0;
  for (uint32_t k = 1; k <= last(z, dst); k++) moved += scaled(z, dst, k);
  if (t->op[i] == AMBIT_OP_ATAN2) sum += tail(z, a, b, 1) + tail(z, b, a, 1);
  return drop[0] * ABOVE + (fmax(sum, 0) + moved * error + 1e-15 * drop[0]) / near;
}

/* the instruction that makes a slot, which is no constant or input */
static uint32_t maker_of(const zono *z, uint32_t slot) { return slot - z->program.tape->nconst - z->program.tape->nin; }

double tanh_aux_error(const zono *z, uint32_t i) {
  uint32_t aux = z->program.tape->aux[i], square = z->program.tape->b[maker_of(z, aux)];
  return (z->r[aux] + z->r[square]) * ABOVE;
}

static double evaluate(zono *z, uint32_t i, double length);

/* u = V_y - tanh V_a: u' = V_y' - V_s V_a' + (V_s - (1 - V_y^2)) V_a' - (V_y + tanh V_a) V_a' u */
static double tangent(zono *z, uint32_t i, double length) {
  const ambit_tape *t = z->program.tape;
  uint32_t dst = t->dst[i], a = t->a[i], aux = t->aux[i], last_one = maker_of(z, aux), square = t->b[last_one];
  double moved = motion(z, a), off = 0;
  if (moved > 0) off = evaluate(z, maker_of(z, square), length) + evaluate(z, last_one, length);
  double sum = polynomial(drop_at(z, dst), last(z, dst), length) + tail(z, a, aux, 1) + off * moved;
  return sum * value_of(z, AMBIT_OP_EXP, (1 + z->proof->high[dst]) * moved * ABOVE, 0);
}

static double evaluate(zono *z, uint32_t i, double length) {
  const ambit_tape *t = z->program.tape;
  uint32_t a = t->a[i], b = t->b[i], dst = t->dst[i];
  const double *drop = drop_at(z, dst), *low = z->proof->low;
  double sum = polynomial(drop, last(z, dst), length);
  if (is_line(z, i)) return kink_defect(z, i, sum, length);
  if (orders(z, dst) == 1 && (last(z, a) || last(z, b))) return INFINITY; /* a tape with wrong degrees */
  switch (t->op[i]) {
  case AMBIT_OP_MUL: return sum + (z->proof->late[dst] = tail(z, a, b, 0));
  case AMBIT_OP_SQR: return sum + (z->proof->late[dst] = tail(z, a, a, 0));
  case AMBIT_OP_DIV: return low[b] > 0 ? (sum + tail(z, dst, b, 0)) / low[b] : INFINITY;
  case AMBIT_OP_SQRT:
    if (!(low[a] > 0 && low[dst] > 0 && row_at(z, a, 0)[0] > 0)) return INFINITY;
    return (sum + tail(z, dst, dst, 0)) / (sqrt(low[a]) + low[dst]);
  case AMBIT_OP_LOG:
    if (!(low[a] > 0 && row_at(z, a, 0)[0] > 0)) return INFINITY;
    return drop[0] * ABOVE + (sum - drop[0] + 1e-15 * drop[0] + tail(z, dst, a, 1)) / low[a];
  case AMBIT_OP_EXP:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: return growing(z, i, length);
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: return turning(z, i, length);
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ATAN2: return angle(z, i, length);
  case AMBIT_OP_TANH: return tangent(z, i, length);
  default: return sum;
  }
}

/* scaled, high, low */
static void bound_slots(zono *z, double length) {
  proof *p = z->proof;
  for (uint32_t j = 0; j < z->nslot; j++) {
    const double *row = row_at(z, j, 0);
    double power = 1, sum = 0;
    for (uint32_t k = 0; k <= last(z, j); k++, power *= length) {
      p->scaled[z->first[j] + k] = total(z, j, k) * power;
      sum += p->scaled[z->first[j] + k];
    }
    p->high[j] = sum * ABOVE;
    double off = (sum - total(z, j, 0) + row_moving(&z->shape, row)) * ABOVE + 1e-15 * fabs(row[0]);
    p->low[j] = fmax(fabs(row[0]) - off, 0) * (1 - 1e-9);
  }
}

/* x'_i: V_F - V_x', parts of F that x' does not hold among it; R: all of it */
static void bound_outputs(zono *z, double length) {
  for (uint32_t o = 0; o < z->nout; o++) {
    uint32_t slot = slot_out(z)[o];
    double sum = 0, power = 1;
    for (uint32_t k = 0; k <= last(z, slot); k++, power *= length) {
      const double *row = row_at(z, slot, k);
      if (o >= z->nx || k == z->K)
        sum += total(z, slot, k) * power;
      else if (k & (k + 1)) /* else it is divided exactly */
        sum += (4 * UNIT * row_moving(&z->shape, row) + 64 * UNIT * UNIT * fabs(row[0])) * power;
      if (o < z->nx) sum += row_lost(&z->shape, row_at(z, slot, k), row_parts(&z->shape, k + 1)) * power;
    }
    z->rr_out[o] = sum * ABOVE + LEAST;
  }
}

int defect_evaluate(zono *z, double length) {
  const ambit_tape *t = z->program.tape;
  bound_slots(z, length);
  for (uint32_t j = 0; j < t->nconst; j++) z->r[j] = z->constant_off[j];
  for (uint32_t j = t->nconst; j < t->nconst + t->nin; j++) z->r[j] = 0;
  for (uint32_t i = 0; i < z->np; i++) {
    double lost = row_lost(&z->shape, z->p_row + (size_t)i * z->shape.stride, row_parts(&z->shape, 0));
    z->r[slot_p(z, i)] = (z->p_rad ? z->p_rad[i] : 0) + lost * ABOVE;
  }
  if (z->program.uses_time) z->r[slot_t(z)] = z->problem.jump_error;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    double r = evaluate(z, i, length);
    if (!(r < INFINITY)) return z->why = WHY_UNDEFINED, z->blamed = t->dst[i], 0;
    z->r[t->dst[i]] = r == 0 && is_kinked(t->op[i]) ? 0 : r * ABOVE + LEAST;
  }
  bound_outputs(z, length);
  return 1;
}

int zono_defects(zono *z) {
  if (!z->proof->prepared) defect_prepare(z);
  return defect_evaluate(z, fabs(z->h));
}
