/* Old errors: discs along modes (discs.c, map.c), what data make of generators (mixed.c), what eps stand for (basis.c).
** For given data and a direction l the farthest of a disc is known, sum_k |l'V_k| b_k, of what a map makes of it,
** too. */
#include "zonotope_case.h"
#include "solver/zonotope/basis.h"
#include "solver/zonotope/modes.h"
#include "solver/zonotope/quartic.h"
#include <complex.h>

#define MOST 6
#define ADDED 3
#define PAIRS_MOST 3

typedef long double complex wide;

/* -- sets */

/* p->J like a mechanism's: pairs of states that oscillate, and what couples them; of states whose sizes differ */
static void fill_jacobian(zono *z, double *unit) {
  uint32_t n = z->nx;
  double coupling = pick(3) ? draw(0, 1) : 0;
  for (uint32_t i = 0; i < n; i++) unit[i] = exp(draw(-6, 6));
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      double entry = coupling * draw(-1, 1) - (i == k ? draw(0, 2) : 0);
      if ((i ^ 1u) == k) entry += i < k ? draw(2, 20) : -draw(2, 20);
      z->proof->J[i * n + k] = entry * unit[i] / unit[k];
    }
  for (uint32_t i = 0; i < n; i++) z->E[i] = unit[i] * draw(1, 2), z->proof->spread[i] = 10 * unit[i];
}

/* what a step makes of errors (close.c): about I + J h, and `share` of it for each datum */
static void fill_maps(zono *z, const double *unit, double share) {
  const shape *s = &z->shape;
  uint32_t n = z->nx;
  for (uint32_t i = 0; i < n; i++) {
    double *y = z->proof->end + i * s->stride;
    memset(y, 0, s->stride * sizeof *y);
    for (uint32_t k = 0; k < n; k++) {
      double square = 0, noise = draw(-1e-6, 1e-6) * unit[i] / unit[k];
      for (uint32_t l = 0; l < n; l++) square += z->proof->J[i * n + l] * z->proof->J[l * n + k];
      y[s->eps + k] = (i == k) + z->h * z->proof->J[i * n + k] + z->h * z->h / 2 * square + noise;
      for (uint32_t j = 0; j < s->mixed; j++)
        y[s->mix + j * n + k] = share * z->h * (z->proof->J[i * n + k] * draw(-1, 1) + 1e6 * noise * draw(-1, 1));
    }
  }
}

/* l' (V + sum_j xi_j U_j), or with the map of the step before it */
static void across(const zono *z, const discs *d, const long double *l, const double *xi, wide *to) {
  uint32_t n = z->nx;
  for (uint32_t k = 0; k < n; k++) {
    to[k] = 0;
    for (uint32_t i = 0; i < n; i++) {
      wide v = d->V[i * n + k];
      for (uint32_t j = 0; j < z->shape.mixed; j++) v += (wide)d->U[(j * n + i) * n + k] * xi[j];
      to[k] += l[i] * v;
    }
  }
}

/* sign [pairs]: of the products of two data; NULL: there are none */
static void before(const zono *z, const long double *l, const double *xi, const int *sign, long double *to) {
  const shape *s = &z->shape;
  for (uint32_t k = 0; k < z->nx; k++) {
    to[k] = 0;
    for (uint32_t i = 0; i < z->nx; i++) {
      const double *y = z->proof->end + i * s->stride;
      long double t = y[s->eps + k];
      for (uint32_t j = 0; j < s->mixed; j++) t += (long double)xi[j] * y[s->mix + j * z->nx + k];
      to[k] += l[i] * t;
    }
    for (uint32_t n = 0; sign && n < z->proof->quartic->pairs; n++)
      for (uint32_t i = 0; i < z->nx; i++)
        for (uint32_t x = 0; x < z->nx; x++)
          to[k] +=
              l[i] * sign[n] * (long double)z->h * z->proof->mean[i * z->nx + x] * quartic_near((zono *)z, x, n)[k];
  }
}

static long double farthest(const zono *z, const discs *d, const long double *l, const double *xi) {
  wide to[MOST];
  long double sum = 0;
  across(z, d, l, xi, to);
  for (uint32_t k = 0; k < z->nx; k++) sum += cabsl(to[k]) * d->b[k];
  return sum;
}

