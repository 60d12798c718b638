/* arithmetic_kit_tier_2.c -- what a plugin offers for speed must agree with tier 1: dot, eval_tape, jets. */
#include "graph/jet.h"
#include "kit/arithmetic_kit_inside.h"
#include "kit/tape_builder.h"
#include <float.h>
#include <math.h>

static bool meet(kit_set a, kit_set b) { return a.lo <= b.hi && b.lo <= a.hi; }

/* -- dot: integers, so that exact sums are known */

enum { TERMS = 6, LANES = 5 };

static void check_dot(kit_state *s, int backwards) {
  kit_set a[TERMS][LANES], b[TERMS][LANES];
  for (uint32_t j = 0; j < TERMS; j++)
    for (size_t l = 0; l < LANES; l++) {
      double x = (double)(kit_random(s) % 200) - 100, y = (double)(kit_random(s) % 200) - 100;
      a[j][l] = (kit_set) { x, x + (double)(kit_random(s) % 5) },
      b[j][l] = (kit_set) { y, y + (double)(kit_random(s) % 5) };
      kit_set_element(s, KIT_T + j, l, a[j][l]), kit_set_element(s, KIT_T + TERMS + j, l, b[j][l]);
    }
  ptrdiff_t stride = (ptrdiff_t)s->pitch;
  const void *right = kit_at(s, KIT_T + TERMS + (backwards ? TERMS - 1 : 0), 0);
  uint32_t flags = s->full->dot(
      s->ctx, kit_at(s, KIT_R, 0), kit_at(s, KIT_T, 0), stride, right, backwards ? -stride : stride, TERMS, LANES);
  if (flags) kit_find(s, "dot", "flags %u for bounded operands", flags);
  for (size_t l = 0; l < LANES; l++) {
    kit_set r = kit_bounds_of(s, KIT_R, l);
    for (int i = 0; i < 20; i++) {
      double sum = 0;
      for (uint32_t j = 0; j < TERMS; j++) {
        kit_set x = a[j][l], y = b[backwards ? TERMS - 1 - j : j][l];
        sum += (kit_random(s) % 2 ? x.lo : x.hi) * (kit_random(s) % 2 ? y.lo : y.hi);
      }
      if (!(r.lo <= sum && sum <= r.hi)) kit_find(s, "dot", "[%a, %a] misses the sum %a", r.lo, r.hi, sum);
    }
  }
}

static void check_dot_specials(kit_state *s) {
  const kit_set none = { INFINITY, -INFINITY }, all = { -INFINITY, INFINITY }, zero = { 0, 0 };
  kit_set_element(s, KIT_A, 0, none), kit_set_element(s, KIT_A, 1, zero), kit_set_element(s, KIT_A, 2, all);
  kit_set_element(s, KIT_B, 0, all), kit_set_element(s, KIT_B, 1, all),
      kit_set_element(s, KIT_B, 2, (kit_set) { 1, 2 });
  uint32_t flags = s->full->dot(s->ctx, kit_at(s, KIT_R, 0), kit_at(s, KIT_A, 0), 1, kit_at(s, KIT_B, 0), 1, 1, 3);
  kit_set r = kit_bounds_of(s, KIT_R, 0), z = kit_bounds_of(s, KIT_R, 1), w = kit_bounds_of(s, KIT_R, 2);
  if (!(r.lo > r.hi)) kit_find(s, "dot", "an empty factor gives [%a, %a]", r.lo, r.hi);
  if (!(z.lo <= 0 && z.hi >= 0)) kit_find(s, "dot", "zero times the line gives [%a, %a]", z.lo, z.hi);
  if (w.lo != -INFINITY || w.hi != INFINITY) kit_find(s, "dot", "the line times [1, 2] gives [%a, %a]", w.lo, w.hi);
  if (!(flags & AMBIT_F_EMPTY) || !(flags & AMBIT_F_UNBOUNDED))
    kit_find(s, "dot", "flags %u lack EMPTY or UNBOUNDED", flags);
  flags = s->full->dot(s->ctx, kit_at(s, KIT_R, 0), kit_at(s, KIT_A, 0), 1, kit_at(s, KIT_B, 0), 1, 0, 3);
  z = kit_bounds_of(s, KIT_R, 2);
  if (z.lo != 0 || z.hi != 0 || flags) kit_find(s, "dot", "an empty sum is [%a, %a], flags %u", z.lo, z.hi, flags);
}

