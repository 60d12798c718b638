/* A step of the zonotope solver with a function of time in equations whose coefficients depend on the data and on old
** generators: a0 = -(q + y) a1, a1 = (p + y) v, with y known twice, as y1 and y2, and y1 - y2 as a further coefficient.
** x' = a and v constant in each half of the step make x(h) a product, of which the farthest values are at corners. As
** w' = x1, all that v adds to w - h/2 x1 is by its first moment, which is largest if v leaps from one end to the
** other. */
#include "zonotope_case.h"
#include "solver/zonotope/quartic.h"

typedef struct equation_case {
  double wide_q, wide_p, old, about, vary, h; /* half widths of q, p, y; middle and half width of v */
} equation_case;

enum { NX = 5, NA = 2, NP = 3, ZERO = 0, X1 = 2, Y1 = 3, Y2 = 4, A0 = 6, A1 = 7, Q = 8, P = 9, V = 10 };

static const uint32_t moving[3] = { 0, 1, 4 }; /* states x0, x1, w */
static double from[NX][400];

static void make_equations(maker *k) {
  make_empty(k, 1, NX, NA, NP); /* constant 0; x0, x1, y1, y2, w, a0, a1, q, p, v, t */
  k->out[0] = A0, k->out[1] = A1, k->out[2] = k->out[3] = ZERO, k->out[4] = X1;
  uint32_t by = put(k, AMBIT_OP_MUL, put(k, AMBIT_OP_ADD, Q, Y1), A1);
  k->out[NX] = put(k, AMBIT_OP_ADD, A0, by);
  uint32_t none = put(k, AMBIT_OP_MUL, put(k, AMBIT_OP_SUB, Y1, Y2), A0);
  uint32_t force = put(k, AMBIT_OP_MUL, put(k, AMBIT_OP_ADD, P, Y1), V);
  k->out[NX + 1] = put(k, AMBIT_OP_SUB, put(k, AMBIT_OP_ADD, A1, none), force);
  k->tape.nslot = k->tape.nconst + k->tape.nin + k->tape.ninstr;
}

static void put_set(zono *z, const equation_case *c) {
  double *q = z->p_row, *p = q + z->shape.stride, *v = p + z->shape.stride;
  q[0] = draw(0.8, 1.2), q[1] = c->wide_q, p[0] = draw(0.8, 1.2), p[2] = c->wide_p, v[0] = c->about;
  row_norms_all(&z->shape, q), row_norms_all(&z->shape, p), row_norms_all(&z->shape, v);
  z->p_rad[2] = c->vary;
  z->ngen = 1, z->G[2] = z->G[3] = c->old, z->E[2] = z->E[3] = c->old * (1 + 1e-12);
  for (uint32_t i = 0; i < NX; i++) {
    double *x = z->P + i * z->shape.stride;
    if (i != 2 && i != 3) x[0] = draw(-1, 1), x[1] = draw(-0.1, 0.1);
    row_norms_all(&z->shape, x);
    memcpy(from[i], x, z->shape.stride * sizeof *x);
  }
}

static void open_equations(zono *z, maker *k, const equation_case *c) {
  static const uint32_t stage_end[1] = { NA }, pivot[NA] = { 0, 1 };
  static const double time[2] = { 0, 1 };
  make_equations(k);
  *z = (zono) { .host = &host, .nx = NX, .na = NA, .np = NP, .m = 2, .K = 4, .K_max = 4, .ngen_max = 200, .h = c->h };
  z->nvarying = z->problem.nvarying = 1, z->problem.time = time, z->problem.ntime = 2, z->vary_room = 60;
  z->program = (program) { &k->tape, NX, NA, NP, 0, 1, stage_end, pivot, NULL, NULL, NULL, NULL };
  assert_true(shape_open(&host, &z->shape, z->m, NX));
  z->P = lend(&host, NX * z->shape.stride * 8), z->E = lend(&host, NX * 8), z->G = lend(&host, NX * 204 * 8);
  z->tube_lo = lend(&host, NX * 8), z->tube_hi = lend(&host, NX * 8);
  assert_true(zono_open_rows(z) && zono_open_implicit(z) && zono_open_proof(z));
  z->proof->patience = 1;
  for (uint32_t i = 0; i < NX; i++) z->proof->spread[i] = 1;
  put_set(z, c);
}

