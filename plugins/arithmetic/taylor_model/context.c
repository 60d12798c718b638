/* context.c -- opening with all memory at once, elements from bounds and back, the rounding mode, the plugin's entry.
** */
#include "interface.h"
#include "runs.h"
#include <ambit/code.h>

enum { ORDER, BOXES };

static const ambit_param params[] = {
  { "order", "1", "integer", "3", "total degree of the polynomials, from 0 to 60; memory and time grow steeply" },
  { "boxes", "1", "integer", "16",
      "into how many boxes the domain may be split to bound a result's polynomial; 0: its coefficients only" },
  { NULL, NULL, NULL, NULL, NULL },
};

#define LANES_LIMIT (1u << 16) /* monomials; products of more are not computed side by side */
#define LANES_CACHED 512u      /* monomials; of more, rows are faster, as operands side by side leave the cache */
#define LANES_LEAST 4          /* and not in vectors of two, which lose more by rearranging than they gain */
#define BOXES_LIMIT ((size_t)1 << 22) /* coefficients in all boxes */

static size_t round_up(size_t n, size_t to) { return (n + to - 1) / to * to; }

typedef struct layout {
  size_t elem, norm_at, mask_at, coef_at, packed, lanes, boxes;
} layout;

/* Sizes in bytes from the counts, which are below 2^32. */
static layout lay_out(uint32_t nvar, uint32_t order, size_t count, uint32_t boxes, uint32_t lanes) {
  size_t blocks = (count + MONOMIALS_BLOCK - 1) / MONOMIALS_BLOCK, words = (blocks + 63) / 64;
  layout l = { .norm_at = sizeof(model) };
  l.mask_at = l.norm_at + (order + 1u) * sizeof(double);
  l.coef_at = round_up(l.mask_at + words * sizeof(uint64_t), 64);
  l.elem = l.coef_at + blocks * MONOMIALS_BLOCK * sizeof(double);
  /* rows filled up to vectors, with a row of zeros that must stay so */
  size_t rows = nvar ? (size_t)(monomial_count(nvar - 1.0, order) + 0.5) : 1;
  l.packed = (count + MONOMIALS_ROW_PAD * rows + order + 4 * MONOMIALS_ROW_PAD) * sizeof(double);
  int side_by_side = lanes >= LANES_LEAST && count <= (monomials_has_rows(nvar, order) ? LANES_CACHED : LANES_LIMIT);
  l.lanes = side_by_side ? lanes * blocks * MONOMIALS_BLOCK * sizeof(double) : 0;
  size_t each = count * sizeof(double);
  while (boxes > 1 && boxes * count > BOXES_LIMIT) boxes /= 2;
  l.boxes = boxes ? 3 * nvar * sizeof(double) + (boxes + 1u) * each : 0;
  return l;
}

static double bytes_of(const layout *l, size_t count, uint32_t order, double tables) {
  return tables + 2.0 * (double)(l->packed + count * (sizeof(uint32_t) + sizeof(double) + sizeof(interval))) +
         3.0 * (double)l->lanes + (double)l->boxes + (double)count + (MODEL_SCRATCH + order + 1.0) * (double)l->elem +
         64.0 * 16;
}

static char *take(char **next, size_t bytes) {
  char *place = *next;
  *next += round_up(bytes, 64);
  return place;
}

static void assign(context *c, const layout *l, uint32_t nvar, uint32_t order, char *room, double tables) {
  size_t count = (size_t)(monomial_count(nvar, order) + 0.5);
  c->norm_at = l->norm_at, c->mask_at = l->mask_at, c->coef_at = l->coef_at, c->elem = l->elem;
  monomials_lay(&c->m, nvar, order, take(&room, (size_t)tables));
  for (int i = 0; i < 2; i++) {
    c->packed[i] = (double *)(void *)take(&room, l->packed);
    c->index[i] = (uint32_t *)(void *)take(&room, count * sizeof(uint32_t));
    c->value[i] = (double *)(void *)take(&room, count * sizeof(double));
    c->at[i] = (interval *)(void *)take(&room, count * sizeof(interval));
  }
  for (int i = 0; i < 3 && l->lanes; i++) c->lanes[i] = (double *)(void *)take(&room, l->lanes);
  if (l->boxes) c->box = (double *)(void *)take(&room, l->boxes);
  c->alive = (uint8_t *)take(&room, count);
  c->scratch = take(&room, (MODEL_SCRATCH + order + 1u) * l->elem);
}

