/* The tables of the Taylor-model plugin: they stay in the room that the formula says, products add exponents, and the
** rows contain every product of coefficients once. */
#include "arithmetic/taylor_model/monomials.c"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#define GUARD 64

static const uint32_t shapes[][2] = { { 0, 0 }, { 0, 5 }, { 1, 0 }, { 1, 1 }, { 1, 7 }, { 1, 60 }, { 2, 3 }, { 2, 20 },
  { 3, 6 }, { 4, 6 }, { 5, 5 }, { 6, 4 }, { 12, 3 }, { 20, 3 }, { 60, 2 }, { 200, 1 } };

static void *lay(monomials *m, uint32_t nvar, uint32_t order) {
  size_t bytes = (size_t)monomials_bytes(nvar, order);
  char *room = malloc(bytes + GUARD);
  assert_non_null(room);
  memset(room, 0x5a, bytes + GUARD);
  monomials_lay(m, nvar, order, room);
  for (size_t i = 0; i < GUARD; i++) assert_int_equal(room[bytes + i], 0x5a);
  return room;
}

static void products_add_exponents(void **state) {
  (void)state;
  for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
    monomials m;
    uint32_t x[256], y[256];
    void *room = lay(&m, shapes[s][0], shapes[s][1]);
    for (uint32_t i = 0; i < m.count; i += 1 + m.count / 97)
      for (uint32_t j = 0; j < m.first[m.order - m.degree[i] + 1u]; j++) {
        monomials_exponents(&m, i, x), monomials_exponents(&m, j, y);
        for (uint32_t v = 0; v < m.nvar; v++) x[v] += y[v];
        assert_int_equal(monomials_product(&m, i, j), monomials_index(&m, x));
      }
    free(room);
  }
}

static void knows_squares_and_terms(void **state) {
  (void)state;
  for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
    monomials m;
    uint32_t x[256];
    void *room = lay(&m, shapes[s][0], shapes[s][1]);
    double most[MONOMIALS_ORDER_MAX + 1] = { 0 };
    for (uint32_t i = 0; i < m.count; i++) {
      uint32_t odd = 0;
      double divisors = 1;
      monomials_exponents(&m, i, x);
      for (uint32_t v = 0; v < m.nvar; v++) odd |= x[v] % 2, divisors *= x[v] + 1.0;
      assert_int_equal(m.odd[i] != 0, odd);
      if (divisors > most[m.degree[i]]) most[m.degree[i]] = divisors;
    }
    for (uint32_t q = 0; q <= m.order; q++) assert_true(m.terms[q] == most[q]);
    free(room);
  }
}

/* rows multiplied one by one, with integers, against the table */
static void rows_are_products(void **state) {
  (void)state;
  for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
    monomials m;
    void *room = lay(&m, shapes[s][0], shapes[s][1]);
    const monomial_rows *r = &m.rows;
    size_t packed = r->count ? r->packed + m.order + 1u : 1;
    double *a = calloc(packed, sizeof *a), *want = calloc(m.count, sizeof *want);
    assert_true(a && want);
    for (uint32_t i = 0; i < m.count; i++)
      for (uint32_t j = 0; j < m.first[m.order - m.degree[i] + 1u]; j++)
        want[monomials_product(&m, i, j)] += (i % 7 + 1.0) * (j % 7 + 1.0);
    for (uint32_t i = 0; i < m.count && r->count; i++) a[r->place[i]] = i % 7 + 1.0;
    for (uint32_t t = 0; t < r->count; t++)
      for (uint32_t k = 0; k <= m.order - r->degree[t]; k++) {
        double sum = 0;
        for (uint32_t p = r->pairs[t]; p < r->pairs[t + 1]; p++)
          for (uint32_t i = 0; i <= k; i++) sum += a[r->pair[p].left + i] * a[r->pair[p].right + k - i];
        assert_true(sum == want[r->index[r->item[t] + k]]);
      }
    free(a), free(want), free(room);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(products_add_exponents),
    cmocka_unit_test(knows_squares_and_terms),
    cmocka_unit_test(rows_are_products),
  };
  return cmocka_run_group_tests_name("monomials", tests, NULL, NULL);
}
