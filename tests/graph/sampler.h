/* sampler.h -- expressions judged by MPFR: every node of a graph evaluated at a few points with 400 bits, and,
** independently of the graph, every expression as it was asked for. The graph may have rewritten it; value and domain
** must be the same.
*/
#ifndef AMBIT_TEST_SAMPLER_H
#define AMBIT_TEST_SAMPLER_H
#include <ambit/graph.h>
#include "oracle.h"
#include <stdlib.h>
#include <string.h>

#define SAMPLER_BITS 400
#define SAMPLER_POINTS 3

/* DOUBTFUL: so small or large that rounding could decide about a domain. Nothing is claimed then. */
typedef enum { DEFINED, UNDEFINED, DOUBTFUL } sample_state;

typedef struct sample {
  mpfr_t v;
  sample_state state;
} sample;

typedef struct sampler {
  ambit_graph *g;
  sample *node; /* [capacity * SAMPLER_POINTS] of all nodes below `count` */
  size_t count, capacity;
} sampler;

static inline bool sampler_is_binary(uint32_t op) {
  static const uint8_t arity[] = {
#define AMBIT_X(name, arity, symbol) arity,
    AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
  };
  return arity[op] == 2;
}

/* Magnitude below 1e-60: zero. Otherwise it has to be of everyday size. */
static inline void sample_settle(sample *r) {
  if (r->state != DEFINED) return;
  if (!mpfr_number_p(r->v))
    r->state = DOUBTFUL;
  else if (mpfr_zero_p(r->v))
    mpfr_set_zero(r->v, 1);
  else {
    mpfr_exp_t exponent = mpfr_get_exp(r->v);
    if (exponent < -200)
      mpfr_set_zero(r->v, 1);
    else if (exponent < -40 || exponent > 40)
      r->state = DOUBTFUL;
  }
}

/* sign of v - bound, 0 within 1e-60 and doubtful within 1e-12 */
static inline int sample_compare(const sample *x, double bound, bool *doubtful) {
  mpfr_t d;
  mpfr_init2(d, SAMPLER_BITS);
  mpfr_sub_d(d, x->v, bound, MPFR_RNDN);
  bool zero = mpfr_zero_p(d) || mpfr_get_exp(d) < -200;
  if (!zero && mpfr_get_exp(d) < -40) *doubtful = true;
  int sign = zero ? 0 : mpfr_sgn(d);
  mpfr_clear(d);
  return sign;
}

static inline sample_state sample_domain(uint32_t op, const sample *a, const sample *b, int32_t n) {
  bool doubtful = false, outside = false;
  switch (op) {
  case AMBIT_OP_DIV: outside = mpfr_zero_p(b->v); break;
  case AMBIT_OP_POWN: outside = n < 0 && mpfr_zero_p(a->v); break;
  case AMBIT_OP_SQRT: outside = mpfr_sgn(a->v) < 0; break;
  case AMBIT_OP_LOG: outside = mpfr_sgn(a->v) <= 0; break;
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: outside = sample_compare(a, -1, &doubtful) < 0 || sample_compare(a, 1, &doubtful) > 0; break;
  case AMBIT_OP_ATAN2: outside = mpfr_zero_p(a->v) && mpfr_zero_p(b->v); break;
  case AMBIT_OP_TAN: {
    sample c = { .state = DEFINED };
    mpfr_init2(c.v, SAMPLER_BITS);
    mpfr_cos(c.v, a->v, MPFR_RNDN);
    outside = sample_compare(&c, 0, &doubtful) == 0;
    mpfr_clear(c.v);
    break;
  }
  default: break;
  }
  return doubtful ? DOUBTFUL : outside ? UNDEFINED : DEFINED;
}