/* Do upward mode, subnormal numbers and exact rounding errors work as this plugin needs them? A compiler that lost
** -frounding-math, or an emulator that knows one mode only, is found here. */
static AMBIT_WORKER int is_upward(double one, double three, double tiny) {
  double up = one / three, down = -(-one / three);
  return up == 0x1.5555555555556p-2 && down == 0x1.5555555555555p-2 && tiny * 0.5 == 0x1p-1074 && -(-tiny * 0.5) == 0;
}

static int is_sound(context *c) {
  model *a = model_scratch(c, 0), *b = model_scratch(c, 1), *r = model_scratch(c, 2);
  ambit_rounding old = ambit_round_up();
  int upward = is_upward(1, 3, 0x1p-1074);
  model_clear(c, a, 1), model_clear(c, b, 0x1p-60);
  double error = model_sum(c, r, a, b, 1);
  ambit_rounding_restore(old);
  return upward && model_coef(c, r)[0] == 1 && error >= 0x1p-60 && error < 0x1.1p-60;
}

static ambit_status open_as(
    const ambit_host *h, const double *option, uint32_t nvar, void **ctx, const kernels *kernels) {
  double wanted = option ? option[ORDER] : 3, boxes = option ? option[BOXES] : 16;
  if (!(wanted >= 0 && wanted <= MONOMIALS_ORDER_MAX))
    return h->fail(h, AMBIT_INVALID, "order %g is not from 0 to %d", wanted, MONOMIALS_ORDER_MAX);
  if (!(boxes >= 0 && boxes <= RANGE_BOXES_MAX))
    return h->fail(h, AMBIT_INVALID, "boxes = %g is not from 0 to %d", boxes, RANGE_BOXES_MAX);
  uint32_t order = nvar ? (uint32_t)wanted : 0;
  double count = monomial_count(nvar, order), tables = monomials_bytes(nvar, order), need = tables + 8 * count;
  layout l = { 0 };
  if (need < 0x1p46 && count < 0x1p31) {
    l = lay_out(nvar, order, (size_t)(count + 0.5), (uint32_t)boxes, kernels->lanes);
    need = bytes_of(&l, (size_t)(count + 0.5), order, tables);
  }
  context *c = l.elem ? h->alloc(h, sizeof *c) : NULL;
  char *room = c && need < 0x1p46 ? h->alloc(h, (size_t)need) : NULL;
  if (!room)
    return h->fail(h, AMBIT_NOMEM,
        "order %u in %u variables has %.6g monomials, %.3g bytes for each quantity, and needs %.3g bytes "
        "of tables, more than there are; lower the order or make fewer data uncertain",
        order, nvar, count, count * sizeof(double), need);
  c->num = h->service(h, AMBIT_NUM_SERVICE);
  if (!c->num) return h->fail(h, AMBIT_INVALID, "this kernel does not lend `%s`", AMBIT_NUM_SERVICE);
  c->kernels = kernels;
  assign(c, &l, nvar, order, room, tables);
  c->boxes = l.boxes ? (uint32_t)boxes : 0;
  while (c->boxes > 1 && (size_t)c->boxes * c->m.count > BOXES_LIMIT) c->boxes /= 2;
  if (!is_sound(c))
    return h->fail_code(h, AMBIT_BROKEN, AMBIT_CODE_BROKEN_ROUNDING,
        "this build or machine does not round as told; nothing it computes is proved");
  *ctx = c;
  return AMBIT_OK;
}