/* l' sum_j xi_j Re(U_j W) P_4, for the one term that there is */
static long double turned_fourth(
    const zono *z, const discs *d, const long double *l, const double *xi, const double *P) {
  uint32_t n = z->nx;
  wide sum = 0;
  for (uint32_t k = 0; k < n; k++) {
    wide w = 0, u = 0;
    for (uint32_t i = 0; i < n; i++) {
      w += (wide)d->W[k * n + i] * P[i];
      for (uint32_t j = 0; j < z->shape.mixed; j++) u += l[i] * (wide)d->U[(j * n + i) * n + k] * xi[j];
    }
    sum += u * w;
  }
  return creall(sum);
}

/* One term of degree 4, which is any number up to 1: before the step, moved, what comes up; M_n of pairs of data. */
typedef struct fourth {
  int any, carried;
  double before[MOST];
  long double fresh[MOST];
} fourth;

static long double along(uint32_t n, const long double *l, const double *x) {
  long double sum = 0;
  for (uint32_t i = 0; i < n; i++) sum += l[i] * x[i];
  return sum;
}

/* by how much l' of the errors that P_4 was differs from l' of what it is now; without M_j P_4 where mixed.c has it */
static long double missed_fourth(
    const zono *z, const fourth *f, const long double *l, const long double *turned, const double *xi) {
  const double *now = z->proof->quartic->term;
  long double own[MOST], sum, rounding = 0; /* of quartic_move(): close.c charges it; of this */
  for (uint32_t k = 0; k < z->nx; k++) {
    own[k] = 0;
    for (uint32_t i = 0; i < z->nx; i++) {
      long double part = l[i] * z->proof->end[i * z->shape.stride + z->shape.eps + k];
      own[k] += part, rounding += 2 * (z->nx + 4) * 0x1p-53L * fabsl(part * f->before[k]);
    }
  }
  if (!f->any) return 0;
  sum = along(z->nx, f->carried ? turned : own, f->before);
  if (z->proof->quartic->held) sum -= along(z->nx, l, now);
  for (uint32_t i = 0; i < z->nx; i++) sum += l[i] * f->fresh[i], rounding += 0x1p-62L * fabsl(l[i] * now[i]);
  if (z->modes->old.any) sum += turned_fourth(z, &z->modes->old, turned, xi, f->before);
  if (z->modes->now.any && z->proof->quartic->held) sum -= turned_fourth(z, &z->modes->now, l, xi, now);
  return fmaxl(fabsl(sum) - rounding, 0);
}

static long double boxes(const zono *z, const long double *l) {
  long double sum = 0;
  for (uint32_t i = 0; i < z->nx; i++)
    for (int o = 0; o < ORIGINS; o++) sum += fabsl(l[i]) * *box(z, (enum origin)o, i);
  return sum;
}

static void draw_data(const zono *z, double *xi) {
  for (uint32_t j = 0; j < z->m; j++) xi[j] = pick(4) ? (pick(2) ? 1 : -1) : draw(-1, 1);
}

/* the most that any data and direction reach, as a share of the bound */
static long double most_reached(const zono *z, double added[ADDED][MOST], const fourth *f, const double *unit) {
  const modes *m = z->modes;
  long double most = 0;
  for (int turn = 0; turn < 200; turn++) {
    long double l[MOST], turned[MOST];
    double xi[MOST];
    int sign[PAIRS_MOST];
    for (uint32_t i = 0; i < z->nx; i++) l[i] = pick(3) ? draw(-1, 1) / unit[i] : 0;
    for (uint32_t n = 0; n < PAIRS_MOST; n++) sign[n] = pick(2) ? 1 : -1;
    draw_data(z, xi), before(z, l, xi, f->carried ? sign : NULL, turned);
    long double truth = farthest(z, &m->old, turned, xi), bound = boxes(z, l);
    truth += missed_fourth(z, f, l, turned, xi);
    if (m->now.any) bound += farthest(z, &m->now, l, xi);
    for (int a = 0; a < ADDED; a++) {
      long double sum = 0;
      for (uint32_t i = 0; i < z->nx; i++) sum += l[i] * added[a][i];
      truth += fabsl(sum);
    }
    if (bound == 0) continue;
    if (!(truth <= bound * (1 + 1e-15L))) fail_msg("%.17Lg times the bound is reached", truth / bound);
    most = fmaxl(most, truth / bound);
  }
  return most;
}

