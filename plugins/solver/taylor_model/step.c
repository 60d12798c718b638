/* step.c -- one step of one piece: polynomial series in time, a length, the proof, and the move.
**
** The polynomials X_k(xi) h^k are no solution: they fail x' = f by the `defect` of each order and by the tail of f
** beyond the last one, and that is integrated over the step (`local`). How far solutions are then from the polynomials
** is proved sub-range by sub-range (proof.c).
*/
#include "flow.h"
#include <string.h>

#define TRIES 100
#define PATIENCE 4     /* failed proofs before splitting is worth a thought */
#define AIM 0.4        /* share of the tolerance that a new length aims at */
#define LOW_WATER 0.03 /* a longer step is worth another tail below this share */
#define GROWTH 3.0
/* what the radii of slopes may add to a remainder in a step before slopes are taken over smaller groups of sub-ranges:
** while the remainder is a small part of its box, and when it is not */
#define BLUR_SMALL 0.05
#define BLUR_LARGE 0.01
#define SMALL 1e-4
#define SHARE 0.3   /* truncation in time may be this share of the truncation in the unknowns */
#define HELPED 0.95 /* a half whose truncation is above this share of the whole's was split for nothing */

/* -- series */

static void put_inputs(worker *w, const piece *p) {
  flow *f = w->flow;
  for (uint32_t i = 0; i < f->nx; i++) series_put(w->series, i, p->x + i * f->space.size, 0);
  for (uint32_t i = 0; i < f->np; i++) series_put(w->series, f->nx + i, p->p + i * f->space.size, p->parameter_rad[i]);
}

static enum why expand(worker *w, piece *p) {
  flow *f = w->flow;
  w->series->kink = 0;
  f->jet->put(w->jet, 0, 0, 0, 0, NULL, NULL); /* the service must know that inputs are new */
  if (f->problem.uses_time) {
    f->jet->put(w->jet, f->nx + f->np, 0, p->t, 0, NULL, NULL);
    f->jet->put(w->jet, f->nx + f->np, 1, 1, 0, NULL, NULL);
  }
  put_inputs(w, p);
  if (!f->jet->solve(w->jet, f->nx, f->options.time_order)) return WHY_NOTHING;
  return w->series->kink ? WHY_KINK : WHY_SERIES;
}

static cell coefficient(const worker *w, uint32_t i, uint32_t k) {
  return series_cell(w->series, w->flow->problem.rhs->nconst + i, k);
}

/* -- the length */

static void set_span(worker *w, double t, double t_next) {
  double above = t_next - t, below = -(t - t_next);
  w->t_next = t_next;
  w->step = (span) { above, above - below, larger(fabs(above), fabs(below)) };
  w->step.length += w->step.error;
}

/* a step of about `length` that ends at the goal or leaves room for one of its own size before it; 0: it is none */
static int plan(worker *w, const piece *p, double goal, double length) {
  double ahead = fabs(goal - p->t);
  w->at_goal = length >= ahead;
  if (w->at_goal)
    set_span(w, p->t, goal);
  else {
    if (length > 0.5 * ahead) length = 0.5 * ahead;
    set_span(w, p->t, goal > p->t ? p->t + length : p->t - length);
  }
  return w->t_next != p->t;
}

/* Defect over the step, `local`, and the part of it that a shorter step would mend, `truncation`; 0: not bounded. */
static int measure_defect(worker *w) {
  flow *f = w->flow;
  uint32_t order = f->options.time_order;
  double H = w->step.length, top = 1;
  for (uint32_t k = 0; k < order; k++) top *= H;
  memset(w->tail_in, 0, f->problem.rhs->nin * sizeof(double));
  for (uint32_t i = 0; i < f->nx; i++) w->tail_in[i] = cell_norm(coefficient(w, i, order)) * top;
  for (uint32_t i = 0; i < f->nx; i++)
    if (!(w->tail_in[i] < INFINITY)) return 0;
  if (f->jet->tail(w->jet, order - 1, H, w->tail_in, NULL, w->tail_out, NULL) != AMBIT_OK) return 0;
  for (uint32_t i = 0; i < f->nx; i++) {
    double power = H, sum = 0;
    const double *defect = w->series->defect + (size_t)i * (order + 1u);
    for (uint32_t k = 0; k < order; k++, power *= H) sum += defect[k] * power / (k + 1.0);
    w->truncation[i] = H * w->tail_out[i] / (order + 1.0);
    w->local[i] = w->truncation[i] + sum;
    if (!(w->local[i] < INFINITY)) return 0;
  }
  return 1;
}