static size_t elem(void *ctx) { return ((context *)ctx)->elem; }
static void enter(void *ctx) { ((context *)ctx)->outside = ambit_round_up(); }
static void leave(void *ctx) { ambit_rounding_restore(((context *)ctx)->outside); }

/* any data made canonical: NaN, reversed or infinite-point bounds become empty */
static interval interval_of(double lo, double hi) {
  int nonempty = lo <= hi && lo < INFINITY && hi > -INFINITY;
  return nonempty ? (interval) { lo == 0 ? 0 : lo, hi == 0 ? 0 : hi } : (interval) { INFINITY, -INFINITY };
}

static AMBIT_WORKER void set_all(
    const context *c, char *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  for (size_t i = 0; i < n; i++) {
    model *x = (model *)(void *)(dst + i * c->elem);
    interval hull = interval_of(lo[i], hi[i]);
    if (var >= 0)
      model_set_variable(c, x, hull, (uint32_t)var);
    else
      model_set_interval(c, x, hull);
  }
}

static void set(void *ctx, void *dst, size_t n, const double *lo, const double *hi, int32_t var) {
  ambit_rounding old = ambit_round_up();
  set_all(ctx, dst, n, lo, hi, var);
  ambit_rounding_restore(old);
}

static AMBIT_WORKER void bounds_all(const context *c, const char *src, size_t n, double *lo, double *hi) {
  for (size_t i = 0; i < n; i++) {
    interval r = model_bounds(c, (const model *)(const void *)(src + i * c->elem));
    lo[i] = r.lo == 0 ? 0 : r.lo, hi[i] = r.hi == 0 ? 0 : r.hi; /* never -0 */
  }
}

static void bounds(void *ctx, const void *src, size_t n, double *lo, double *hi) {
  ambit_rounding old = ambit_round_up();
  bounds_all(ctx, src, n, lo, hi);
  ambit_rounding_restore(old);
}

#define ENTRY(OP) [AMBIT_OP_##OP] = taylor_run_##OP,

/* One interface for each instruction set, so that they can be compared. */
#define ARITHMETIC(NAME, KERNELS)                                                                                      \
  static ambit_status open_##NAME(const ambit_host *h, const double *option, uint32_t nvar, void **ctx) {              \
    return open_as(h, option, nvar, ctx, KERNELS);                                                                     \
  }                                                                                                                    \
  static const ambit_arithmetic arithmetic_##NAME = { .size = sizeof(ambit_arithmetic),                                \
    .rigorous = 1,                                                                                                     \
    .param = params,                                                                                                   \
    .open = open_##NAME,                                                                                               \
    .elem = elem,                                                                                                      \
    .enter = enter,                                                                                                    \
    .leave = leave,                                                                                                    \
    .set = set,                                                                                                        \
    .bounds = bounds,                                                                                                  \
    .run = { TAYLOR_FUNCTIONS(ENTRY) TAYLOR_OTHERS(ENTRY) },                                                           \
    .function = taylor_run_function };

ARITHMETIC(portable, &kernels_portable)
#if defined(__x86_64__)
ARITHMETIC(avx2, &kernels_avx2)
ARITHMETIC(avx512, &kernels_avx512)
#endif

static const void *get(const char *interface_id) {
  if (strcmp(interface_id, AMBIT_TAYLOR) == 0) return &taylor_interface;
  if (strcmp(interface_id, "ambit.arithmetic.portable/1") == 0) return &arithmetic_portable;
  int widest = strcmp(interface_id, AMBIT_ARITHMETIC) == 0;
  if (!widest && strcmp(interface_id, "ambit.arithmetic.avx2/1") != 0) return NULL;
#if defined(__x86_64__)
  if (widest && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return &arithmetic_avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return &arithmetic_avx2;
#endif
  return &arithmetic_portable;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "arithmetic.taylor_model", "1.0",
  "Taylor models: a polynomial in the uncertain data, in double precision, plus a proved bound of everything it leaves "
  "out. Remembers how every quantity depends on the data up to the given order, so that bounds of long calculations "
  "stay near the true range where intervals widen.",
  get };