/* x0, x1, y1, y2, w at p->s for the data of a point, the old generator at rho and v off its middle by as much as is
** allowed, up or down in each half */
static void solve(const zono *z, const equation_case *c, const point *p, long double rho, long double *x) {
  const double *row = z->p_row;
  long double first = c->about + (pick(2) ? c->vary : -c->vary), second = c->about + (pick(2) ? c->vary : -c->vary);
  long double q = value_at(&z->shape, row, p), r = value_at(&z->shape, row + z->shape.stride, p), y = c->old * rho;
  long double gained = (r + y) * (first + second) / 2 * p->s, speed = value_at(&z->shape, from[1], p);
  x[0] = value_at(&z->shape, from[0], p) - (q + y) * gained, x[1] = speed + gained, x[2] = x[3] = y;
  x[4] = value_at(&z->shape, from[4], p) + speed * p->s + (r + y) * (3 * first + second) / 8 * p->s * p->s;
}

/* zeta, at any time: how far the states are off their rows */
static void check_distance(const zono *z, const equation_case *c, const double *E) {
  point p = { 0 };
  long double x[NX], rho = pick(2) ? 1 : -1;
  draw_point(z, &p, z->h);
  solve(z, c, &p, rho, x);
  for (uint32_t i = 0; i < NX; i++) p.eps[i] = E[i] > 0 ? x[i] / E[i] : 0;
  for (uint32_t m = 0; m < 3; m++) {
    uint32_t i = moving[m];
    long double off = fabsl(x[i] - slot_at(z, slot_x(z, i), &p));
    if (!(off <= z->proof->zeta[i] * (1 + 1e-17L)))
      fail_msg("state %u is %Lg off its rows, the bound is %g", i, off, z->proof->zeta[i]);
  }
}

/* how much of the set's width in a direction is reached */
static double check_set(const zono *z, const equation_case *c, long double l0, long double l1, long double lw) {
  point p = { 0 };
  long double x[NX], l[NX] = { l0, l1, pick(2) ? draw(-1, 1) : 0, 0, lw }, off = 0, room = 0;
  draw_point(z, &p, z->h);
  p.s = z->h;
  solve(z, c, &p, pick(2) ? 1 : -1, x);
  for (uint32_t i = 0; i < NX; i++) {
    off += l[i] * (x[i] - value_at(&z->shape, z->P + i * z->shape.stride, &p));
    room += fabsl(l[i]) * quartic_size(z, i);
  }
  for (uint32_t g = 0; g < z->ngen; g++) {
    long double sum = 0;
    for (uint32_t i = 0; i < NX; i++) sum += l[i] * z->G[(size_t)g * NX + i];
    room += fabsl(sum);
  }
  if (!(fabsl(off) <= room * (1 + 1e-17L))) fail_msg("a solution is %Lg off, the set %Lg wide", off, room);
  return (double)(fabsl(off) / room);
}

/* least: so much of the set is reached at least along x0, along x1, and where only the moment of v matters */
static void try_case(const equation_case *c, double least) {
  static zono z;
  static maker k;
  double E[NX], most[3] = { 0 };
  open_equations(&z, &k, c);
  memcpy(E, z.E, sizeof E);
  if (!(zono_series(&z) && zono_defects(&z) && zono_prove(&z))) fail_msg("why %d", z.why);
  zono_finish(&z);
  for (int m = 0; m < 200; m++) {
    check_distance(&z, c, E);
    most[0] = fmax(most[0], check_set(&z, c, 1, 0, 0)), most[1] = fmax(most[1], check_set(&z, c, 0, 1, 0));
    most[2] = fmax(most[2], check_set(&z, c, 0, -c->h / 2, 1));
    check_set(&z, c, draw(-1, 1), draw(-1, 1), draw(-1, 1));
  }
  if (most[0] < least || most[1] < least || most[2] < least)
    fail_msg("only %.2g, %.2g, %.2g of the set is reached at q %g, p %g, y %g", most[0], most[1], most[2], c->wide_q,
        c->wide_p, c->old);
  give_back();
}

static void what_varies_is_in_the_set(void **unused) {
  (void)unused;
  static const double wide[] = { 0, 0.02, 0.2 }, old[] = { 0, 0.01, 0.05 }, length[] = { 0.1, 1, -0.5 };
  for (int n = 0; n < 81; n++) {
    const equation_case c = { wide[n % 3], wide[n / 3 % 3], old[n / 9 % 3], n % 2 ? 0.3 : 0, 0.1, length[n / 27] };
    try_case(&c, 0.6);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(what_varies_is_in_the_set) };
  return cmocka_run_group_tests_name("zonotope: equations with functions of time", tests, NULL, NULL);
}
