/* pace.c -- the length of a step and the order in time, by need.
**
** What the lumps add to each state per second, weighed with coefficients at the set's centre, is rate_i(h). It starts
** from what rows drop at order 0 and grows with h. A step is the longest over which it at most doubles, but for what is
** negligible beside the state's motion, beside its set, or for the run as a whole (its budget). No proof depends on
** anything here.
*/
#include "kink.h"
#include "proof.h"
#include "quartic.h"

#define GROWTH 2.0     /* of the rate over a step; */
#define LESS 1.25      /* where lumps matter so much that quartic.c is at work: it knows them at one time of the step */
#define FROM_REST 1e-4 /* most that a step may add, as a share of a state that starts at 0 */
#define OF_SET 0.03    /* or of its set: terms of higher degree in the data are some part of it from the start */
#define SHARE_EXACT 0.1
#define SHARE 0.001    /* of its set: what a state may be widened by in a whole run without more ado; */
#define MANY 20.0      /* data; of fewer, triples cost less, by the cube, and that much less is given away */
#define FADED 0.1      /* of a set that was larger once, as if it still were so large */
#define ORDER_EXACT 30 /* without, and least */
#define ORDER_LEAST 10
#define ORDER_SHORT 3  /* least between jumps; */
#define SETTLE 2       /* steps until a lower one is tried, */
#define RELAX 100      /* or after one that was too low */
#define FLOOR 1e-4     /* of the largest of these: states that are at rest for a while */
#define DIGITS 0x1p-10 /* what rounding to doubles would add, times this: where there are no data */
#define LEFT 0.7       /* of the length that was chosen: the proof bore less */
#define SCALE 1e-8 /* of a state's size, the least that its errors are weighed by: it may be known but for rounding */
#define TRIES 60
#define REFINE 4
#define BESIDE_SET 1e-5     /* share of the set that truncation may add in a step */
#define BESIDE_MOTION 1e-13 /* of the state's size, where it has data; */
#define EXACT 1e-15         /* where it has none: */
#define NARROW 1e-10        /* its set is narrower than this share of it */

/* rate of each state from z->r, z->rr_out */
static void find_rates(const zono *z, double *rate) {
  const proof *p = z->proof;
  double *target = p->work;
  for (uint32_t n = 0; n < p->ntarget; n++) {
    const double *C = p->weight + (size_t)n * z->nslot, *L = p->weight_L + (size_t)n * z->na;
    double sum = 0;
    for (uint32_t j = 0; j < z->nslot; j++) sum += z->kinks->is_slot[j] ? 0 : fabs(C[j]) * z->r[j];
    for (uint32_t q = 0; q < z->na; q++) sum += fabs(L[q]) * z->rr_out[z->nx + q];
    target[n] = sum;
  }
  for (uint32_t i = 0; i < z->nx; i++) rate[i] = z->rr_out[i] + (p->link[i] == LINK_STATE ? 0 : target[p->link_to[i]]);
}

/* the state's size with its motion, and its set's, over the step */
static void find_sizes(const zono *z, uint32_t i, double length, double *size, double *set) {
  uint32_t slot = slot_x(z, i);
  double power = 1;
  *size = *set = 0;
  for (uint32_t k = 0; k < orders(z, slot); k++, power *= length) {
    const double *row = row_at(z, slot, k);
    *size += power * row_total(&z->shape, row), *set += power * row_moving(&z->shape, row);
  }
}

/* share of the state's size that a step may add */
static double share_of(const zono *z, double size, double set) {
  double share = z->options.tolerance;
  if (share == 0) share = set > NARROW * size ? BESIDE_MOTION : EXACT;
  return fmax(share, EXACT);
}

/* Does a shorter step gain nothing? Half of it adds as much of what the state is by then: the state is of some order in
** time, and so is what is added. That is so of rounding, from rest more than EXACT of the state however short the step;
** and of a state that starts at 0 for all data, whose terms of higher degree come up as the state does. Of more than a
** small part of the state it is not: orders in time that are missing come up with it as well. */
static int is_of_like_order(const zono *z, uint32_t i, double length, double rate, double half) {
  double size, set, size_half, set_half, start;
  find_sizes(z, i, 0, &start, &set);
  find_sizes(z, i, length, &size, &set);
  if (set > NARROW * size && start > 0) return 0;
  find_sizes(z, i, 0.5 * length, &size_half, &set_half);
  return length * rate <= fmax(FROM_REST * size, OF_SET * set) && rate * size_half <= 2 * half * size;
}

/* What is added to a state at such a rate for the whole run is a small part of its set, now or at its widest. */
void pace_budget(zono *z, double length) {
  proof *p = z->proof;
  const double *time = z->problem.time;
  double span = fabs(time[z->problem.ntime - 1] - time[0]), many = is_certain(z) ? 1 : fmin(z->m / MANY, 1);
  for (uint32_t i = 0; i < z->nx; i++) {
    double size, set;
    find_sizes(z, i, length, &size, &set);
    p->budget[i] = (is_certain(z) ? SHARE_EXACT : SHARE * many * many * many) * fmax(set, FADED * p->largest[i]) / span;
  }
}