static inline void sample_value(uint32_t op, sample *r, const sample *a, const sample *b, int32_t n) {
  mpfr_rnd_t nearest = MPFR_RNDN;
  switch (op) {
  case AMBIT_OP_ADD: mpfr_add(r->v, a->v, b->v, nearest); break;
  case AMBIT_OP_SUB: mpfr_sub(r->v, a->v, b->v, nearest); break;
  case AMBIT_OP_NEG: mpfr_neg(r->v, a->v, nearest); break;
  case AMBIT_OP_MUL: mpfr_mul(r->v, a->v, b->v, nearest); break;
  case AMBIT_OP_SQR: mpfr_sqr(r->v, a->v, nearest); break;
  case AMBIT_OP_POWN: mpfr_pow_si(r->v, a->v, n, nearest); break;
  case AMBIT_OP_DIV: mpfr_div(r->v, a->v, b->v, nearest); break;
  case AMBIT_OP_SQRT: mpfr_sqrt(r->v, a->v, nearest); break;
  case AMBIT_OP_EXP: mpfr_exp(r->v, a->v, nearest); break;
  case AMBIT_OP_LOG: mpfr_log(r->v, a->v, nearest); break;
  case AMBIT_OP_SIN: mpfr_sin(r->v, a->v, nearest); break;
  case AMBIT_OP_COS: mpfr_cos(r->v, a->v, nearest); break;
  case AMBIT_OP_TAN: mpfr_tan(r->v, a->v, nearest); break;
  case AMBIT_OP_ASIN: mpfr_asin(r->v, a->v, nearest); break;
  case AMBIT_OP_ACOS: mpfr_acos(r->v, a->v, nearest); break;
  case AMBIT_OP_ATAN: mpfr_atan(r->v, a->v, nearest); break;
  case AMBIT_OP_ATAN2: mpfr_atan2(r->v, a->v, b->v, nearest); break;
  case AMBIT_OP_SINH: mpfr_sinh(r->v, a->v, nearest); break;
  case AMBIT_OP_COSH: mpfr_cosh(r->v, a->v, nearest); break;
  case AMBIT_OP_TANH: mpfr_tanh(r->v, a->v, nearest); break;
  case AMBIT_OP_ABS: mpfr_abs(r->v, a->v, nearest); break;
  case AMBIT_OP_MIN: mpfr_min(r->v, a->v, b->v, nearest); break;
  case AMBIT_OP_MAX: mpfr_max(r->v, a->v, b->v, nearest); break;
  default: abort();
  }
}

/* |a| just above 1 by rounding is 1 */
static inline void sample_clamp(uint32_t op, sample *a) {
  bool doubtful = false;
  if (op != AMBIT_OP_ASIN && op != AMBIT_OP_ACOS) return;
  if (sample_compare(a, 1, &doubtful) == 0) mpfr_set_d(a->v, 1, MPFR_RNDN);
  if (sample_compare(a, -1, &doubtful) == 0) mpfr_set_d(a->v, -1, MPFR_RNDN);
}

/* r := op(a, b); r is initialised */
static inline void sample_apply(uint32_t op, sample *r, const sample *a, const sample *b, int32_t n) {
  if (!sampler_is_binary(op)) b = a;
  if (a->state == UNDEFINED || b->state == UNDEFINED)
    r->state = UNDEFINED;
  else if (a->state == DOUBTFUL || b->state == DOUBTFUL)
    r->state = DOUBTFUL;
  else {
    sample copy = { .state = DEFINED };
    mpfr_init2(copy.v, SAMPLER_BITS);
    mpfr_set(copy.v, a->v, MPFR_RNDN);
    sample_clamp(op, &copy);
    r->state = sample_domain(op, &copy, b, n);
    if (r->state == DEFINED) sample_value(op, r, &copy, b, n);
    bool tiny = mpfr_regular_p(r->v) && mpfr_get_exp(r->v) < -200;
    if (r->state == DEFINED && tiny && (op == AMBIT_OP_EXP || op == AMBIT_OP_POWN)) r->state = DOUBTFUL; /* no zero */
    mpfr_clear(copy.v);
  }
  sample_settle(r);
}

static inline void sample_init(sample *s) {
  mpfr_init2(s->v, SAMPLER_BITS);
  mpfr_set_zero(s->v, 1);
  s->state = DEFINED;
}

/* |a - b| <= tolerance (1 + |a|) */
static inline bool sample_close(const sample *a, const sample *b, double tolerance) {
  mpfr_t d, bound;
  mpfr_init2(d, SAMPLER_BITS), mpfr_init2(bound, SAMPLER_BITS);
  mpfr_sub(d, a->v, b->v, MPFR_RNDN);
  mpfr_abs(bound, a->v, MPFR_RNDN);
  mpfr_add_d(bound, bound, 1, MPFR_RNDN);
  mpfr_mul_d(bound, bound, tolerance, MPFR_RNDN);
  bool close = mpfr_cmpabs(d, bound) <= 0;
  mpfr_clear(d), mpfr_clear(bound);
  return close;
}

