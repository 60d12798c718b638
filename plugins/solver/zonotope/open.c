/* open.c -- memory, and which slots depend on which unknowns. */
#include "vary.h"
#include "implicit.h"
#include "jump.h"
#include "kink.h"
#include "shared/constant.h"
#include <ambit/code.h>

#define ROOM 400e6    /* bytes that rows may take at the highest order */
#define ORDER_MOST 40 /* that may be asked for */
#define ORDER_HIGH 30 /* that is chosen */
#define ORDER_LEAST 8
#define HISTORY 60  /* generators kept for each state, */
#define BOXES 40    /* without data: boxes of so many steps, */
#define FEW 1200    /* and at least so many where something varies: what joining its columns leaves comes each step */
#define VARYING 600 /* and so many more for all that varies together, */
#define FEW_DATA 10 /* whose triples cost so little that rows hold them all */
#define EACH 32u    /* or for the mean and the moment of each */

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, (count ? count : 1) * size); }
static double *doubles(const ambit_host *h, size_t count) { return room(h, count, sizeof(double)); }

/* -- levels */

static int has_second(uint32_t op) {
  return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 ||
         op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}

static void find_levels(zono *z) {
  program *p = &z->program;
  const ambit_tape *t = p->tape;
  for (uint32_t s = 0, j = 0; s < p->nstage; s++)
    for (; j < p->stage_end[s]; j++) p->level[slot_a(z, j)] = s + 1;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t a = p->level[t->a[i]], b = has_second(t->op[i]) ? p->level[t->b[i]] : 0;
    p->level[t->dst[i]] = a > b ? a : b;
  }
  uint32_t at = 0;
  for (uint32_t level = 0; level <= p->nstage; level++) {
    p->of_level[level] = at;
    for (uint32_t i = 0; i < t->ninstr; i++)
      if (p->level[t->dst[i]] == level) p->sorted[at++] = i;
  }
  p->of_level[p->nstage + 1] = at;
}

static void find_needed(zono *z) {
  program *p = &z->program;
  const ambit_tape *t = p->tape;
  for (uint32_t s = 0, j = 0; s < p->nstage; s++)
    for (; j < p->stage_end[s]; j++) p->needed[t->out[z->nx + j]] = p->level[t->out[z->nx + j]] == s + 1;
  for (uint32_t i = t->ninstr; i-- > 0;) {
    uint32_t dst = t->dst[i];
    if (!p->needed[dst]) continue;
    if (p->level[t->a[i]] == p->level[dst]) p->needed[t->a[i]] = 1;
    if (has_second(t->op[i]) && p->level[t->b[i]] == p->level[dst]) p->needed[t->b[i]] = 1;
  }
}

static int open_program(zono *z) {
  program *p = &z->program;
  const ambit_host *h = z->host;
  p->level = room(h, p->tape->nslot, sizeof *p->level), p->needed = room(h, p->tape->nslot, 1);
  p->sorted = room(h, p->tape->ninstr, sizeof *p->sorted), p->of_level = room(h, p->nstage + 2u, sizeof *p->of_level);
  if (!p->level || !p->needed || !p->sorted || !p->of_level) return 0;
  find_levels(z);
  find_needed(z);
  return 1;
}

/* -- rows */

static int divides(uint32_t op) {
  return op == AMBIT_OP_DIV || op == AMBIT_OP_SQRT || op == AMBIT_OP_LOG || op == AMBIT_OP_ATAN || op == AMBIT_OP_ATAN2;
}

