/* batch.c -- which slots may share a place, and the loop over lanes.
**
** A place is free for a new result when the run that reads its element for the last time is over: within a run no
** result is an operand, as run[] demands. Constants and outputs keep their places. The results are those of the tape,
** since every operand is still in its place when it is read.
*/
#include "verbs/sample/batch.h"
#include "base/memory.h"
#include <ambit/block.h>
#include <stdlib.h>
#include <string.h>

#define ALIGNMENT 64u
#define CACHE_BYTES (512u << 10) /* about half of a second-level cache */
#define WIDTH_MIN 16u
#define WIDTH_MAX 256u
#define NEVER UINT32_MAX

struct ambit_batch {
  const ambit_tape *tape;
  const ambit_arithmetic *arithmetic;
  void *ctx;
  char *base;
  size_t places, width, elem;
  uint32_t *place;       /* [nslot] */
  uint32_t *dst, *a, *b; /* [ninstr] places */
  bool initialised;      /* clear() is due */
  ambit_work work;
};

/* -- places */

typedef struct plan {
  const ambit_tape *tape;
  uint32_t *last;  /* [nslot] number of the run that reads it last; NEVER: it is kept */
  uint32_t *free;  /* [nslot] stack of places */
  uint32_t *place; /* [nslot] */
  uint32_t nfree, nplace;
} plan;

static bool reads_second(const ambit_tape *t, uint32_t i) { return t->op[i] != AMBIT_OP_POWN; }

static void find_last_uses(plan *p) {
  const ambit_tape *t = p->tape;
  for (uint32_t s = 0; s < t->nslot; s++) p->last[s] = s < t->nconst ? NEVER : 0;
  for (uint32_t r = 0; r < t->nrun; r++)
    for (uint32_t i = t->run[r].first; i < t->run[r].first + t->run[r].count; i++) {
      p->last[t->dst[i]] = r; /* if nobody reads it */
      if (p->last[t->a[i]] != NEVER) p->last[t->a[i]] = r;
      if (reads_second(t, i) && p->last[t->b[i]] != NEVER) p->last[t->b[i]] = r;
    }
  for (uint32_t o = 0; o < t->nout; o++) p->last[t->out[o]] = NEVER;
}

static void give_place(plan *p, uint32_t slot) { p->place[slot] = p->nfree ? p->free[--p->nfree] : p->nplace++; }

/* NEVER afterwards: once is enough */
static void free_place(plan *p, uint32_t slot, uint32_t run) {
  if (p->last[slot] != run) return;
  p->last[slot] = NEVER;
  p->free[p->nfree++] = p->place[slot];
}

static void share_places(plan *p) {
  const ambit_tape *t = p->tape;
  for (uint32_t s = 0; s < t->nconst + t->nin; s++) give_place(p, s);
  for (uint32_t r = 0; r < t->nrun; r++) {
    uint32_t first = t->run[r].first, end = first + t->run[r].count;
    for (uint32_t i = first; i < end; i++) give_place(p, t->dst[i]);
    for (uint32_t i = first; i < end; i++) {
      free_place(p, t->dst[i], r);
      free_place(p, t->a[i], r);
      if (reads_second(t, i)) free_place(p, t->b[i], r);
    }
  }
}

static bool make_plan(ambit_batch *batch) {
  const ambit_tape *t = batch->tape;
  uint32_t *room = malloc(2 * ((size_t)t->nslot + 1) * sizeof *room);
  if (!room) return false;
  plan p = { .tape = t, .last = room, .free = room + t->nslot + 1, .place = batch->place };
  find_last_uses(&p);
  share_places(&p);
  batch->places = p.nplace;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    batch->dst[i] = p.place[t->dst[i]];
    batch->a[i] = p.place[t->a[i]];
    batch->b[i] = reads_second(t, i) ? p.place[t->b[i]] : t->b[i];
  }
  free(room);
  return true;
}

/* -- the block */

static char *element(const ambit_batch *batch, uint32_t slot) {
  return batch->base + (size_t)batch->place[slot] * batch->width * batch->elem;
}

static size_t choose_width(size_t bytes_per_lane) {
  size_t width = CACHE_BYTES / (bytes_per_lane + 1) / WIDTH_MIN * WIDTH_MIN;
  return width < WIDTH_MIN ? WIDTH_MIN : width > WIDTH_MAX ? WIDTH_MAX : width;
}

static ambit_status allocate(ambit_batch *batch, ambit_failure *f) {
  size_t lane, bytes, count;
  double need = (double)batch->places * (double)batch->elem * WIDTH_MIN;
  bool overflow = __builtin_mul_overflow(batch->places, batch->elem, &lane);
  if (!overflow) batch->width = choose_width(lane);
  overflow = overflow || __builtin_mul_overflow(lane, batch->width, &bytes) || bytes > SIZE_MAX / 2;
  if (overflow)
    return ambit_fail(f, AMBIT_INVALID, "%zu slots of %zu bytes need %.3g bytes, more than there are addresses",
        batch->places, batch->elem, need);
  count = batch->places * batch->width;
  bytes = (bytes / ALIGNMENT + 1) * ALIGNMENT;
  batch->base = ambit_memory_allows(bytes) ? aligned_alloc(ALIGNMENT, bytes) : NULL;
  if (!batch->base) return ambit_fail(f, AMBIT_NOMEM, "out of memory: a batch needs %.3g bytes", (double)bytes);
  memset(batch->base, 0, bytes);
  const ambit_arithmetic *full = batch->arithmetic;
  ambit_status status = full->init ? full->init(batch->ctx, batch->base, count) : AMBIT_OK;
  if (status != AMBIT_OK) return ambit_fail(f, status, "the arithmetic could not initialise %zu elements", count);
  batch->initialised = true;
  return AMBIT_OK;
}