/* half widths, and bounds of products with rows */
static void check_sizes(zono *z, const double *unit) {
  discs *now = &z->modes->now, *old = &z->modes->old, keep = *old;
  *old = *now; /* discs_size() is of the start of a step */
  for (int turn = 0; turn < 20; turn++) {
    long double l[MOST];
    double xi[MOST], y[MOST];
    uint32_t i = pick(z->nx);
    for (uint32_t k = 0; k < z->nx; k++) l[k] = y[k] = draw(-1, 1) / unit[k];
    draw_data(z, xi);
    const double *P = z->proof->quartic->term;
    int any = z->proof->quartic->held;
    long double more = any ? fabsl(turned_fourth(z, old, l, xi, P)) : 0;
    if (!(farthest(z, old, l, xi) + more <= discs_size(z, y))) fail_msg("a product is larger than its bound");
    for (uint32_t k = 0; k < z->nx; k++) l[k] = k == i;
    more = any ? fabsl(turned_fourth(z, now, l, xi, P)) : 0;
    if (!(farthest(z, now, l, xi) + more <= discs_width(z, i))) fail_msg("a state is wider than its bound");
    if (!(more <= discs_turned(z, i))) fail_msg("terms of degree 4 turn more than their bound");
  }
  *old = keep;
}

/* leaves axes where discs_move() finds those of the last step but one */
static void leave_old_axes(zono *z) {
  modes *m = z->modes;
  discs now = m->now;
  m->now = m->old, modes_find(z), m->old = m->now, m->now = now;
}

/* discs_move() with a W that is no inverse of V: any will do */
static void move_crudely(zono *z) {
  modes *m = z->modes;
  discs last = m->old;
  m->old = m->now, m->now = last;
  memset(m->in, 0, z->nx * sizeof *m->in), memset(m->box, 0, z->nx * sizeof *m->box);
  memset(m->now.b, 0, z->nx * sizeof *m->now.b), memset(m->now.a, 0, z->nx * sizeof *m->now.a);
  m->now.any = modes_find(z);
  if (!m->now.any) return;
  for (uint32_t e = 0; e < z->nx * z->nx; e++) m->now.W[e] *= 1 + draw(-1e-2, 1e-2);
  map_discs(z);
}

enum manner { AS_IT_IS, GROWN_TOO_MUCH, CRUDE };

/* P_4 at the start of a step, in units of the states: one term, turned with discs */
static void start_fourth(zono *z, fourth *f, double size, const double *unit) {
  quartic *q = z->proof->quartic;
  discs *d = &z->modes->now;
  q->n = q->length = 1, q->held = f->any = 1, q->count = pick(2), q->pairs = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    f->before[i] = q->term[i] = size * unit[i] * draw(-1, 1), f->fresh[i] = 0;
    q->size[i] = fabs(q->term[i]);
  }
  for (uint32_t k = 0; k < z->nx; k++) {
    complex double w = 0;
    for (uint32_t i = 0; i < z->nx; i++)
      w += d->W[k * z->nx + i] * q->term[i], d->a[k] += cabs(d->W[k * z->nx + i]) * 1e-15 * q->size[i];
    d->a[k] += cabs(w);
  }
}

/* what a step does to it, as distance.c and close.c do; what pairs of data make of errors */
static void move_fourth(zono *z, fourth *f, double size, const double *unit) {
  quartic *q = z->proof->quartic;
  const shape *s = &z->shape;
  uint32_t n = z->nx;
  f->carried = discs_carry(z);
  for (uint32_t i = 0; i < n && f->any; i++) quartic_move(z, i, z->proof->end + i * s->stride + s->eps);
  if (f->carried) {
    q->pairs = pick(PAIRS_MOST + 1);
    for (uint32_t i = 0; i < n; i++) {
      z->proof->link[i] = LINK_UNKNOWN;
      for (uint32_t k = 0; k < n; k++) {
        z->proof->mean[i * n + k] = ((i == k) + 0.1 * draw(-1, 1)) * unit[i] / unit[k];
        for (uint32_t p = 0; p < q->pairs; p++)
          quartic_near(z, i, p)[k] = pick(3) ? draw(-3, 3) * unit[i] / unit[k] : 0;
      }
    }
    map_pairs(z);
  }
  for (uint32_t i = 0; i < n && f->any && q->count; i++) {
    q->term[i] = q->moved[i];
    if (pick(2)) q->moved[i] += 3 * size * unit[i] * draw(-1, 1);
    f->fresh[i] = (long double)q->moved[i] - q->term[i];
  }
  for (uint32_t i = 0; i < n; i++) z->proof->budget[i] = pick(2) ? 0 : INFINITY;
  if (f->any) quartic_finish(z), discs_turn(z), quartic_drop(z);
}

