/* symbols.c -- the right-hand side over the tube of a step, in the arithmetic of the problem.
**
** The unknowns xi and the time sigma of the step, all in [-1, 1], are its variables, and every input of the tape is
** computed from them: x_i = p_i(sigma, xi) +- radius_i by Horner's rule, parameters middle + reach xi, t = time + half
** sigma. So an arithmetic that keeps symbols sees what cancels in the defect half f(p) - p'; one that keeps none is as
** valid, only wider. What an arithmetic keeps is tried, not asked.
**
** Elements behind the slots of the tape: sigma; the monomials of xi; half; three for intermediate results.
*/
#include "valencia.h"

enum { SIGMA, HALF, SUM, NEXT, TERM, FACTOR, MONOMIALS };

static uint32_t at(const valencia *s, uint32_t k) { return s->problem.rhs->nslot + k; }
static void *element(const valencia *s, uint32_t slot) { return ambit_lane_at(&s->symbols.lane, slot); }

static void put(const valencia *s, uint32_t slot, interval x, int32_t var) {
  s->symbols.lane.arithmetic->set(s->symbols.lane.ctx, element(s, slot), 1, &x.lo, &x.hi, var);
}

static uint32_t apply(const valencia *s, uint32_t op, uint32_t dst, uint32_t a, uint32_t b) {
  const ambit_lane *l = &s->symbols.lane;
  return l->arithmetic->run[op](l->arithmetic, l->ctx, l->base, 1, 1, 1, &dst, &a, &b);
}

static interval bounds(const valencia *s, uint32_t slot) {
  interval r;
  ambit_bounds_read(s->symbols.lane.arithmetic, s->symbols.lane.ctx, element(s, slot), 1, &r.lo, &r.hi);
  return r;
}

static void enter(const ambit_lane *l) {
  if (l->arithmetic->enter) l->arithmetic->enter(l->ctx);
}

static void leave(const ambit_lane *l) {
  if (l->arithmetic->leave) l->arithmetic->leave(l->ctx);
}

/* Around operations that are no instructions of the tape: a profile must not charge the equations for them. */
static void enter_curves(const valencia *s) {
  if (!s->meter) return;
  s->meter->enter("curves");
  s->meter->operation(AMBIT_OP_COUNT);
}

static void leave_curves(const valencia *s) {
  if (s->meter) s->meter->leave();
}

/* -- what the arithmetic keeps */

#define TRIED 16

/* x^k - x^k, k counted up while it stays nothing */
static uint32_t kept_degree(const valencia *s, int32_t var) {
  uint32_t k = 0, power = at(s, TERM), again = at(s, FACTOR);
  interval one = { -1, 1 };
  enter_curves(s);
  put(s, at(s, SIGMA), one, var), put(s, power, point(1), -1), put(s, again, point(1), -1);
  for (; k < TRIED; k++) {
    apply(s, AMBIT_OP_MUL, at(s, SUM), power, at(s, SIGMA));
    apply(s, AMBIT_OP_MUL, at(s, NEXT), again, at(s, SIGMA));
    apply(s, AMBIT_OP_SUB, power, at(s, SUM), at(s, NEXT));
    if (!(magnitude(bounds(s, power)) < 1e-9)) break;
    apply(s, AMBIT_OP_ADD, power, at(s, SUM), at(s, HALF));
    apply(s, AMBIT_OP_ADD, again, at(s, NEXT), at(s, HALF));
  }
  leave_curves(s);
  return k;
}

static int open_room(valencia *s) {
  symbols *y = &s->symbols;
  const ambit_tape *t = s->problem.rhs;
  const ambit_arithmetic *a = s->problem.arithmetic;
  size_t count = t->nslot + MONOMIALS + TERMS_MAX, elem = a->elem(s->problem.actx);
  y->lane = (ambit_lane) { t, a, s->problem.actx, s->host->alloc(s->host, count * elem), elem, ambit_work_open(s->host),
    0, 0 };
  if (!y->lane.base || (a->init && a->init(s->problem.actx, y->lane.base, count) != AMBIT_OK)) return 0;
  y->count = count;
  for (uint32_t i = 0; i < t->nconst; i++) ambit_constant_set(a, s->problem.actx, element(s, i), t, i);
  return 1;
}

int valencia_symbols_open(valencia *s) {
  symbols *y = &s->symbols;
  size_t nslot = s->problem.rhs->nslot;
  y->time_var = s->nu;
  y->lo = s->host->alloc(s->host, nslot * sizeof *y->lo);
  y->hi = s->host->alloc(s->host, nslot * sizeof *y->hi);
  y->slope = s->host->alloc(s->host, nslot * (s->ndir + 1) * sizeof *y->slope);
  if (!open_room(s) || !y->lo || !y->hi || !y->slope) return 0;
  enter(&y->lane);
  put(s, at(s, HALF), point(0), -1);
  y->degree = s->nu ? kept_degree(s, 0) : 1;
  y->keeps = kept_degree(s, (int32_t)y->time_var) > 0 && y->degree > 0;
  leave(&y->lane);
  return 1;
}

/* -- inputs */

static uint32_t set_monomials(const valencia *s, int only_middle) {
  const terms *t = &s->terms;
  interval one = { -1, 1 }, xi = only_middle ? point(0) : one;
  uint32_t flags = 0;
  put(s, at(s, SIGMA), one, (int32_t)s->symbols.time_var);
  put(s, at(s, HALF), s->half, -1);
  for (uint32_t j = 0; j < s->nu; j++) put(s, at(s, MONOMIALS + 1 + j), xi, (int32_t)j);
  put(s, at(s, MONOMIALS), point(1), -1);
  for (uint32_t k = 1 + s->nu; k < t->n; k++)
    flags |= apply(s, AMBIT_OP_MUL, at(s, MONOMIALS + k), at(s, MONOMIALS + t->parent[2 * k]),
        at(s, MONOMIALS + 1 + t->parent[2 * k + 1]));
  return flags;
}

