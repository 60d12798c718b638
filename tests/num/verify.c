/* verify.c -- checks enclosures against MPFR and exact rounding errors for as long as it is told:
**
**     verify CHECKS [SEED] [PLUGIN] [-j THREADS]        e.g.  verify 1e9 1 interval -j 4
**
** Every opcode of the kernel's interval functions, or of the arithmetic plugin PLUGIN (found on AMBIT_PATH), on random
** and nasty points and intervals. Prints for each function the checks, the violations (a bound that misses the image,
** or is NaN), the fraction of tightest results and the greatest excess of a bound in doubles. Exit status: 1 if there
** is a violation, with its operands in hexadecimal; 2 for bad usage. The checks depend on CHECKS and SEED only.
*/
#include "verify_operands.h"
#include "verify_subject.h"
#include <pthread.h>

#define SHOWN 20 /* violations printed */
#define THREADS_MOST 64

static const char *const op_name[] = {
#define NAME(name, arity, symbol) #name,
  AMBIT_OPS(NAME)
#undef NAME
};

typedef struct tally {
  uint64_t checks, violations, tightest, excess; /* excess: doubles between a bound and the tightest one */
} tally;

typedef struct worker {
  pthread_t thread;
  const char *plugin;
  char trouble[1024]; /* what went wrong, or nothing */
  uint64_t first, step, blocks, seed;
  tally by_op[AMBIT_OP_COUNT];
} worker;

static pthread_mutex_t printing = PTHREAD_MUTEX_INITIALIZER;
static int shown;

static void show(uint32_t op, int32_t n, const ambit_interval x[4]) {
  pthread_mutex_lock(&printing);
  if (shown++ < SHOWN)
    fprintf(stderr, "violation: %s [%a, %a] [%a, %a] n = %d: [%a, %a] does not enclose [%a, %a]\n", op_name[op],
        x[0].lo, x[0].hi, x[1].lo, x[1].hi, (int)n, x[2].lo, x[2].hi, x[3].lo, x[3].hi);
  pthread_mutex_unlock(&printing);
}

/* doubles in ascending order as integers */
static int64_t rank(double x) {
  int64_t i;
  memcpy(&i, &x, sizeof i);
  return i < 0 ? INT64_MIN - i : i;
}
static uint64_t distance(double low, double high) { return (uint64_t)rank(high) - (uint64_t)rank(low); }

static void judge(tally *t, uint32_t op, int32_t n, ambit_interval a, ambit_interval b, ambit_interval got) {
  ambit_interval want = AMBIT_EMPTY;
  if (!ambit_interval_is_empty(a) && !ambit_interval_is_empty(b)) want = image(op, a, b, n);
  bool nothing = ambit_interval_is_empty(want);
  t->checks++;
  if (isnan(got.lo) || isnan(got.hi) || (!nothing && !(got.lo <= want.lo && want.hi <= got.hi))) {
    t->violations++;
    show(op, n, (const ambit_interval[4]) { a, b, got, want });
    return;
  }
  if (nothing) {
    t->tightest += ambit_interval_is_empty(got);
    return;
  }
  uint64_t low = distance(got.lo, want.lo), high = distance(want.hi, got.hi), most = low > high ? low : high;
  t->tightest += most == 0;
  if (most > t->excess) t->excess = most;
}