/* One step of discs that there are, in random axes of another map */
static long double try_step(uint32_t nx, double share, double size, enum manner manner) {
  static const double time[2] = { 0, 1 };
  static zono z;
  static maker k;
  double unit[MOST], added[ADDED][MOST] = { { 0 } };
  long double most = 0;
  open_case(&z, &k, nx, 0, 0);
  z.problem.time = time, z.problem.ntime = 2, z.h = 0.02;
  assert_true(zono_open_proof(&z));
  fill_jacobian(&z, unit), fill_maps(&z, unit, share);
  modes *m = z.modes;
  if (modes_find(&z)) {
    leave_old_axes(&z);
    m->now.any = 1, m->is_bad = manner == GROWN_TOO_MUCH;
    int is_empty = manner == AS_IT_IS && pick(3) == 0;
    for (uint32_t i = 0; i < nx; i++) m->now.b[i] = !is_empty && pick(4) ? draw(0, 1) : 0;
    fourth f = { 0 };
    int crude_start = pick(3) == 0;
    for (uint32_t e = 0; e < nx * nx && crude_start; e++) m->now.W[e] *= 1 + draw(-0.5, 0.5);
    if (pick(2)) start_fourth(&z, &f, pick(2) ? 10 : 0.1, unit);
    if (pick(2)) fill_jacobian(&z, unit);
    fill_maps(&z, unit, share);
    manner == CRUDE ? move_crudely(&z) : discs_move(&z);
    if (share > 0)
      move_fourth(&z, &f, 10, unit);
    else
      f.any = 0;
    for (int a = 0; a < ADDED && size > 0 && (m->now.any || manner != CRUDE); a++) {
      int mode = (int)pick(2 * nx); /* one alone: others do not hide what turns cost */
      for (uint32_t i = 0; i < nx; i++)
        added[a][i] =
            size * (m->now.any && mode < (int)nx ? creal(m->now.V[i * nx + (uint32_t)mode]) : unit[i] * draw(-1, 1));
      if (is_empty && a != 1) memset(added[a], 0, sizeof added[a]);
      if (a)
        discs_put(&z, added[a], FROM_SQUARE);
      else /* a box is for every sign: the corner that was drawn is one of its points */
        for (uint32_t i = 0; i < nx; i++) *box(&z, FROM_TIME, i) += fabs(added[a][i]);
    }
    discs_finish(&z);
    if (m->now.any || manner != CRUDE) most = most_reached(&z, added, &f, unit);
    if (m->now.any) check_sizes(&z, unit);
  }
  give_back();
  return most;
}

static void steps_lie_in_discs(void **unused) {
  (void)unused;
  for (uint32_t n = 0; n < 1500; n++)
    try_step(1 + n % MOST, n % 3 ? draw(0, 1) : draw(0, 1e-3), n % 2 ? exp(draw(-30, 0)) : 0,
        pick(7) ? pick(2) ? AS_IT_IS : CRUDE : GROWN_TOO_MUCH);
}

/* Along its modes a step without data enlarges nothing. */
static void they_are_no_larger_than_need_be(void **unused) {
  (void)unused;
  int good = 0;
  for (uint32_t n = 0; n < 240; n++) good += try_step(1 + n % MOST, 0, 0, AS_IT_IS) > 1 - 1e-3;
  if (!(good > 80)) fail_msg("good %d", good);
}

/* -- a frequency that is not known */

