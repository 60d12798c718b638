/* open.c -- memory and checks. */
#include "reduce.h"
#include <math.h>
#include <string.h>

#define BYTES 4e6 /* of all tables: what a cache holds */
#define WIDTH_MAX 64

void *reduce_room(reducer *s, size_t n, size_t size) {
  if (n > SIZE_MAX / size - 1) return NULL;
  return s->host->alloc(s->host, (n + 1) * size);
}

int reduce_wants(const options *o, uint32_t ranking) { return o->ranking == ranking || o->also[ranking]; }

/* not ONE_STEP: an effect that lasts is as many times that of a step as there are steps */
int reduce_is_relative(uint32_t ranking) {
  return ranking == AMBIT_RANK_LOWERED || ranking == AMBIT_RANK_EXACT || ranking == AMBIT_RANK_ADJOINT;
}

static int wants_slopes(const options *o) {
  return reduce_wants(o, AMBIT_RANK_ONE_STEP) || reduce_wants(o, AMBIT_RANK_ADJOINT);
}

static ambit_status check(const reducer *s) {
  const ambit_reduction *r = &s->r;
  const options *o = &s->options;
  const ambit_host *h = s->host;
  int slopes = wants_slopes(o), along = slopes || reduce_wants(o, AMBIT_RANK_RESIDUAL);
  if (!r->prove || !r->tried || s->nx == 0 || r->noutput == 0 || (r->neffect && !r->effect))
    return h->fail(h, AMBIT_INVALID, "the problem is not one of reductions");
  if (along && r->ncandidate && !r->nreference)
    return h->fail(h, AMBIT_INVALID,
        "there are no reference solutions: `residual`, `one_step` and `adjoint` rank along them; `exact` and "
        "`lowered_order` do without");
  if (slopes && (!r->rates || !r->output_value))
    return h->fail(h, AMBIT_INVALID, "the host gives no right-hand sides to differentiate");
  if (slopes && r->ncandidate && s->longest < 2)
    return h->fail(h, AMBIT_INVALID, "the reference solutions are single points: `one_step` and `adjoint` need steps");
  return AMBIT_OK;
}

/* nodes at a time, so that all tables stay in the cache */
static uint32_t choose_width(const reducer *s) {
  const ambit_reduction *r = &s->r;
  const ambit_tape *const tape[] = { r->effect, r->jacobian, r->output_jacobian, r->rates, r->output_value };
  double slots = 1, square = (double)s->nx * (s->nx + r->noutput);
  for (size_t i = 0; i < sizeof tape / sizeof *tape; i++)
    if (tape[i]) slots += tape[i]->nslot + (double)tape[i]->nout;
  if (wants_slopes(&s->options)) slots += square;
  double width = BYTES / (8 * slots);
  return width < 2 ? 2 : width > WIDTH_MAX ? WIDTH_MAX : (uint32_t)width;
}

static int open_slopes(reducer *s) {
  const ambit_reduction *r = &s->r;
  const options *o = &s->options;
  uint32_t ends = reduce_wants(o, AMBIT_RANK_ADJOINT) ? o->ends : 1;
  if (ends > s->longest - 1) ends = s->longest - 1;
  s->J = reduce_room(s, (size_t)s->width * s->nx * s->nx, sizeof *s->J);
  s->C = reduce_room(s, (size_t)s->width * r->noutput * s->nx, sizeof *s->C);
  s->near = reduce_room(s, (size_t)s->width * r->nin, sizeof *s->near);
  return s->J && s->C && s->near && dual_open(s, ends * r->noutput) &&
         table_open(&s->jacobian, s, r->jacobian, s->width) == AMBIT_OK &&
         table_open(&s->output_jacobian, s, r->output_jacobian, s->width) == AMBIT_OK &&
         table_open(&s->rates, s, r->rates, s->width) == AMBIT_OK &&
         table_open(&s->output_value, s, r->output_value, s->width) == AMBIT_OK;
}

static int allocate(reducer *s) {
  const ambit_reduction *r = &s->r;
  uint32_t n = r->ncandidate;
  for (uint32_t i = 0; i < AMBIT_RANK_COUNT; i++)
    if (reduce_wants(&s->options, i) && !(s->value[i] = reduce_room(s, n, sizeof(double)))) return 0;
  s->scale = reduce_room(s, s->nx, sizeof *s->scale);
  s->sum = reduce_room(s, n, sizeof *s->sum);
  s->own = reduce_room(s, n, sizeof *s->own);
  s->order = reduce_room(s, n, sizeof *s->order);
  s->stack = reduce_room(s, 2 * DEPTH_MAX, sizeof *s->stack);
  s->known = reduce_room(s, (size_t)DEPTH_MAX * r->noutput, sizeof *s->known);
  s->cut = reduce_room(s, n, 1);
  s->single = reduce_room(s, n, 1);
  s->error = reduce_room(s, r->noutput, sizeof *s->error);
  if (!s->scale || !s->sum || !s->own || !s->order || !s->stack || !s->known || !s->cut || !s->single || !s->error)
    return 0;
  if (table_open(&s->effect, s, r->effect, s->width) != AMBIT_OK) return 0;
  return !wants_slopes(&s->options) || s->longest < 2 || open_slopes(s);
}

void reduce_close(void *self) {
  reducer *s = self;
  table *const all[] = { &s->effect, &s->jacobian, &s->output_jacobian, &s->rates, &s->output_value };
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) table_close(all[i]);
}

ambit_status reduce_open(const ambit_host *h, const ambit_reduction *r, const double *option, void **self) {
  reducer *s = h->alloc(h, sizeof *s);
  if (!s) return h->fail(h, AMBIT_NOMEM, "out of memory");
  memcpy(&s->r, r, r->size < sizeof s->r ? r->size : sizeof s->r);
  s->host = h, s->nx = r->nx;
  for (uint32_t k = 0; k < s->r.nreference; k++)
    if (s->r.reference[k].ntime > s->longest) s->longest = s->r.reference[k].ntime;
  ambit_status status = reduce_options(h, option, &s->options);
  if (status == AMBIT_OK) status = check(s);
  if (status != AMBIT_OK) return status;
  s->width = choose_width(s);
  if (!allocate(s)) {
    reduce_close(s);
    return h->fail(h, AMBIT_NOMEM, "out of memory");
  }
  *self = s;
  return AMBIT_OK;
}
