/* meter.c -- frames of one thread, and threads joined.
**
** A frame's own time is what is left of it without the frames inside. Each look at the clock costs time that falls
** partly into the frame (between its two looks) and partly into the one around it; both shares are measured on empty
** frames when the profile begins.
*/
#include "base/meter.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define DEPTH 4096  /* elements that ask each other */
#define FRAMES 8192 /* of a thread */
#define EMPTY 2000  /* frames, to measure what one costs */
#define ROUNDS 9

typedef struct level {
  ambit_meter_frame *frame;
  uint64_t since;
  bool mark;
} level;

typedef struct meter {
  struct meter *next;
  ambit_profile *profile;
  ambit_meter_frame *frame;     /* [FRAMES] */
  uint32_t used, depth, beyond; /* levels in use; those that found no room */
  level stack[DEPTH];
  bool busy;
} meter;

struct ambit_profile {
  pthread_mutex_t lock;
  ambit_meter_table *tables;
  meter *meters; /* the first is that of the thread that began */
  uint64_t began, ended;
  double seconds;         /* wall time between the two */
  double inside, outside; /* ticks of an empty frame: in it, around it */
  double mark;            /* ticks of an empty mark, all of them in it */
  struct timespec start;
  atomic_bool cut; /* any thread says so */
};

static _Thread_local meter *current;

static uint64_t now(void) {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
#endif
}

/* -- the tree */

static ambit_meter_frame *new_frame(meter *m, uint32_t kind, const char *name, ambit_meter_frame *parent) {
  if (m->used == FRAMES) {
    m->profile->cut = true;
    return NULL;
  }
  ambit_meter_frame *f = &m->frame[m->used++];
  f->kind = kind;
  snprintf(f->name, sizeof f->name, "%s", name);
  f->parent = parent;
  if (parent) f->next = parent->child, parent->child = f;
  return f;
}

static bool is_named(const ambit_meter_frame *f, const char *name) {
  return strncmp(f->name, name, AMBIT_FRAME_NAME - 1) == 0;
}

static ambit_meter_frame *find_frame(
    meter *m, uint32_t kind, const char *name, ambit_meter_frame *parent, ambit_meter_frame *anchor) {
  for (ambit_meter_frame *f = parent->child; f; f = f->next)
    if (f->kind == kind && f->anchor == anchor && is_named(f, name)) return f;
  ambit_meter_frame *made = new_frame(m, kind, name, parent);
  if (made) made->anchor = anchor;
  return made;
}

/* Where a new frame hangs: elements that ask each other hang side by side, not in chains as long as the mechanism. */
static ambit_meter_frame *place_for(const meter *m, uint32_t kind) {
  ambit_meter_frame *top = m->stack[m->depth - 1].frame;
  return kind == AMBIT_FRAME_ELEMENT && top->kind == AMBIT_FRAME_ELEMENT ? top->parent : top;
}

static void push(meter *m, uint32_t kind, const char *name, ambit_meter_frame *anchor, bool mark, uint64_t since) {
  bool full = m->beyond || m->depth == DEPTH;
  ambit_meter_frame *f = full ? NULL : find_frame(m, kind, name, place_for(m, kind), anchor);
  if (!f) {
    m->beyond++;
    m->profile->cut = true;
    return;
  }
  m->stack[m->depth++] = (level) { f, since, mark };
}

static void pop(meter *m, uint64_t at) {
  if (m->beyond) {
    m->beyond--;
    return;
  }
  const level *top = &m->stack[--m->depth];
  ambit_meter_frame *f = top->frame, *parent = m->depth ? m->stack[m->depth - 1].frame : NULL;
  uint64_t ticks = at > top->since ? at - top->since : 0; /* clocks of two processors may differ */
  f->count++;
  f->marks += top->mark;
  f->ticks += ticks;
  if (!parent) return;
  parent->child_count += !top->mark;
  parent->child_ticks += ticks;
}

/* the root stays */
static bool has_level(const meter *m) { return m->beyond || m->depth > 1; }

static bool is_marked(const meter *m) { return !m->beyond && m->stack[m->depth - 1].mark; }

/* -- frames of this thread */

bool ambit_meter_is_on(void) { return current != NULL; }

void ambit_meter_enter(uint32_t kind, const char *name) {
  if (current) push(current, kind, name, NULL, false, now());
}

void ambit_meter_leave(void) {
  meter *m = current;
  if (!m || !has_level(m)) return;
  uint64_t at = now();
  if (is_marked(m)) pop(m, at);
  if (has_level(m)) pop(m, at);
}