/* A step turns a state by w h, with w = 10 + xi. Discs must not grow but by squares of h: |1 + i xi h| - 1. */
static void frequencies_cost_nothing(void **unused) {
  (void)unused;
  static const double time[2] = { 0, 1 };
  static zono z;
  static maker k;
  open_case(&z, &k, 2, 0, 0);
  z.problem.time = time, z.problem.ntime = 2, z.h = 1e-3;
  assert_true(zono_open_proof(&z));
  const shape *s = &z.shape;
  double angle = 10 * z.h, J[] = { 0, 10, -10, 0 }, Y[] = { cos(angle), sin(angle), -sin(angle), cos(angle) };
  memcpy(z.proof->J, J, sizeof J);
  for (uint32_t i = 0; i < 2; i++) {
    double *y = z.proof->end + i * s->stride;
    memset(y, 0, s->stride * sizeof *y), z.E[i] = 1, z.proof->spread[i] = 1;
    for (uint32_t l = 0; l < 2; l++) y[s->eps + l] = Y[2 * i + l];
    y[s->mix + 0] = i == 0 ? -z.h * sin(angle) : -z.h * cos(angle); /* of datum 0: the derivative by w */
    y[s->mix + 1] = i == 0 ? z.h * cos(angle) : -z.h * sin(angle);
  }
  assert_true(s->mixed > 0 && modes_find(&z));
  z.modes->now.any = 1, z.modes->now.b[0] = z.modes->now.b[1] = 1;
  for (int step = 0; step < 1000; step++) {
    discs_move(&z), memset(z.proof->boxes, 0, ORIGINS * 2 * sizeof(double)), discs_finish(&z);
    assert_true(z.modes->now.any);
  }
  assert_true(z.modes->now.b[0] < 1.01 && z.modes->now.b[0] > 1); /* by sizes it would be e */
  give_back();
}

/* -- two data that do nothing alone */

/* Datum 0 makes mode 2 from mode 1, datum 1 mode 1 from mode 2: both together slow the decay, to second order. */
static void pairs_of_data_are_not_left_out(void **unused) {
  (void)unused;
  static const double time[2] = { 0, 1 };
  static zono z;
  static maker k;
  for (uint32_t turn = 0; turn < 4; turn++) {
    int sign = turn < 2 ? -1 : 1;
    open_case(&z, &k, 2, 0, 0);
    z.problem.time = time, z.problem.ntime = 2, z.h = 1e-2;
    assert_true(zono_open_proof(&z));
    const shape *s = &z.shape;
    double J[] = { -1, 0, 0, -9 }, y1 = exp(-z.h), y2 = exp(-9 * z.h), c = 0.02 * (y1 - y2);
    memcpy(z.proof->J, J, sizeof J);
    for (uint32_t i = 0; i < 2; i++) {
      double *y = z.proof->end + i * s->stride;
      memset(y, 0, s->stride * sizeof *y), z.E[i] = 1, z.proof->spread[i] = 1;
      y[s->eps + i] = i ? y2 : y1;
      y[s->mix + (i == turn % 2 ? 0u : 2u) + 1 - i] = i ? sign * c : c;
    }
    assert_true(s->mixed > 1 && modes_find(&z));
    z.modes->now.any = 1, z.modes->now.b[0] = z.modes->now.b[1] = 1;
    discs_move(&z);
    const double *g = z.modes->growth;
    double truth = y1 + y2 + sqrt((y1 - y2) * (y1 - y2) + 4 * c * c), mean = g[0] + g[3],
           found = mean + sqrt((g[0] - g[3]) * (g[0] - g[3]) + 4 * g[1] * g[2]);
    assert_true(found >= truth); /* twice the largest eigenvalue, for xi = (1, sign) */
    assert_true(found < truth + 0.2 * (truth - 2 * y1));
    give_back();
  }
}

/* V = I, Y = 0; M_0 makes state 0 of state 1, T_1 turns mode 0 into mode 1: together they make state 0 of mode 0, which
** goes into the box where the end has no axes. With V' = I it goes along, and T'_2 turns what it made into mode 1. As
** discs do terms of degree 4 along mode 0; and as M_0 does what a pair of data makes of state 1. */
enum of_what { OF_DISCS, OF_FOURTH, OF_PAIRS };

