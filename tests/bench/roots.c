/* roots.c -- the root finder's operators on standard test systems: boxes looked at and CPU seconds, in one run.
**
** Systems as in Van Hentenryck, McAllester & Kapur, SIAM J. Numer. Anal. 34 (1997), Neumaier 1990, More, Garbow &
** Hillstrom, ACM TOMS 7 (1981). That what is proved is true is tested elsewhere
** (tests/plugins/test_solver_krawczyk*.c). Needs AMBIT_PATH to find the plugins. roots [NAME [OPTION=VALUE ...]]: only
** the system of that name, with options of the solver.
*/
#define _POSIX_C_SOURCE 200809L
#include <ambit/roots.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define UNKNOWNS 32
#define OPTIONS 8
#define REPEATS 3

typedef struct system {
  ambit_graph *g;
  size_t n;
  ambit_expr x[UNKNOWNS], f[UNKNOWNS];
  ambit_interval box[UNKNOWNS];
  char text[UNKNOWNS][8];
  const char *name[UNKNOWNS];
} system_of;

/* -- expressions: a sum of products is written as sum(s, sum(s, a, b), times(s, c, d)) */

static ambit_expr num(system_of *s, double c) { return ambit_graph_number(s->g, c); }
static ambit_expr sum(system_of *s, ambit_expr a, ambit_expr b) { return ambit_graph_op(s->g, AMBIT_OP_ADD, a, b); }
static ambit_expr less(system_of *s, ambit_expr a, ambit_expr b) { return ambit_graph_op(s->g, AMBIT_OP_SUB, a, b); }
static ambit_expr times(system_of *s, ambit_expr a, ambit_expr b) { return ambit_graph_op(s->g, AMBIT_OP_MUL, a, b); }
static ambit_expr apply(system_of *s, uint32_t op, ambit_expr a) { return ambit_graph_op(s->g, op, a, a); }
static ambit_expr sqr(system_of *s, ambit_expr a) { return apply(s, AMBIT_OP_SQR, a); }
static ambit_expr scaled(system_of *s, double c, ambit_expr a) { return times(s, num(s, c), a); }

/* c prod of n unknowns by number, from 1 */
static ambit_expr term(system_of *s, double c, size_t n, const int *which) {
  ambit_expr t = num(s, c);
  for (size_t i = 0; i < n; i++) t = times(s, t, s->x[which[i] - 1]);
  return t;
}

static void begin(system_of *s, size_t n, double lo, double hi) {
  s->n = n;
  for (size_t i = 0; i < n; i++) {
    snprintf(s->text[i], sizeof s->text[i], "x%zu", i + 1);
    s->name[i] = s->text[i];
    s->x[i] = ambit_graph_symbol(s->g, s->text[i], "1");
    s->box[i] = (ambit_interval) { lo, hi };
  }
}

/* -- systems */

/* x_(i-1), x_i or x_(i+1); 0 beyond the ends */
static ambit_expr neighbour(system_of *s, size_t i, int step) {
  if ((step < 0 && i == 0) || (step > 0 && i + 1 == s->n)) return num(s, 0);
  return s->x[(size_t)((long)i + step)];
}

/* More, Garbow & Hillstrom 30 */
static void broyden(system_of *s) {
  begin(s, 16, -2, 2);
  for (size_t i = 0; i < s->n; i++) {
    ambit_expr own = times(s, less(s, num(s, 3), scaled(s, 2, s->x[i])), s->x[i]);
    s->f[i] = sum(s, less(s, less(s, own, neighbour(s, i, -1)), scaled(s, 2, neighbour(s, i, 1))), num(s, 1));
  }
}

/* Moore & Jones 1977, as "i1" of Van Hentenryck & al. */
static void moore_jones(system_of *s) {
  static const double constant[] = { 0.25428722, 0.37842197, 0.27162577, 0.19807914, 0.44166728, 0.14654113, 0.42937161,
    0.07056438, 0.34504906, 0.42651102 },
                      factor[] = { 0.18324757, 0.16275449, 0.16955071, 0.15585316, 0.19950920, 0.18922793, 0.21180486,
                        0.17081208, 0.19612740, 0.21466544 };
  static const int which[][3] = { { 4, 3, 9 }, { 1, 10, 6 }, { 1, 2, 10 }, { 7, 1, 6 }, { 7, 6, 3 }, { 8, 5, 10 },
    { 2, 5, 8 }, { 1, 7, 6 }, { 10, 6, 8 }, { 4, 8, 1 } };
  begin(s, 10, -2, 2);
  for (size_t i = 0; i < 10; i++)
    s->f[i] = less(s, less(s, s->x[i], num(s, constant[i])), term(s, factor[i], 3, which[i]));
}

