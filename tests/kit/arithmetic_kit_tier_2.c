/* arithmetic_kit_tier_2.c -- what a plugin offers for speed must enclose what tier 1 encloses: dot, set_text. */
#include "kit/arithmetic_kit_inside.h"
#include "kit/program_oracle.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>

/* -- dot */

enum { TERMS = 21, RESULT = 2 * TERMS }; /* the Taylor product of order 20 */

typedef struct product {
  kit_set a[TERMS][KIT_PITCH], b[TERMS][KIT_PITCH];
  size_t terms, lanes;
  bool backwards, same; /* b runs backwards, as in a convolution; b is a */
} product;

static kit_set factor(kit_state *s) {
  double x = kit_random(s) % 2 ? kit_uniform(s, -8, 8) : (double)(kit_random(s) % 200) - 100;
  double w = kit_random(s) % 3 ? 0 : kit_random(s) % 2 ? ldexp(1, -40) : kit_uniform(s, 0, 2);
  return (kit_set) { x, s->rigorous ? x + w : x };
}

enum {
  EXACT_BITS = 4400
}; /* products of doubles have bits from 2^-2148 to 2^2048: their sums are exact
    */

static void judge_dot(kit_state *s, const product *p, size_t lane) {
  mpfr_t sum, x;
  mpfr_init2(sum, EXACT_BITS), mpfr_init2(x, EXACT_BITS);
  mpfr_set_emin(mpfr_get_emin_min()), mpfr_set_emax(mpfr_get_emax_max());
  mpfr_set_zero(sum, 1);
  double size = 0;
  for (size_t j = 0; j < p->terms; j++) {
    kit_set a = p->a[j][lane], b = (p->same ? p->a : p->b)[p->backwards ? p->terms - 1 - j : j][lane];
    double u = kit_random(s) % 2 ? a.lo : a.hi, v = kit_random(s) % 2 ? b.lo : b.hi;
    mpfr_set_d(x, u, MPFR_RNDN);
    mpfr_mul_d(x, x, v, MPFR_RNDN);
    mpfr_add(sum, sum, x, MPFR_RNDN);
    size += fabs(u * v);
  }
  kit_set r = kit_bounds_of(s, RESULT, lane);
  double room = s->rigorous ? 0 : 1e-13 * size;
  s->judged++;
  if (!program_encloses(r.lo - room, r.hi + room, sum))
    kit_find(s, "dot", "%zu terms in %zu lanes: [%a, %a] misses the sum %.17g (%s)", p->terms, p->lanes, r.lo, r.hi,
        mpfr_get_d(sum, MPFR_RNDN), s->environment->name);
  mpfr_clear(sum), mpfr_clear(x);
}

static void check_dot(kit_state *s) {
  product p = { .terms = 1 + kit_random(s) % TERMS,
    .lanes = 1 + kit_random(s) % (s->pitch - 1),
    .backwards = kit_random(s) % 2,
    .same = kit_random(s) % 4 == 0 };
  for (uint32_t j = 0; j < p.terms; j++)
    for (size_t l = 0; l < p.lanes; l++) {
      kit_set_element(s, j, l, p.a[j][l] = factor(s));
      kit_set_element(s, TERMS + j, l, p.b[j][l] = factor(s));
    }
  ptrdiff_t stride = (ptrdiff_t)s->pitch;
  uint32_t first = p.same ? 0 : TERMS, last = first + (uint32_t)p.terms - 1;
  if (p.lanes < s->pitch) kit_set_element(s, RESULT, p.lanes, (kit_set) { 5, 6 });
  uint32_t flags = kit_dot(s, RESULT, kit_at(s, 0, 0), stride, kit_at(s, p.backwards ? last : first, 0),
      p.backwards ? -stride : stride, p.terms, p.lanes);
  if (flags) kit_find(s, "dot", "flags %u for bounded operands", flags);
  for (size_t l = 0; l < p.lanes; l++)
    for (int i = 0; i < 4; i++) judge_dot(s, &p, l);
  kit_set next = kit_bounds_of(s, RESULT, p.lanes);
  if (!(next.lo <= 6 && next.hi >= 5)) kit_find(s, "layout", "dot writes lane %zu of %zu", p.lanes, p.lanes);
}