static void check_several(enum of_what what, int has_axes) {
  static zono z;
  static maker k;
  open_case(&z, &k, 2, 0, 0);
  z.h = 1e-2;
  assert_true(zono_open_proof(&z));
  const shape *s = &z.shape;
  modes *m = z.modes;
  for (uint32_t i = 0; i < 2; i++)
    memset(z.proof->end + i * s->stride, 0, s->stride * sizeof(double)), z.E[i] = 1, m->old.V[3 * i] = 1;
  if (what != OF_PAIRS) z.proof->end[s->mix + 1] = 0.5;
  assert_true(s->mixed > 2);
  m->old.T[4 + 2] = m->old.U[4 + 2] = m->old.S[2] = m->old.tilt[2] = 0.25;
  m->old.any = 1, (what == OF_FOURTH ? m->old.a : m->old.b)[0] = 1;
  if (what == OF_PAIRS) m->old.b[1] = 1;
  for (uint32_t i = 0; i < 2 && has_axes; i++) m->now.V[3 * i] = m->now.W[3 * i] = 1;
  if (has_axes) m->now.T[8 + 2] = m->now.U[8 + 2] = m->now.S[2] = m->now.tilt[2] = 0.125;
  map_discs(&z);
  z.proof->quartic->pairs = 1, z.proof->link[0] = LINK_UNKNOWN, z.proof->mean[0] = 0.5 / z.h;
  quartic_near(&z, 0, 0)[1] = 1;
  if (what == OF_PAIRS) map_pairs(&z);
  if (has_axes && what == OF_PAIRS)
    assert_true(m->now.b[0] >= 0.5 && m->in[0] >= 0.5 * 0.25 && m->in[1] >= 0.5 * 0.125);
  else if (has_axes)
    assert_true(m->now.b[0] >= 0.5 * 0.25 && m->in[1] >= 0.5 * 0.25 * 0.125);
  else
    assert_true(m->box[0] >= 0.5 * 0.25 + (what == OF_PAIRS ? 0.5 : 0));
  give_back();
}

static void what_several_data_leave_is_bounded(void **unused) {
  (void)unused;
  for (enum of_what what = OF_DISCS; what <= OF_PAIRS; what++) check_several(what, 0), check_several(what, 1);
}

/* V = I, W = 0, Y = I: the end's axes turn all of what a term of degree 4 has in state 0 anew, into mode 1. */
static void what_axes_miss_is_turned(void **unused) {
  (void)unused;
  static zono z;
  static maker k;
  open_case(&z, &k, 2, 0, 0);
  z.h = 1e-2;
  assert_true(zono_open_proof(&z));
  const shape *s = &z.shape;
  modes *m = z.modes;
  assert_true(s->mixed > 0);
  for (uint32_t i = 0; i < 2; i++) {
    double *y = z.proof->end + i * s->stride;
    memset(y, 0, s->stride * sizeof *y), y[s->eps + i] = 1, z.E[i] = 1;
    m->old.V[3 * i] = m->now.V[3 * i] = m->now.W[3 * i] = 1;
  }
  m->now.T[2] = m->now.U[2] = m->now.S[2] = m->now.tilt[2] = 0.125;
  z.proof->quartic->size[0] = 1;
  map_discs(&z);
  assert_true(m->in[1] >= 0.125 && m->in[1] < 0.126 && m->in[0] < 1e-10);
  give_back();
}

/* -- what data make of generators */

/* Sizes of many sums at once: of each, what generators make, and the one term of degree 4. */
static void check_many(const zono *z, const double *unit) {
  enum { SUMS = 300 };
  static double y[SUMS * MOST];
  const quartic *q = z->proof->quartic;
  long double moved = 0, fourth = 0;
  double kept;
  for (uint32_t r = 0; r < SUMS; r++) {
    long double term = 0;
    for (uint32_t i = 0; i < z->nx; i++) y[r * z->nx + i] = draw(-1, 1) / unit[i];
    for (uint32_t c = 0; c < z->ngen; c++) {
      long double sum = 0;
      for (uint32_t i = 0; i < z->nx; i++) sum += (long double)y[r * z->nx + i] * z->G[c * z->nx + i];
      moved += fabsl(sum);
    }
    for (uint32_t i = 0; i < z->nx && q->n; i++) term += (long double)y[r * z->nx + i] * q->term[i];
    fourth += fabsl(term);
  }
  double all = mixed_sizes(z, y, SUMS, &kept);
  assert_true(kept >= moved * (1 - 1e-12L) && kept <= moved * (1 + 1e-12L));
  assert_true(all - kept >= fourth * (1 - 1e-9L));
}

