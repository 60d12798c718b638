/* arithmetic_kit_programs.c -- random straight-line programs over shared variables.
**
** Uncertain data are identities: a variable that is used twice is one number. Whatever correlation an arithmetic
** keeps, at every point of the box every slot must hold the value of the program at this point; a fused eval_tape
** must do the same; and a gradient must obey the mean value theorem between any two points of the box:
** f(q) - f(p) = sum_j g_j (q_j - p_j) for some g_j between the bounds.
*/
#include "kit/arithmetic_kit_inside.h"
#include "kit/program_oracle.h"
#include "kit/tape_builder.h"
#include "num/interval.h"
#include <float.h>
#include <stdio.h>

enum { LANES = 3, STEPS = 14, SAMPLES = 5 };

typedef struct program {
  tape_builder builder;
  const ambit_tape *tape;
  int32_t var[KIT_NVAR + 1];           /* of each input; -1: none */
  kit_set box[KIT_NVAR + 1][LANES];    /* inputs with one variable have one range */
  ambit_interval image[PROGRAM_SLOTS]; /* natural interval evaluation over the hull of all lanes: steers the choice */
} program;

/* the exponents that are worth a step */
static uint32_t right_of(kit_state *s, uint32_t op, uint32_t a, uint32_t slots) {
  if (op == AMBIT_OP_POWN) return (uint32_t)((int32_t)(kit_random(s) % 9) - 3);
  return kit_op_arity[op] == 2 ? (uint32_t)(kit_random(s) % slots) : a;
}

/* Adds an instruction whose result is bounded and not too large; now and then one that leaves its domain. */
static void add_step(kit_state *s, program *p) {
  for (int tries = 0; tries < 30; tries++) {
    uint32_t slots = p->builder.tape.nslot, op = (uint32_t)(kit_random(s) % AMBIT_OP_COUNT);
    uint32_t a = (uint32_t)(kit_random(s) % slots), b = right_of(s, op, a, slots), flags;
    ambit_interval r;
    if (op == AMBIT_OP_POWN)
      flags = ambit_interval_pown(&r, p->image[a], (int32_t)b);
    else
      flags = ambit_interval_op(op, &r, p->image[a], p->image[b]);
    bool tame = !ambit_interval_is_empty(r) && fabs(r.lo) < 1e4 && fabs(r.hi) < 1e4;
    if (!tame || (flags && kit_random(s) % 8)) continue;
    p->image[tape_op(&p->builder, op, a, b)] = r;
    return;
  }
}

static ambit_interval hull_of(const kit_set *x) {
  ambit_interval h = { x[0].lo, x[0].hi };
  for (size_t l = 1; l < LANES; l++) h.lo = fmin(h.lo, x[l].lo), h.hi = fmax(h.hi, x[l].hi);
  return h;
}

static void make_program(kit_state *s, program *p) {
  static const double constant[] = { 1, -0.75, 3 };
  tape_begin(&p->builder);
  for (size_t i = 0; i < sizeof constant / sizeof *constant; i++)
    p->image[tape_constant(&p->builder, constant[i], constant[i])] = (ambit_interval) { constant[i], constant[i] };
  uint32_t inputs = 1 + (uint32_t)(kit_random(s) % (KIT_NVAR + 1));
  double scale = ldexp(1, -(int)(kit_random(s) % 3) * (int)(kit_random(s) % 16));
  for (uint32_t i = 0; i < inputs; i++) {
    bool twin = i == KIT_NVAR; /* one more input of variable 0: the same number */
    bool free = !twin && i > 0 && kit_random(s) % 4 == 0;
    p->var[i] = twin ? 0 : free ? -1 : (int32_t)i;
    for (size_t l = 0; l < LANES; l++) {
      double c = kit_uniform(s, -2, 2), w = kit_random(s) % 6 ? kit_uniform(s, 0, 1) * scale : 0;
      p->box[i][l] = twin ? p->box[0][l] : (kit_set) { c - w, c + w };
    }
    p->image[tape_input(&p->builder, AMBIT_DEGREE_ANY)] = hull_of(p->box[i]);
  }
  uint64_t steps = 2 + kit_random(s) % STEPS;
  for (uint64_t i = 0; i < steps; i++) add_step(s, p);
  p->tape = tape_seal(&p->builder, AMBIT_NO_SLOT);
}

