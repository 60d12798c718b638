/* The claim of a Taylor model, |v(x) - p(x)| <= r, at random points of the box, not only the hull: single operations on
** thin, wide and degenerate ranges, and random programs whose variables are shared, against MPFR. */
#include "taylor_case.h"
#include "num/interval.h"

static const char *const op_name[] = {
#define NAME(name, arity, symbol) #name,
  AMBIT_OPS(NAME)
#undef NAME
};
static const int op_arity[] = {
#define ARITY(name, arity, symbol) arity,
  AMBIT_OPS(ARITY)
#undef ARITY
};

enum { STEPS = 14, LANES_MAX = 9, VARIABLES = 5 };

typedef struct program {
  uint32_t nvar, order, steps, op[STEPS], a[STEPS], b[STEPS];
  double mid[LANES_MAX][VARIABLES], rad[LANES_MAX][VARIABLES];
} program;

/* few bits, so that mid +- rad are doubles */
static double few_bits(uint64_t *random, int exponent) {
  return ldexp((double)(oracle_random(random) % 255) - 127, exponent - 7);
}

static program any_program(uint64_t *random) {
  static const uint32_t smooth[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_MUL, AMBIT_OP_MUL, AMBIT_OP_SQR };
  program p = { .nvar = (uint32_t)(oracle_random(random) % (VARIABLES + 1)) };
  p.order = (uint32_t)(oracle_random(random) % 7), p.steps = STEPS;
  for (uint32_t i = 0; i < STEPS; i++) {
    uint32_t slots = p.nvar + 1 + i;
    p.op[i] = oracle_random(random) % 2 ? smooth[oracle_random(random) % 5]
                                        : (uint32_t)(oracle_random(random) % AMBIT_OP_COUNT);
    p.a[i] = (uint32_t)(oracle_random(random) % slots), p.b[i] = (uint32_t)(oracle_random(random) % slots);
    if (op_arity[p.op[i]] == 1) p.b[i] = p.a[i];
    if (p.op[i] == AMBIT_OP_POWN) p.b[i] = (uint32_t)((int32_t)(oracle_random(random) % 25) - 6);
  }
  int size = (int)(oracle_random(random) % 7) - 3, thin = (int)(oracle_random(random) % 20);
  for (size_t l = 0; l < LANES_MAX; l++)
    for (uint32_t v = 0; v < p.nvar; v++) {
      p.mid[l][v] = few_bits(random, size);
      p.rad[l][v] = oracle_random(random) % 8 == 0 ? 0 : fabs(few_bits(random, size - thin));
    }
  return p;
}

static void describe(const program *p, size_t lane, const double *x) {
  for (uint32_t v = 0; v < p->nvar; v++) print_error("  %u: %a + %a * %a\n", v, p->mid[lane][v], p->rad[lane][v], x[v]);
  print_error("  %u: 0.75\n", p->nvar);
  for (uint32_t i = 0; i < p->steps; i++)
    print_error("  %u: %s %d %d\n", p->nvar + 1 + i, op_name[p->op[i]], (int)p->a[i], (int)p->b[i]);
}

/* all slots at the point x of a lane; returns the number of values that were judged */
static size_t judge(const taylor_case *c, const program *p, size_t lane, const double *x) {
  mpfr_t v[VARIABLES + 1 + STEPS];
  bool known[VARIABLES + 1 + STEPS];
  double size = 1;
  size_t judged = 0;
  uint32_t slots = p->nvar + 1 + p->steps;
  for (uint32_t s = 0; s < slots; s++) mpfr_init2(v[s], TAYLOR_BITS), known[s] = true;
  for (uint32_t s = 0; s < p->nvar; s++) {
    mpfr_set_d(v[s], p->rad[lane][s], MPFR_RNDN);
    mpfr_mul_d(v[s], v[s], x[s], MPFR_RNDN), mpfr_add_d(v[s], v[s], p->mid[lane][s], MPFR_RNDN);
  }
  mpfr_set_d(v[p->nvar], 0.75, MPFR_RNDN);
  for (uint32_t i = 0; i < p->steps; i++) {
    uint32_t s = p->nvar + 1 + i, b = p->op[i] == AMBIT_OP_POWN ? p->a[i] : p->b[i];
    known[s] = known[p->a[i]] && known[b] && taylor_judge(p->op[i], v[s], v[p->a[i]], v[b], (int32_t)p->b[i]);
    if (!known[s]) continue;
    size = fmax(size, fabs(mpfr_get_d(v[s], MPFR_RNDA)));
    if (size > 1e200) known[s] = false; /* the judge has no bits left */
    if (!known[s]) continue;
    judged++;
    if (taylor_holds(c, taylor_at(c, s, lane), x, v[s], 1e-40 / size)) continue;
    describe(p, lane, x);
    double lo, hi;
    c->a->bounds(c->ctx, taylor_at(c, s, lane), 1, &lo, &hi);
    mpfr_t poly;
    mpfr_init2(poly, TAYLOR_BITS), taylor_value(c, taylor_at(c, s, lane), x, poly);
    fail_msg("order %u, lane %zu, slot %u (%s): %.17g is not %.17g +- %g in [%.17g, %.17g]", p->order, lane, s,
        op_name[p->op[i]], mpfr_get_d(v[s], MPFR_RNDN), mpfr_get_d(poly, MPFR_RNDN),
        c->t->remainder(c->ctx, taylor_at(c, s, lane)), lo, hi);
  }
  for (uint32_t s = 0; s < slots; s++) mpfr_clear(v[s]);
  return judged;
}