static void data_move_generators(void **unused) {
  (void)unused;
  static zono z;
  static maker k;
  for (uint32_t n = 0; n < 300; n++) {
    uint32_t nx = 1 + n % MOST, columns = pick(7);
    double unit[MOST];
    open_case(&z, &k, nx, 0, 0);
    z.h = 0.02, z.ngen_max = columns, z.G = lend(&host, 8 * MOST * MOST * sizeof *z.G);
    assert_true(zono_open_proof(&z));
    fill_jacobian(&z, unit), fill_maps(&z, unit, n % 5 ? draw(0, 1) : 0);
    memset(z.E, 0, nx * sizeof *z.E), z.ngen = columns;
    for (uint32_t c = 0; c < columns * nx; c++) z.G[c] = pick(4) ? unit[c % nx] * draw(-1, 1) : 0;
    for (uint32_t c = 0; c < columns * nx; c++) z.E[c % nx] += fabs(z.G[c]) * (1 + 1e-12);
    quartic *q = z.proof->quartic;
    q->n = q->length = n % 3 != 0, q->held = q->n > 0; /* one term of degree 4, which is 1 or -1 */
    for (uint32_t i = 0; i < nx && q->n; i++) {
      q->term[i] = 3 * unit[i] * draw(-1, 1), q->size[i] = fabs(q->term[i]) * (1 + 1e-12);
      z.E[i] += q->size[i];
    }
    mixed_prepare(&z);
    check_many(&z, unit);
    uint32_t found = mixed_add(&z, 0);
    for (int turn = 0; turn < 100; turn++) {
      long double l[MOST], moved[MOST] = { 0 }, truth = 0, bound = 0;
      double xi[MOST];
      for (uint32_t i = 0; i < nx; i++) l[i] = draw(-1, 1) / unit[i];
      draw_data(&z, xi);
      for (uint32_t i = 0; i < nx; i++)
        for (uint32_t j = 0; j < z.shape.mixed; j++)
          for (uint32_t a = 0; a < nx; a++)
            moved[a] += l[i] * xi[j] * z.proof->end[i * z.shape.stride + z.shape.mix + j * nx + a];
      for (uint32_t c = 0; c < columns; c++) {
        long double sum = 0;
        for (uint32_t a = 0; a < nx; a++) sum += moved[a] * z.G[c * nx + a];
        truth += fabsl(sum);
      }
      long double known = 0;
      for (uint32_t a = 0; a < nx && q->n; a++) known += moved[a] * q->term[a];
      truth += fabsl(known);
      for (uint32_t c = 0; c < found; c++) {
        long double sum = 0;
        for (uint32_t a = 0; a < nx; a++) sum += l[a] * z.proof->columns[c * nx + a];
        bound += fabsl(sum);
      }
      bound += boxes(&z, l);
      if (!(truth <= bound * (1 + 1e-15L))) fail_msg("%.17Lg times the bound is reached", truth / bound);
    }
    give_back();
  }
}

/* -- what eps stand for */

/* Errors that are small along some modes, on which forces are strong: G along them, one term of degree 4, discs. */
static void fill_errors(zono *z) {
  modes *m = z->modes;
  discs *d = &m->now;
  quartic *q = z->proof->quartic;
  uint32_t n = z->nx;
  double strength[MOST];
  for (uint32_t k = 0; k < n; k++) strength[k] = k % 2 ? strength[k - 1] : exp(draw(0, 12)), d->b[k] = 1 / strength[k];
  memset(z->E, 0, n * sizeof *z->E);
  for (uint32_t c = 0; c < z->ngen; c++)
    for (uint32_t i = 0; i < n; i++)
      z->G[c * n + i] = creal(d->V[i * n + c % n]) * draw(-1, 1) / strength[c % n], z->E[i] += fabs(z->G[c * n + i]);
  q->n = q->length = pick(2), q->held = q->n > 0;
  for (uint32_t i = 0; i < n; i++) {
    q->term[i] = cimag(d->V[i * n]) / strength[0], q->size[i] = fabs(q->term[i]) * (1 + 1e-12);
    z->E[i] = (z->E[i] + discs_width(z, i) + q->size[i]) * (1 + 1e-12), z->proof->spread[i] = z->E[i];
    for (uint32_t l = 0; l < n; l++) {
      complex double sum = 0;
      for (uint32_t k = 0; k < n; k++) sum += d->V[i * n + k] * strength[k] * d->W[k * n + l];
      z->proof->J[i * n + l] = creal(sum);
    }
  }
}