static void put_operands(kit_state *s, const program *p) {
  const ambit_tape *t = p->tape;
  for (size_t l = 0; l < LANES; l++) {
    for (uint32_t i = 0; i < t->nconst; i++) kit_set_element(s, i, l, (kit_set) { t->lo[i], t->hi[i] });
    for (uint32_t i = 0; i < t->nin; i++) kit_set_variable(s, t->nconst + i, l, p->box[i][l], p->var[i]);
  }
}

static uint32_t run_steps(kit_state *s, const ambit_tape *t) {
  uint32_t flags = 0;
  for (uint32_t i = 0; i < t->ninstr; i++) flags |= kit_apply(s, t->op[i], t->dst[i], t->a[i], t->b[i], LANES);
  return flags;
}

static void sample(kit_state *s, const program *p, size_t lane, double *x) {
  for (uint32_t i = 0; i < p->tape->nin; i++) {
    kit_set box = p->box[i][lane];
    double at = kit_random(s) % 2 ? kit_uniform(s, box.lo, box.hi) : kit_random(s) % 2 ? box.lo : box.hi;
    x[i] = i == KIT_NVAR ? x[0] : fmin(fmax(at, box.lo), box.hi);
  }
}

/* "t5 = MUL t3 t4; ..." up to a slot */
static const char *listing(const program *p, uint32_t slot, char *out, size_t room) {
  const ambit_tape *t = p->tape;
  size_t used = 0;
  out[0] = '\0';
  for (uint32_t i = 0; i < t->ninstr && t->dst[i] <= slot && used < room; i++)
    used += (size_t)snprintf(out + used, room - used, " t%u = %s t%u %s%d;", t->dst[i], kit_op_name[t->op[i]], t->a[i],
        t->op[i] == AMBIT_OP_POWN ? "" : "t", (int)t->b[i]);
  return out;
}

static void judge_sample(
    kit_state *s, const program *p, program_oracle *o, size_t lane, const double *x, uint32_t flags, const char *how) {
  char text[400];
  const ambit_tape *t = p->tape;
  program_run(o, t, x);
  for (uint32_t slot = t->nconst; slot < t->nslot; slot++) {
    s->judged++;
    if (mpfr_nan_p(o->u[slot])) {
      if (!(flags & AMBIT_F_PARTIAL))
        kit_find(s, "partial", "%s: the program is undefined at a sample, without PARTIAL:%s", how,
            listing(p, slot, text, sizeof text));
      return; /* later slots may lack their operands */
    }
    kit_set r = kit_bounds_of(s, slot, lane);
    if (!program_encloses(r.lo, r.hi, o->u[slot])) {
      kit_find(s, "program",
          "%s: t%u in [%a, %a] misses %.17g at inputs (%a, %a, %a, %a), the first in [%a, %a], from t%u:%s (%s)", how,
          slot, r.lo, r.hi, mpfr_get_d(o->u[slot], MPFR_RNDN), x[0], t->nin > 1 ? x[1] : 0, t->nin > 2 ? x[2] : 0,
          t->nin > 3 ? x[3] : 0, p->box[0][lane].lo, p->box[0][lane].hi, t->nconst, listing(p, slot, text, sizeof text),
          s->environment->name);
      return;
    }
  }
}

/* sum := sum + [lo, hi] d, as bounds */
static void add_slope(mpfr_t down, mpfr_t up, double lo, double hi, double to, double from) {
  mpfr_t d, a, b;
  mpfr_init2(d, PROGRAM_BITS), mpfr_init2(a, PROGRAM_BITS), mpfr_init2(b, PROGRAM_BITS);
  mpfr_set_d(d, to, MPFR_RNDN);
  mpfr_sub_d(d, d, from, MPFR_RNDN);
  mpfr_mul_d(a, d, lo, MPFR_RNDN), mpfr_mul_d(b, d, hi, MPFR_RNDN);
  if (!mpfr_zero_p(d)) {
    mpfr_add(down, down, mpfr_cmp(a, b) <= 0 ? a : b, MPFR_RNDN);
    mpfr_add(up, up, mpfr_cmp(a, b) <= 0 ? b : a, MPFR_RNDN);
  }
  mpfr_clear(d), mpfr_clear(a), mpfr_clear(b);
}