/* -- a tape with every rule for power series; values stay in all domains for inputs within [-1, 1] */

static const ambit_tape *every_rule(tape_builder *t) {
  tape_begin(t);
  uint32_t one = tape_constant(t, 1, 1), three = tape_constant(t, 3, 3),
           tenth = tape_constant(t, 0x1.9999999999999p-4, 0.1);
  uint32_t x = tape_input(t, AMBIT_DEGREE_ANY), y = tape_input(t, AMBIT_DEGREE_ANY), time = tape_input(t, 1);
  uint32_t parameter = tape_input(t, 0);
  uint32_t sum = tape_op(t, AMBIT_OP_ADD, x, three), low = tape_op(t, AMBIT_OP_SUB, y, three);
  uint32_t scaled = tape_op(t, AMBIT_OP_MUL, tenth, x), shifted = tape_op(t, AMBIT_OP_ADD, three, parameter);
  tape_op(t, AMBIT_OP_MUL, x, y), tape_op(t, AMBIT_OP_MUL, time, y), tape_op(t, AMBIT_OP_MUL, parameter, x);
  tape_unary(t, AMBIT_OP_SQR, x), tape_unary(t, AMBIT_OP_SQR, time), tape_unary(t, AMBIT_OP_NEG, y);
  tape_op(t, AMBIT_OP_DIV, y, sum), tape_op(t, AMBIT_OP_DIV, x, low), tape_op(t, AMBIT_OP_DIV, x, shifted);
  tape_unary(t, AMBIT_OP_SQRT, sum), tape_unary(t, AMBIT_OP_LOG, sum), tape_unary(t, AMBIT_OP_EXP, scaled);
  tape_unary(t, AMBIT_OP_SIN, x), tape_unary(t, AMBIT_OP_COS, y), tape_unary(t, AMBIT_OP_ATAN, x);
  tape_op(t, AMBIT_OP_ATAN2, y, sum), tape_op(t, AMBIT_OP_ATAN2, sum, y), tape_op(t, AMBIT_OP_ATAN2, low, x);
  tape_unary(t, AMBIT_OP_SINH, scaled), tape_unary(t, AMBIT_OP_COSH, y), tape_unary(t, AMBIT_OP_ABS, low);
  tape_unary(t, AMBIT_OP_ABS, sum), tape_op(t, AMBIT_OP_MIN, sum, low), tape_op(t, AMBIT_OP_MAX, sum, low);
  tape_unary(t, AMBIT_OP_EXP, parameter), tape_unary(t, AMBIT_OP_SQRT, shifted);
  return tape_seal(t, one);
}