/* some errors, ends of their ranges mostly */
static void draw_errors(const zono *z, const double *xi, long double *e) {
  const discs *d = &z->modes->now;
  const quartic *q = z->proof->quartic;
  uint32_t n = z->nx;
  double by = pick(2) ? 1 : -1;
  for (uint32_t i = 0; i < n; i++) e[i] = q->n ? by * q->term[i] : 0;
  for (uint32_t c = 0; c < z->ngen; c++) {
    double rho = pick(2) ? 1 : -1;
    for (uint32_t i = 0; i < n; i++) e[i] += rho * (long double)z->G[c * n + i];
  }
  for (uint32_t k = 0; k < n; k++) {
    wide w = d->b[k] * cexp(draw(-4, 4) * I);
    for (uint32_t i = 0; i < n; i++) {
      wide v = d->V[i * n + k];
      for (uint32_t j = 0; j < z->shape.mixed; j++) v += (wide)d->U[(j * n + i) * n + k] * xi[j];
      e[i] += creall(v * w);
    }
  }
}

/* columns eps = e, by Gauss with pivots */
static void solve_for_eps(const zono *z, const long double *e, long double *eps) {
  uint32_t n = z->nx;
  long double m[MOST][MOST + 1];
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t k = 0; k < n; k++) m[i][k] = z->basis->columns[i * n + k];
    m[i][n] = e[i];
  }
  for (uint32_t k = 0; k < n; k++) {
    uint32_t pivot = k;
    for (uint32_t i = k; i < n; i++)
      if (fabsl(m[i][k]) > fabsl(m[pivot][k])) pivot = i;
    for (uint32_t c = 0; c <= n; c++) {
      long double old = m[k][c];
      m[k][c] = m[pivot][c], m[pivot][c] = old;
    }
    for (uint32_t i = 0; i < n; i++) {
      long double f = m[i][k] / m[k][k];
      for (uint32_t c = k; c <= n && i != k; c++) m[i][c] -= f * m[k][c];
    }
  }
  for (uint32_t k = 0; k < n; k++) eps[k] = m[k][n] / m[k][k];
}

static void errors_lie_in_the_basis(void **unused) {
  (void)unused;
  static zono z;
  static maker k;
  uint32_t turned = 0;
  long double most = 0;
  for (uint32_t n = 0; n < 300; n++) {
    uint32_t nx = 1 + n % MOST;
    double unit[MOST];
    open_case(&z, &k, nx, 0, 0);
    z.h = 0.02, z.ngen = z.ngen_max = pick(10), z.G = lend(&host, 10 * MOST * sizeof *z.G);
    assert_true(zono_open_proof(&z));
    fill_jacobian(&z, unit), fill_maps(&z, unit, draw(0, 1));
    if (modes_find(&z)) {
      z.modes->now.any = 1;
      fill_errors(&z), basis_choose(&z);
    }
    turned += (uint32_t)z.basis->is_turned;
    for (int turn = 0; turn < 40 && z.basis->is_turned; turn++) {
      long double e[MOST], eps[MOST], by_eps = 0, by_errors = 0, size = 0;
      double xi[MOST], y[MOST];
      draw_data(&z, xi), draw_errors(&z, xi, e), solve_for_eps(&z, e, eps);
      for (uint32_t i = 0; i < nx; i++) {
        if (!(fabsl(eps[i]) <= 1)) fail_msg("eps is %.17Lg", eps[i]);
        most = fmaxl(most, fabsl(eps[i])), y[i] = draw(-1, 1), by_eps += y[i] * eps[i];
      }
      double bound = basis_resolve(&z, y);
      for (uint32_t i = 0; i < nx; i++) by_errors += y[i] * e[i], size += fabsl(y[i] * e[i]);
      if (!(fabsl(by_eps - by_errors) <= bound + 1e-17L * size)) fail_msg("off by %Lg", by_eps - by_errors);
    }
    give_back();
  }
  assert_true(turned > 50 && most > 0.9);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(steps_lie_in_discs),
    cmocka_unit_test(they_are_no_larger_than_need_be),
    cmocka_unit_test(frequencies_cost_nothing),
    cmocka_unit_test(pairs_of_data_are_not_left_out),
    cmocka_unit_test(what_several_data_leave_is_bounded),
    cmocka_unit_test(what_axes_miss_is_turned),
    cmocka_unit_test(data_move_generators),
    cmocka_unit_test(errors_lie_in_the_basis),
  };
  return cmocka_run_group_tests_name("zonotope: old errors", tests, NULL, NULL);
}