/* SplitMix64 (Steele, Lea, Flood, 2014): an independent start for each block; not 0 for xorshift */
static uint64_t start_of(uint64_t seed, uint64_t block) {
  uint64_t z = seed + (block + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return z ? z : 1;
}

static void check_block(worker *w, verify_subject *v, uint64_t block) {
  uint32_t op = (uint32_t)(block % AMBIT_OP_COUNT);
  uint64_t s = start_of(w->seed, block);
  ambit_interval a[VERIFY_LANES], b[VERIFY_LANES], r[VERIFY_LANES];
  int32_t n = any_exponent(&s);
  for (int i = 0; i < VERIFY_LANES; i++) {
    a[i] = any_interval(op, n, &s);
    b[i] = second_interval(op, a[i], &s);
    if (random_below(&s, 512) == 0) a[i] = AMBIT_EMPTY;
  }
  verify_run(v, op, r, a, b, n);
  for (int i = 0; i < VERIFY_LANES; i++) judge(&w->by_op[op], op, n, a[i], b[i], r[i]);
}

static void *work(void *argument) {
  worker *w = argument;
  verify_subject v;
  const char *trouble = verify_open(&v, w->plugin);
  for (uint64_t block = w->first; !trouble && block < w->blocks; block += w->step) check_block(w, &v, block);
  if (trouble)
    snprintf(w->trouble, sizeof w->trouble, "%s", trouble); /* the original may end with the thread */
  else
    verify_close(&v);
  mpfr_free_cache();
  return NULL;
}

static void print_row(const char *name, tally t) {
  printf("%-8s %14llu %11llu %13.4f %% %14.6g\n", name, (unsigned long long)t.checks, (unsigned long long)t.violations,
      t.checks ? 100 * (double)t.tightest / (double)t.checks : 0, (double)t.excess);
}

/* the number of violations */
static uint64_t report(const worker *w, int threads) {
  tally all = { 0 };
  printf("%-8s %14s %11s %15s %14s\n", "", "checks", "violations", "tightest", "excess, ulp");
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    tally sum = { 0 };
    for (int i = 0; i < threads; i++) {
      const tally *t = &w[i].by_op[op];
      sum.checks += t->checks, sum.violations += t->violations, sum.tightest += t->tightest;
      if (t->excess > sum.excess) sum.excess = t->excess;
    }
    print_row(op_name[op], sum);
    all.checks += sum.checks, all.violations += sum.violations, all.tightest += sum.tightest;
    if (sum.excess > all.excess) all.excess = sum.excess;
  }
  print_row("all", all);
  return all.violations;
}

static int run(double checks, uint64_t seed, const char *plugin, int threads) {
  static worker w[THREADS_MOST];
  uint64_t blocks = (uint64_t)ceil(checks / VERIFY_LANES);
  int started = 0;
  for (; started < threads; started++) {
    w[started] = (worker) {
      .plugin = plugin, .first = (uint64_t)started, .step = (uint64_t)threads, .blocks = blocks, .seed = seed
    };
    if (pthread_create(&w[started].thread, NULL, work, &w[started])) break;
  }
  for (int i = 0; i < started; i++) pthread_join(w[i].thread, NULL);
  if (started < threads) {
    fprintf(stderr, "verify: no thread number %d\n", started + 1);
    return 2;
  }
  for (int i = 0; i < threads; i++)
    if (*w[i].trouble) {
      fprintf(stderr, "verify: %s: %s\n", plugin, w[i].trouble);
      return 2;
    }
  return report(w, threads) ? 1 : 0;
}

int main(int argc, char **argv) {
  const char *word[3] = { NULL, "1", NULL };
  int words = 0, threads = 1;
  bool sound = true;
  for (int i = 1; i < argc; i++) {
    if (strcmp(argv[i], "-j") == 0 && i + 1 < argc)
      threads = atoi(argv[++i]);
    else if (words < 3)
      word[words++] = argv[i];
    else
      sound = false;
  }
  char *end = NULL, *seed_end = NULL;
  double checks = word[0] ? strtod(word[0], &end) : 0;
  uint64_t seed = strtoull(word[1], &seed_end, 10);
  if (!sound || !(checks >= 1 && checks <= 1e15) || *end || *seed_end || threads < 1 || threads > THREADS_MOST ||
      (threads > 1 && !mpfr_buildopt_tls_p())) {
    fprintf(stderr, "usage: verify CHECKS [SEED] [PLUGIN] [-j THREADS]    e.g. verify 1e9 1 interval -j 4\n");
    return 2;
  }
  ambit_registry *registry = ambit_registry_open(NULL); /* brings the slow path of the elementary functions */
  int status = run(checks, seed, word[2], threads);
  ambit_registry_close(registry);
  return status;
}