typedef struct ratio {
  double time, rest; /* truncation in time; what else is in the defect; relative to the size of the worst state */
} ratio;

static ratio compare(const worker *w) {
  ratio r = { 0, 0 };
  flow_find_sizes(w, w->size), flow_find_units(w, w->unit);
  for (uint32_t i = 0; i < w->flow->nx; i++) {
    r.time = larger(r.time, w->truncation[i] / w->size[i]);
    r.rest = larger(r.rest, (w->local[i] - w->truncation[i]) / w->size[i]);
  }
  return r;
}

/* -- the move */

/* x := sum of X_k h^k of state i; returns what rounding and the error of h change: X_k has k products and k + 1
** sums */
double flow_evaluate(const worker *w, const span *t, uint32_t i, double *x) {
  uint32_t order = w->flow->options.time_order;
  size_t size = w->flow->space.size;
  double off = 0, drift = 0, power = 1;
  memcpy(x, coefficient(w, i, order).c, size * sizeof *x);
  for (uint32_t k = order; k-- > 0;) {
    const double *c = coefficient(w, i, k).c;
    for (size_t j = 0; j < size; j += 4) *(four *)(x + j) = t->h * *(const four *)(x + j) + *(const four *)(c + j);
  }
  for (uint32_t k = 0; k <= order; k++, power *= t->length) {
    off += gamma_of(2.0 * k + 2) * cell_norm(coefficient(w, i, k)) * power;
    if (k < order) drift += (k + 1.0) * cell_norm(coefficient(w, i, k + 1)) * power;
  }
  return off + drift * t->error + (off > 0 ? TINY : 0);
}

static int is_bounded(const flow *f, piece *p) {
  ambit_explosion e = AMBIT_EXPLOSION_START;
  for (uint32_t i = 0; i < f->nx; i++) {
    double width = 0, limit = f->limit[i];
    for (uint32_t n = 0; n < f->ns; n++) width = larger(width, 2 * p->rad[(size_t)n * (f->nx + f->np) + i]);
    p->blamed = i;
    if (f->options.width_max > 0 ? !(width <= limit) : !(width < INFINITY)) return 0;
    ambit_explosion_note(&e, i, width, polynomial_norm(&f->space, p->x + i * f->space.size), &limit);
  }
  if (f->options.width_max > 0 || !ambit_explodes(&e)) return 1;
  p->blamed = e.worst;
  return 0;
}

static enum why move(worker *w, piece *p) {
  flow *f = w->flow;
  uint32_t nx = f->nx;
  double blur = 0, part = 0; /* what the radii of slopes add to remainders; remainders in their boxes; relative */
  for (uint32_t i = 0; i < nx; i++) w->rounding[i] = flow_evaluate(w, &w->step, i, w->x + (size_t)i * f->space.size);
  flow_narrow_tube(w, p);
  memcpy(p->x, w->x, nx * f->space.size * sizeof(double));
  for (uint32_t n = 0; n < f->ns; n++) {
    zonotope z = zonotope_at(&w->shape, p->zonotope, n);
    uint32_t g = f->group[(size_t)p->level * f->ns + n];
    const double *mid = w->transfer_mid + (size_t)g * nx * nx, *rad = w->transfer_rad + (size_t)g * nx * nx;
    double *box = w->scratch, *grown = box + nx;
    for (uint32_t i = 0; i < nx; i++) {
      box[i] = grown[i] = 0;
      for (uint32_t j = 0; j < nx; j++) {
        box[i] += rad[(size_t)i * nx + j] * z.sum[j];
        grown[i] += fabs(mid[(size_t)i * nx + j]) * z.sum[j];
      }
      blur = larger(blur, box[i] / (grown[i] + TINY));
      part = larger(part, z.sum[i] / (p->rad[(size_t)n * (nx + f->np) + i] + TINY));
      box[i] += w->apart[(size_t)g * nx + i] + w->rounding[i];
    }
    zonotope_multiply(&w->shape, z, mid, box);
    zonotope_push(&w->shape, z, box);
  }
  w->groups = f->ngroup[p->level];
  double most = part < SMALL ? BLUR_SMALL : BLUR_LARGE;
  if (blur > most && p->level) p->level--;
  if (blur < 0.25 * most && p->level + 1 < f->levels) p->level++;
  for (uint32_t i = 0; i < nx; i++) {
    p->tube_lo[i] = smaller(p->tube_lo[i], w->tube_lo[i]);
    p->tube_hi[i] = larger(p->tube_hi[i], w->tube_hi[i]);
  }
  p->t = w->t_next;
  flow_boxes(w, p);
  return is_bounded(f, p) ? WHY_NOTHING : WHY_WIDE;
}

