/* Old errors in an ellipsoid (ellipsoid.c): it holds what maps with uncertain data, and added vectors, make of it. For
** given data and a direction the farthest is known: sqrt(l' M Q M' l), M = T0 + sum_j xi_j T_j. */
#include "zonotope_case.h"
#include "solver/zonotope/ellipsoid.h"

#define MOST 4
#define ADDED 3

typedef struct image {
  long double Q[MOST][MOST];
  double size[MOST], added[ADDED][MOST];
} image;

/* Q = A A' of random A, of states whose sizes differ; E not much above sizes */
static void fill_set(zono *z, image *m, double *unit) {
  uint32_t n = z->nx;
  ellipsoid *e = z->proof->ellipsoid;
  double A[MOST][MOST];
  for (uint32_t i = 0; i < n; i++) {
    unit[i] = exp(draw(-8, 8));
    for (uint32_t k = 0; k < n; k++) A[i][k] = unit[i] * draw(-1, 1);
  }
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k <= i; k++) {
      double sum = 0;
      for (uint32_t a = 0; a < n; a++) sum += A[i][a] * A[k][a];
      e->Q[i * n + k] = e->Q[k * n + i] = sum * (1 + (i == k) * 1e-12);
      m->Q[i][k] = m->Q[k][i] = e->Q[i * n + k];
    }
  for (uint32_t i = 0; i < n; i++) {
    e->size[i] = sqrt(e->Q[i * n + i]) * (1 + 1e-12);
    z->E[i] = e->size[i] * draw(1, 2), z->proof->spread[i] = 10 * unit[i];
  }
}

/* rows of the states at the end of the step: y / E maps old errors */
static void fill_maps(zono *z, const double *unit, double share) {
  const shape *s = &z->shape;
  for (uint32_t i = 0; i < z->nx; i++) {
    double *y = z->proof->end + i * s->stride;
    memset(y, 0, s->stride * sizeof *y);
    for (uint32_t k = 0; k < z->nx; k++) {
      y[s->eps + k] = unit[i] / unit[k] * draw(-1, 1) * z->E[k];
      for (uint32_t j = 0; j < s->mixed; j++)
        y[s->mix + j * z->nx + k] = share * unit[i] / unit[k] * draw(-1, 1) * z->E[k];
    }
  }
}

/* l' M, M for data xi; its farthest value over Q and added vectors */
static long double farthest(const zono *z, const image *m, const long double *l, const double *xi) {
  const shape *s = &z->shape;
  long double v[MOST] = { 0 }, square = 0, more = 0;
  for (uint32_t k = 0; k < z->nx; k++)
    for (uint32_t i = 0; i < z->nx; i++) {
      const double *y = z->proof->end + i * s->stride;
      long double t = y[s->eps + k];
      for (uint32_t j = 0; j < s->mixed; j++) t += (long double)xi[j] * y[s->mix + j * z->nx + k];
      v[k] += l[i] * t / z->E[k];
    }
  for (uint32_t i = 0; i < z->nx; i++)
    for (uint32_t k = 0; k < z->nx; k++) square += v[i] * m->Q[i][k] * v[k];
  for (int a = 0; a < ADDED; a++) {
    long double sum = 0;
    for (uint32_t i = 0; i < z->nx; i++) sum += l[i] * m->added[a][i];
    more += fabsl(sum);
  }
  return sqrtl(square) + more;
}

static long double bound(const zono *z, const long double *l) {
  long double square = 0, boxes = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    for (uint32_t k = 0; k < z->nx; k++) square += l[i] * z->proof->ellipsoid->Q[i * z->nx + k] * l[k];
    for (int o = 0; o < ORIGINS; o++) boxes += fabsl(l[i]) * *box(z, (enum origin)o, i);
  }
  return sqrtl(fmaxl(square, 0)) + boxes;
}

/* the most that any data and direction reach, as a share of the bound */
static long double most_reached(const zono *z, const image *m, const double *unit) {
  long double most = 0;
  for (int turn = 0; turn < 300; turn++) {
    long double l[MOST];
    double xi[MOST];
    for (uint32_t i = 0; i < z->nx; i++) l[i] = draw(-1, 1) / unit[i];
    for (uint32_t j = 0; j < z->m; j++) xi[j] = pick(4) ? (pick(2) ? 1 : -1) : draw(-1, 1);
    long double share = farthest(z, m, l, xi) / bound(z, l);
    if (!(share <= 1)) fail_msg("%Lg times the bound is reached", share);
    most = fmaxl(most, share);
  }
  return most;
}

static long double try_case(uint32_t nx, double share, double added) {
  static const double time[2] = { 0, 1 };
  static zono z;
  static maker k;
  image m = { 0 };
  double unit[MOST];
  open_case(&z, &k, nx, 0, 0);
  z.problem.time = time, z.problem.ntime = 2, z.h = 0.01;
  assert_true(zono_open_proof(&z));
  fill_set(&z, &m, unit), fill_maps(&z, unit, share);
  z.proof->ellipsoid->is_used = 1;
  ellipsoid_begin(&z, z.proof->end);
  ellipsoid_move(&z, z.proof->end);
  for (int a = 0; a < ADDED; a++) {
    for (uint32_t i = 0; i < nx; i++) m.added[a][i] = added * unit[i] * draw(-1, 1);
    ellipsoid_add(&z, m.added[a], FROM_SQUARE);
  }
  ellipsoid_finish(&z);
  long double most = most_reached(&z, &m, unit);
  give_back();
  return most;
}

static void images_lie_in_it(void **unused) {
  (void)unused;
  for (uint32_t n = 0; n < 400; n++) try_case(1 + n % MOST, n % 3 ? draw(0, 1) : draw(0, 1e-3), n % 2 ? draw(0, 1) : 0);
}

/* Of one state all is reached; without data and additions of any number, too. */
static void it_is_no_larger_than_need_be(void **unused) {
  (void)unused;
  for (uint32_t n = 0; n < 40; n++) {
    long double one = try_case(1, n % 2 ? 0 : 1e-3, n % 4 > 1 ? 0.5 : 0), many = try_case(2 + n % 3, 0, 0);
    if (one < 1 - 1e-4 || many < 1 - 1e-6) fail_msg("%Lg, %Lg of the bound are reached", one, many);
  }
}

/* What is too small for squares goes into the box. */
static void nothing_is_lost_to_underflow(void **unused) {
  (void)unused;
  for (uint32_t n = 0; n < 40; n++) try_case(1 + n % MOST, 0.1, exp(draw(-700, -50)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(images_lie_in_it),
    cmocka_unit_test(it_is_no_larger_than_need_be),
    cmocka_unit_test(nothing_is_lost_to_underflow),
  };
  return cmocka_run_group_tests_name("zonotope: the ellipsoid", tests, NULL, NULL);
}
