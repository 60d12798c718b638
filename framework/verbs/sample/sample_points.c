/* sample_points.c -- midpoint, corners, points of a sequence. */
#include "verbs/sample/sample_points.h"
#include "num/random.h"
#include <ambit/quasi_random.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MANY_CORNERS 62 /* data: more have corners that no counter numbers */

struct ambit_sample_points {
  ambit_sample_points_request q;
  const ambit_quasi_random_service *service; /* NULL: pseudo-random */
  void *sequence;
  char name[24], why[256];
  double *shift;    /* [n] */
  size_t corners;   /* draws 1, 3, ..., 2 corners - 1 are corners */
  bool all_corners; /* each of them once */
  uint64_t flips;   /* of the bits of a corner's number */
  pthread_mutex_t lock;
  /* guarded by the lock */
  size_t next;
  ambit_random random; /* of the points of the inside */
};

static void fall_back(ambit_sample_points *p, const char *why) {
  snprintf(p->name, sizeof p->name, "random");
  snprintf(p->why, sizeof p->why, "%s", why);
}

static ambit_status no_sequence(ambit_sample_points *p, const char *why, ambit_failure *f) {
  fall_back(p, why);
  if (!p->q.points) return AMBIT_OK;
  return ambit_fail(
      f, AMBIT_INVALID, "points: \"%s\" cannot draw: %s; leave `points` out, or say \"random\"", p->q.points, why);
}

static ambit_status find_service(ambit_registry *registry, ambit_sample_points *p, ambit_failure *f) {
  const ambit_plugin *plugin;
  ambit_failure own = { 0 };
  if (ambit_registry_plugin(registry, "service", "quasi_random", &plugin, &own) != AMBIT_OK)
    return no_sequence(p, "the plugin service/quasi_random is not installed", f);
  p->service = plugin->get(AMBIT_QUASI_RANDOM_SERVICE);
  if (p->service && p->service->size >= sizeof *p->service) return AMBIT_OK;
  p->service = NULL;
  return no_sequence(p, "the plugin service/quasi_random offers no " AMBIT_QUASI_RANDOM_SERVICE, f);
}

/* The asked one, or the first that has as many dimensions. */
static ambit_status choose(ambit_sample_points *p, ambit_failure *f) {
  static const char *const by_evenness[] = { "sobol", "reverse_halton" };
  uint32_t dimensions = 0, most_dimensions = 0;
  uint64_t points = 0;
  char why[128];
  for (size_t i = 0; i < sizeof by_evenness / sizeof *by_evenness; i++) {
    const char *name = p->q.points ? p->q.points : by_evenness[i];
    p->service->most(name, &dimensions, &points);
    if (dimensions == 0)
      return ambit_fail(
          f, AMBIT_INVALID, "points: expected sobol, niederreiter, halton, reverse_halton or random, got `%s`", name);
    if (p->q.n <= dimensions && p->q.draws <= points) {
      snprintf(p->name, sizeof p->name, "%s", name);
      return p->service->open(name, (uint32_t)p->q.n, &p->sequence) == AMBIT_OK ? AMBIT_OK : ambit_no_memory(f);
    }
    most_dimensions = dimensions > most_dimensions ? dimensions : most_dimensions;
    if (p->q.points) break;
  }
  if (p->q.n > most_dimensions)
    snprintf(why, sizeof why, "%zu data, and a sequence has at most %u dimensions", p->q.n, most_dimensions);
  else
    snprintf(
        why, sizeof why, "%zu draws, and a sequence has at most %llu points", p->q.draws, (unsigned long long)points);
  p->service = NULL;
  return no_sequence(p, why, f);
}

static ambit_status open_sequence(ambit_registry *registry, ambit_sample_points *p, ambit_failure *f) {
  if (p->q.points && strcmp(p->q.points, "random") == 0) {
    fall_back(p, "");
    return AMBIT_OK;
  }
  if (p->q.n == 0) {
    fall_back(p, "nothing is uncertain");
    return AMBIT_OK;
  }
  ambit_status status = find_service(registry, p, f);
  return status == AMBIT_OK && p->service ? choose(p, f) : status;
}

static void plan_corners(ambit_sample_points *p) {
  size_t half = p->q.draws / 2, n = p->q.n;
  p->corners = p->q.no_corners || n == 0 ? 0 : half;
  p->all_corners = n <= MANY_CORNERS && (UINT64_C(1) << n) <= half;
  if (p->all_corners && p->corners) p->corners = (size_t)1 << n;
}