static void check_eval_tape(kit_state *s, const ambit_tape *t) {
  if (t->nslot > KIT_SLOTS) return;
  kit_set want[KIT_SLOTS][2], input[4][2];
  for (uint32_t i = 0; i < t->nin; i++)
    for (size_t l = 0; l < 2; l++) {
      double x = kit_uniform(s, -1, 0.5);
      input[i][l] = (kit_set) { x, x + 0.25 };
    }
  for (int fused = 0; fused < 2; fused++) {
    for (size_t l = 0; l < 2; l++) {
      for (uint32_t c = 0; c < t->nconst; c++) kit_set_element(s, c, l, (kit_set) { t->lo[c], t->hi[c] });
      for (uint32_t i = 0; i < t->nin; i++) kit_set_element(s, t->nconst + i, l, input[i][l]);
    }
    if (fused) {
      if (s->full->enter) s->full->enter(s->ctx);
      s->full->eval_tape(s->ctx, t, s->block, s->pitch, 2);
      if (s->full->leave) s->full->leave(s->ctx);
    } else {
      for (uint32_t i = 0; i < t->ninstr; i++) kit_apply(s, t->op[i], t->dst[i], t->a[i], t->b[i], 2);
    }
    for (uint32_t slot = 0; slot < t->nslot; slot++)
      for (size_t l = 0; l < 2; l++) {
        kit_set r = kit_bounds_of(s, slot, l);
        if (fused && !meet(r, want[slot][l]))
          kit_find(s, "eval_tape", "slot %u: [%a, %a] is not the same set", slot, r.lo, r.hi);
        want[slot][l] = r;
      }
  }
}

/* -- jets: against the kernel's general ones at points, where both are thin */

enum { ORDER = 9, NDIR = 3, NIN = 4 };

typedef struct jet_run { /* one object of either kind */
  const ambit_jets *jets;
  void *self;
} jet_run;

typedef struct curve {
  double at[NIN][ORDER + 1], slope[NIN][ORDER + 1][NDIR], delta[NDIR], radius;
} curve;

static void random_curve(kit_state *s, const ambit_tape *t, curve *c) {
  c->radius = ldexp(1, -(int)(kit_random(s) % 30) - 4);
  for (int d = 0; d < NDIR; d++) c->delta[d] = ldexp((double)(kit_random(s) % 33) - 16, -4) * c->radius;
  for (uint32_t i = 0; i < NIN; i++)
    for (uint32_t k = 0; k <= ORDER; k++) {
      int vanishes = k > t->degree[t->nconst + i];
      /* few bits, so that the curve at delta is exact */
      c->at[i][k] = vanishes ? 0 : ldexp((double)(kit_random(s) % 257) - 128, -8);
      for (int d = 0; d < NDIR; d++) c->slope[i][k][d] = vanishes ? 0 : (double)(kit_random(s) % 3) - 1;
    }
}

static uint32_t run_jet(jet_run r, const curve *c, const ambit_tape *t, int box, double scale) {
  const double none[NDIR] = { 0 };
  uint32_t flags = 0;
  for (uint32_t k = 0; k <= ORDER; k++) {
    for (uint32_t i = 0; i < NIN; i++) {
      if (k > t->degree[t->nconst + i]) continue;
      double x = c->at[i][k], rad = 0;
      for (int d = 0; d < NDIR; d++)
        x += scale * c->slope[i][k][d] * c->delta[d], rad += fabs(c->slope[i][k][d]) * c->radius;
      r.jets->put(r.self, i, k, x, box ? rad : 0, box ? c->slope[i][k] : NULL, box ? none : NULL);
    }
    flags |= r.jets->advance(r.self, k);
  }
  return flags;
}

static kit_set coefficient(jet_run r, uint32_t slot, uint32_t k, double *dmid, double *drad) {
  double mid, rad;
  r.jets->get(r.self, slot, k, &mid, &rad, dmid, drad);
  return (kit_set) { nextafter(mid - rad, -INFINITY), nextafter(mid + rad, INFINITY) };
}

