/* fill.c -- the operations that an arithmetic leaves out: hull the operands, apply the kernel's interval function, set.
**
** Sound for every enclosing arithmetic: bounds() contains the operand, the interval function contains the image of
** the bounds (num/interval.h), and set() contains its interval. What is lost is all correlation between elements.
** Elements travel in chunks through arrays on the stack, so that an elementary function sees many at once.
*/
#include "graph/interpreter.h"
#include "graph/tape.h"
#include "num/interval.h"
#include <string.h>

#define CHUNK 64

typedef struct call {
  const ambit_arithmetic *self;
  void *ctx;
  char *base;
  size_t pitch, elem;
} call;

static char *element(const call *c, uint32_t slot, size_t lane) {
  return c->base + ((size_t)slot * c->pitch + lane) * c->elem;
}

static void read_bounds(const call *c, uint32_t slot, size_t lane, size_t n, ambit_interval *x) {
  double lo[CHUNK], hi[CHUNK];
  ambit_bounds_read(c->self, c->ctx, element(c, slot, lane), n, lo, hi);
  for (size_t i = 0; i < n; i++) x[i] = (ambit_interval) { lo[i], hi[i] };
}

static void write_bounds(const call *c, uint32_t slot, size_t lane, size_t n, const ambit_interval *x) {
  double lo[CHUNK], hi[CHUNK];
  for (size_t i = 0; i < n; i++) lo[i] = x[i].lo, hi[i] = x[i].hi;
  c->self->set(c->ctx, element(c, slot, lane), n, lo, hi, -1);
}

/* Lanes [lane, lane + width) of instructions [0, count), count * width <= CHUNK. Exponent: of POWN, then count is 1. */
static uint32_t fill_chunk(const call *c, uint32_t op, size_t lane, size_t width, size_t count, const uint32_t *dst,
    const uint32_t *a, const uint32_t *b, int32_t exponent) {
  ambit_interval x[CHUNK], y[CHUNK], r[CHUNK];
  for (size_t i = 0; i < count; i++) {
    read_bounds(c, a[i], lane, width, x + i * width);
    if (op != AMBIT_OP_POWN) read_bounds(c, b[i], lane, width, y + i * width);
  }
  uint32_t flags = ambit_interval_map(op, count * width, r, x, op == AMBIT_OP_POWN ? x : y, exponent);
  for (size_t i = 0; i < count; i++) write_bounds(c, dst[i], lane, width, r + i * width);
  return flags;
}

static uint32_t fill(uint32_t op, const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  call c = { self, ctx, base, pitch, self->elem(ctx) };
  uint32_t flags = 0;
  for (size_t lane = 0; lane < lanes; lane += CHUNK) {
    size_t width = lanes - lane < CHUNK ? lanes - lane : CHUNK;
    size_t group = op == AMBIT_OP_POWN ? 1 : CHUNK / width;
    for (size_t i = 0; i < count; i += group) {
      size_t n = count - i < group ? count - i : group;
      int32_t exponent = op == AMBIT_OP_POWN ? (int32_t)b[i] : 0;
      flags |= fill_chunk(&c, op, lane, width, n, dst + i, a + i, b + i, exponent);
    }
  }
  return flags;
}

/* One function per opcode: a run function is not told its opcode. */
#define AMBIT_X(name, arity, symbol)                                                                                   \
  static uint32_t fill_##name(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,         \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    return fill(AMBIT_OP_##name, self, ctx, base, pitch, lanes, count, dst, a, b);                                     \
  }
AMBIT_OPS(AMBIT_X)
#undef AMBIT_X

static const ambit_run_fn fallback[AMBIT_OP_COUNT] = {
#define AMBIT_X(name, arity, symbol) fill_##name,
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
};

static uint32_t fill_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  return fill(op, self, ctx, base, pitch, lanes, count, dst, a, b);
}

uint32_t ambit_arithmetic_seal(const ambit_arithmetic *full) {
  uint32_t flags = full->set_text ? AMBIT_SEAL_KEEP : 0;
  if (full->function == fill_function) flags |= AMBIT_SEAL_WRITE_FUNCTIONS;
  return full->pair == fill_function ? flags | AMBIT_SEAL_WRITE_PAIRS : flags;
}

ambit_status ambit_arithmetic_complete(const ambit_arithmetic *plugin, ambit_arithmetic *full, ambit_failure *f) {
  memset(full, 0, sizeof *full);
  size_t size = plugin->size < sizeof *full ? plugin->size : sizeof *full;
  memcpy(full, plugin, size);
  full->size = sizeof *full;
  full->fault = NULL; /* whoever owns `full` may give it one */
  const char *missing = !full->elem ? "elem" : !full->set ? "set" : !full->bounds ? "bounds" : NULL;
  if (missing)
    return ambit_fail(
        f, AMBIT_INVALID, "the arithmetic has no function '%s'; elem, set and bounds are required", missing);
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++)
    if (!full->run[op]) full->run[op] = fallback[op];
  if (!full->function) full->function = fill_function;
  if (!full->pair) full->pair = fill_function;
  return AMBIT_OK;
}