int zono_open_rows(zono *z) {
  const ambit_tape *t = z->program.tape;
  const ambit_host *h = z->host;
  size_t stride = z->shape.stride, rows = 0, inverses = 0, at = 0;
  z->nslot = t->nslot, z->nout = t->nout;
  z->num = h->service(h, AMBIT_NUM_SERVICE);
  z->constant = room(h, t->nconst, sizeof *z->constant), z->constant_off = doubles(h, t->nconst);
  z->first = room(h, t->nslot, sizeof *z->first), z->at = room(h, t->nslot, sizeof *z->at);
  z->has_inverse = room(h, t->ninstr, sizeof *z->has_inverse);
  if (!z->constant || !z->constant_off) return 0;
  for (uint32_t i = 0; i < t->nconst; i++) z->constant_off[i] = constant_at(t, i, &z->constant[i]);
  if (!z->num || !z->first || !z->at || !z->has_inverse || !open_program(z) || !kinks_open(z)) return 0;
  for (uint32_t i = 0; i < t->nslot; i++) {
    size_t n = t->degree[i] ? z->K_max + 1u : 1u, cubed = z->shape.room < n ? z->shape.room : n;
    z->first[i] = rows, z->at[i] = at;
    rows += n, at += cubed * stride + (n - cubed) * z->shape.cube;
  }
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (divides(t->op[i])) z->has_inverse[i] = (uint32_t)++inverses;
  z->row = doubles(h, at), z->inverse = doubles(h, inverses * stride);
  z->zero = doubles(h, stride), z->scratch = doubles(h, stride);
  z->r = doubles(h, t->nslot), z->rr = doubles(h, t->nslot), z->rr_out = doubles(h, t->nout);
  z->p_row = doubles(h, z->np * stride), z->p_rad = doubles(h, z->np);
  return z->row && z->inverse && z->zero && z->scratch && z->r && z->rr && z->rr_out && z->p_row && z->p_rad;
}

/* the highest order in time that there is room for */
static uint32_t highest_order(const zono *z) {
  const ambit_tape *t = z->program.tape;
  if (z->options.time_order) return z->options.time_order;
  if (z->m > 0 || z->nvarying) return ORDER_DATA;
  double moving = 1, row = 8.0 * z->shape.cube;
  for (uint32_t i = 0; i < t->nslot; i++) moving += t->degree[i] != 0;
  double k = ROOM / (moving * row) - 1;
  return k > ORDER_HIGH ? ORDER_HIGH : k < ORDER_LEAST ? ORDER_LEAST : (uint32_t)k;
}

static int open_set(zono *z) {
  const ambit_host *h = z->host;
  size_t nx = z->nx;
  uint32_t sources = vary_sources(z), each = VARYING / (sources ? sources : 1);
  z->vary_room = sources * (each > EACH ? each : EACH);
  z->ngen_max = (z->options.history ? z->options.history : is_certain(z) ? BOXES : HISTORY) * z->nx;
  if (!z->options.history && sources && z->ngen_max < FEW) z->ngen_max = FEW;
  z->ngen_max += z->vary_room;
  z->P = doubles(h, nx * z->shape.stride), z->E = doubles(h, nx), z->G = doubles(h, nx * (z->ngen_max + nx));
  z->lo = doubles(h, nx), z->hi = doubles(h, nx), z->tube_lo = doubles(h, nx), z->tube_hi = doubles(h, nx);
  z->limit = doubles(h, nx);
  return z->P && z->E && z->G && z->lo && z->hi && z->tube_lo && z->tube_hi && z->limit;
}

/* -- the solver */

/* Those that only jumps depend on make no columns in the flow. */
static int flow_varies(const zono *z) {
  const ambit_tape *t = z->program.tape;
  uint32_t first = vary_first(z), n = z->problem.nvarying;
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (t->a[i] - first < n || (has_second(t->op[i]) && t->b[i] - first < n)) return 1;
  for (uint32_t o = 0; o < t->nout; o++)
    if (t->out[o] - first < n) return 1;
  return 0;
}

static void choose_program(zono *z) {
  const ambit_problem *p = &z->problem;
  z->nx = p->nx, z->np = p->np;
  z->program = (program) { .nx = p->nx, .np = p->np, .uses_time = p->uses_time };
  const ambit_implicit *i = p->implicit;
  z->na = i->na;
  z->program.tape = i->tape, z->program.na = i->na, z->program.nstage = i->na ? i->nstage : 0;
  z->program.stage_end = i->stage_end, z->program.pivot = i->pivot;
  z->nvarying = flow_varies(z) ? p->nvarying : 0;
}

