/* merge.c -- hulls of pieces. Least and greatest of numbers are the same in every order; zeros lose their sign on the
** way out, since the least of 0 and -0 is not. */
#include "verbs/split/merge.h"
#include <math.h>
#include <pthread.h>
#include <stdio.h>

typedef struct interval_state {
  uint32_t arrived, flags, order;
  bool no_tube, filled; /* some piece has no tube; some piece has added something */
} interval_state;

struct ambit_merge {
  pthread_mutex_t lock;
  uint32_t nx, pieces, count; /* intervals */
  const double *time;
  interval_state *state; /* [count] */
  double *hull;          /* [count][4 nx]: lo, hi, tube lo, tube hi */
  uint64_t arrived;      /* over all intervals */
  uint32_t forwarded;    /* intervals that the sink has */
  bool stop;
  uint32_t failed_piece, failed_at; /* least by (intervals completed, number) */
  ambit_failure failed;
  uint32_t nothing, nothing_piece; /* pieces without a solution; the least of them, and why it has none */
  ambit_failure why_nothing;
};

ambit_status ambit_merge_open(ambit_arena *arena, const ambit_problem *p, uint32_t pieces, ambit_merge **out) {
  *out = NULL;
  ambit_merge *m = ambit_arena_alloc(arena, sizeof *m);
  if (!m) return AMBIT_NOMEM;
  *m = (ambit_merge) { .nx = p->nx, .pieces = pieces, .count = p->ntime - 1, .time = p->time };
  m->failed_at = UINT32_MAX;
  m->state = ambit_arena_alloc(arena, m->count * sizeof *m->state);
  m->hull = ambit_arena_alloc(arena, (size_t)m->count * 4 * m->nx * sizeof *m->hull);
  if (!m->state || !m->hull) return AMBIT_NOMEM;
  pthread_mutex_init(&m->lock, NULL);
  *out = m;
  return AMBIT_OK;
}

void ambit_merge_close(ambit_merge *m) {
  if (m) pthread_mutex_destroy(&m->lock);
}

/* -- from the pieces */

static void widen(uint32_t n, double *lo, double *hi, const double *other_lo, const double *other_hi) {
  for (uint32_t i = 0; i < n; i++) {
    if (other_lo[i] < lo[i]) lo[i] = other_lo[i];
    if (other_hi[i] > hi[i]) hi[i] = other_hi[i];
  }
}

static void start_hull(uint32_t n, double *hull) {
  for (uint32_t i = 0; i < n; i++) {
    hull[i] = hull[2 * n + i] = INFINITY;
    hull[n + i] = hull[3 * n + i] = -INFINITY;
  }
}

static void add(ambit_merge *m, uint32_t interval, const ambit_merge_part *part) {
  interval_state *s = &m->state[interval];
  double *hull = m->hull + (size_t)interval * 4 * m->nx;
  if (!s->filled) start_hull(m->nx, hull);
  s->filled = true;
  s->flags |= part->flags;
  if (part->order > s->order) s->order = part->order;
  s->no_tube = s->no_tube || !part->has_tube;
  widen(m->nx, hull, hull + m->nx, part->lo, part->hi);
  if (part->has_tube) widen(m->nx, hull + 2 * m->nx, hull + 3 * m->nx, part->tube_lo, part->tube_hi);
}

void ambit_merge_put(ambit_merge *m, uint32_t interval, const ambit_merge_part *part) {
  pthread_mutex_lock(&m->lock);
  add(m, interval, part);
  m->state[interval].arrived++;
  m->arrived++;
  pthread_mutex_unlock(&m->lock);
}

void ambit_merge_put_nothing(ambit_merge *m, uint32_t piece, uint32_t completed, const ambit_failure *why) {
  pthread_mutex_lock(&m->lock);
  if (!m->nothing++ || piece < m->nothing_piece) {
    m->nothing_piece = piece;
    m->why_nothing = *why;
  }
  for (uint32_t k = completed; k < m->count; k++) m->state[k].arrived++;
  m->arrived += m->count - completed;
  pthread_mutex_unlock(&m->lock);
}

static bool is_behind(const ambit_merge *m, uint32_t piece, uint32_t completed) {
  return completed < m->failed_at || (completed == m->failed_at && piece < m->failed_piece);
}

/* A broken solver is worse than one that could not go on, however far either got. */
static bool outranks(const ambit_merge *m, const ambit_failure *why) {
  return why->status == AMBIT_BROKEN && m->failed.status != AMBIT_OK && m->failed.status != AMBIT_BROKEN;
}

void ambit_merge_fail(ambit_merge *m, uint32_t piece, uint32_t completed, const ambit_failure *why) {
  pthread_mutex_lock(&m->lock);
  bool broken = m->failed.status == AMBIT_BROKEN;
  if (outranks(m, why) || (is_behind(m, piece, completed) && (!broken || why->status == AMBIT_BROKEN))) {
    m->failed_piece = piece;
    m->failed_at = completed;
    m->failed = *why;
  }
  pthread_mutex_unlock(&m->lock);
}

