/* pilot.c -- before the first step, by an unproved run of low degree: how much each datum matters, how many of them
** need triples in rows, and how wide states get.
**
** A datum matters by its linear terms in the states. Data that matter most are numbered first, since parts of the rows
** and terms of degree 4 are held for the first data only. Pairs in the states tell how the motion bends: b is their
** size beside the linear terms, and b^(n - 1) about that of terms of degree n. Triples of data that have few pairs need
** no place in rows, where their number grows with the cube: far.c knows them at the middle of steps. What is built on
** them is not known then, and was seen to matter as b^4.
**
** What states get to tells what is next to nothing beside it, for states that start at rest or stay there for a while:
** what they get to soon, since what is added early grows as long as the run, and where sets grow by orders of magnitude
** their end is no measure of it. No proof depends on anything here.
*/
#include "implicit.h"
#include "zonotope.h"

#define STEPS 200
#define ORDER 8
#define PARTS 100      /* of the whole time, that a step is at most: it looks for kinks at the starts of steps only */
#define SOON 0.1       /* of the whole time */
#define LAST_TERM 1e-3 /* of a state, or of its set, that the last order in time may make in a step */
#define BENT 2e-6      /* of a state's set, that terms of degree 5 with the other data are at most */
#define MUCH 0.05      /* b^2 from which on all are needed */
#define FADED 0.1      /* of a set that was larger once, as if it still were so large */
#define LEAST 6        /* data that have triples in rows */
#define MANY 34        /* data: pairs of more would cost more than is gained */

typedef struct pilot {
  zono z;
  double *weight; /* [m] how much each datum matters, or NULL */
  double *bend;   /* [m x m] i <= j: what triples with this pair are of the states' sets, times time; */
  double bent;    /* of all pairs, at most at any time */
  double *widest; /* [nx] linear terms */
} pilot;

/* -- the run */

static double *doubles(const ambit_host *h, size_t n) { return h->alloc(h, (n + 1) * sizeof(double)); }

/* rows [n] of `from`, whose constants, linear terms and pairs are where the pilot's are */
static double *take_rows(const zono *of, const shape *s, const double *from, uint32_t n) {
  double *to = doubles(of->host, (size_t)n * s->stride);
  for (uint32_t i = 0; to && i < n; i++) {
    const double *x = from + (size_t)i * of->shape.stride;
    double *y = to + (size_t)i * s->stride;
    memcpy(y, x, (row_q(&of->shape, x) > 0 ? s->mix : s->eps) * sizeof *y);
    row_norms_all(s, y), y[s->norms + LOW] = row_low(&of->shape, x);
  }
  return to;
}

static int open_pilot(const zono *of, pilot *p, int is_weighed) {
  const ambit_host *h = of->host;
  zono *z = &p->z;
  size_t nx = of->nx, m = of->m;
  *p = (pilot) { .z = *of };
  z->shape.mixed = z->shape.room = 0;
  shape_place(&z->shape);
  z->K = z->K_max = ORDER < of->K_max ? ORDER : of->K_max;
  z->start = take_rows(of, &z->shape, of->start, of->nx), z->start_p = take_rows(of, &z->shape, of->start_p, of->np);
  if (!z->start || !z->start_p || !zono_open_rows(z) || (z->na && !zono_open_implicit(z))) return 0;
  z->P = doubles(h, nx * z->shape.stride), z->E = doubles(h, nx), z->G = doubles(h, nx * nx);
  p->widest = doubles(h, nx);
  if (is_weighed && !(p->weight = doubles(h, m))) return 0;
  if (is_weighed && m <= MANY && !(p->bend = doubles(h, m * m))) return 0;
  return z->P && z->E && z->G && p->widest;
}

/* x_i at s = h, constant, linear terms and pairs */
static void move(const zono *z, uint32_t i, double h, double *to) {
  const shape *s = &z->shape;
  double power = 1;
  memset(to, 0, s->stride * sizeof *to);
  for (uint32_t k = 0; k < orders(z, slot_x(z, i)); k++, power *= h) {
    const double *x = row_at(z, slot_x(z, i), k);
    for (uint32_t v = 0; v < s->eps; v++) to[v] += power * x[v];
    for (uint32_t v = s->pair[0]; v < s->mix && row_q(s, x) > 0; v++) to[v] += power * x[v];
  }
  row_norms_all(s, to);
}