/* the rates that rounding every operation to doubles would have */
static void find_natural(zono *z) {
  const ambit_tape *t = z->program.tape;
  proof *p = z->proof;
  const double *total = p->total;
  memset(z->r, 0, z->nslot * sizeof *z->r);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    int sum = t->op[i] == AMBIT_OP_ADD || t->op[i] == AMBIT_OP_SUB;
    double size = sum ? total[z->first[t->a[i]]] + total[z->first[t->b[i]]] : total[z->first[t->dst[i]]];
    z->r[t->dst[i]] = UNIT * size;
  }
  memset(z->rr_out, 0, z->nout * sizeof *z->rr_out);
  find_rates(z, p->natural);
  double most[2] = { 0, 0 }; /* of integrals of states, and of others */
  for (uint32_t i = 0; i < z->nx; i++) {
    p->natural[i] += UNIT * total[z->first[slot_out(z)[i]]];
    most[p->link[i] == LINK_STATE] = fmax(most[p->link[i] == LINK_STATE], p->natural[i]);
  }
  for (uint32_t i = 0; i < z->nx; i++) p->natural[i] = fmax(p->natural[i], FLOOR * most[p->link[i] == LINK_STATE]);
}

/* a state that is another one's integral is off by what that is off by over the step, too */
static double natural_of(const zono *z, uint32_t i, double length) {
  const proof *p = z->proof;
  return p->natural[i] + (p->link[i] == LINK_STATE ? p->natural[p->link_to[i]] * length : 0);
}

/* what truncation may add to a state: less than rounding would if the order in time can be what it needs to be */
static double allowed_beside_rounding(const zono *z, uint32_t i, double size, double length) {
  const options *o = &z->options;
  double share = o->time_order && o->tolerance == 0 ? EXACT : o->tolerance, digits = o->time_order ? 1 : DIGITS;
  return share * size + (digits * natural_of(z, i, length) + z->proof->budget[i]) * length;
}

/* 1: short enough; start: rates over a step of length 0 */
static int fits(zono *z, double length, const double *start) {
  const proof *p = z->proof;
  double *rate = p->grow, *half = p->zeta_new;
  int known = 0; /* half */
  double growth = p->quartic->count ? LESS : GROWTH;
  if (!defect_evaluate(z, length) || !kinks_fit(z, length)) return 0;
  find_rates(z, rate);
  pace_budget(z, length);
  for (uint32_t i = 0; i < z->nx; i++) {
    double size, set;
    find_sizes(z, i, length, &size, &set);
    double allowed = share_of(z, size, set) * size + BESIDE_SET * set + p->budget[i] * length;
    if (is_certain(z)) allowed = allowed_beside_rounding(z, i, size, length);
    if (length * rate[i] <= growth * length * start[i] + allowed) continue;
    if (is_certain(z)) return 0;
    if (!known && !defect_evaluate(z, 0.5 * length)) return 0;
    if (!known) find_rates(z, half), known = 1;
    if (!is_of_like_order(z, i, length, rate[i], half[i])) return 0;
  }
  return 1;
}

double zono_choose_step(zono *z, double h_most) {
  proof *p = z->proof;
  double *start = p->zeta, most = fabs(h_most), length = most, above = 0;
  z->h = h_most; /* its sign */
  defect_prepare(z);
  p->prepared = 1, p->rho_before = 0;
  if (p->patience > 0) p->patience--;
  for (uint32_t i = 0; i < z->nx; i++) {
    double size, set;
    find_sizes(z, i, 0, &size, &set);
    p->spread[i] = set > 0 ? fmax(set, SCALE * size) : size;
    p->largest[i] = fmax(fmax(p->largest[i], z->expected[i]), set);
    find_sizes(z, i, most, &size, &set);
    if (!(p->spread[i] > LEAST / UNIT)) p->spread[i] = size > LEAST / UNIT ? size : 1;
  }
  if (!defect_evaluate(z, 0) || !sweep_weights(z)) return 0;
  kinks_start(z, most);
  find_rates(z, start);
  find_natural(z);
  for (uint32_t n = 0; n < TRIES && !fits(z, length, start); n++) above = length, length *= 0.5;
  for (uint32_t n = 0; n < REFINE && above > 0; n++) {
    double middle = sqrt(length * above);
    if (fits(z, middle, start))
      length = middle;
    else
      above = middle;
  }
  p->paced = length;
  return h_most < 0 ? -length : length;
}

/* Without data: the least for which steps are as long as the proof of the last one bore. */
static uint32_t adapted(zono *z) {
  proof *p = z->proof;
  if (z->guess == 0)
    p->time_order = ORDER_EXACT;
  else if (z->guess < LEFT * p->paced)
    p->time_order -= p->time_order > ORDER_LEAST;
  else
    p->time_order += p->time_order < ORDER_EXACT;
  return p->time_order;
}

/* Between jumps steps are short anyway: the least order for which one is enough. */
static uint32_t sampled(zono *z, uint32_t most) {
  proof *p = z->proof;
  if (p->time_order == 0) p->time_order = most, p->order_wait = SETTLE;
  if (p->cut) {
    p->time_order += p->time_order < most;
    p->order_wait = RELAX;
  } else if (p->order_wait > 0)
    p->order_wait--;
  else
    p->time_order -= p->time_order > ORDER_SHORT, p->order_wait = SETTLE;
  return p->time_order;
}

void zono_choose_order(zono *z) {
  uint32_t usual = z->m || z->nvarying ? ORDER_DATA : ORDER_EXACT;
  z->proof->prepared = 0;
  uint32_t order = z->options.time_order ? z->options.time_order
                   : z->problem.njump    ? sampled(z, usual)
                   : usual == ORDER_DATA ? ORDER_DATA
                                         : adapted(z);
  z->K = order < z->K_max ? order : z->K_max;
}
