/* Coefficients of the error equation (slope.c, sweep.c, inverse.c) and how lumps act on the end of a step (kernel.c):
** against derivatives, inverses and integrals at points in extended precision. */
#include "zonotope_case.h"

#define UNKNOWNS_MOST 4
#define STATES_MOST 4

/* -- coefficients: all adjoints of all outputs at a point */

typedef struct sweep_at {
  long double value[SLOTS], adjoint[STATES_MOST + UNKNOWNS_MOST][SLOTS];
  long double lambda[UNKNOWNS_MOST][UNKNOWNS_MOST]; /* -(the inverse of dR/da) */
} sweep_at;

static void sweep_all(const zono *z, const point *p, sweep_at *w) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t j = 0; j < z->nslot; j++) w->value[j] = slot_at(z, j, p);
  for (uint32_t o = 0; o < z->nout; o++) {
    long double *x = w->adjoint[o];
    memset(x, 0, sizeof w->adjoint[o]);
    x[t->out[o]] = 1;
    for (uint32_t i = t->ninstr; i-- > 0;) {
      long double by_a, by_b;
      slopes_at(t->op[i], w->value[t->a[i]], w->value[t->b[i]], &by_a, &by_b);
      kink_slopes(z, i, &by_a, &by_b);
      if (twin_of(z, i) < SLOTS) x[twin_of(z, i)] -= x[t->dst[i]];
      x[t->a[i]] += by_a * x[t->dst[i]];
      if (by_b != 0) x[t->b[i]] += by_b * x[t->dst[i]];
    }
  }
}

/* lambda by Gauss and Jordan, with pivots */
static void invert(const zono *z, sweep_at *w) {
  uint32_t n = z->na;
  long double m[UNKNOWNS_MOST][2 * UNKNOWNS_MOST] = { { 0 } };
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t j = 0; j < n; j++) m[i][j] = w->adjoint[z->nx + i][slot_a(z, j)];
    m[i][n + i] = -1;
  }
  for (uint32_t c = 0; c < n; c++) {
    uint32_t best = c;
    for (uint32_t r = c; r < n; r++)
      if (fabsl(m[r][c]) > fabsl(m[best][c])) best = r;
    for (uint32_t j = 0; j < 2 * n; j++) {
      long double old = m[c][j];
      m[c][j] = m[best][j], m[best][j] = old;
    }
    for (uint32_t r = 0; r < n; r++) {
      long double factor = m[r][c] / m[c][c];
      for (uint32_t j = 0; j < 2 * n && r != c; j++) m[r][j] -= factor * m[c][j];
    }
    long double pivot = m[c][c];
    for (uint32_t j = 0; j < 2 * n; j++) m[c][j] /= pivot;
  }
  for (uint32_t k = 0; k < n; k++)
    for (uint32_t q = 0; q < n; q++) w->lambda[k][q] = m[k][n + q];
}

/* the true coefficients of target n: of equations, of slots */
static void coefficients_at(const zono *z, const sweep_at *w, uint32_t n, long double *L, long double *C) {
  memset(C, 0, SLOTS * sizeof *C);
  const long double *own = n < z->na ? NULL : w->adjoint[z->proof->target_out[n - z->na]];
  for (uint32_t q = 0; q < z->na; q++) {
    L[q] = own ? 0 : w->lambda[n][q];
    for (uint32_t k = 0; own && k < z->na; k++) L[q] += own[slot_a(z, k)] * w->lambda[k][q];
  }
  for (uint32_t j = 0; j < z->nslot; j++) {
    if (own) C[j] = own[j];
    for (uint32_t q = 0; q < z->na; q++) C[j] += L[q] * w->adjoint[z->nx + q][j];
  }
}

static double reached_C, reached_L;

static void check_coefficients(const zono *z, const point *p) {
  static sweep_at w;
  const proof *f = z->proof;
  sweep_all(z, p, &w), invert(z, &w);
  for (uint32_t n = 0; n < f->ntarget; n++) {
    long double L[UNKNOWNS_MOST], C[SLOTS];
    coefficients_at(z, &w, n, L, C);
    for (uint32_t j = 0; j < z->nslot; j++) {
      if (j >= slot_a(z, 0) && j < slot_a(z, z->na)) continue;
      double width = f->dC[(size_t)n * z->nslot + j];
      long double off = fabsl(C[j] - f->C[(size_t)n * z->nslot + j]) - 1e-17L * fabsl(C[j]);
      if (!(off <= width)) fail_msg("target %u, slot %u: coefficient %Lg off by %Lg, bound %g", n, j, C[j], off, width);
      if (width > 1e-9 && off > width * (long double)reached_C) reached_C = (double)off / width;
    }
    for (uint32_t q = 0; q < z->na; q++) {
      double width = f->dL[(size_t)n * z->na + q];
      long double off = fabsl(L[q] - f->L[(size_t)n * z->na + q]) - 1e-17L * fabsl(L[q]);
      if (!(off <= width)) fail_msg("target %u, equation %u: %Lg off by %Lg, bound %g", n, q, L[q], off, width);
      if (off > width * (long double)reached_L) reached_L = (double)off / width;
    }
  }
}

