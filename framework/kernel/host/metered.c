/* metered.c -- frames around the services of the kernel and around the runs of an arithmetic. */
#include "host/metered.h"
#include "graph/interpreter.h"
#include "graph/tape.h"
#include "base/meter.h"
#include "graph/contract.h"
#include "graph/jet.h"
#include "num/service.h"
#include <ambit/meter.h>
#include <stdio.h>
#include <string.h>

static void enter(const char *name) { ambit_meter_enter(AMBIT_FRAME_SERVICE, name); }

/* -- ambit.num/1 */

static uint32_t map(uint32_t op, size_t n, double *r, const double *a, const double *b, int32_t exponent) {
  enter("num.map");
  uint32_t flags = ambit_num_service_v1.map(op, n, r, a, b, exponent);
  ambit_meter_leave();
  return flags;
}

static void elementary(uint32_t op, size_t n, const double *alo, const double *ahi, const double *blo,
    const double *bhi, double *rlo, double *rhi) {
  enter("num.elementary");
  ambit_num_service_v1.elementary(op, n, alo, ahi, blo, bhi, rlo, rhi);
  ambit_meter_leave();
}

static uint32_t pown(double *lo, double *hi, double alo, double ahi, int32_t n) {
  enter("num.pown");
  uint32_t flags = ambit_num_service_v1.pown(lo, hi, alo, ahi, n);
  ambit_meter_leave();
  return flags;
}

static uint32_t convolve(
    size_t n, double *rlo, double *rhi, const double *alo, const double *ahi, const double *blo, const double *bhi) {
  enter("num.convolve");
  uint32_t flags = ambit_num_service_v1.convolve(n, rlo, rhi, alo, ahi, blo, bhi);
  ambit_meter_leave();
  return flags;
}

static uint32_t matmul(size_t rows, size_t inner, size_t cols, double *rlo, double *rhi, const double *alo,
    const double *ahi, const double *blo, const double *bhi) {
  enter("num.matmul");
  uint32_t flags = ambit_num_service_v1.matmul(rows, inner, cols, rlo, rhi, alo, ahi, blo, bhi);
  ambit_meter_leave();
  return flags;
}

static ambit_status read(const char *text, double *lo, double *hi, char *message, size_t room) {
  return ambit_num_service_v1.read(text, lo, hi, message, room);
}

static size_t shortest(char *out, size_t room, double x) { return ambit_num_service_v1.shortest(out, room, x); }

static uint32_t taylor(uint32_t op, uint32_t n, double *c, double lo, double hi) {
  enter("num.taylor");
  uint32_t flags = ambit_num_service_v1.taylor(op, n, c, lo, hi);
  ambit_meter_leave();
  return flags;
}

static const ambit_function_facts *facts(uint32_t op) { return ambit_num_service_v1.facts(op); }

static const ambit_num_service num_service = { sizeof num_service, map, elementary, pown, read, shortest, convolve,
  matmul, taylor, facts };

/* -- ambit.jet/1 */

static ambit_status open_jet(const ambit_host *h, const ambit_tape *t, const ambit_arithmetic *arithmetic, void *actx,
    uint32_t order, uint32_t ndir, const ambit_jet *centre, ambit_jet **jet) {
  enter("jet.open");
  ambit_status status = ambit_jet_service_v1.open(h, t, arithmetic, actx, order, ndir, centre, jet);
  ambit_meter_leave();
  return status;
}

static void close_jet(ambit_jet *jet) { ambit_jet_service_v1.close(jet); }

static void put(
    ambit_jet *jet, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad) {
  enter("jet.put");
  ambit_jet_service_v1.put(jet, in, k, mid, rad, dmid, drad);
  ambit_meter_leave();
}

static uint32_t advance(ambit_jet *jet, uint32_t k) {
  enter("jet.advance");
  uint32_t flags = ambit_jet_service_v1.advance(jet, k);
  ambit_meter_leave();
  return flags;
}

static void get(const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  enter("jet.get");
  ambit_jet_service_v1.get(jet, slot, k, mid, rad, dmid, drad);
  ambit_meter_leave();
}

static uint32_t solve(ambit_jet *jet, uint32_t nx, uint32_t order) {
  enter("jet.solve");
  uint32_t flags = ambit_jet_service_v1.solve(jet, nx, order);
  ambit_meter_leave();
  return flags;
}

static ambit_status tail(ambit_jet *jet, uint32_t K, double h, const double *tail_in, const double *dtail_in,
    double *tail_out, double *dtail_out) {
  enter("jet.tail");
  ambit_status status = ambit_jet_service_v1.tail(jet, K, h, tail_in, dtail_in, tail_out, dtail_out);
  ambit_meter_leave();
  return status;
}