static void compare(
    kit_state *s, const ambit_tape *t, const curve *c, jet_run centre, jet_run box, jet_run at, jet_run there) {
  double dmid[NDIR], drad[NDIR], mag[ORDER + 1], dmag[(ORDER + 1) * NDIR];
  for (uint32_t slot = 0; slot < t->nslot; slot++) {
    box.jets->magnitude(box.self, slot, ORDER + 1, mag, dmag);
    for (uint32_t k = 0; k <= ORDER; k++) {
      kit_set u = coefficient(box, slot, k, dmid, drad), mine = coefficient(centre, slot, k, NULL, NULL);
      kit_set at_centre = coefficient(at, slot, k, NULL, NULL), at_point = coefficient(there, slot, k, NULL, NULL);
      if (!meet(mine, at_centre))
        kit_find(s, "jets", "slot %u order %u at a point: [%a, %a]", slot, k, mine.lo, mine.hi);
      if (!meet(u, at_centre) || !meet(u, at_point))
        kit_find(s, "jets", "slot %u order %u over the box: [%a, %a]", slot, k, u.lo, u.hi);
      kit_set change = { at_point.lo - at_centre.hi, at_point.hi - at_centre.lo }, linear = { 0, 0 };
      double size = fmax(fabs(at_point.lo), fabs(at_centre.lo));
      for (int d = 0; d < NDIR; d++) {
        linear.lo += dmid[d] * c->delta[d] - drad[d] * fabs(c->delta[d]);
        linear.hi += dmid[d] * c->delta[d] + drad[d] * fabs(c->delta[d]);
        size = fmax(size, (fabs(dmid[d]) + drad[d]) * fabs(c->delta[d]));
        if (!(dmag[k * NDIR + (uint32_t)d] >= fabs(dmid[d]) + drad[d] - 0x1p-50 * (fabs(dmid[d]) + drad[d])))
          kit_find(
              s, "jets", "magnitude of slope %d of slot %u order %u is %a", d, slot, k, dmag[k * NDIR + (uint32_t)d]);
      }
      double room = 0x1p-48 * size; /* this comparison is made in plain doubles */
      linear.lo -= room, linear.hi += room;
      if (!meet(change, linear))
        kit_find(s, "jets", "slot %u order %u: slopes allow [%a, %a], the change is in [%a, %a]", slot, k, linear.lo,
            linear.hi, change.lo, change.hi);
      double mid, rad;
      box.jets->get(box.self, slot, k, &mid, &rad, NULL, NULL);
      if (!(mag[k] >= (fabs(mid) + rad) * (1 - 0x1p-50)))
        kit_find(s, "jets", "magnitude of slot %u order %u is %a", slot, k, mag[k]);
    }
  }
}

static void check_jets(kit_state *s, const ambit_tape *t, int slopes) {
  const ambit_host *h = s->kit->host;
  ambit_jet_source source = { s->full, s->ctx };
  jet_run centre = { s->full->jets, NULL }, box = centre, at = { &ambit_jets_general, NULL }, there = at;
  if (centre.jets->open(h, s->ctx, t, ORDER, 0, NULL, &centre.self) ||
      at.jets->open(h, &source, t, ORDER, 0, NULL, &at.self) ||
      box.jets->open(h, s->ctx, t, ORDER, NDIR, slopes ? centre.self : NULL, &box.self) ||
      there.jets->open(h, &source, t, ORDER, 0, NULL, &there.self)) {
    kit_find(s, "jets", "open fails");
    return;
  }
  for (int round = 0; round < 6; round++) {
    curve c;
    random_curve(s, t, &c);
    uint32_t flags = run_jet(centre, &c, t, 0, 0) | run_jet(box, &c, t, 1, 0);
    if (flags) kit_find(s, "jets", "flags %u where everything is defined and bounded", flags);
    run_jet(at, &c, t, 0, 0), run_jet(there, &c, t, 0, 1);
    compare(s, t, &c, centre, box, at, there);
  }
  centre.jets->close(centre.self), box.jets->close(box.self), at.jets->close(at.self), there.jets->close(there.self);
}

void kit_check_tier_2(kit_state *s) {
  static const int both[] = { 0, 1 };
  for (int i = 0; i < 40 && s->full->dot; i++) check_dot(s, both[i % 2]);
  if (s->full->dot && s->rigorous) check_dot_specials(s);
  tape_builder builder;
  const ambit_tape *t = every_rule(&builder);
  if (s->full->eval_tape) check_eval_tape(s, t);
  if (s->full->jets) check_jets(s, t, 0), check_jets(s, t, 1);
}
