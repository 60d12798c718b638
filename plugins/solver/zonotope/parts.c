/* parts.c -- which parts of the rows are held at which orders in time, by need.
**
** What a part at order k is worth to a product is what the product would drop without it. By its lump that is a rate of
** each x', and as long as the rates of all parts that are left out stay within the budgets of the states (pace.c), they
** are left out, from the highest order on. No proof depends on anything here: what is dropped is in the lumps.
*/
#include "kink.h"
#include "proof.h"

#define SHARE 0.25  /* of the budget, for each kind of parts */
#define FADING 0.97 /* of the usual length of a step, from one to the next */
#define LONGER 1.2  /* without data, where it may be 3 times as long after a short one */
#define AHEAD 2.0   /* the next step may be so much longer; else what is left out would keep steps short */

enum kind { KIND_PAIRS, KIND_MIXED, KIND_TRIPLES, KIND_ERRORS, KINDS };

/* Sizes of what a (*) b has of each kind. is_a, is_b: that operand is of the order of the product, and would not hold
** the part either. */
static void add_worth(
    const shape *s, double w, const double *a, int is_a, const double *b, int is_b, double worth[KINDS]) {
  double x = is_b ? 0 : w * fabs(a[0]), y = is_a ? 0 : w * fabs(b[0]), la = w * row_l(s, a), lb = w * row_l(s, b);
  worth[KIND_PAIRS] += x * row_q(s, b) + y * row_q(s, a) + la * row_l(s, b);
  worth[KIND_MIXED] += x * row_x(s, b) + y * row_x(s, a) + la * row_r(s, b) + lb * row_r(s, a);
  worth[KIND_ERRORS] += x * row_r(s, b) + y * row_r(s, a);
  worth[KIND_TRIPLES] += x * row_c(s, b) + y * row_c(s, a) + la * row_q(s, b) + lb * row_q(s, a);
}

/* order k of u v, or (weighted) of the integral of u' v */
static void add_product(const zono *z, uint32_t u, uint32_t v, uint32_t k, int weighted, double worth[KINDS]) {
  for (uint32_t j = (uint32_t)weighted; j <= k && j < orders(z, u); j++)
    if (k - j < orders(z, v))
      add_worth(&z->shape, weighted ? (double)j / k : 1, row_at(z, u, j), j == k, row_at(z, v, k - j), j == 0, worth);
}

/* of instruction i at order k; quotients and the like: what multiplying them out drops */
static void find_worth(const zono *z, uint32_t i, uint32_t k, double worth[KINDS]) {
  const ambit_tape *t = z->program.tape;
  uint32_t a = t->a[i], b = t->b[i], dst = t->dst[i];
  int of_time = k > 0;
  switch (t->op[i]) {
  case AMBIT_OP_MUL: add_product(z, a, b, k, 0, worth); return;
  case AMBIT_OP_SQR: add_product(z, a, a, k, 0, worth); return;
  case AMBIT_OP_DIV: add_product(z, dst, b, k, 0, worth); return;
  case AMBIT_OP_SQRT: add_product(z, dst, dst, k, 0, worth); return;
  case AMBIT_OP_LOG: add_product(z, dst, a, k, of_time, worth); return;
  case AMBIT_OP_ATAN: add_product(z, dst, t->aux[i], k, of_time, worth); return;
  case AMBIT_OP_ATAN2: add_product(z, a, b, k, of_time, worth), add_product(z, b, a, k, of_time, worth); return;
  case AMBIT_OP_EXP: add_product(z, a, dst, k, of_time, worth); return;
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: add_product(z, a, t->aux[i], k, of_time, worth); return;
  case AMBIT_OP_TANH:
    if (!is_line(z, i)) add_product(z, a, t->aux[i], k, of_time, worth);
    return;
  default: return;
  }
}

