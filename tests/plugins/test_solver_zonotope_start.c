/* The set at the start of a run with many data, before and after they are put in another order: it holds the values of
** the initial tape, and wants no more data than there is room for.
*/
#include "zonotope_case.h"

#define DATA 50
#define STATES 6
#define LATE 2 /* states of which data that come last in the first order are factors */

/* each state a product of three data: triples are held for the first data only */
static const uint32_t factor[STATES][3] = { { 0, 1, 2 }, { 47, 48, 49 }, { 3, 4, 5 }, { 44, 45, 46 }, { 1, 3, 5 },
  { 0, 2, 4 } };

typedef struct start_case {
  zono z;
  maker k;
  double lo[DATA], hi[DATA], time[2];
} start_case;

static void open_start(start_case *c) {
  make_empty(&c->k, 1, DATA, 0, 0);
  c->k.lo[0] = c->k.hi[0] = 1;
  c->k.tape.nin = DATA, c->k.tape.nout = STATES;
  for (uint32_t i = 0; i < STATES; i++) {
    uint32_t pair = put(&c->k, AMBIT_OP_MUL, 1 + factor[i][0], 1 + factor[i][1]);
    c->k.out[i] = put(&c->k, AMBIT_OP_MUL, pair, 1 + factor[i][2]);
  }
  c->k.tape.nslot = 1 + DATA + c->k.tape.ninstr;
  for (uint32_t u = 0; u < DATA; u++) c->lo[u] = draw(0.5, 1), c->hi[u] = c->lo[u] + draw(0.1, 0.5);
  c->z = (zono) { .host = &host, .nx = STATES };
  c->z.problem.initial = &c->k.tape, c->z.problem.nx = STATES, c->z.problem.nu = DATA;
  c->z.problem.u_lo = c->lo, c->z.problem.u_hi = c->hi, c->z.problem.time = c->time;
}

/* but for as much as data of their own and errors let them */
static void holds_products(const start_case *c) {
  const zono *z = &c->z;
  for (int turn = 0; turn < 200; turn++) {
    long double u[DATA];
    point p = { .s = 0 };
    for (uint32_t i = 0; i < DATA; i++) u[i] = c->lo[i] + (c->hi[i] - c->lo[i]) * (pick(4) ? pick(2) : draw(0, 1));
    for (uint32_t j = 0; j < DATA; j++) p.xi[j] = (u[z->unknown[j]] - z->about[j]) / z->scale[j];
    for (uint32_t i = 0; i < STATES; i++) {
      const double *row = z->start + (size_t)i * z->shape.stride;
      long double exact = u[factor[i][0]] * u[factor[i][1]] * u[factor[i][2]], off = z->start_rad[i];
      for (uint32_t j = DATA; j < z->m; j++) off += fabs(row[1 + j]);
      assert_true(off < 0.05 && fabsl(exact - value_at(&z->shape, row, &p)) <= off + 1e-18L);
    }
  }
}

static uint32_t count_own(const zono *z, uint32_t state) {
  uint32_t n = 0;
  for (uint32_t j = DATA; j < z->m; j++) n += z->start[(size_t)state * z->shape.stride + 1 + j] != 0;
  return n;
}

static void another_order_gets_no_more_data(void **unused) {
  (void)unused;
  for (int turn = 0; turn < 20; turn++) {
    start_case c;
    double weight[DATA];
    open_start(&c);
    assert_int_equal(AMBIT_OK, zono_start_open(&c.z, NULL));
    assert_int_equal(DATA + LATE, c.z.m);
    assert_true(count_own(&c.z, 1) == 1 && count_own(&c.z, 3) == 1);
    holds_products(&c);
    uint32_t room = c.z.m;
    for (uint32_t u = 0; u < DATA; u++) weight[u] = u < 6 ? draw(0, 1) : draw(1, 2); /* what came first is last */
    assert_int_equal(AMBIT_OK, zono_start_open(&c.z, weight));
    assert_int_equal(room, c.z.m);
    uint32_t errors = 0;
    for (uint32_t i = 0; i < STATES; i++) errors += c.z.start_rad[i] > 1e-6;
    assert_true(errors >= STATES - LATE - LATE);
    holds_products(&c);
    give_back();
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(another_order_gets_no_more_data) };
  return cmocka_run_group_tests_name("solver zonotope start", tests, NULL, NULL);
}