/* SUM := SUM + c monomial */
static uint32_t add_term(const valencia *s, interval c, uint32_t monomial) {
  if (c.lo == 0 && c.hi == 0) return 0;
  put(s, at(s, FACTOR), c, -1);
  uint32_t flags = apply(s, AMBIT_OP_MUL, at(s, TERM), at(s, FACTOR), at(s, MONOMIALS + monomial));
  flags |= apply(s, AMBIT_OP_ADD, at(s, NEXT), at(s, SUM), at(s, TERM));
  put(s, at(s, TERM), point(0), -1);
  return flags | apply(s, AMBIT_OP_ADD, at(s, SUM), at(s, NEXT), at(s, TERM));
}

/* SUM := p_i(sigma, xi), or its derivative by sigma */
static uint32_t set_curve(const valencia *s, uint32_t i, uint32_t derived) {
  uint32_t n = s->stages.n + 1, flags = 0;
  const double *c = s->curve + (size_t)i * s->terms.n * n;
  put(s, at(s, SUM), point(0), -1);
  for (uint32_t m = n; m-- > derived;) {
    if (m + 1 < n) {
      flags |= apply(s, AMBIT_OP_MUL, at(s, NEXT), at(s, SUM), at(s, SIGMA));
      put(s, at(s, TERM), point(c[m]), -1);
      if (derived) put(s, at(s, TERM), scaled(point(c[m]), m), -1);
      flags |= apply(s, AMBIT_OP_ADD, at(s, SUM), at(s, NEXT), at(s, TERM));
    } else
      put(s, at(s, SUM), derived ? scaled(point(c[m]), m) : point(c[m]), -1);
    for (uint32_t k = 1; k < s->terms.n; k++) {
      double x = c[(size_t)k * n + m];
      flags |= add_term(s, derived ? scaled(point(x), m) : point(x), k);
    }
  }
  return flags;
}

static uint32_t set_inputs(const valencia *s, const double *radius) {
  uint32_t first = s->problem.rhs->nconst, flags = 0;
  for (uint32_t i = 0; i < s->nx; i++) {
    flags |= set_curve(s, i, 0);
    put(s, at(s, TERM), within(radius ? radius[i] : 0), -1);
    flags |= apply(s, AMBIT_OP_ADD, first + i, at(s, SUM), at(s, TERM));
  }
  for (uint32_t k = 0; k < s->np; k++) {
    put(s, at(s, SUM), point(s->middle[k]), -1);
    for (uint32_t j = 0; j < s->nu; j++) flags |= add_term(s, point(s->reach[(size_t)k * s->nu + j]), 1 + j);
    put(s, at(s, TERM), within(s->loose[k]), -1);
    flags |= apply(s, AMBIT_OP_ADD, first + s->nx + k, at(s, SUM), at(s, TERM));
  }
  if (!s->problem.uses_time) return flags;
  flags |= apply(s, AMBIT_OP_MUL, at(s, SUM), at(s, HALF), at(s, SIGMA));
  put(s, at(s, TERM), s->time, -1);
  return flags | apply(s, AMBIT_OP_ADD, first + s->nx + s->np, at(s, SUM), at(s, TERM));
}

static uint32_t run_tape(const ambit_lane *l) {
  const ambit_tape *t = l->tape;
  uint32_t flags = 0;
  ambit_work_evaluate(l->work, t->ninstr, 1);
  for (uint32_t i = 0; i < t->nrun; i++) {
    const ambit_run *r = &t->run[i];
    flags |= l->arithmetic->run[r->op](
        l->arithmetic, l->ctx, l->base, 1, 1, r->count, t->dst + r->first, t->a + r->first, t->b + r->first);
  }
  return flags;
}

uint32_t valencia_symbols_run(valencia *s, const double *radius, int only_middle, interval *out) {
  const ambit_lane *l = &s->symbols.lane;
  const ambit_tape *t = l->tape;
  enter(l);
  enter_curves(s);
  uint32_t flags = set_monomials(s, only_middle);
  flags |= set_inputs(s, radius);
  leave_curves(s);
  flags |= run_tape(l);
  enter_curves(s);
  ambit_lane_slots(l, flags, s->symbols.lo, s->symbols.hi);
  for (uint32_t i = 0; i < s->nx; i++) {
    flags |= set_curve(s, i, 1);
    flags |= apply(s, AMBIT_OP_MUL, at(s, TERM), at(s, HALF), t->out[i]);
    flags |= apply(s, AMBIT_OP_SUB, at(s, NEXT), at(s, TERM), at(s, SUM));
    out[i] = bounds(s, at(s, NEXT));
    ambit_empty_check(l->arithmetic, flags, l->given_empty, out[i].lo, out[i].hi);
    if (!is_bounded(out[i])) flags |= AMBIT_F_UNBOUNDED;
  }
  leave_curves(s);
  leave(l);
  return flags;
}

void valencia_symbols_close(valencia *s) {
  const ambit_lane *l = &s->symbols.lane;
  if (l->base && l->arithmetic->clear) l->arithmetic->clear(l->ctx, l->base, s->symbols.count);
}