/* rates of order k of each kind by the budgets: the largest over the states. rate [nx x KINDS] is scratch. */
static void find_shares(const zono *z, uint32_t k, double power, double before, double *rate, double share[KINDS]) {
  const proof *p = z->proof;
  const ambit_tape *t = z->program.tape;
  memset(rate, 0, z->nx * KINDS * sizeof *rate);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    double worth[KINDS] = { 0 };
    if (k >= orders(z, t->dst[i])) continue;
    find_worth(z, i, k, worth);
    for (uint32_t x = 0;
         x < z->nx && worth[KIND_PAIRS] + worth[KIND_MIXED] + worth[KIND_TRIPLES] + worth[KIND_ERRORS] > 0; x++) {
      if (p->link[x] == LINK_STATE) continue;
      double c = fabs(p->C[(size_t)p->link_to[x] * z->nslot + t->dst[i]]) * power;
      for (int n = 0; n < KINDS; n++) rate[x * KINDS + (uint32_t)n] += c * worth[n];
    }
  }
  for (uint32_t x = 0; x < z->nx && k > 0; x++) { /* of x', what the next order of x would not hold */
    const double *row = coefficient(z, slot_out(z)[x], k - 1);
    rate[x * KINDS + KIND_PAIRS] += row_q(&z->shape, row) * before;
    rate[x * KINDS + KIND_MIXED] += row_x(&z->shape, row) * before;
    rate[x * KINDS + KIND_ERRORS] += row_r(&z->shape, row) * before;
    rate[x * KINDS + KIND_TRIPLES] += row_c(&z->shape, row) * before;
  }
  for (uint32_t x = 0; x < z->nx; x++)
    for (int n = 0; n < KINDS; n++) {
      double by = p->budget[x] > 0 ? rate[x * KINDS + (uint32_t)n] / p->budget[x] : INFINITY;
      if (rate[x * KINDS + (uint32_t)n] > 0) share[n] = fmax(share[n], by);
    }
}

/* how many orders hold the part: those above it have shares that add up to at most SHARE */
static uint32_t count_orders(double share[][KINDS], uint32_t K, enum kind n) {
  double sum = 0;
  uint32_t count = K + 1;
  while (count > 0 && (sum += share[count - 1][n]) <= SHARE) count--;
  return count;
}

void parts_choose(zono *z) {
  const double *usual = &z->proof->usual;
  double share[TIME_ORDERS][KINDS], power = 1, length = fabs(z->h);
  shape *s = &z->shape;
  if (z->m == 0 && !is_certain(z)) return;
  if (length < *usual) length = fmin(*usual, AHEAD * length);
  if (is_certain(z)) length = fmax(LONGER * fabs(z->h), fmin(*usual, 3 * fabs(z->h)));
  z->proof->usual = fmax(fabs(z->h), FADING * *usual);
  for (uint32_t k = 0; k <= z->K; k++, power *= length) {
    memset(share[k], 0, sizeof share[k]);
    find_shares(z, k, power, power / length, z->proof->worth, share[k]);
  }
  for (uint32_t i = 0; i < z->nx; i++) { /* triples of the states become errors once */
    double once =
        row_c(s, row_at(z, slot_x(z, i), 0)) / fabs(z->problem.time[z->problem.ntime - 1] - z->problem.time[0]);
    if (once > 0) share[0][KIND_TRIPLES] = fmax(share[0][KIND_TRIPLES], once / z->proof->budget[i]);
  }
  uint32_t paired = count_orders(share, z->K, KIND_PAIRS), cubed = count_orders(share, z->K, KIND_TRIPLES);
  s->paired = paired > 0 ? paired : 1, s->mixing = count_orders(share, z->K, KIND_MIXED);
  s->cubed = cubed < s->room ? cubed : s->room;
  if (s->cubed > s->paired) s->paired = s->cubed;
  if (!is_certain(z)) return;
  uint32_t erring = count_orders(share, z->K, KIND_ERRORS);
  s->erring = erring == 0 ? 1 : erring < s->room ? erring : s->room;
}