static const char *kink(const ambit_jet *jet) { return ambit_jet_service_v1.kink(jet); }

static const ambit_jet_service jet_service = { sizeof jet_service, open_jet, close_jet, put, advance, get, solve, tail,
  kink };

/* -- ambit.contract/1 */

static ambit_status open_contractor(const ambit_host *h, const ambit_tape *t, ambit_contractor **c) {
  return ambit_contract_service_v1.open(h, t, c);
}

static ambit_status narrow(ambit_contractor *c, double *lo, double *hi, const double *out_lo, const double *out_hi) {
  enter("contract.narrow");
  ambit_status status = ambit_contract_service_v1.narrow(c, lo, hi, out_lo, out_hi);
  ambit_meter_leave();
  return status;
}

static uint32_t inspect(ambit_contractor *c, const double *lo, const double *hi) {
  enter("contract.inspect");
  uint32_t flags = ambit_contract_service_v1.inspect(c, lo, hi);
  ambit_meter_leave();
  return flags;
}

static uint32_t inspect_in(ambit_contractor *c, const double *lo, const double *hi, uint32_t n) {
  enter("contract.inspect");
  uint32_t flags = ambit_contract_service_v1.inspect_in(c, lo, hi, n);
  ambit_meter_leave();
  return flags;
}

static const ambit_contract_service contract_service = { sizeof contract_service, open_contractor, narrow, inspect,
  inspect_in };

/* -- ambit.meter/1 */

static const char *const operation_name[AMBIT_OP_END] = {
#define AMBIT_X(name, arity, symbol) [AMBIT_OP_##name] = #name,
  AMBIT_OPS(AMBIT_X) AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
};

static void enter_part(const char *name) { ambit_meter_enter(AMBIT_FRAME_SOLVER, name); }

static void operation(uint32_t op) {
  ambit_meter_mark(AMBIT_FRAME_OPERATION, op < AMBIT_OP_END && operation_name[op] ? operation_name[op] : "other");
}

static const ambit_meter_service meter_service = { sizeof meter_service, enter_part, ambit_meter_leave, operation };

const void *ambit_metered_service(const char *id, const void *service) {
  if (service == &ambit_num_service_v1) return &num_service;
  if (service == &ambit_jet_service_v1) return &jet_service;
  if (service == &ambit_contract_service_v1) return &contract_service;
  return strcmp(id, AMBIT_METER_SERVICE) == 0 ? &meter_service : service;
}

/* -- arithmetics */

typedef struct metered {
  ambit_arithmetic full; /* first: what others see */
  const ambit_arithmetic *plain;
  char label[AMBIT_OP_END][AMBIT_FRAME_NAME]; /* "interval MUL" */
} metered;

/* One function per opcode: a run function is not told its opcode. */
#define AMBIT_X(name, arity, symbol)                                                                                   \
  static uint32_t run_##name(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,          \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    const metered *m = (const metered *)(const void *)self;                                                            \
    ambit_meter_enter(AMBIT_FRAME_OPERATION, m->label[AMBIT_OP_##name]);                                               \
    uint32_t flags = m->plain->run[AMBIT_OP_##name](m->plain, ctx, base, pitch, lanes, count, dst, a, b);              \
    ambit_meter_leave();                                                                                               \
    return flags;                                                                                                      \
  }
AMBIT_OPS(AMBIT_X)
#undef AMBIT_X

static const ambit_run_fn metered_run[AMBIT_OP_COUNT] = {
#define AMBIT_X(name, arity, symbol) run_##name,
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
};

static uint32_t run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  const metered *m = (const metered *)(const void *)self;
  ambit_meter_enter(AMBIT_FRAME_OPERATION, m->label[op]);
  uint32_t flags = ambit_arithmetic_run(m->plain, ctx, op, base, pitch, lanes, count, dst, a, b);
  ambit_meter_leave();
  return flags;
}

const ambit_arithmetic *ambit_metered_arithmetic(ambit_arena *arena, const ambit_arithmetic *plain, const char *name) {
  metered *m = ambit_arena_alloc(arena, sizeof *m);
  if (!m) return NULL;
  m->full = *plain, m->plain = plain;
  for (int op = 0; op < AMBIT_OP_END; op++)
    if (operation_name[op]) snprintf(m->label[op], sizeof m->label[op], "%.30s %s", name, operation_name[op]);
  memcpy(m->full.run, metered_run, sizeof metered_run);
  uint32_t seal = ambit_arithmetic_seal(plain); /* what it leaves out stays the kernel's, and is known by that */
  if (!(seal & AMBIT_SEAL_WRITE_FUNCTIONS)) m->full.function = run_function;
  if (!(seal & AMBIT_SEAL_WRITE_PAIRS)) m->full.pair = run_function;
  return &m->full;
}