/* Does x, some digits wider, contain the value? */
static inline bool sample_inside(const sample *s, ambit_interval x) {
  mpfr_t wide;
  mpfr_init2(wide, SAMPLER_BITS);
  mpfr_sub_d(wide, s->v, 0x1p-150, MPFR_RNDN);
  bool inside = mpfr_cmp_d(wide, x.hi) <= 0;
  mpfr_add_d(wide, s->v, 0x1p-150, MPFR_RNDN);
  inside = inside && mpfr_cmp_d(wide, x.lo) >= 0;
  mpfr_clear(wide);
  return inside;
}

static inline void sampler_open(sampler *s) { *s = (sampler) { .g = ambit_graph_open() }; }

static inline sample *sampler_at(const sampler *s, ambit_expr e, size_t point) {
  return &s->node[(size_t)e * SAMPLER_POINTS + point];
}

static inline void sampler_constant(const ambit_node *x, sample *r) {
  const char *slash = x->text ? strchr(x->text, '/') : NULL;
  if (!x->text)
    mpfr_set_d(r->v, x->value.lo, MPFR_RNDN);
  else if (strcmp(x->text, "pi") == 0)
    mpfr_const_pi(r->v, MPFR_RNDN);
  else {
    mpfr_strtofr(r->v, x->text, NULL, 10, MPFR_RNDN);
    if (slash) mpfr_div_si(r->v, r->v, atol(slash + 1), MPFR_RNDN);
  }
}

/* Evaluates the nodes made since the last call. Leaves but constants: 0 until they are set by sampler_set. */
static inline void sampler_update(sampler *s) {
  size_t count = ambit_graph_count(s->g);
  if (count > s->capacity) {
    s->capacity = 2 * count;
    s->node = realloc(s->node, s->capacity * SAMPLER_POINTS * sizeof *s->node);
  }
  for (; s->count < count; s->count++) {
    const ambit_node *x = ambit_graph_node(s->g, (ambit_expr)s->count);
    for (size_t p = 0; p < SAMPLER_POINTS; p++) {
      sample *r = sampler_at(s, (ambit_expr)s->count, p);
      sample_init(r);
      if (x->op == AMBIT_LEAF_CONSTANT)
        sampler_constant(x, r);
      else if (x->op < AMBIT_OP_COUNT) {
        const sample *b = x->op == AMBIT_OP_POWN ? sampler_at(s, x->a, p) : sampler_at(s, x->b, p);
        sample_apply(x->op, r, sampler_at(s, x->a, p), b, (int32_t)x->b);
      }
    }
  }
}

static inline void sampler_close(sampler *s) {
  for (size_t i = 0; i < s->count * SAMPLER_POINTS; i++) mpfr_clear(s->node[i].v);
  free(s->node);
  ambit_graph_close(s->g);
}

/* An expression, and what it is by its definition. */
typedef struct judged {
  ambit_expr e;
  sample truth[SAMPLER_POINTS];
} judged;

#define POOL_MAX 400
#define POOL_LEAVES 15

typedef struct pool {
  sampler s;
  judged item[POOL_MAX];
  size_t count;
  ambit_expr x, y, u, v, t;
} pool;

static inline void pool_leaf(pool *q, ambit_expr e) {
  judged *j = &q->item[q->count++];
  j->e = e;
  sampler_update(&q->s);
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    sample_init(&j->truth[p]);
    mpfr_set(j->truth[p].v, sampler_at(&q->s, e, p)->v, MPFR_RNDN);
  }
}

/* A free leaf with its values at the points. */
static inline void pool_variable(pool *q, ambit_expr e, const mpfr_t *value) {
  sampler_update(&q->s);
  for (size_t p = 0; p < SAMPLER_POINTS; p++) mpfr_set(sampler_at(&q->s, e, p)->v, value[p], MPFR_RNDN);
  pool_leaf(q, e);
}