/* the inverse kinematics of a PUMA robot, Tsai & Morgan 1985; 16 roots */
static void puma(system_of *s) {
  begin(s, 8, -1, 1);
  for (size_t i = 0; i < 4; i++) s->f[i] = less(s, sum(s, sqr(s, s->x[2 * i]), sqr(s, s->x[2 * i + 1])), num(s, 1));
  ambit_expr *x = s->x, a = times(s, x[0], x[2]), b = times(s, x[1], x[2]);
  s->f[4] = sum(s, less(s, scaled(s, 0.004731, a), scaled(s, 0.3578, b)), less(s, x[6], scaled(s, 0.1238, x[0])));
  s->f[4] = less(s, less(s, s->f[4], scaled(s, 0.001637, x[1])), sum(s, scaled(s, 0.9338, x[3]), num(s, 0.3571)));
  s->f[5] = sum(s, sum(s, scaled(s, 0.2238, a), scaled(s, 0.7623, b)), less(s, scaled(s, 0.2638, x[0]), x[6]));
  s->f[5] = less(s, less(s, s->f[5], scaled(s, 0.07745, x[1])), sum(s, scaled(s, 0.6734, x[3]), num(s, 0.6022)));
  s->f[6] = sum(s, times(s, x[5], x[7]), sum(s, scaled(s, 0.3578, x[0]), scaled(s, 0.004731, x[1])));
  s->f[7] = sum(s, less(s, scaled(s, 0.2238, x[1]), scaled(s, 0.7623, x[0])), num(s, 0.3461));
}

/* combustion of propane, Meintjes & Morgan 1990: one positive root */
static void chemistry(system_of *s) {
  static const double R = 10, R5 = 0.193, R6 = 4.10622e-4, R7 = 5.45177e-4, R8 = 4.4975e-7, R9 = 3.40735e-5,
                      R10 = 9.615e-7;
  begin(s, 5, 1e-5, 100);
  static const int x12[] = { 1, 2 }, x2[] = { 2 }, x22[] = { 2, 2 }, x233[] = { 2, 3, 3 }, x23[] = { 2, 3 },
                   x24[] = { 2, 4 }, x33[] = { 3, 3 }, x3[] = { 3 }, x44[] = { 4, 4 };
  ambit_expr *x = s->x, base = sum(s, term(s, 1, 2, x12), x[0]);
  ambit_expr mixed = sum(s, term(s, R7, 2, x23), sum(s, term(s, R9, 2, x24), term(s, R8, 1, x2)));
  s->f[0] = less(s, base, scaled(s, 3, x[4]));
  s->f[1] = sum(s, sum(s, term(s, 2, 2, x12), x[0]), sum(s, term(s, 3 * R10, 2, x22), term(s, 1, 3, x233)));
  s->f[1] = less(s, sum(s, s->f[1], mixed), scaled(s, R, x[4]));
  s->f[2] =
      sum(s, sum(s, term(s, 2, 3, x233), term(s, R7, 2, x23)), sum(s, term(s, 2 * R5, 2, x33), term(s, R6, 1, x3)));
  s->f[2] = less(s, s->f[2], scaled(s, 8, x[4]));
  s->f[3] = less(s, sum(s, term(s, R9, 2, x24), term(s, 2, 2, x44)), scaled(s, 4 * R, x[4]));
  s->f[4] = sum(s, sum(s, base, term(s, R10, 2, x22)), sum(s, term(s, 1, 3, x233), mixed));
  s->f[4] = sum(s, s->f[4], sum(s, term(s, R5, 2, x33), sum(s, term(s, R6, 1, x3), term(s, 1, 2, x44))));
  s->f[4] = less(s, s->f[4], num(s, 1));
}

