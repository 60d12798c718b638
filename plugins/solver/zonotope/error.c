/* error.c -- the exact error equation, and the proof that its solution stays small.
**
** z' = J z + sum_j C_j theta_j, z(0) = 0 for the distance z from the polynomials to the solution with the same xi and
** rho; |theta_j| <= rr_j as long as |z| <= zeta. If the bound of z that follows is below zeta, it holds over the whole
** step, and the solution exists there (docs/numerics/zonotope.md, section 5).
*/
#include "kink.h"
#include "proof.h"
#include "value.h"

#define TRIES 8
#define STEADY 0.1
#define MOST_GROWTH 4.0 /* of a distance in a step, e to this power, where there are no data */
#define ENOUGH 1e-3     /* share of it that terms of a series may be, which are bounded together */
#define SERIES 60
#define ROOMY 1.2 /* a new guess over the bound that the last one gave */

/* -- |Delta| of all slots, and lumps: what an operation fails by, and terms of second order */

static double larger(double a, double b) { return a > b ? a : b; }

typedef struct move {
  double linear, square; /* < 0: outside the domain */
} move;

static move no_move(void) { return (move) { 0, -1 }; }

/* quotient: (da - (V_z + tau) db) (1 / V_b - db / (V_b (V_b + db))) */
static move move_quotient(double high, double r, double low, double da, double db) {
  double near = low - db;
  if (!(near > 0)) return no_move();
  double first = da + (high + r) * db;
  return (move) { first / low, first * db / (low * near) };
}

static move move_angle(const zono *z, uint32_t i, double d) {
  const ambit_tape *t = z->program.tape;
  double a = z->proof->low[t->a[i]], b = z->proof->low[t->b[i]], r = larger(a, b), near = r - d;
  if (!(near > 0)) return no_move();
  const double *y = row_at(z, t->a[i], 0), *x = row_at(z, t->b[i], 0);
  int clear = (x[0] > 0 && b > d) || (y[0] != 0 && a > d); /* of the cut */
  return clear ? (move) { d / r, d * d / (2 * near * near) } : no_move();
}

/* |f''| <= 0.77; of the line: kink.c */
static move move_tanh(const zono *z, uint32_t i, double da) {
  const ambit_tape *t = z->program.tape;
  uint32_t dst = t->dst[i], aux = t->aux[i];
  if (is_line(z, i)) return (move) { fabs(z->kinks->of[i].slope) * da, kink_second(z, i, da) };
  double slope = z->proof->high[aux] + tanh_aux_error(z, i) + (1 + z->proof->high[dst]) * z->r[dst];
  return (move) { fmin(1, slope) * da, 0.385 * da * da };
}

static move move_kink(const zono *z, uint32_t i, double da, double db) {
  double share_a, share_b;
  if (has_twin(z, i)) return (move) { larger(da, db) + z->r[z->program.tape->dst[z->kinks->of[i].twin]], 0 };
  kink_shares(z, i, &share_a, &share_b);
  return (move) { fabs(share_a) * da + fabs(share_b) * db, kink_second(z, i, da + db) };
}

static move move_of(zono *z, uint32_t i, double da, double db) {
  const ambit_tape *t = z->program.tape;
  const double *high = z->proof->high, *low = z->proof->low;
  uint32_t a = t->a[i], b = t->b[i], dst = t->dst[i];
  double r = z->r[dst], near = low[a] - da;
  switch (t->op[i]) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB: return (move) { da + db, 0 };
  case AMBIT_OP_NEG: return (move) { da, 0 };
  case AMBIT_OP_MUL: return (move) { high[a] * db + high[b] * da, da * db };
  case AMBIT_OP_SQR: return (move) { 2 * high[a] * da, da * da };
  case AMBIT_OP_DIV: return move_quotient(high[dst], r, low[b], da, db);
  case AMBIT_OP_SQRT:
    return near > 0 ? (move) { da / (2 * sqrt(low[a])), da * da / (8 * near * sqrt(near)) } : no_move();
  case AMBIT_OP_LOG: return near > 0 ? (move) { da / low[a], da * da / (2 * near * near) } : no_move();
  case AMBIT_OP_EXP:
    return (move) { (high[dst] + r) * da, 0.5 * (high[dst] + r) * value_of(z, AMBIT_OP_EXP, da, 0) * da * da };
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: return (move) { fmin(1, high[t->aux[i]] + r) * da, 0.5 * da * da };
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
    return (
        move) { (high[t->aux[i]] + z->r[t->aux[i]]) * da, 0.5 * value_of(z, AMBIT_OP_COSH, high[a] + da, 0) * da * da };
  case AMBIT_OP_TANH: return move_tanh(z, i, da);
  case AMBIT_OP_ATAN: return (move) { da, 0.5 * da * da };
  case AMBIT_OP_ATAN2: return move_angle(z, i, da + db);
  default: return move_kink(z, i, da, db);
  }
}