bool ambit_merge_is_over(ambit_merge *m, uint32_t piece, uint32_t completed) {
  pthread_mutex_lock(&m->lock);
  bool over = m->stop || (m->failed.status != AMBIT_OK && !is_behind(m, piece, completed));
  pthread_mutex_unlock(&m->lock);
  return over;
}

/* -- of one piece */

const double *ambit_merge_hull(const ambit_merge *m, uint32_t interval) {
  return m->state[interval].filled ? m->hull + (size_t)interval * 4 * m->nx : NULL;
}

static bool meets(uint32_t n, const double *lo, const double *hi, const double *other_lo, const double *other_hi) {
  for (uint32_t i = 0; i < n; i++)
    if (lo[i] > other_hi[i] || hi[i] < other_lo[i]) return false;
  return true;
}

static void intersect(uint32_t n, double *lo, double *hi, const double *other_lo, const double *other_hi) {
  if (!meets(n, lo, hi, other_lo, other_hi)) return;
  for (uint32_t i = 0; i < n; i++) {
    if (other_lo[i] > lo[i]) lo[i] = other_lo[i];
    if (other_hi[i] < hi[i]) hi[i] = other_hi[i];
  }
}

void ambit_merge_narrow(ambit_merge *m, const ambit_merge *larger) {
  uint32_t nx = m->nx;
  for (uint32_t k = 0; k < m->count; k++) {
    if (!m->state[k].filled || !larger->state[k].filled) continue;
    double *hull = m->hull + (size_t)k * 4 * nx;
    const double *other = larger->hull + (size_t)k * 4 * nx;
    intersect(nx, hull, hull + nx, other, other + nx);
    if (!m->state[k].no_tube && !larger->state[k].no_tube)
      intersect(nx, hull + 2 * nx, hull + 3 * nx, other + 2 * nx, other + 3 * nx);
  }
}

bool ambit_merge_is_complete(const ambit_merge *m) {
  return m->failed.status == AMBIT_OK && m->arrived == (uint64_t)m->count * m->pieces;
}

void ambit_merge_join(ambit_merge *m, uint32_t piece, const ambit_merge *own) {
  uint32_t nx = m->nx;
  for (uint32_t k = 0; k < m->count; k++) {
    const interval_state *s = &own->state[k];
    if (s->arrived == 0) continue;
    double *hull = own->hull + (size_t)k * 4 * nx;
    const ambit_merge_part part = { .lo = hull,
      .hi = hull + nx,
      .tube_lo = hull + 2 * nx,
      .tube_hi = hull + 3 * nx,
      .flags = s->flags,
      .order = s->order,
      .has_tube = !s->no_tube };
    if (s->filled) add(m, k, &part);
    m->state[k].arrived++;
    m->arrived++;
  }
  if (own->failed.status != AMBIT_OK) ambit_merge_fail(m, piece, own->failed_at, &own->failed);
  if (!own->nothing) return;
  if (!m->nothing++) m->nothing_piece = piece, m->why_nothing = own->why_nothing;
}

/* -- to the sink */

static int32_t forward_one(ambit_merge *m, uint32_t interval, ambit_sink *sink) {
  uint32_t nx = m->nx;
  const interval_state *s = &m->state[interval];
  double *hull = m->hull + (size_t)interval * 4 * nx;
  if (!s->filled) return 0;
  for (uint32_t i = 0; i < 4 * nx; i++) hull[i] += 0.0;
  const ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = m->time[interval],
    .t_to = m->time[interval + 1],
    .nx = nx,
    .flags = s->flags,
    .rigorous = 1,
    .lo = hull,
    .hi = hull + nx,
    .tube_lo = s->no_tube ? NULL : hull + 2 * nx,
    .tube_hi = s->no_tube ? NULL : hull + 3 * nx,
    .order = s->order };
  return sink->emit ? sink->emit(sink, &r) : 0;
}

int32_t ambit_merge_forward(ambit_merge *m, ambit_sink *sink) {
  pthread_mutex_lock(&m->lock);
  uint32_t ready = m->forwarded;
  while (ready < m->count && m->state[ready].arrived == m->pieces) ready++;
  double done = (double)m->arrived / ((double)m->count * m->pieces);
  bool stop = m->stop;
  pthread_mutex_unlock(&m->lock);
  while (!stop && m->forwarded < ready) stop = forward_one(m, m->forwarded++, sink) != 0;
  if (!stop && sink->progress) stop = sink->progress(sink, done, "pieces") != 0;
  if (!stop) return 0;
  pthread_mutex_lock(&m->lock);
  m->stop = true;
  pthread_mutex_unlock(&m->lock);
  return 1;
}

ambit_status ambit_merge_outcome(ambit_merge *m, ambit_failure *why) {
  pthread_mutex_lock(&m->lock);
  *why = m->failed.status == AMBIT_OK && m->nothing == m->pieces ? m->why_nothing : m->failed;
  pthread_mutex_unlock(&m->lock);
  return why->status;
}
