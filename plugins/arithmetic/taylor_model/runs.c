/* runs.c -- the operations as the kernel calls them: one opcode, many instructions and lanes. Upward mode (enter). */
#include "runs.h"

typedef struct block {
  const context *c;
  char *base;
  size_t pitch;
} block;

static model *at(const block *b, uint32_t slot, size_t lane) {
  return (model *)(void *)(b->base + ((size_t)slot * b->pitch + lane) * b->c->elem);
}

#define ARGUMENTS                                                                                                      \
  const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count, const uint32_t *dst,  \
      const uint32_t *a, const uint32_t *b

/* `expression` in terms of r, x, y for each instruction i and lane */
#define RUN(NAME, expression)                                                                                          \
  uint32_t taylor_run_##NAME(ARGUMENTS) {                                                                              \
    (void)self, (void)b;                                                                                               \
    block all = { ctx, base, pitch };                                                                                  \
    uint32_t flags = 0;                                                                                                \
    for (size_t i = 0; i < count; i++)                                                                                 \
      for (size_t lane = 0; lane < lanes; lane++) {                                                                    \
        model *r = at(&all, dst[i], lane), *x = at(&all, a[i], lane);                                                  \
        flags |= expression;                                                                                           \
      }                                                                                                                \
    return flags;                                                                                                      \
  }
#define Y at(&all, b[i], lane)
#define FUNCTION(NAME) RUN(NAME, model_function(all.c, AMBIT_OP_##NAME, r, x, 0))

RUN(ADD, model_add(all.c, r, x, Y, 1))
RUN(SUB, model_add(all.c, r, x, Y, -1))
RUN(NEG, model_negate(all.c, r, x))
RUN(POWN, model_power(all.c, r, x, (int32_t)b[i]))
RUN(DIV, model_divide(all.c, r, x, Y))
RUN(ATAN2, model_angle(all.c, r, x, Y))
RUN(ABS, model_absolute(all.c, r, x))
RUN(MIN, model_extremum(all.c, r, x, Y, AMBIT_OP_MIN))
RUN(MAX, model_extremum(all.c, r, x, Y, AMBIT_OP_MAX))
TAYLOR_FUNCTIONS(FUNCTION)

uint32_t taylor_run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base, size_t pitch,
    size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self, (void)b;
  block all = { ctx, base, pitch };
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++)
      flags |= model_function(all.c, op, at(&all, dst[i], lane), at(&all, a[i], lane), 0);
  return flags;
}

/* as many at a time as the vector unit has lanes */
static uint32_t products(
    const block *all, size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  model *r[MONOMIALS_ROW_PAD];
  const model *x[MONOMIALS_ROW_PAD], *y[MONOMIALS_ROW_PAD];
  uint32_t flags = 0;
  size_t n = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++) {
      r[n] = at(all, dst[i], lane), x[n] = at(all, a[i], lane), y[n] = at(all, b[i], lane);
      if (++n == all->c->kernels->lanes) flags |= model_multiply_many(all->c, n, r, x, y), n = 0;
    }
  return n ? flags | model_multiply_many(all->c, n, r, x, y) : flags;
}

uint32_t taylor_run_MUL(ARGUMENTS) {
  (void)self;
  block all = { ctx, base, pitch };
  return products(&all, lanes, count, dst, a, b);
}

uint32_t taylor_run_SQR(ARGUMENTS) {
  (void)self, (void)b;
  block all = { ctx, base, pitch };
  return products(&all, lanes, count, dst, a, a);
}