static int has_second(uint32_t op) {
  return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 ||
         op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}

static int outside(zono *z, uint32_t i) {
  const ambit_tape *t = z->program.tape;
  uint32_t op = t->op[i];
  int kinked = is_kinked(op);
  z->why = kinked ? WHY_KINK : WHY_UNDEFINED, z->blamed = t->dst[i];
  z->detail = kinked && t->kink ? t->kink[i] : NULL;
  return 0;
}

int zono_spread(zono *z, const double *input, double *delta) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t j = 0; j < t->nconst; j++) delta[j] = z->rr[j] = z->r[j];
  for (uint32_t k = 0, j = t->nconst; k < t->nin; k++, j++) z->rr[j] = z->r[j], delta[j] = input[k] + z->r[j];
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t dst = t->dst[i];
    move m = move_of(z, i, delta[t->a[i]], has_second(t->op[i]) ? delta[t->b[i]] : 0);
    if (!(m.square >= 0) || !(m.linear < INFINITY)) return outside(z, i);
    z->rr[dst] = (z->r[dst] + m.square) * ABOVE;
    delta[dst] = (m.linear + z->rr[dst]) * ABOVE;
  }
  return 1;
}

/* -- the bound of z */

/* what lumps add to target n at most */
static double reach_of(const zono *z, uint32_t n, const double *lump) {
  const proof *p = z->proof;
  const double *C = p->C + (size_t)n * z->nslot, *dC = p->dC + (size_t)n * z->nslot;
  const double *L = p->L + (size_t)n * z->na, *dL = p->dL + (size_t)n * z->na;
  double sum = 0;
  for (uint32_t j = 0; j < z->nslot; j++) sum += (fabs(C[j]) + dC[j]) * lump[j];
  for (uint32_t q = 0; q < z->na; q++) sum += (fabs(L[q]) + dL[q]) * z->rr_out[z->nx + q];
  return sum;
}

/* to := (|J| + dJ) x; returns the largest to_i / unit_i */
static double through_sizes(const zono *z, const double *x, double *to) {
  const proof *p = z->proof;
  double most = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *size = p->jacobian_size + (size_t)i * z->nx, *dJ = p->dJ + (size_t)i * z->nx;
    to[i] = 0;
    for (uint32_t j = 0; j < z->nx; j++) to[i] += (size[j] + dJ[j]) * x[j];
    most = larger(most, to[i] / p->unit[i]);
  }
  return most * ABOVE;
}

/* zeta_new: |z| <= u with u' = (|J| + dJ) u + rate, u(0) = 0, a series. In the units its terms fall by norm / (k + 1)
** at least; once that is below 1/2, all further terms together are at most the last one's largest share of a unit. */
static int grow_bound(zono *z, const double *rate) {
  proof *p = z->proof;
  uint32_t n = z->nx, k = 0;
  double *term = p->grow_path, *next = p->zeta_new + n, h = fabs(z->h) * ABOVE, last = INFINITY, total = 0;
  double norm = through_sizes(z, p->unit, next) * h;
  if (!(norm < MOST_GROWTH)) return 0;
  for (uint32_t i = 0; i < n; i++) p->zeta_new[i] = term[i] = (rate[i] + LEAST) * h;
  while (k + 2 < 2 * norm || (last > ENOUGH * total && k < SERIES)) {
    last = through_sizes(z, term, next) * h / (++k + 1);
    total += last;
    for (uint32_t i = 0; i < n; i++) term[i] = next[i] * h / (k + 1) * ABOVE, p->zeta_new[i] += term[i];
  }
  for (uint32_t i = 0; i < n; i++) p->zeta_new[i] = (p->zeta_new[i] + last * p->unit[i]) * ABOVE;
  return 1;
}