void ambit_meter_mark(uint32_t kind, const char *name) {
  meter *m = current;
  if (!m) return;
  uint64_t at = now();
  if (is_marked(m)) pop(m, at);
  if (m->beyond) return;
  push(m, kind, name, NULL, true, at);
  m->beyond = 0; /* one that found no room is nobody's to leave */
}

uint32_t ambit_meter_depth(void) { return current ? current->depth + current->beyond : 0; }

void ambit_meter_unwind(uint32_t depth) {
  meter *m = current;
  if (!m) return;
  uint64_t at = now();
  while (m->depth + m->beyond > depth && has_level(m)) pop(m, at);
}

/* -- tables */

ambit_meter_table *ambit_meter_tabulate(const char *title, uint32_t rows, uint32_t columns) {
  meter *m = current;
  if (!m || m->beyond) return NULL;
  ambit_meter_table *t = calloc(1, sizeof *t);
  if (!t) return NULL;
  t->name = calloc(rows + (size_t)1, sizeof *t->name);
  t->value = calloc((size_t)rows * columns + 1, sizeof *t->value);
  if (!t->name || !t->value) {
    free(t->name);
    free(t->value);
    free(t);
    return NULL;
  }
  t->title = title, t->rows = rows, t->columns = columns;
  t->frame = m->stack[m->depth - 1].frame;
  pthread_mutex_lock(&m->profile->lock);
  t->next = m->profile->tables;
  m->profile->tables = t;
  pthread_mutex_unlock(&m->profile->lock);
  return t;
}

const ambit_meter_table *ambit_profile_tables(const ambit_profile *p) { return p->tables; }

/* -- threads */

static meter *new_meter(ambit_profile *p, uint32_t kind, const char *name) {
  meter *m = calloc(1, sizeof *m);
  if (m) m->frame = calloc(FRAMES, sizeof *m->frame);
  if (!m || !m->frame) {
    free(m);
    return NULL;
  }
  m->profile = p;
  m->stack[m->depth++] = (level) { new_frame(m, kind, name, NULL), now(), false };
  return m;
}

/* One that no thread uses now, or a new one behind the others. */
static meter *take_meter(ambit_profile *p) {
  pthread_mutex_lock(&p->lock);
  meter **at = &p->meters;
  while (*at && (*at)->busy) at = &(*at)->next;
  if (!*at) *at = new_meter(p, AMBIT_FRAME_THREAD, "");
  meter *m = *at;
  if (m) m->busy = true;
  pthread_mutex_unlock(&p->lock);
  return m;
}

/* On a thread of a pool: the place of the first thread that it works for, so that a pool inside a pool is not lost. */
ambit_meter_place ambit_meter_here(void) {
  const meter *m = current;
  if (!m) return (ambit_meter_place) { 0 };
  ambit_meter_frame *top = m->stack[m->depth - 1].frame, *f = top;
  while (f && !f->anchor) f = f->parent;
  return (ambit_meter_place) { m->profile, f ? f->anchor : top };
}

bool ambit_meter_join(const ambit_meter_place *place, const char *name) {
  if (!place->profile) return false;
  if (current) { /* the thread that waits does the work itself */
    ambit_meter_enter(AMBIT_FRAME_THREAD, name);
    return true;
  }
  current = take_meter(place->profile);
  if (current) push(current, AMBIT_FRAME_THREAD, name, place->frame, false, now());
  return current != NULL;
}

void ambit_meter_part(void) {
  meter *m = current;
  ambit_meter_leave();
  if (!m || m == m->profile->meters || m->depth > 1) return;
  current = NULL;
  pthread_mutex_lock(&m->profile->lock);
  m->busy = false;
  pthread_mutex_unlock(&m->profile->lock);
}

/* -- a profile */

/* -- what measuring costs: the lower quartile of rounds, for others may have been interrupted */

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double quartile(size_t n, double *x) {
  qsort(x, n, sizeof *x, by_value);
  return x[n / 4];
}

static void calibrate_frames(ambit_profile *p) {
  double inside[ROUNDS], outside[ROUNDS];
  const ambit_meter_frame *empty = new_frame(current, AMBIT_FRAME_OPERATION, "empty", current->stack[0].frame);
  for (int r = 0; r < ROUNDS; r++) {
    uint64_t before = empty->ticks, start = now();
    for (int i = 0; i < EMPTY; i++) {
      ambit_meter_enter(AMBIT_FRAME_OPERATION, "empty");
      ambit_meter_leave();
    }
    uint64_t all = now() - start;
    inside[r] = (double)(empty->ticks - before) / EMPTY;
    outside[r] = (double)all / EMPTY - inside[r];
  }
  p->inside = quartile(ROUNDS, inside);
  p->outside = quartile(ROUNDS, outside);
}