/* all rows of states and parameters times a factor, their constants apart */
static void shrink(zono *z, double factor) {
  for (uint32_t i = 0; i < z->nx + z->np; i++) {
    double *x = i < z->nx ? z->P + i * z->shape.stride : z->p_row + (i - z->nx) * z->shape.stride;
    for (uint32_t v = 1; v < z->shape.stride; v++) x[v] *= factor;
    row_norms_all(&z->shape, x);
  }
  for (uint32_t i = 0; i < z->nx; i++) z->E[i] *= factor;
}

static void coefficients_hold_the_true_ones(void **unused) {
  (void)unused;
  static const double length[] = { 0, 1e-6, 0.02, 0.2 }, size[] = { 0, 1e-6, 0.1, 1 };
  static zono z;
  static maker k;
  uint32_t found = 0;
  for (uint32_t n = 0; n < 400; n++) {
    uint32_t na = n % 4, nx = 2 + n / 4 % 3;
    open_case(&z, &k, nx, na, n % 2);
    assert_true(zono_open_proof(&z));
    z.proof->patience = 1, z.h = length[n / 4 % 4] * (pick(2) ? 1 : -1);
    shrink(&z, size[n / 16 % 4]);
    if (zono_series(&z) && zono_defects(&z) && sweep_coefficients(&z)) {
      for (int m = 0; m < 10; m++) {
        point p;
        draw_point(&z, &p, z.h);
        check_coefficients(&z, &p);
      }
      found++;
    }
    give_back();
  }
  assert_true(found > 250);
  if (reached_C < 0.5 || reached_L < 0.5) fail_msg("only %.2g and %.2g of widths are seen", reached_C, reached_L);
}

/* -- kernels */

typedef struct matrix {
  long double x[STATES_MOST][STATES_MOST];
} matrix;

static matrix exponential(const double *J, uint32_t n, long double t) {
  matrix sum = { { { 0 } } }, term = sum;
  for (uint32_t i = 0; i < n; i++) sum.x[i][i] = term.x[i][i] = 1;
  for (int k = 1; k < 60; k++) {
    matrix next = { { { 0 } } };
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t j = 0; j < n; j++) {
        for (uint32_t l = 0; l < n; l++) next.x[i][j] += term.x[i][l] * J[l * n + j] * t / k;
        sum.x[i][j] += next.x[i][j];
      }
    term = next;
  }
  return sum;
}

#define PIECES 1000

/* integrals of |K| and of what mean and tilt leave of it; a midpoint rule is off by less than 1e-5 of its size */
static void check_kernel(const zono *z, double *least) {
  const proof *p = z->proof;
  uint32_t n = z->nx;
  long double all[STATES_MOST][STATES_MOST] = { { 0 } }, rest[STATES_MOST][STATES_MOST] = { { 0 } };
  for (int m = 0; m < PIECES; m++) {
    long double tau = (m + 0.5L) / PIECES, piece = fabsl((long double)z->h) / PIECES;
    matrix K = exponential(p->J, n, z->h * tau);
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t j = 0; j < n; j++) {
        all[i][j] += fabsl(K.x[i][j]) * piece;
        rest[i][j] += fabsl(K.x[i][j] - p->mean[i * n + j] - p->tilt[i * n + j] * (2 * tau - 1)) * piece;
      }
  }
  double most = 0;
  int bent = 0;
  for (uint32_t e = 0; e < n * n; e++) {
    long double reach = all[e / n][e % n], wobble = rest[e / n][e % n];
    if (!(reach * (1 - 1e-5L) <= p->reach[e])) fail_msg("the integral of |K| is %Lg, bound %g", reach, p->reach[e]);
    if (!(wobble * (1 - 1e-4L) - 1e-18L * reach <= p->wobble[e]))
      fail_msg("%Lg is left of K, bound %g", wobble, p->wobble[e]);
    if (wobble > 1e-3L * reach) bent = 1, most = fmax(most, (double)wobble / p->wobble[e]);
  }
  if (bent) *least = fmin(*least, most);
}

static void kernels_are_bounded(void **unused) {
  (void)unused;
  static zono z;
  static maker k;
  double least = 1;
  for (uint32_t n = 0; n < 60; n++) {
    open_case(&z, &k, 2 + n % 3, 0, 0);
    assert_true(zono_open_proof(&z));
    uint32_t nx = z.nx;
    z.h = draw(-1, 1);
    double size = pick(2) ? 1 : 0.1;
    for (uint32_t e = 0; e < nx * nx; e++) {
      uint32_t i = e / nx, j = e % nx;
      z.proof->J[e] = n % 4 == 0 ? j == i + 1 : size * draw(-1, 1); /* chains of integrators among them */
    }
    for (uint32_t i = 0; i < nx; i++) z.proof->spread[i] = draw(0.1, 10);
    assert_true(kernel_find(&z));
    check_kernel(&z, &least);
    give_back();
  }
  if (least < 0.3) fail_msg("only %.2g of a bound of what is left of a kernel is seen", least);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(coefficients_hold_the_true_ones),
    cmocka_unit_test(kernels_are_bounded),
  };
  return cmocka_run_group_tests_name("zonotope: slopes", tests, NULL, NULL);
}