ambit_status ambit_sample_points_open(
    ambit_registry *registry, const ambit_sample_points_request *q, ambit_sample_points **points, ambit_failure *f) {
  *points = NULL;
  ambit_sample_points *p = calloc(1, sizeof *p);
  if (!p || !(p->shift = calloc(q->n + 1, sizeof *p->shift))) {
    free(p);
    return ambit_no_memory(f);
  }
  p->q = *q;
  pthread_mutex_init(&p->lock, NULL);
  ambit_random random = { q->seed };
  for (size_t i = 0; i < q->n; i++) p->shift[i] = (double)(ambit_random_bits(&random) >> 11) * 0x1p-53;
  p->flips = ambit_random_bits(&random);
  p->random.state = ambit_random_bits(&random);
  plan_corners(p);
  ambit_status status = open_sequence(registry, p, f);
  if (status != AMBIT_OK) {
    ambit_sample_points_close(p);
    return status;
  }
  *points = p;
  return AMBIT_OK;
}

void ambit_sample_points_close(ambit_sample_points *p) {
  if (!p) return;
  if (p->service) p->service->close(p->sequence);
  pthread_mutex_destroy(&p->lock);
  free(p->shift);
  free(p);
}

const char *ambit_sample_points_name(const ambit_sample_points *p) { return p->name; }
const char *ambit_sample_points_why(const ambit_sample_points *p) { return p->why; }

/* -- a block */

static bool is_corner(const ambit_sample_points *p, size_t draw) { return draw % 2 && draw / 2 < p->corners; }

/* How many of the draws are points of the inside. */
static size_t count_inside(const ambit_sample_points *p, size_t first, size_t count) {
  size_t inside = 0;
  for (size_t k = first; k < first + count; k++) inside += k != 0 && !is_corner(p, k);
  return inside;
}

static void put_corner(const ambit_sample_points *p, size_t number, double *out, size_t stride) {
  ambit_random random = { p->flips };
  ambit_random_skip(&random, (uint64_t)number * p->q.n);
  for (size_t i = 0; i < p->q.n; i++) {
    uint64_t upper = p->all_corners ? (number ^ p->flips) >> i & 1 : ambit_random_bits(&random) >> 63;
    out[i * stride] = upper ? p->q.range[i].hi : p->q.range[i].lo;
  }
}

/* The part u in [0, 1) of the range. */
static double within(ambit_interval x, double u) {
  double v = x.lo * (1 - u) + x.hi * u;
  return v < x.lo ? x.lo : v > x.hi ? x.hi : v;
}

/* [lock held] The next `count` numbers of each datum, at out[i * stride]. */
static ambit_status take_inside(ambit_sample_points *p, size_t count, double *out, size_t stride) {
  if (p->service) return p->service->next(p->sequence, count, out, stride);
  for (size_t k = 0; k < count; k++)
    for (size_t i = 0; i < p->q.n; i++) out[i * stride + k] = (double)(ambit_random_bits(&p->random) >> 11) * 0x1p-53;
  return AMBIT_OK;
}

/* From the numbers that lie at the front of a row to the points at their places: from the last one on, since no number
** is behind its place. */
static void spread_row(const ambit_sample_points *p, size_t first, size_t count, size_t inside, size_t i, double *row) {
  ambit_interval range = p->q.range[i];
  double shift = p->service ? p->shift[i] : 0;
  for (size_t k = count; k-- > 0;) {
    if (first + k == 0 || is_corner(p, first + k)) continue;
    double u = row[--inside] + shift;
    row[k] = within(range, u >= 1 ? u - 1 : u);
  }
}

ambit_status ambit_sample_points_next(ambit_sample_points *p, size_t most, double *out, size_t *first, size_t *count) {
  pthread_mutex_lock(&p->lock);
  size_t left = p->q.draws - p->next, n = left < most ? left : most, inside = 0;
  *first = p->next, *count = n;
  p->next += n;
  inside = count_inside(p, *first, n);
  ambit_status status = n && p->q.n ? take_inside(p, inside, out, n) : AMBIT_OK;
  pthread_mutex_unlock(&p->lock);
  if (status != AMBIT_OK || n == 0) return status;
  for (size_t i = 0; i < p->q.n; i++) spread_row(p, *first, n, inside, i, out + i * n);
  for (size_t k = 0; k < n; k++)
    if (is_corner(p, *first + k)) put_corner(p, (*first + k) / 2, out + k, n);
  for (size_t i = 0; i < p->q.n && *first == 0; i++) out[i * n] = ambit_interval_mid(p->q.range[i]);
  return AMBIT_OK;
}