/* Terms of the data may swing much faster than the motion. */
static int fits(const pilot *p, double h) {
  const zono *z = &p->z;
  for (uint32_t i = 0; i < z->nx; i++) {
    double sum = 0, last = 0, all = 0, end = 0, power = 1;
    for (uint32_t k = 0; k < orders(z, slot_x(z, i)); k++, power *= fabs(h)) {
      const double *x = row_at(z, slot_x(z, i), k);
      sum += last = row_total(&z->shape, x) * power, all += end = row_moving(&z->shape, x) * power;
    }
    if (!(last <= LAST_TERM * sum) || (p->weight && !(end <= LAST_TERM * all))) return 0;
  }
  return 1;
}

static void note_widths(const zono *z, double *expected) {
  for (uint32_t i = 0; i < z->nx; i++) {
    double width = row_l(&z->shape, z->P + (size_t)i * z->shape.stride);
    if (width < INFINITY) expected[i] = fmax(expected[i], width);
  }
}

/* weights += length of the step times the shares of the states' linear terms */
static void weigh(const pilot *p, double h) {
  const zono *z = &p->z;
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *x = z->P + (size_t)i * z->shape.stride;
    double l = row_l(&z->shape, x);
    for (uint32_t j = 0; j < z->m && l > 0; j++) p->weight[j] += fabs(h) * fabs(x[1 + j]) / l;
  }
}

/* bends += length of the step times those of the state that is bent most */
static void bend(pilot *p, double h) {
  const zono *z = &p->z;
  const shape *s = &z->shape;
  const double *most = NULL;
  double worst = 0, by = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *x = z->P + (size_t)i * s->stride;
    p->widest[i] = fmax(p->widest[i], row_l(s, x));
    double set = fmax(row_l(s, x), FADED * p->widest[i]);
    if (set > 0 && row_q(s, x) > worst * set) worst = row_q(s, x) / set, most = x, by = set;
  }
  p->bent = fmax(p->bent, worst * worst);
  for (uint32_t i = 0; most && i < z->m; i++)
    for (uint32_t j = i; j < s->reach[i]; j++)
      p->bend[(size_t)i * z->m + j] += fabs(h) * fabs(most[s->pair[i] + j - i]) / by * worst;
}

/* -- what is done with it */

/* data, in the order of their weights, without which the others bend next to nothing */
static uint32_t count_bent(const pilot *p) {
  uint32_t m = p->z.m, n = m, *rank = p->z.host->alloc(p->z.host, (m + 1u) * sizeof *rank);
  double *lost = doubles(p->z.host, m), sum = 0, all = 0;
  if (!rank || !lost) return m;
  for (uint32_t i = 0; i < m; i++) {
    rank[i] = 0;
    for (uint32_t j = 0; j < m; j++)
      rank[i] += p->weight[j] > p->weight[i] || (!(p->weight[j] < p->weight[i]) && j < i);
  }
  for (uint32_t i = 0; i < m; i++)
    for (uint32_t j = i; j < m; j++) {
      double part = p->bend[(size_t)i * m + j];
      lost[rank[i] > rank[j] ? rank[i] : rank[j]] += part, all += part;
    }
  while (n > LEAST && p->bent < MUCH && (sum += lost[n - 1]) * p->bent * p->bent <= BENT * all) n--;
  return n;
}

int zono_pilot(zono *of, double *weight, int may_wait) {
  pilot p;
  double first = of->problem.time[0], end = of->problem.time[of->problem.ntime - 1], part = (end - first) / PARTS;
  double soon = SOON * fabs(end - first);
  if (!open_pilot(of, &p, weight != NULL)) return 0;
  zono *z = &p.z;
  zono_start(z);
  z->shape.paired = p.bend ? UINT32_MAX : 1, z->shape.mixing = z->shape.cubed = 0;
  memset(z->E, 0, z->nx * sizeof *z->E);
  for (uint32_t n = 0; n < STEPS && z->t != end && zono_series(z); n++) {
    if (!weight && !may_wait && fabs(z->t - first) >= soon) break;
    double h = fabs(end - z->t) > fabs(part) ? part : end - z->t;
    for (int halved = 0; halved < 60 && !fits(&p, h); halved++) h *= 0.5;
    for (uint32_t i = 0; i < z->nx; i++) move(z, i, h, z->P + (size_t)i * z->shape.stride);
    if (weight) weigh(&p, h);
    if (p.bend) bend(&p, h);
    if (may_wait || fabs(z->t - first) < soon) note_widths(z, of->expected);
    z->t = h == end - z->t ? end : z->t + h;
  }
  for (uint32_t j = 0; weight && j < z->m; j++) {
    if (z->unknown[j] == AMBIT_NO_SLOT)
      p.weight[j] = -1; /* of the solver's own data: they come last */
    else
      weight[z->unknown[j]] += p.weight[j];
  }
  if (p.bend) of->bent = count_bent(&p);
  return 1;
}