/* Verschelde, Verlinden & Cools 1994, with the right-hand sides that x1..x6 = .6 .8 .8 .6 .5 .25 gives */
static void neurophysiology(system_of *s) {
  static const int third[] = { 3, 1 },
                   fourth[] = { 4, 2 }; /* of rows 3 to 6: the powers are split 3-0, 0-3, 1-2, 2-1 */
  static const double at[] = { 0.6, 0.8, 0.8, 0.6, 0.5, 0.25 };
  static const int power[][2] = { { 3, 0 }, { 0, 3 }, { 2, 1 }, { 1, 2 } };
  begin(s, 6, -2, 2);
  s->f[0] = less(s, sum(s, sqr(s, s->x[0]), sqr(s, s->x[2])), num(s, 1));
  s->f[1] = less(s, sum(s, sqr(s, s->x[1]), sqr(s, s->x[3])), num(s, 1));
  for (size_t r = 0; r < 4; r++) {
    int a[4] = { 5 }, b[4] = { 6 };
    double value_a = at[4], value_b = at[5];
    for (int i = 0; i < 3; i++) {
      int second = i >= power[r][0];
      a[i + 1] = third[second], b[i + 1] = fourth[second];
      value_a *= at[a[i + 1] - 1], value_b *= at[b[i + 1] - 1];
    }
    s->f[r + 2] = less(s, sum(s, term(s, 1, 4, a), term(s, 1, 4, b)), num(s, value_a + value_b));
  }
}

/* Morgan 1987: (x_k + sum x_i x_(i+k)) x_n = c_k, sum x = -1 */
static void economics(system_of *s) {
  begin(s, 5, -100, 100);
  size_t n = s->n;
  ambit_expr all = num(s, 1);
  for (size_t k = 0; k + 1 < n; k++) {
    ambit_expr inner = s->x[k];
    for (size_t i = 0; i + k + 2 < n; i++) inner = sum(s, inner, times(s, s->x[i], s->x[i + k + 1]));
    s->f[k] = less(s, times(s, inner, s->x[n - 1]), num(s, (double)k + 1));
    all = sum(s, all, s->x[k]);
  }
  s->f[n - 1] = all;
}

/* x_(i-1) - 2 x_i + x_(i+1) + h^2 exp x_i = 0: two roots */
static void bratu(system_of *s) {
  begin(s, 20, 0, 8);
  double h = 1 / ((double)s->n + 1);
  for (size_t i = 0; i < s->n; i++) {
    ambit_expr bend = less(s, sum(s, neighbour(s, i, -1), neighbour(s, i, 1)), scaled(s, 2, s->x[i]));
    s->f[i] = sum(s, bend, scaled(s, h * h, apply(s, AMBIT_OP_EXP, s->x[i])));
  }
}

/* More, Garbow & Hillstrom 27 */
static void brown(system_of *s) {
  begin(s, 5, -10, 10);
  ambit_expr all = num(s, 0), product = num(s, 1);
  for (size_t i = 0; i < s->n; i++) all = sum(s, all, s->x[i]), product = times(s, product, s->x[i]);
  for (size_t i = 0; i + 1 < s->n; i++) s->f[i] = less(s, sum(s, s->x[i], all), num(s, (double)s->n + 1));
  s->f[s->n - 1] = less(s, product, num(s, 1));
}

/* Toint 1983: one root, all ones */
static void trigexp(system_of *s) {
  begin(s, 8, -2, 3);
  size_t n = s->n;
  for (size_t i = 0; i < n; i++) {
    ambit_expr *x = s->x;
    s->f[i] = i + 1 < n
                  ? less(s, sum(s, scaled(s, 3, ambit_graph_pown(s->g, x[i], 3)), scaled(s, 2, x[i + 1])), num(s, 5))
                  : num(s, 0);
    if (i + 1 < n) {
      ambit_expr d = apply(s, AMBIT_OP_SIN, less(s, x[i], x[i + 1])),
                 e = apply(s, AMBIT_OP_SIN, sum(s, x[i], x[i + 1]));
      s->f[i] = sum(s, s->f[i], times(s, d, e));
    }
    if (i > 0) {
      ambit_expr back = times(s, x[i - 1], apply(s, AMBIT_OP_EXP, less(s, x[i - 1], x[i])));
      s->f[i] = less(s, sum(s, s->f[i], scaled(s, 4, x[i])), sum(s, back, num(s, 3)));
    }
  }
}