static void set_constants(ambit_batch *batch) {
  for (uint32_t i = 0; i < batch->tape->nconst; i++)
    for (size_t lane = 0; lane < batch->width; lane++)
      ambit_constant_set(batch->arithmetic, batch->ctx, element(batch, i) + lane * batch->elem, batch->tape, i);
}

ambit_status ambit_batch_open(
    const ambit_tape *t, const ambit_arithmetic *full, void *ctx, ambit_batch **batch, ambit_failure *f) {
  *batch = NULL;
  size_t elem = full->elem(ctx);
  if (elem == 0 || elem % 8 != 0)
    return ambit_fail(f, AMBIT_INVALID, "the arithmetic's elements have %zu bytes; a multiple of 8 is required", elem);
  ambit_batch *made = calloc(1, sizeof *made);
  if (!made) return ambit_no_memory(f);
  *made = (ambit_batch) { .tape = t, .arithmetic = full, .ctx = ctx, .elem = elem };
  made->place = malloc(((size_t)t->nslot + 3 * (size_t)t->ninstr + 1) * sizeof *made->place);
  if (made->place) made->dst = made->place + t->nslot, made->a = made->dst + t->ninstr, made->b = made->a + t->ninstr;
  ambit_status status = AMBIT_OK;
  if (!made->place || !make_plan(made)) status = ambit_no_memory(f);
  if (status == AMBIT_OK) status = allocate(made, f);
  if (status != AMBIT_OK) {
    ambit_batch_close(made);
    return status;
  }
  set_constants(made);
  *batch = made;
  return AMBIT_OK;
}

void ambit_batch_close(ambit_batch *batch) {
  if (!batch) return;
  if (batch->initialised && batch->arithmetic->clear)
    batch->arithmetic->clear(batch->ctx, batch->base, batch->places * batch->width);
  free(batch->base);
  free(batch->place);
  free(batch);
}

size_t ambit_batch_places(const ambit_batch *batch) { return batch->places; }
size_t ambit_batch_width(const ambit_batch *batch) { return batch->width; }
const ambit_work *ambit_batch_work(const ambit_batch *batch) { return &batch->work; }

/* -- running */

static uint32_t run_all(ambit_batch *batch, size_t lanes) {
  const ambit_tape *t = batch->tape;
  const ambit_arithmetic *full = batch->arithmetic;
  uint32_t flags = 0;
  if (full->enter) full->enter(batch->ctx);
  for (uint32_t i = 0; i < t->nrun; i++) {
    const ambit_run *r = &t->run[i];
    flags |= ambit_arithmetic_run(full, batch->ctx, r->op, batch->base, batch->width, lanes, r->count,
        batch->dst + r->first, batch->a + r->first, batch->b + r->first);
  }
  if (full->leave) full->leave(batch->ctx);
  return flags;
}

/* Is something empty that goes into these lanes? Asked only where a result is. */
static bool takes_empty(const ambit_tape *t, size_t lanes, size_t lane, const double *lo, const double *hi) {
  for (uint32_t i = 0; i < t->nconst; i++)
    if (!(t->lo[i] <= t->hi[i])) return true;
  for (uint32_t i = 0; i < t->nin; i++)
    if (!(lo[i * lanes + lane] <= hi[i * lanes + lane])) return true;
  return false;
}

uint32_t ambit_batch_run(ambit_batch *batch, size_t lanes, const double *lo, const double *hi, const int32_t *var,
    double *rlo, double *rhi) {
  const ambit_tape *t = batch->tape;
  const ambit_arithmetic *full = batch->arithmetic;
  uint32_t flags = 0;
  for (size_t done = 0; done < lanes; done += batch->width) {
    size_t n = lanes - done < batch->width ? lanes - done : batch->width;
    for (uint32_t i = 0; i < t->nin; i++) {
      size_t at = i * lanes + done;
      full->set(batch->ctx, element(batch, t->nconst + i), n, lo + at, hi + at, var ? var[i] : -1);
    }
    ambit_work_evaluate(&batch->work, t->ninstr, n);
    uint32_t own = run_all(batch, n);
    flags |= own;
    for (uint32_t o = 0; o < t->nout; o++) {
      size_t at = o * lanes + done;
      ambit_bounds_read(full, batch->ctx, element(batch, t->out[o]), n, rlo + at, rhi + at);
      for (size_t i = at; i < at + n; i++) {
        if (rlo[i] > rhi[i] && !takes_empty(t, lanes, i - o * lanes, lo, hi))
          ambit_empty_check(full, own, 0, rlo[i], rhi[i]);
      }
    }
  }
  return flags;
}
