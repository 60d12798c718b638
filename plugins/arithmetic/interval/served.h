/* served.h -- runs that the kernel's interval functions compute: elementary functions and integer powers.
**
** The service wants lower and upper bounds in arrays of their own. Elements are taken apart and put together in whole
** vectors, which exchanges them within a vector the same way both times; elements of several instructions go into one
** call, so that the kernel's vector code sees long arrays even when there is one lane. The service sets and restores
** its own rounding mode; here only signs are changed, which is exact.
*/
#define CHUNK 128

typedef struct chunk { /* bounds of operands and results */
  double alo[CHUNK], ahi[CHUNK], blo[CHUNK], bhi[CHUNK], rlo[CHUNK], rhi[CHUNK];
} chunk;

INLINE void take_apart(const double *x, size_t n, double *lo, double *hi) {
  size_t i = 0;
  for (; i + WIDTH <= n; i += WIDTH) {
    vector u = load(x + 2 * i), v = load(x + 2 * i + WIDTH);
    store(lo + i, -firsts(u, v)), store(hi + i, seconds(u, v));
  }
  for (; i < n; i++) lo[i] = -x[2 * i], hi[i] = x[2 * i + 1];
}

INLINE void put_together(findings *f, double *x, size_t n, const double *lo, const double *hi) {
  size_t i = 0;
  for (; i + WIDTH <= n; i += WIDTH) {
    vector down = -load(lo + i), up = load(hi + i), u = firsts(down, up), v = seconds(down, up);
    f->empty |= is_empty(u) | is_empty(v);
    f->unbounded |= equal(u, splat(INFINITY)) | equal(v, splat(INFINITY));
    store(x + 2 * i, u), store(x + 2 * i + WIDTH, v);
  }
  for (; i < n; i++) {
    x[2 * i] = -lo[i], x[2 * i + 1] = hi[i];
    vector u = load_pair(x + 2 * i);
    f->empty |= is_empty(u), f->unbounded |= equal(u, splat(INFINITY));
  }
}

/* Where nonempty operands leave the domain; TAN does where its result is entire. */
typedef mask (*domain)(vector x, vector y);
#define ALWAYS_DEFINED ((domain)0)
INLINE mask positive_only(vector x, vector y) { return (void)y, reaches(x, splat(0)) & FIRST_HALVES; }
INLINE mask unit_only(vector x, vector y) { return (void)y, above(x, splat(1)); }
INLINE mask has_zero(vector x) { return reaches(first(x), splat(0)) & reaches(second(x), splat(0)); }
INLINE mask not_the_origin(vector x, vector y) { return has_zero(x) & has_zero(y); }

INLINE void check_domain(findings *f, const double *x, const double *y, size_t n, domain outside) {
  size_t i = 0;
  for (; i + PAIRS <= n; i += PAIRS) f->partial |= outside(load(x + 2 * i), load(y + 2 * i));
  for (; i < n; i++) f->partial |= outside(load_pair(x + 2 * i), load_pair(y + 2 * i));
}

/* walks the elements of a run, lane by lane, instruction by instruction */
typedef struct cursor {
  const place *at;
  const uint32_t *slot;
  size_t lane;
} cursor;

/* the next elements that belong to one instruction, at most `room` */
INLINE double *next_row(cursor *c, size_t room, size_t *n) {
  double *row = c->at->slots + c->at->pitch * *c->slot + 2 * c->lane;
  size_t left = c->at->lanes - c->lane;
  *n = left < room ? left : room;
  c->lane += *n;
  if (c->lane == c->at->lanes) c->lane = 0, c->slot++;
  return row;
}

INLINE void copy(double *to, const double *from, size_t n) {
  if (n == 1)
    memcpy(to, from, 2 * sizeof *to);
  else
    memcpy(to, from, 2 * n * sizeof *to);
}

/* `total` elements side by side: where they are, if one instruction has them all, otherwise copied to `pairs` */
INLINE const double *gather(cursor *c, size_t total, double *pairs) {
  size_t n;
  const double *row = next_row(c, total, &n);
  if (n == total) return row;
  copy(pairs, row, n);
  for (size_t i = n; i < total; i += n) {
    row = next_row(c, total - i, &n);
    copy(pairs + 2 * i, row, n);
  }
  return pairs;
}

/* copies `total` elements to where they belong */
INLINE void scatter(cursor *c, size_t total, const double *pairs) {
  for (size_t i = 0, n; i < total; i += n) {
    double *row = next_row(c, total - i, &n);
    copy(row, pairs + 2 * i, n);
  }
}

INLINE void write_results(findings *f, cursor *c, size_t total, const chunk *from) {
  if (c->at->lanes - c->lane >= total) {
    size_t n;
    put_together(f, next_row(c, total, &n), total, from->rlo, from->rhi);
    return;
  }
  double pairs[2 * CHUNK];
  put_together(f, pairs, total, from->rlo, from->rhi);
  scatter(c, total, pairs);
}