static void calibrate_marks(ambit_profile *p) {
  double each[ROUNDS];
  for (int r = 0; r < ROUNDS; r++) {
    uint64_t start = now();
    for (int i = 0; i < EMPTY; i++) ambit_meter_mark(AMBIT_FRAME_OPERATION, i % 2 ? "empty" : "other");
    each[r] = (double)(now() - start) / EMPTY;
  }
  p->mark = quartile(ROUNDS, each);
}

static void start_afresh(ambit_profile *p) {
  meter *m = p->meters;
  memset(m->frame, 0, m->used * sizeof *m->frame);
  m->used = m->depth = 0;
  p->began = now();
  clock_gettime(CLOCK_MONOTONIC, &p->start);
  m->stack[m->depth++] = (level) { new_frame(m, AMBIT_FRAME_SCRIPT, "script", NULL), p->began, false };
}

ambit_profile *ambit_profile_begin(void) {
  if (current) return NULL;
  ambit_profile *p = calloc(1, sizeof *p);
  if (!p) return NULL;
  pthread_mutex_init(&p->lock, NULL);
  p->meters = new_meter(p, AMBIT_FRAME_SCRIPT, "script");
  if (!p->meters) {
    ambit_profile_close(p);
    return NULL;
  }
  current = p->meters;
  current->busy = true;
  calibrate_frames(p);
  calibrate_marks(p);
  start_afresh(p);
  return p;
}

static void add_frames(meter *m, ambit_meter_frame *to, const ambit_meter_frame *from) {
  for (const ambit_meter_frame *f = from->child; f; f = f->next) {
    ambit_meter_frame *parent = f->anchor ? f->anchor : to;
    ambit_meter_frame *same = find_frame(m, f->kind, f->name, parent, NULL);
    if (!same) return;
    same->count += f->count, same->marks += f->marks, same->ticks += f->ticks;
    same->child_count += f->child_count, same->child_ticks += f->child_ticks;
    add_frames(m, same, f);
  }
}

const ambit_meter_frame *ambit_profile_end(ambit_profile *p) {
  meter *m = p->meters;
  struct timespec end;
  ambit_meter_unwind(1);
  p->ended = now();
  clock_gettime(CLOCK_MONOTONIC, &end);
  p->seconds = (double)(end.tv_sec - p->start.tv_sec) + 1e-9 * (double)(end.tv_nsec - p->start.tv_nsec);
  pop(m, p->ended);
  current = NULL;
  for (meter *other = m->next; other; other = other->next) add_frames(m, m->frame, other->frame);
  return m->frame;
}

void ambit_profile_close(ambit_profile *p) {
  if (!p) return;
  if (current && current->profile == p) current = NULL;
  while (p->meters) {
    meter *m = p->meters;
    p->meters = m->next;
    free(m->frame);
    free(m);
  }
  while (p->tables) {
    ambit_meter_table *t = p->tables;
    p->tables = t->next;
    free(t->name);
    free(t->value);
    free(t);
  }
  pthread_mutex_destroy(&p->lock);
  free(p);
}

static double seconds_of(const ambit_profile *p, double ticks) {
  return p->ended > p->began ? ticks * p->seconds / (double)(p->ended - p->began) : 0;
}

static double own_ticks(const ambit_meter_frame *f) { return (double)f->ticks - (double)f->child_ticks; }

/* no more than there is: a frame may have been quicker than the empty ones */
static double cost_ticks(const ambit_profile *p, const ambit_meter_frame *f) {
  double frames = p->inside * (double)(f->count - f->marks) + p->outside * (double)f->child_count;
  double cost = frames + p->mark * (double)f->marks, own = own_ticks(f);
  return cost < own ? cost : own > 0 ? own : 0;
}

double ambit_profile_self_seconds(const ambit_profile *p, const ambit_meter_frame *f) {
  double own = own_ticks(f) - cost_ticks(p, f);
  return seconds_of(p, own > 0 ? own : 0);
}

double ambit_profile_cost_seconds(const ambit_profile *p, const ambit_meter_frame *f) {
  return seconds_of(p, cost_ticks(p, f));
}

double ambit_profile_wall_seconds(const ambit_profile *p) { return p->seconds; }

bool ambit_profile_is_cut(const ambit_profile *p) { return p->cut; }