/* Leaves x, y, t (any real), u in [1, 2], v in [-1, 2]; constants. draw(state, which, point) gives the values. */
static inline void pool_open(
    pool *q, uint64_t *state, void (*draw)(uint64_t *state, size_t which, mpfr_t value[SAMPLER_POINTS])) {
  q->count = 0;
  sampler_open(&q->s);
  ambit_graph *g = q->s.g;
  q->x = ambit_graph_symbol(g, "x", "m");
  q->y = ambit_graph_symbol(g, "y", "m");
  q->u = ambit_graph_unknown(g, "u", (ambit_interval) { 1, 2 });
  q->v = ambit_graph_unknown(g, NULL, (ambit_interval) { -1, 2 });
  q->t = ambit_graph_time(g);
  ambit_expr leaf[] = { q->x, q->y, q->u, q->v, q->t };
  for (size_t i = 0; i < 5; i++) {
    mpfr_t value[SAMPLER_POINTS];
    for (size_t p = 0; p < SAMPLER_POINTS; p++) mpfr_init2(value[p], SAMPLER_BITS);
    draw(state, i, value);
    pool_variable(q, leaf[i], (const mpfr_t *)value);
    for (size_t p = 0; p < SAMPLER_POINTS; p++) mpfr_clear(value[p]);
  }
  static const char *const text[] = { "0", "1", "-1", "2", "3", "-0.5", "0.1", "1/3", "pi", "-0.7" };
  for (size_t i = 0; i < POOL_LEAVES - 5; i++) pool_leaf(q, ambit_graph_decimal(g, text[i], NULL));
}

static inline void pool_close(pool *q) {
  for (size_t i = 0; i < q->count; i++)
    for (size_t p = 0; p < SAMPLER_POINTS; p++) mpfr_clear(q->item[i].truth[p].v);
  sampler_close(&q->s);
}

/* The common operations come more often, and operands tend to be alike, so that rules fire. */
static inline uint32_t pool_op(uint64_t *state, bool smooth) {
  static const uint32_t common[] = { AMBIT_OP_ADD, AMBIT_OP_SUB, AMBIT_OP_MUL, AMBIT_OP_SIN, AMBIT_OP_COS, AMBIT_OP_DIV,
    AMBIT_OP_NEG, AMBIT_OP_POWN };
  uint32_t op =
      oracle_random(state) % 4 ? common[oracle_random(state) % 8] : (uint32_t)(oracle_random(state) % AMBIT_OP_COUNT);
  return smooth && op >= AMBIT_OP_ABS ? AMBIT_OP_MUL : op;
}

static inline size_t pool_pick(const pool *q, uint64_t *state) {
  size_t recent = q->count < 12 ? q->count : 12;
  if (oracle_random(state) % 3 == 0) return oracle_random(state) % POOL_LEAVES;
  return q->count - 1 - oracle_random(state) % recent;
}

/* One more random expression. */
static inline judged *pool_grow(pool *q, uint64_t *state, bool smooth) {
  uint32_t op = pool_op(state, smooth);
  const judged *a = &q->item[pool_pick(q, state)], *b = &q->item[pool_pick(q, state)];
  if (oracle_random(state) % 6 == 0) b = a;
  int32_t n = (int32_t)(oracle_random(state) % 9) - 4;
  judged *r = &q->item[q->count++];
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    sample_init(&r->truth[p]);
    sample_apply(op, &r->truth[p], &a->truth[p], &b->truth[p], n);
  }
  r->e = op == AMBIT_OP_POWN ? ambit_graph_pown(q->s.g, a->e, n) : ambit_graph_op(q->s.g, op, a->e, b->e);
  sampler_update(&q->s);
  return r;
}

/* What is wrong with e as another form of j: NULL, or in words. */
static inline const char *pool_differs(const pool *q, const judged *j, ambit_expr e) {
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    const sample *other = sampler_at(&q->s, e, p), *truth = &j->truth[p];
    if (truth->state == DOUBTFUL || other->state == DOUBTFUL) continue;
    if (truth->state != other->state) return truth->state == DEFINED ? "domain lost" : "domain gained";
    if (truth->state == DEFINED && !sample_close(truth, other, 1e-30)) return "value changed";
  }
  return NULL;
}

/* Values for most tests: x, y, t plain numbers at the first point, then anything; u, v inside their sets. */
static inline void pool_draw(uint64_t *state, size_t which, mpfr_t value[SAMPLER_POINTS]) {
  static const double plain[] = { 0, 1, -1, 0.5, 2, -3 };
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    if (which == 2)
      mpfr_set_d(value[p], oracle_uniform(state, 1, 2), MPFR_RNDN);
    else if (which == 3)
      mpfr_set_d(value[p], p == 0 ? 0 : oracle_uniform(state, -1, 2), MPFR_RNDN);
    else if (p == 0)
      mpfr_set_d(value[p], plain[oracle_random(state) % 6], MPFR_RNDN);
    else
      mpfr_set_d(value[p], oracle_uniform(state, -3, 3), MPFR_RNDN);
  }
}
#endif