INLINE void serve(findings *f, const ambit_num_service *num, uint32_t op, place at, size_t total, const uint32_t *dst,
    const uint32_t *a, const uint32_t *b, domain outside) {
  chunk c;
  double room[2][2 * CHUNK];
  cursor first = { &at, a, 0 }, second = { &at, b, 0 }, result = { &at, dst, 0 };
  for (size_t done = 0; done < total; done += CHUNK) {
    size_t n = total - done < CHUNK ? total - done : CHUNK;
    const double *x = gather(&first, n, room[0]), *y = op == AMBIT_OP_ATAN2 ? gather(&second, n, room[1]) : x;
    take_apart(x, n, c.alo, c.ahi);
    if (op == AMBIT_OP_ATAN2) take_apart(y, n, c.blo, c.bhi);
    if (outside) check_domain(f, x, y, n, outside);
    num->elementary(op, n, c.alo, c.ahi, c.blo, c.bhi, c.rlo, c.rhi);
    write_results(f, &result, n, &c);
  }
  if (op == AMBIT_OP_TAN) f->partial |= f->unbounded;
}

#define ELEMENTARY_OPERATIONS(X)                                                                                       \
  X(EXP, ALWAYS_DEFINED, a)                                                                                            \
  X(LOG, positive_only, a)                                                                                             \
  X(SIN, ALWAYS_DEFINED, a)                                                                                            \
  X(COS, ALWAYS_DEFINED, a)                                                                                            \
  X(TAN, ALWAYS_DEFINED, a)                                                                                            \
  X(ASIN, unit_only, a)                                                                                                \
  X(ACOS, unit_only, a)                                                                                                \
  X(ATAN, ALWAYS_DEFINED, a)                                                                                           \
  X(ATAN2, not_the_origin, b)                                                                                          \
  X(SINH, ALWAYS_DEFINED, a)                                                                                           \
  X(COSH, ALWAYS_DEFINED, a)                                                                                           \
  X(TANH, ALWAYS_DEFINED, a)

#define DEFINE(OP, outside, other)                                                                                     \
  static AMBIT_WORKER uint32_t run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch,             \
      size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                         \
    (void)self, (void)b;                                                                                               \
    const ambit_num_service *num = ((interval_context *)ctx)->num;                                                     \
    findings f = { 0 };                                                                                                \
    serve(&f, num, AMBIT_OP_##OP, (place) { base, 2 * pitch, lanes }, lanes *count, dst, a, other, outside);           \
    return flags_of(&f);                                                                                               \
  }
ELEMENTARY_OPERATIONS(DEFINE)
#undef DEFINE

/* the next n elements as pairs of a lower and an upper bound */
INLINE void gather_bounds(cursor *c, size_t n, double *pairs) {
  const double *x = gather(c, n, pairs);
  for (size_t i = 0; i < n; i++) pairs[2 * i] = -x[2 * i], pairs[2 * i + 1] = x[2 * i + 1];
}

/* POWN of instructions with the same exponent, or a function; b: NULL if there is one operand */
INLINE uint32_t serve_map(const ambit_num_service *num, uint32_t op, int32_t exponent, place at, size_t total,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  double pairs[2 * CHUNK], others[2 * CHUNK];
  cursor operand = { &at, a, 0 }, other = { &at, b, 0 }, result = { &at, dst, 0 };
  uint32_t flags = 0;
  for (size_t done = 0; done < total; done += CHUNK) {
    size_t n = total - done < CHUNK ? total - done : CHUNK;
    gather_bounds(&operand, n, pairs);
    if (b) gather_bounds(&other, n, others);
    flags |= num->map(op, n, pairs, pairs, b ? others : NULL, exponent);
    for (size_t i = 0; i < n; i++) pairs[2 * i] = -pairs[2 * i];
    scatter(&result, n, pairs);
  }
  return flags;
}

static AMBIT_WORKER uint32_t run_function(const ambit_arithmetic *self, void *ctx, uint32_t op, void *base,
    size_t pitch, size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self;
  const ambit_num_service *num = ((interval_context *)ctx)->num;
  return serve_map(
      num, op, 0, (place) { base, 2 * pitch, lanes }, lanes * count, dst, a, ambit_op_arity(op) == 2 ? b : NULL);
}

static AMBIT_WORKER uint32_t run_POWN(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self;
  const ambit_num_service *num = ((interval_context *)ctx)->num;
  uint32_t flags = 0;
  for (size_t i = 0, same; i < count; i += same) {
    for (same = 1; i + same < count && b[i + same] == b[i];) same++;
    flags |= serve_map(
        num, AMBIT_OP_POWN, (int32_t)b[i], (place) { base, 2 * pitch, lanes }, lanes * same, dst + i, a + i, NULL);
  }
  return flags;
}