/* The change between p and q, of which the inputs that are no variables are the same. */
static void judge_gradient(kit_state *s, const program *p, program_oracle *at, program_oracle *there, size_t lane,
    const double *from, const double *to) {
  const ambit_tape *t = p->tape;
  char text[400];
  double lo[KIT_NVAR], hi[KIT_NVAR];
  mpfr_t down, up, change;
  program_run(at, t, from), program_run(there, t, to);
  mpfr_init2(down, PROGRAM_BITS), mpfr_init2(up, PROGRAM_BITS), mpfr_init2(change, PROGRAM_BITS);
  for (uint32_t slot = t->nconst; slot < t->nslot; slot++) {
    if (mpfr_nan_p(at->u[slot]) || mpfr_nan_p(there->u[slot])) break;
    for (int j = 0; j < KIT_NVAR; j++) lo[j] = hi[j] = NAN;
    if (!kit_gradient(s, slot, lane, lo, hi)) continue;
    mpfr_sub(change, there->u[slot], at->u[slot], MPFR_RNDN);
    mpfr_set_zero(down, 1), mpfr_set_zero(up, 1);
    bool sane = true;
    for (uint32_t j = 0; j < KIT_NVAR; j++) {
      sane = sane && lo[j] <= hi[j]; /* false for NaN */
      if (j < t->nin && p->var[j] >= 0) add_slope(down, up, lo[j], hi[j], to[j], from[j]);
    }
    s->judged++;
    mpfr_sub(down, down, change, MPFR_RNDN), mpfr_sub(up, up, change, MPFR_RNDN);
    bool holds = mpfr_cmp_d(down, 0x1p-200) <= 0 && mpfr_cmp_d(up, -0x1p-200) >= 0;
    if (!sane || !holds) {
      kit_find(s, "gradient",
          "t%u: [%a, %a], [%a, %a], [%a, %a] does not allow the change from (%a, ...) to (%a, ...):%s", slot, lo[0],
          hi[0], lo[1], hi[1], lo[2], hi[2], from[0], to[0], listing(p, slot, text, sizeof text));
      break;
    }
  }
  mpfr_clear(down), mpfr_clear(up), mpfr_clear(change);
}

static void check_gradient(kit_state *s, const program *p, program_oracle *at, program_oracle *there, size_t lane) {
  double from[KIT_NVAR + 1], to[KIT_NVAR + 1];
  sample(s, p, lane, from);
  sample(s, p, lane, to);
  for (uint32_t i = 0; i < p->tape->nin; i++)
    if (p->var[i] < 0 || (i < KIT_NVAR && kit_random(s) % 2)) to[i] = from[i];
  if (p->tape->nin > KIT_NVAR) to[KIT_NVAR] = to[0];
  judge_gradient(s, p, at, there, lane, from, to);
}

/* f = x sqr(x) + x on [1, 2]: smooth, so that a gradient must be known and hold f' = 3 x^2 + 1 */
static void check_gradient_is_known(kit_state *s) {
  double lo[KIT_NVAR], hi[KIT_NVAR];
  kit_set_variable(s, 0, 0, (kit_set) { 1, 2 }, 1);
  kit_apply(s, AMBIT_OP_SQR, 1, 0, 0, 1), kit_apply(s, AMBIT_OP_MUL, 2, 0, 1, 1),
      kit_apply(s, AMBIT_OP_ADD, 3, 2, 0, 1);
  s->judged++;
  if (!kit_gradient(s, 3, 0, lo, hi))
    kit_find(s, "gradient", "none is known of x^3 + x on [1, 2]");
  else if (!(lo[0] <= 0 && hi[0] >= 0 && lo[2] <= 0 && hi[2] >= 0 && lo[1] <= 4 && hi[1] >= 13))
    kit_find(s, "gradient", "of x^3 + x on [1, 2] is [%a, %a], not all of [4, 13]", lo[1], hi[1]);
}

void kit_check_programs(kit_state *s) {
  if (!s->rigorous) return; /* for points, operations say it all */
  program_oracle at, there;
  program_open(&at), program_open(&there);
  if (s->full->gradient) check_gradient_is_known(s);
  for (int round = 0; kit_more(s, round, 1500); round++) {
    program p;
    double x[KIT_NVAR + 1];
    make_program(s, &p);
    for (int fused = 0; fused < (s->full->eval_tape ? 2 : 1); fused++) {
      put_operands(s, &p);
      uint32_t flags = fused ? kit_eval_tape(s, p.tape, LANES) : run_steps(s, p.tape);
      for (int i = 0; i < SAMPLES; i++) {
        size_t lane = kit_random(s) % LANES;
        sample(s, &p, lane, x);
        judge_sample(s, &p, &at, lane, x, flags, fused ? "eval_tape" : "step by step");
        if (s->full->gradient) check_gradient(s, &p, &at, &there, lane);
      }
    }
  }
  program_close(&at), program_close(&there);
}