static void check_dot_specials(kit_state *s) {
  enum { A, B };
  const kit_set none = { INFINITY, -INFINITY }, all = { -INFINITY, INFINITY }, zero = { 0, 0 };
  kit_set_element(s, A, 0, none), kit_set_element(s, A, 1, zero), kit_set_element(s, A, 2, all);
  kit_set_element(s, B, 0, all), kit_set_element(s, B, 1, all), kit_set_element(s, B, 2, (kit_set) { 1, 2 });
  uint32_t flags = kit_dot(s, RESULT, kit_at(s, A, 0), 1, kit_at(s, B, 0), 1, 1, 3);
  kit_set r = kit_bounds_of(s, RESULT, 0), z = kit_bounds_of(s, RESULT, 1), w = kit_bounds_of(s, RESULT, 2);
  if (!kit_is_empty(r)) kit_find(s, "dot", "an empty factor gives [%a, %a]", r.lo, r.hi);
  if (!(z.lo <= 0 && z.hi >= 0)) kit_find(s, "dot", "zero times the line gives [%a, %a]", z.lo, z.hi);
  if (w.lo != -INFINITY || w.hi != INFINITY) kit_find(s, "dot", "the line times [1, 2] gives [%a, %a]", w.lo, w.hi);
  if (!(flags & AMBIT_F_EMPTY) || !(flags & AMBIT_F_UNBOUNDED))
    kit_find(s, "dot", "flags %u lack EMPTY or UNBOUNDED", flags);
  flags = kit_dot(s, RESULT, kit_at(s, A, 0), 1, kit_at(s, B, 0), 1, 0, 3);
  z = kit_bounds_of(s, RESULT, 2);
  if (z.lo != 0 || z.hi != 0 || flags) kit_find(s, "dot", "an empty sum is [%a, %a], flags %u", z.lo, z.hi, flags);
  s->judged += 4;
}

/* products that overflow or vanish: the sum is what the reals say */
static void check_dot_rims(kit_state *s) {
  static const double rim[] = { DBL_MAX, -DBL_MAX, 0x1p-1074, -0x1p-1074, DBL_MIN, 1e200, -1e-200, 0.0, -0.0, 1 };
  product p = { .terms = 3, .lanes = 3 };
  for (uint32_t j = 0; j < p.terms; j++)
    for (size_t l = 0; l < p.lanes; l++) {
      double x = rim[kit_random(s) % (sizeof rim / sizeof *rim)], y = rim[kit_random(s) % (sizeof rim / sizeof *rim)];
      kit_set_element(s, j, l, p.a[j][l] = (kit_set) { x, x });
      kit_set_element(s, TERMS + j, l, p.b[j][l] = (kit_set) { y, y });
    }
  kit_dot(s, RESULT, kit_at(s, 0, 0), (ptrdiff_t)s->pitch, kit_at(s, TERMS, 0), (ptrdiff_t)s->pitch, p.terms, p.lanes);
  for (size_t l = 0; l < p.lanes; l++) judge_dot(s, &p, l);
}

void kit_check_dot(kit_state *s) {
  if (!s->full->dot) return;
  for (int i = 0; kit_more(s, i, 200); i++) {
    check_dot(s);
    if (s->rigorous) check_dot_rims(s);
  }
  if (s->rigorous) check_dot_specials(s);
}

/* -- set_text */

static void number_of(mpfr_t v, const char *text) {
  char *end;
  if (strcmp(text, "pi") == 0) {
    mpfr_const_pi(v, MPFR_RNDN);
    return;
  }
  mpfr_strtofr(v, text, &end, 10, MPFR_RNDN);
  if (*end == '/') mpfr_div_ui(v, v, (unsigned long)strtoul(end + 1, NULL, 10), MPFR_RNDN);
}

/* the text, and sums with its own double: what a better element knows must be right */
static void check_one_text(kit_state *s, const char *text) {
  enum { T, D, R };
  mpfr_t v;
  mpfr_init2(v, PROGRAM_BITS);
  number_of(v, text);
  s->judged++;
  if (kit_set_text(s, T, text)) {
    double nearest = mpfr_get_d(v, MPFR_RNDN);
    kit_set x = kit_bounds_of(s, T, 0);
    if (!program_encloses(x.lo, x.hi, v)) kit_find(s, "set_text", "\"%s\" is [%a, %a]", text, x.lo, x.hi);
    if (isfinite(nearest)) {
      kit_set_element(s, D, 0, (kit_set) { nearest, nearest });
      kit_apply(s, AMBIT_OP_SUB, R, T, D, 1);
      mpfr_sub_d(v, v, nearest, MPFR_RNDN);
      x = kit_bounds_of(s, R, 0);
      bool holds = mpfr_cmp_d(v, x.lo) >= 0 && mpfr_cmp_d(v, x.hi) <= 0;
      if (!holds) kit_find(s, "set_text", "\"%s\" minus its nearest double is [%a, %a]", text, x.lo, x.hi);
    }
  }
  mpfr_clear(v);
}

void kit_check_text(kit_state *s) {
  static const char *const text[] = { "0.1", "1/3", "pi", "-2.5e-3", "0.25", "1", "-1/7", "1e-320", "1e308", "1e400",
    "3.14159265358979323846264338327950288", "123456789012345678901234567890", "2/3", "0", "-0.0", "1e-400" };
  static const char *const nonsense[] = { "", "x", "1..2", "0x", "pie", "1/0", "nan", "--1", "[1, 2" };
  if (!s->full->set_text || !s->rigorous) return;
  mpfr_set_emin(mpfr_get_emin_min()), mpfr_set_emax(mpfr_get_emax_max());
  for (size_t i = 0; i < sizeof text / sizeof *text; i++) check_one_text(s, text[i]);
  for (size_t i = 0; i < sizeof nonsense / sizeof *nonsense; i++) {
    s->judged++;
    if (kit_set_text(s, 0, nonsense[i])) kit_find(s, "set_text", "\"%s\" is taken for a number", nonsense[i]);
  }
}
