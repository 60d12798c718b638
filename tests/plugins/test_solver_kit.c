/* The kit of solvers notices records whose dense enclosure or set is wrong: lohner's records, spoilt on their way. */
#include "solver_case.h"
#include <math.h>

enum spoil {
  NOTHING,
  DENSE_MOVED,
  DENSE_SHARP,
  DENSE_NAN,
  DENSE_MISSING,
  SET_MOVED,
  SET_TURNED,
  SET_SHARP,
  SET_WIDE,
  SET_UNKNOWNS,
  SET_MISSING,
  SPOILS
};

#define TERMS 512

typedef struct liar {
  ambit_sink sink; /* first */
  ambit_sink *outer;
} liar;

static enum spoil kind;
static const ambit_solver *honest;

/* a record with some entries changed; copies live until the record is judged */
typedef struct copy {
  ambit_record r;
  ambit_set set;
  double mid[TERMS], rad[TERMS], coefficient[TERMS], rest[TERMS];
} copy;

static void spoil_dense(copy *c) {
  if (!c->r.dense_mid) return;
  size_t n = (size_t)c->r.nx * c->r.ndense;
  assert_true(n <= TERMS);
  memcpy(c->mid, c->r.dense_mid, n * sizeof(double));
  memcpy(c->rad, c->r.dense_rad, n * sizeof(double));
  c->r.dense_mid = c->mid, c->r.dense_rad = c->rad;
  if (kind == DENSE_MOVED) c->mid[0] += 1e-3 + 2 * c->rad[0];
  if (kind == DENSE_SHARP) memset(c->rad, 0, sizeof c->rad);
  if (kind == DENSE_NAN) c->rad[n - 1] = NAN;
  if (kind == DENSE_MISSING) c->r.dense_mid = c->r.dense_rad = NULL, c->r.ndense = 0;
}

static void spoil_set(copy *c) {
  if (!c->r.set) return;
  c->set = *c->r.set;
  uint32_t nx = c->r.nx, nterm = c->set.nterm;
  assert_true(nx * nterm <= TERMS);
  memcpy(c->coefficient, c->set.coefficient, nx * nterm * sizeof(double));
  memcpy(c->rest, c->set.rest, nx * sizeof(double));
  c->r.set = &c->set, c->set.coefficient = c->coefficient, c->set.rest = c->rest;
  if (kind == SET_MOVED) c->coefficient[0] += 1e-3 + 2 * c->rest[0];
  if (kind == SET_TURNED && nterm > 1) c->coefficient[1] = -c->coefficient[1];
  if (kind == SET_SHARP) c->rest[0] = 0;
  if (kind == SET_WIDE) c->rest[0] += 1 + c->r.hi[0] - c->r.lo[0];
  if (kind == SET_UNKNOWNS) c->set.nu++;
  if (kind == SET_MISSING) c->r.set = NULL;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  static copy c;
  liar *l = (liar *)(void *)s;
  c.r = *r;
  spoil_dense(&c);
  spoil_set(&c);
  return l->outer->emit(l->outer, &c.r);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  liar *l = (liar *)(void *)s;
  return l->outer->progress(l->outer, done, message);
}

static ambit_status run(void *self, ambit_sink *sink) {
  liar l = { { sizeof l.sink, emit, progress }, sink };
  return honest->run(self, &l.sink);
}

static void what_is_spoilt_is_found(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "lohner", "interval");
  honest = c.kit.plugin;
  ambit_solver spoilt = *honest;
  spoilt.run = run;
  c.kit.plugin = &spoilt;
  c.kit.gives = AMBIT_WISH_DENSE | AMBIT_WISH_SET;
  for (kind = NOTHING; kind < SPOILS; kind++) {
    c.kit.finding = kind == NOTHING ? case_show : case_hide;
    /* few terms, so that remainders and rests are more than rounding */
    size_t findings = case_findings(&c, "tolerance", "1e-9");
    if ((kind == NOTHING) != (findings == 0)) fail_msg("spoilt in way %d: %zu findings", (int)kind, findings);
  }
  case_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(what_is_spoilt_is_found) };
  return cmocka_run_group_tests_name("solver kit", tests, NULL, NULL);
}
