/* arithmetic_kit_jets.c -- the arithmetic's own Taylor series against the kernel's general ones at points, where both
** are thin. */
#include "graph/jet.h"
#include "kit/arithmetic_kit_inside.h"
#include "kit/tape_builder.h"
#include <math.h>

static bool meet(kit_set a, kit_set b) { return a.lo <= b.hi && b.lo <= a.hi; }

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
  tape_unary(t, AMBIT_OP_TANH, low), tape_unary(t, AMBIT_OP_TANH, x), tape_unary(t, AMBIT_OP_TANH, parameter);
  return tape_seal(t, one);
}

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

static void check_series(kit_state *s, const ambit_tape *t, int slopes) {
  const ambit_host *h = &s->host.host;
  ambit_jet_source source = { s->full, s->ctx };
  jet_run centre = { s->full->jets, NULL }, box = centre, at = { &ambit_jets_general, NULL }, there = at;
  if (centre.jets->open(h, s->ctx, t, ORDER, 0, NULL, &centre.self) ||
      at.jets->open(h, &source, t, ORDER, 0, NULL, &at.self) ||
      box.jets->open(h, s->ctx, t, ORDER, NDIR, slopes ? centre.self : NULL, &box.self) ||
      there.jets->open(h, &source, t, ORDER, 0, NULL, &there.self)) {
    kit_find(s, "jets", "open fails");
    return;
  }
  for (int round = 0; kit_more(s, round, 6); round++) {
    curve c;
    random_curve(s, t, &c);
    uint32_t flags = run_jet(centre, &c, t, 0, 0) | run_jet(box, &c, t, 1, 0);
    if (flags) kit_find(s, "jets", "flags %u where everything is defined and bounded", flags);
    run_jet(at, &c, t, 0, 0), run_jet(there, &c, t, 0, 1);
    compare(s, t, &c, centre, box, at, there);
    s->judged += (size_t)t->nslot * (ORDER + 1);
  }
  centre.jets->close(centre.self), box.jets->close(box.self), at.jets->close(at.self), there.jets->close(there.self);
}

void kit_check_jets(kit_state *s) {
  if (!s->full->jets) return;
  tape_builder builder;
  const ambit_tape *t = every_rule(&builder);
  check_series(s, t, 0), check_series(s, t, 1);
}
