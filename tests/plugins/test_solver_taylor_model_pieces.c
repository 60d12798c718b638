/* Every piece is followed in upward mode, in whatever mode the thread is that follows it, which finds its own again. */
#define flow_step seen_step
#define flow_hull seen_hull
#include "solver/taylor_model/pieces.c"
#include <fenv.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

/* as arithmetic has it: the mode of the x87 unit is another */
static int mode(void) {
  volatile double one = 1, tiny = 0x1p-60;
  volatile double up = one + tiny, down = -one - tiny;
  return up > 1 ? FE_UPWARD : down < -1 ? FE_DOWNWARD : FE_TONEAREST;
}

static int modes[2];

enum why seen_step(worker *w, piece *p, double t) {
  (void)w;
  modes[0] = mode();
  p->t = t;
  return WHY_NOTHING;
}

void seen_hull(worker *w, piece *p) {
  (void)w, (void)p;
  modes[1] = mode();
}

static void pieces_are_followed_in_upward_mode(void **unused) {
  (void)unused;
  static const int own[] = { FE_TONEAREST, FE_DOWNWARD, FE_UPWARD };
  for (size_t k = 0; k < sizeof own / sizeof *own; k++) {
    piece p = { .t = 0 };
    uint32_t todo = 0;
    flow f = { .t_to = 1, .piece = &p, .todo = &todo, .pool = (ambit_pool *)&todo }; /* whose owner asks */
    worker w = { .flow = &f };
    f.worker = &w, modes[0] = modes[1] = -1;
    fesetround(own[k]);
    ambit_status status = job(&f, 0, 0);
    int after = mode();
    fesetround(FE_TONEAREST);
    assert_int_equal(status, AMBIT_OK);
    assert_int_equal(after, own[k]);
    assert_int_equal(modes[0], FE_UPWARD);
    assert_int_equal(modes[1], FE_UPWARD);
    assert_true(p.done && p.t == 1);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(pieces_are_followed_in_upward_mode) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