/* More, Garbow & Hillstrom 28, with h = 1/(n + 1): one root */
static void boundary_value(system_of *s) {
  begin(s, 12, -5, 5);
  double h = 1 / ((double)s->n + 1);
  for (size_t i = 0; i < s->n; i++) {
    ambit_expr own = sum(s, s->x[i], num(s, ((double)i + 1) * h + 1));
    ambit_expr bend = less(s, scaled(s, 2, s->x[i]), sum(s, neighbour(s, i, -1), neighbour(s, i, 1)));
    s->f[i] = sum(s, bend, scaled(s, 0.5 * h * h, ambit_graph_pown(s->g, own, 3)));
  }
}

/* Kearfott & Novoa 1990, "Griewank and Osborne": a root at which Newton's method diverges */
static void griewank(system_of *s) {
  begin(s, 2, -10, 10);
  s->f[0] = less(s,
      less(s, scaled(s, 29.0 / 16, ambit_graph_pown(s->g, s->x[0], 3)), scaled(s, 2, times(s, s->x[0], s->x[1]))),
      num(s, 0.001));
  s->f[1] = less(s, s->x[1], sqr(s, s->x[0]));
}

static const struct entry {
  const char *name, *what;
  void (*build)(system_of *s);
} entries[] = {
  { "broyden", "Broyden tridiagonal, 16 unknowns", broyden },
  { "moore_jones", "Moore-Jones, 10 unknowns", moore_jones },
  { "puma", "PUMA robot, 8 unknowns", puma },
  { "chemistry", "combustion, 5 unknowns", chemistry },
  { "neurophysiology", "neurophysiology, 6 unknowns", neurophysiology },
  { "economics", "economics, 5 unknowns", economics },
  { "bratu", "Bratu, 20 unknowns", bratu },
  { "brown", "Brown almost linear, 5 unknowns", brown },
  { "trigexp", "trigexp, 8 unknowns", trigexp },
  { "boundary_value", "discrete boundary value, 12 unknowns", boundary_value },
  { "griewank", "Griewank-Osborne shifted, 2 unknowns", griewank },
};

/* -- runs */

static void measure(
    ambit_registry *registry, const struct entry *e, const char *operator_name, size_t n, const ambit_option *more) {
  system_of s = { .g = ambit_graph_open() };
  e->build(&s);
  ambit_option option[OPTIONS + 1] = { { "operator", operator_name } };
  memcpy(option + 1, more, n * sizeof *more);
  ambit_equations q = { .graph = s.g, .ne = s.n, .equation = s.f, .nx = s.n, .unknown = s.x, .name = s.name };
  ambit_roots_request request = {
    .equations = &q,
    .box = s.box,
    .registry = registry,
    .solver = "krawczyk",
    .nsolver_option = n + 1,
    .solver_option = option,
  };
  ambit_roots_result best = { .cpu_seconds = INFINITY }, r;
  for (int i = 0; i < REPEATS && (i == 0 || best.cpu_seconds < 1); i++) {
    ambit_failure f = { 0 };
    if (ambit_roots(&request, &r, NULL, &f) != AMBIT_OK) {
      fprintf(stderr, "%s: %s\n", e->name, f.message);
      exit(1);
    }
    if (r.cpu_seconds < best.cpu_seconds) best = r;
  }
  printf("  %-17s %4u proved %5u undecided %8u boxes %10.3f ms\n", operator_name, best.proved, best.undecided,
      best.boxes, 1e3 * best.cpu_seconds);
  fflush(stdout);
  ambit_graph_close(s.g);
}

int main(int argc, char **argv) {
  static const char *const operators[] = { "auto", "newton", "krawczyk", "hansen_sengupta" };
  ambit_option option[OPTIONS];
  size_t noption = 0;
  for (int i = 2; i < argc && noption < OPTIONS; i++) {
    char *value = strchr(argv[i], '=');
    if (!value) return fprintf(stderr, "expected OPTION=VALUE, got %s\n", argv[i]), 2;
    *value = 0;
    option[noption++] = (ambit_option) { argv[i], value + 1 };
  }
  ambit_registry *registry = ambit_registry_open(NULL);
  for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
    if (argc > 1 && strcmp(argv[1], entries[i].name) != 0) continue;
    printf("%s: %s\n", entries[i].name, entries[i].what);
    for (size_t o = 0; o < sizeof operators / sizeof *operators; o++)
      measure(registry, &entries[i], operators[o], noption, option);
  }
  ambit_registry_close(registry);
  return 0;
}