/* zeta_new by the kernel, or (0) no bound */
static int bound_by_kernel(zono *z, double *rate, const double *zeta) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  for (uint32_t i = 0; i < nx; i++)
    for (uint32_t j = 0; j < nx; j++) rate[i] += p->dJ[(size_t)i * nx + j] * zeta[j];
  for (uint32_t i = 0; i < nx; i++) {
    double sum = LEAST;
    for (uint32_t j = 0; j < nx; j++) sum += p->reach[(size_t)i * nx + j] * rate[j];
    p->zeta_new[i] = sum * ABOVE;
  }
  return 1;
}

/* zeta_new, alpha_new from lumps and zeta; 0: none */
static int bound(zono *z, const double *lump, const double *zeta) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  double *target = p->work, *rate = p->grow;
  for (uint32_t n = 0; n < p->ntarget; n++) target[n] = reach_of(z, n, lump);
  for (uint32_t i = 0; i < nx; i++) rate[i] = z->rr_out[i] + (p->link[i] == LINK_STATE ? 0 : target[p->link_to[i]]);
  if (!(is_certain(z) ? grow_bound(z, rate) : bound_by_kernel(z, rate, zeta))) return 0;
  for (uint32_t k = 0; k < z->na; k++) {
    const double *C = p->C + (size_t)k * z->nslot + slot_x(z, 0), *dC = p->dC + (size_t)k * z->nslot + slot_x(z, 0);
    double sum = target[k] + LEAST;
    for (uint32_t j = 0; j < nx; j++) sum += (fabs(C[j]) + dC[j]) * zeta[j];
    p->alpha_new[k] = sum * ABOVE;
  }
  return 1;
}

static int within(uint32_t n, const double *a, const double *b) {
  for (uint32_t i = 0; i < n; i++)
    if (!(a[i] < b[i])) return 0;
  return 1;
}

static void guess_again(uint32_t n, double *to, const double *from) {
  for (uint32_t i = 0; i < n; i++) to[i] = larger(to[i], ROOMY * from[i] + 1e3 * LEAST);
}

static int close_bound(zono *z) {
  proof *p = z->proof;
  uint32_t nx = z->nx, na = z->na;
  memset(p->zeta, 0, nx * sizeof(double)), memset(p->alpha, 0, na * sizeof(double));
  if (!bound(z, z->r, p->zeta)) return z->why = WHY_GROWTH, 0;
  for (uint32_t try = 0; try < TRIES; try++) {
    guess_again(nx, p->zeta, p->zeta_new);
    guess_again(na, p->alpha, p->alpha_new);
    memset(p->input, 0, z->program.tape->nin * sizeof(double));
    memcpy(p->input, p->zeta, nx * sizeof(double)), memcpy(p->input + nx, p->alpha, na * sizeof(double));
    if (!zono_spread(z, p->input, p->delta)) return 0;
    if (bound(z, z->rr, p->zeta) && within(nx, p->zeta_new, p->zeta) && within(na, p->alpha_new, p->alpha)) {
      memcpy(p->zeta, p->zeta_new, nx * sizeof(double));
      return 1;
    }
  }
  return z->why = WHY_GROWTH, 0;
}

/* What the change of the slopes over the step makes of a distance, at most, in units in which J h is small. */
static double gain(const zono *z) {
  const proof *p = z->proof;
  double most = 0, *turned = p->grow;
  for (uint32_t i = 0; i < z->nx; i++) {
    turned[i] = 0;
    for (uint32_t j = 0; j < z->nx; j++) turned[i] += p->dJ[(size_t)i * z->nx + j] * p->unit[j];
  }
  for (uint32_t i = 0; i < z->nx; i++) {
    double sum = 0;
    for (uint32_t j = 0; j < z->nx; j++) sum += p->reach[(size_t)i * z->nx + j] * turned[j];
    most = larger(most, sum / p->unit[i]);
  }
  return most;
}

/* Without data, all that slopes change by is the time of the step: shorter steps are the remedy for it. */
static int is_steady(zono *z) {
  if (z->m > 0 || gain(z) < STEADY) return 1;
  return z->why = WHY_GROWTH, 0;
}

static int fits_kinks(zono *z) {
  if (kinks_steady(z)) return 1;
  return z->why = WHY_GROWTH, 0;
}

int zono_prove(zono *z) {
  if (is_certain(z)) return sweep_coefficients(z) && kernel_units(z) && close_bound(z) && fits_kinks(z);
  return sweep_coefficients(z) && kernel_find(z) && is_steady(z) && close_bound(z) && fits_kinks(z);
}
