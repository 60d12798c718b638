/* runs.h -- an operation over all instructions and lanes of a run.
**
** With several lanes the elements of a slot lie side by side; with one lane, those of several instructions are brought
** together in one vector. What does not fill a vector shares it with copies of itself, so that no flag is raised by
** numbers that are not there.
*/
typedef struct place { /* a block; pitch in doubles */
  double *slots;
  size_t pitch, lanes;
} place;

INLINE void run_row(findings *f, double *r, const double *x, const double *y, size_t lanes, operation work) {
  size_t l = 0;
  for (; l + WIDTH <= 2 * lanes; l += WIDTH) store(r + l, work(f, load(x + l), load(y + l)));
  size_t left = lanes - l / 2;
  if (left) store_some(r + l, left, work(f, load_some(x + l, left), load_some(y + l, left)));
}

INLINE void run_single(
    findings *f, place at, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b, operation work) {
  size_t i = 0;
  for (; i + PAIRS <= count; i += PAIRS) {
    vector x = gather_pairs(at.slots, at.pitch, a + i), y = gather_pairs(at.slots, at.pitch, b + i);
    scatter_pairs(at.slots, at.pitch, dst + i, work(f, x, y));
  }
  for (; i < count; i++) {
    vector x = load_pair(at.slots + at.pitch * a[i]), y = load_pair(at.slots + at.pitch * b[i]);
    store_pair(at.slots + at.pitch * dst[i], work(f, x, y));
  }
}

/* b is a when the operation is unary */
INLINE void run(
    findings *f, place at, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b, operation work) {
  if (at.lanes == 1) {
    run_single(f, at, count, dst, a, b, work);
    return;
  }
  for (size_t i = 0; i < count; i++)
    run_row(f, at.slots + at.pitch * dst[i], at.slots + at.pitch * a[i], at.slots + at.pitch * b[i], at.lanes, work);
}

/* X(OPCODE, function, second operand) */
#define BASIC_OPERATIONS(X)                                                                                            \
  X(ADD, add, b)                                                                                                       \
  X(SUB, sub, b)                                                                                                       \
  X(NEG, neg, a)                                                                                                       \
  X(MUL, mul, b)                                                                                                       \
  X(SQR, sqr, a)                                                                                                       \
  X(DIV, divide, b)                                                                                                    \
  X(SQRT, square_root, a)                                                                                              \
  X(ABS, absolute, a)                                                                                                  \
  X(MIN, minimum, b)                                                                                                   \
  X(MAX, maximum, b)

#define DEFINE(OP, work, other)                                                                                        \
  static AMBIT_WORKER uint32_t run_##OP(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch,             \
      size_t lanes, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {                         \
    (void)self, (void)ctx, (void)b;                                                                                    \
    findings f = { 0 };                                                                                                \
    run(&f, (place) { base, 2 * pitch, lanes }, count, dst, a, other, work);                                           \
    return flags_of(&f);                                                                                               \
  }
BASIC_OPERATIONS(DEFINE)
#undef DEFINE