/* Never wider than intervals: each operation also goes through the kernel's interval function. */
static void compare_with_intervals(const taylor_case *c, const program *p, size_t lane) {
  ambit_interval x[VARIABLES + 1 + STEPS];
  for (uint32_t v = 0; v < p->nvar; v++)
    x[v] = (ambit_interval) { p->mid[lane][v] - p->rad[lane][v], p->mid[lane][v] + p->rad[lane][v] };
  x[p->nvar] = (ambit_interval) { 0.75, 0.75 };
  for (uint32_t i = 0; i < p->steps; i++) {
    uint32_t s = p->nvar + 1 + i;
    double lo, hi;
    if (p->op[i] == AMBIT_OP_POWN)
      ambit_interval_pown(&x[s], x[p->a[i]], (int32_t)p->b[i]);
    else
      ambit_interval_op(p->op[i], &x[s], x[p->a[i]], x[p->b[i]]);
    c->a->bounds(c->ctx, taylor_at(c, s, lane), 1, &lo, &hi);
    /* elementary functions of nested intervals are nested up to the last bits, which later operations amplify */
    double room = 1e-9 * (fabs(x[s].lo) + fabs(x[s].hi));
    if (lo <= hi && !ambit_interval_is_empty(x[s]) && isfinite(room) && (lo < x[s].lo - room || hi > x[s].hi + room)) {
      describe(p, lane, p->mid[lane]);
      fail_msg("slot %u (%s): [%.17g, %.17g], with intervals [%.17g, %.17g]", s, op_name[p->op[i]], lo, hi, x[s].lo,
          x[s].hi);
    }
  }
}

static void run_program(const taylor_case *c, const program *p) {
  const double constant = 0.75;
  for (size_t l = 0; l < c->lanes; l++) {
    for (uint32_t v = 0; v < p->nvar; v++) {
      double lo = p->mid[l][v] - p->rad[l][v], hi = p->mid[l][v] + p->rad[l][v];
      c->a->set(c->ctx, taylor_at(c, v, l), 1, &lo, &hi, (int32_t)v);
    }
    c->a->set(c->ctx, taylor_at(c, p->nvar, l), 1, &constant, &constant, -1);
  }
  for (uint32_t i = 0; i < p->steps; i++) taylor_run(c, p->op[i], p->nvar + 1 + i, p->a[i], p->b[i]);
}

static void programs(void **state) {
  (void)state;
  uint64_t random = 271828;
  size_t judged = 0;
  for (int round = 0; round < 1500; round++) {
    program p = any_program(&random);
    taylor_case c;
    taylor_open(&c, round % 3, p.nvar, p.order, p.nvar + 1 + p.steps, 1 + oracle_random(&random) % LANES_MAX);
    run_program(&c, &p);
    for (size_t l = 0; l < c.lanes; l++) compare_with_intervals(&c, &p, l);
    for (int sample = 0; sample < 3; sample++)
      for (size_t l = 0; l < c.lanes; l++) {
        double x[VARIABLES];
        for (uint32_t v = 0; v < p.nvar; v++)
          x[v] = sample == 0 ? (oracle_random(&random) % 2 ? 1 : -1)
                             : ldexp((double)(oracle_random(&random) % 129) - 64, -6);
        judged += judge(&c, &p, l, x);
      }
    taylor_close(&c);
  }
  assert_true(judged > 100000);
}

/* -- one operation at a time, high orders, all kinds of ranges */

static void single(
    const taylor_case *c, uint32_t op, int32_t n, double mid, double rad, double other, uint64_t *random) {
  program p = { .nvar = 2, .order = c->order, .steps = 3 };
  p.op[0] = op, p.a[0] = 0, p.b[0] = op == AMBIT_OP_POWN ? (uint32_t)n : op_arity[op] == 2 ? 1 : 0;
  p.op[1] = AMBIT_OP_SUB, p.a[1] = 3, p.b[1] = 0; /* what cancels shows whether the dependence is right */
  p.op[2] = op, p.a[2] = 1, p.b[2] = op == AMBIT_OP_POWN ? (uint32_t)n : op_arity[op] == 2 ? 0 : 1;
  p.mid[0][0] = mid, p.rad[0][0] = rad, p.mid[0][1] = other, p.rad[0][1] = rad / 2;
  run_program(c, &p);
  for (int sample = 0; sample < 7; sample++) {
    double x[2];
    for (int v = 0; v < 2; v++)
      x[v] = sample < 2 ? 2 * sample - 1 : ldexp((double)(oracle_random(random) % 129) - 64, -6);
    judge(c, &p, 0, x);
  }
}

static void operations(void **state) {
  (void)state;
  static const uint32_t orders[] = { 0, 1, 2, 3, 5, 8, 13, 20 };
  static const double thickness[] = { 0, 0x1p-40, 0x1p-20, 0x1p-8, 0.125, 0.5, 0.875, 1, 2 };
  uint64_t random = 314159;
  for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
    taylor_case c;
    taylor_open(&c, (int)(o % 3), 2, orders[o], 6, 1);
    for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
      for (size_t k = 0; k < sizeof thickness / sizeof *thickness; k++)
        for (int round = 0; round < 12; round++) {
          double mid = few_bits(&random, (int)(oracle_random(&random) % 6) - 2), other = few_bits(&random, 1);
          double size = round % 2 ? fabs(mid) : 1; /* relative or absolute */
          single(&c, op, (int32_t)(oracle_random(&random) % 40) - 12, mid, size * thickness[k], other, &random);
        }
    taylor_close(&c);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(programs),
    cmocka_unit_test(operations),
  };
  return cmocka_run_group_tests_name("Taylor models at points", tests, NULL, NULL);
}
