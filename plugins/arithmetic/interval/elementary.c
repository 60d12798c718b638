/* elementary.c -- runs that the kernel's interval functions compute: elementary functions and integer powers.
**
** Operands are gathered over instructions and lanes into chunks, so that the kernel's vector code sees long arrays
** even when there is one lane. The service sets and restores its own rounding mode; here only signs are changed,
** which is exact.
*/
#include "interval.h"
#include <math.h>

#define CHUNK 64

typedef struct cursor { /* walks the elements of a run: lane by lane, instruction by instruction */
  double *slots;
  size_t pitch, lanes, instruction, lane;
} cursor;

static double *next(cursor *c, const uint32_t *slot) {
  double *place = c->slots + 2 * (c->pitch * slot[c->instruction] + c->lane);
  if (++c->lane == c->lanes) c->lane = 0, c->instruction++;
  return place;
}

static void gather(cursor *c, const uint32_t *slot, size_t n, double *pairs) {
  for (size_t i = 0; i < n; i++) {
    const double *x = next(c, slot);
    pairs[2 * i] = -x[0], pairs[2 * i + 1] = x[1];
  }
}

static void scatter(cursor *c, const uint32_t *slot, size_t n, const double *pairs) {
  for (size_t i = 0; i < n; i++) {
    double *x = next(c, slot);
    x[0] = -pairs[2 * i], x[1] = pairs[2 * i + 1];
  }
}

static uint32_t served(void *ctx, uint32_t op, int32_t exponent, cursor at, size_t total, const uint32_t *dst,
    const uint32_t *a, const uint32_t *b) {
  const ambit_num_service *num = ((interval_context *)ctx)->num;
  double x[2 * CHUNK], y[2 * CHUNK], r[2 * CHUNK];
  cursor first = at, second = at, result = at;
  uint32_t flags = 0;
  for (size_t done = 0; done < total; done += CHUNK) {
    size_t n = total - done < CHUNK ? total - done : CHUNK;
    gather(&first, a, n, x);
    if (b) gather(&second, b, n, y);
    flags |= num->map(op, n, r, x, b ? y : NULL, exponent);
    scatter(&result, dst, n, r);
  }
  return flags;
}

#define DEFINE(OP)                                                                                                     \
  uint32_t interval_run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,          \
      size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                                       \
    (void)self;                                                                                                        \
    cursor start = { base, pitch, lanes, 0, 0 };                                                                       \
    return served(ctx, AMBIT_OP_##OP, 0, start, lanes * count, dst, a, AMBIT_OP_##OP == AMBIT_OP_ATAN2 ? b : NULL);    \
  }
INTERVAL_SERVED(DEFINE)

uint32_t interval_run_POWN(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self;
  cursor start = { base, pitch, lanes, 0, 0 };
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    flags |= served(ctx, AMBIT_OP_POWN, (int32_t)b[i], start, lanes, dst + i, a + i, NULL);
  return flags;
}