static ambit_status no_memory(const ambit_host *h) {
  return h->fail(h, AMBIT_NOMEM, "zonotope: out of memory; make fewer data uncertain, or lower `time_order`");
}

/* may states stay at rest until a kink is passed? */
static int may_wait(const zono *z) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (is_kinked(t->op[i])) return 1;
  return 0;
}

/* an unproved run; then many data once more, in the order of how much they matter */
static ambit_status look_ahead(zono *z) {
  int is_followed = z->m > 0 && !z->nvarying && z->problem.njump == 0;
  int is_weighed = z->m > FOLLOWED || (is_followed && z->m > FEW_DATA);
  double *weight = is_weighed ? doubles(z->host, z->problem.nu) : NULL;
  if (!(z->expected = doubles(z->host, z->nx)) || (is_weighed && !weight)) return AMBIT_NOMEM;
  if (!is_weighed && !is_followed) return AMBIT_OK;
  if (!zono_pilot(z, weight, is_followed && may_wait(z))) return AMBIT_NOMEM;
  return weight ? zono_start_open(z, weight) : AMBIT_OK;
}

static ambit_status open_all(zono *z) {
  const ambit_host *h = z->host;
  choose_program(z);
  for (uint32_t s = 0, from = 0; s < z->program.nstage; from = z->program.stage_end[s++])
    if (z->program.stage_end[s] - from > STAGE_MAX)
      return h->fail(h, AMBIT_INVALID,
          "zonotope: %u accelerations and multipliers at once, more than %d; take `lohner`",
          z->program.stage_end[s] - from, STAGE_MAX);
  ambit_status status = zono_start_open(z, NULL);
  if (status == AMBIT_NOMEM) return no_memory(h);
  if (status != AMBIT_OK) return status;
  z->K_max = highest_order(z), z->K = z->K_max;
  if (look_ahead(z) != AMBIT_OK) return no_memory(h);
  if (!zono_open_rows(z) || (z->na && !zono_open_implicit(z)) || !open_set(z) || !jump_open(z)) return no_memory(h);
  return zono_open_proof(z) && jump_open_proofs(z) ? AMBIT_OK : no_memory(h);
}

static ambit_status refuse(const ambit_host *h, const char *option, const char *expected, double got) {
  return h->fail(h, AMBIT_INVALID, "zonotope: option `%s` must be %s, not %g", option, expected, got);
}

static ambit_status choose(const ambit_host *h, const double *option, options *o) {
  double order = option[0], history = option[1];
  if (!(order == 0 || (order >= 3 && order <= ORDER_MOST))) return refuse(h, "time_order", "0, or 3 to 40", order);
  if (!(history == 0 || (history >= 2 && history <= 1000))) return refuse(h, "generators", "0, or 2 to 1000", history);
  if (!(option[2] >= 0)) return refuse(h, "tolerance", "0 or more", option[2]);
  if (!(option[3] > 0)) return refuse(h, "step_max", "more than 0", option[3]);
  if (!(option[4] >= 0)) return refuse(h, "step_min", "0 or more", option[4]);
  if (!(option[5] >= 0)) return refuse(h, "width_max", "0 or more", option[5]);
  *o = (options) { (uint32_t)order, (uint32_t)history, option[2], option[3], option[4], option[5] };
  return AMBIT_OK;
}

ambit_status zono_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  *self = NULL;
  options o;
  ambit_status chosen = choose(h, option, &o);
  if (chosen != AMBIT_OK) return chosen;
  zono *z = h->alloc(h, sizeof *z);
  if (!z) return no_memory(h);
  z->host = h, z->options = o;
  memcpy(&z->problem, p, p->size < sizeof z->problem ? p->size : sizeof z->problem);
  ambit_status status = open_all(z);
  if (status == AMBIT_OK) *self = z;
  return status;
}

void zono_close(void *self) { (void)self; }