/* -- a step */

static int is_proved(worker *w, piece *p) {
  flow *f = w->flow;
  for (uint32_t i = 0; i < f->nx; i++) w->tube_lo[i] = INFINITY, w->tube_hi[i] = -INFINITY;
  for (uint32_t n = 0; n < f->ngroup[p->level]; n++)
    if (!flow_prove(w, p, n)) return 0;
  for (uint32_t i = 0; i < f->nx; i++) {
    double most = 0;
    for (uint32_t n = 0; n < f->ngroup[p->level]; n++) most = larger(most, w->apart[(size_t)n * f->nx + i]);
    p->pad[i] = 3 * most;
  }
  return 1;
}

/* How much truncation in the unknowns no split mends: where halves have as much of it as the whole, it is rounding of
** terms that cancel, as in a state that starts at zero and stays there. It is forgotten when the truncation falls. */
static double find_futile(piece *p, double rest) {
  if (p->parent_rest > 0 && rest > HELPED * p->parent_rest) p->futile = 2 * rest;
  p->parent_rest = 0;
  p->futile = smaller(p->futile, 2 * rest);
  return p->futile;
}

static double rescaled(const worker *w, double ratio) {
  double factor = ratio > 0 ? pow(AIM / ratio, 1.0 / (w->flow->options.time_order + 1.0)) : GROWTH;
  if (!(factor > 0.2)) factor = 0.2;
  return w->step.length * smaller(factor, GROWTH);
}

static enum why try_step(worker *w, piece *p, double goal) {
  const options *o = &w->flow->options;
  enum why why = expand(w, p);
  if (why != WHY_NOTHING) return why;
  flow_find_rates(w, p);
  double least = flow_least_step(w->flow, p->t), most = o->step_max, length = smaller(larger(p->guess, least), most);
  uint32_t failed = 0;
  for (int i = 0; i < TRIES; i++) {
    if (!plan(w, p, goal, length) || (w->step.length < least && !w->at_goal)) return WHY_NO_STEP;
    ambit_work_try(w->counted);
    int bounded = measure_defect(w), cut_short = w->at_goal || w->step.length < 0.99 * length;
    ratio r = bounded ? compare(w) : (ratio) { INFINITY, INFINITY };
    double rest = r.rest <= o->split_tolerance ? r.rest : p->tolerant || p->futile > 0 ? o->split_tolerance : 0;
    double allowed = larger(o->tolerance, SHARE * rest);
    double over = bounded ? r.time / allowed : INFINITY;
    if (!(over <= 1)) { /* never again as long: an infinite ratio would otherwise shrink and grow in turn */
      most = smaller(most, 0.9 * w->step.length);
      length = smaller(rescaled(w, over), most);
      continue;
    }
    if (over < LOW_WATER && !cut_short && length < most) {
      length = over > 0 ? smaller(rescaled(w, over), most) : most;
      continue;
    }
    if (r.rest > larger(o->split_tolerance, find_futile(p, r.rest)) && !p->tolerant) {
      p->parent_rest = r.rest;
      return WHY_DEFECT;
    }
    if (is_proved(w, p)) {
      p->guess = most < o->step_max ? 1.1 * w->step.length
                 : cut_short        ? larger(length, rescaled(w, over))
                                    : rescaled(w, over);
      return move(w, p);
    }
    if (p->level && !w->order_too_low) { /* over smaller groups, before shorter */
      p->level = p->level > 2 ? p->level - 2 : 0;
      continue;
    }
    if (!w->order_too_low && ++failed == PATIENCE && !p->tolerant) return WHY_NO_STEP;
    most = length = 0.6 * w->step.length;
  }
  return WHY_NO_STEP;
}

enum why flow_step(worker *w, piece *p, double goal) {
  enum why why = try_step(w, p, goal);
  p->kink = why == WHY_KINK || why == WHY_NO_STEP ? flow_kink(w) : NULL;
  return why;
}
