/* discs.c -- errors in discs along modes, from the start of a step to its end.
**
** The set has { Re((V + sum_j xi_j U_j) w) : |w_k| <= b_k } besides. map.c has what a step makes of it. What the step
** adds goes in by W, about the inverse of V, and what V W leaves of it into the box. Since discs lie along V + sum_j
** xi_j U_j, U_j = V T_j, it is enlarged for that: V w = (V + sum_j xi_j U_j) u for some u if b_k >= |w_k| + sum_l
** tilt_kl b_l. P_4 turns with them: sum_j xi_j Re(U_j W) P_4 is part of the set, |W P_4| <= a.
*/
#include "depend.h"
#include "modes.h"
#include "proof.h"
#include "quartic.h"

#define ALONG 0.02 /* of a column, besides its part along one state */
#define WIDER 5.0  /* discs than the box */
#define WAIT 16    /* steps until discs are tried again */

/* -- what goes into discs besides */

/* m->in += |W x| by, m->box += |x - V W x| by; x [nx] */
static void put(zono *z, const number *x, double by) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  number *c = (number *)(void *)m->work;
  for (uint32_t k = 0; k < n; k++) {
    c[k] = 0;
    for (uint32_t i = 0; i < n; i++) c[k] += m->now.W[k * n + i] * x[i];
    m->in[k] += modulus(c[k]) * by * ABOVE;
  }
  for (uint32_t i = 0; i < n; i++) {
    number left = x[i];
    double size = modulus(x[i]);
    for (uint32_t k = 0; k < n; k++) {
      number part = m->now.V[i * n + k] * c[k];
      left -= part, size += modulus(part);
    }
    m->box[i] += by * (modulus(left) + 8 * (n + 4) * UNIT * size) * ABOVE;
  }
}

/* Does x go into the box of a sampled system? If it lies along a state, which costs nothing; or if discs around it are
** so wide that turning in the box again and again costs less. In units of the states' sets. */
static int suits_box(const zono *z, const double *x) {
  const discs *d = &z->modes->now;
  uint32_t n = z->nx;
  double boxed = 0, turned = 0, most = 0;
  for (uint32_t i = 0; i < n; i++) {
    double u = fabs(x[i]) / z->proof->spread[i];
    boxed += u, most = fmax(most, u);
  }
  if (boxed - most <= ALONG * boxed) return 1;
  for (uint32_t k = 0; k < n && turned <= WIDER * boxed; k++) {
    number c = 0;
    double size = 0;
    for (uint32_t i = 0; i < n; i++)
      c += d->W[k * n + i] * x[i], size += modulus(d->V[i * n + k]) / z->proof->spread[i];
    turned += modulus(c) * size;
  }
  return turned > WIDER * boxed;
}

void discs_put(zono *z, const double *x, enum origin from) {
  modes *m = z->modes;
  number *copy = m->A;
  int in_box = !m->now.any || (m->cycle && suits_box(z, x));
  for (uint32_t i = 0; i < z->nx; i++) {
    copy[i] = x[i];
    if (in_box) *box(z, from, i) += fabs(x[i]);
  }
  if (!in_box) put(z, copy, 1);
}

/* -- the movement */

/* the discs of the start into the box, as the step moves them */
static void dissolve(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  double *y = m->work;
  for (uint32_t i = 0; i < n; i++) {
    const double *end = z->proof->end + (size_t)i * z->shape.stride;
    memcpy(y, end + z->shape.eps, n * sizeof *y);
    m->box[i] += discs_size(z, y);
    for (uint32_t j = 0; j < z->shape.mixed; j++) m->box[i] += discs_size(z, end + z->shape.mix + (size_t)j * n);
  }
}

static void copy_axes(const zono *z, const discs *from, discs *to) {
  size_t square = (size_t)z->nx * z->nx, mixed = z->shape.mixed * square;
  memcpy(to->V, from->V, square * sizeof(number)), memcpy(to->W, from->W, square * sizeof(number));
  memcpy(to->U, from->U, mixed * sizeof(number)), memcpy(to->T, from->T, mixed * sizeof(number));
  memcpy(to->S, from->S, square * sizeof(double)), memcpy(to->tilt, from->tilt, square * sizeof(double));
}

/* discs that are empty, as the step would move them: are they of use? Where they would be much wider than generators,
** and only shrink, generators that depend on the data do it better. */
static int are_of_use(zono *z) {
  modes *m = z->modes;
  enum worth worth = worth_enclosing(z);
  if (worth == WORTH_NOTHING) return 0;
  copy_axes(z, &m->now, &m->old);
  memset(m->old.b, 0, z->nx * sizeof *m->old.b), memset(m->old.a, 0, z->nx * sizeof *m->old.a);
  map_discs(z);
  if (!worth_keeping(z)) return 0;
  if (worth == WORTH_IF_SHRINKING && m->rate < 0) depend_begin(z);
  return worth == WORTH_KEEPING;
}

static void clear(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  memset(m->in, 0, n * sizeof *m->in), memset(m->box, 0, n * sizeof *m->box);
  memset(m->now.b, 0, n * sizeof *m->now.b), memset(m->now.a, 0, n * sizeof *m->now.a);
}

/* Along the modes of the step; or along the directions of before, if modes are not found or so near to one another that
** discs would grow too much: the proof holds for any. Do they not? */
static int map_along(zono *z) {
  if (modes_find(z)) {
    map_discs(z);
    if (worth_keeping(z)) return 1;
  }
  clear(z);
  copy_axes(z, &z->modes->old, &z->modes->now);
  map_discs(z);
  return worth_keeping(z);
}

/* those of the end of the last step are old; there are none now */
static void turn_page(zono *z) {
  modes *m = z->modes;
  discs last = m->old;
  m->old = m->now, m->now = last;
  clear(z);
  m->now.any = 0;
}

/* those of a sampled system: where they lie is known; cycle: cycle_step or cycle_jump */
static void follow_cycle(zono *z, void (*cycle)(zono *z)) {
  modes *m = z->modes;
  turn_page(z);
  cycle(z);
  if (m->old.any && m->now.any)
    map_discs(z);
  else if (m->old.any)
    dissolve(z);
}

void discs_jump(zono *z) { follow_cycle(z, cycle_jump); }

void discs_move(zono *z) {
  modes *m = z->modes;
  if (m->cycle) {
    follow_cycle(z, cycle_step);
    return;
  }
  turn_page(z);
  if (m->old.any) {
    if (m->is_bad) {
      dissolve(z), m->wait = WAIT;
      return;
    }
    m->is_bad = !map_along(z), m->now.any = 1;
  } else if (m->wait > 0)
    m->wait--;
  else if (z->m > 0) {
    m->now.any = worth_trying(z) && modes_find(z) && are_of_use(z);
    m->is_bad = 0, m->wait = WAIT;
  }
}

/* -- sizes */

/* y (V + sum_j xi_j U_j) w: what U_j = V T_j has of it by sizes of U_j, or of y V and T_j */
double discs_along(const zono *z, const discs *d, const double *y) {
  uint32_t n = z->nx;
  double all = 0, *along = z->modes->along, *rounded = along + n;
  if (!d->any) return 0;
  for (uint32_t k = 0; k < n; k++) {
    number sum = 0;
    double size = 0;
    for (uint32_t l = 0; l < n; l++) {
      number part = y[l] * d->V[l * n + k];
      sum += part, size += modulus(part);
    }
    along[k] = modulus(sum), rounded[k] = 8 * (n + 4) * UNIT * size;
  }
  for (uint32_t k = 0; k < n; k++) {
    double turned = 0, by_turns = 0;
    if (d->b[k] == 0 && d->a[k] == 0) continue;
    for (uint32_t l = 0; l < n; l++) {
      turned += fabs(y[l]) * d->S[l * n + k];
      by_turns += (along[l] + 2 * rounded[l]) * d->tilt[l * n + k];
    }
    turned = fmin(turned, by_turns);
    all += (along[k] + rounded[k] + turned) * d->b[k] + turned * d->a[k];
  }
  return all * ABOVE;
}

double discs_size(const zono *z, const double *y) { return discs_along(z, &z->modes->old, y); }

double discs_width(const zono *z, uint32_t i) {
  const discs *d = &z->modes->now;
  double sum = 0;
  for (uint32_t k = 0; k < z->nx && d->any; k++) {
    size_t e = (size_t)i * z->nx + k;
    sum += (modulus(d->V[e]) + d->S[e]) * d->b[k] + d->S[e] * d->a[k];
  }
  return sum * ABOVE;
}

/* in := u >= in + tilt u; infinite if none is found, as where something is no number */
static void close_turns(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  double *u = m->work, *next = u + n;
  int is_closed = 0;
  memcpy(u, m->in, n * sizeof *u);
  for (int turn = 0; turn < 60 && !is_closed; turn++) {
    is_closed = 1;
    for (uint32_t k = 0; k < n; k++) {
      next[k] = m->in[k];
      for (uint32_t l = 0; l < n; l++) next[k] += m->now.tilt[(size_t)k * n + l] * u[l];
      next[k] *= ABOVE;
      if (!(next[k] <= u[k])) is_closed = 0;
    }
    for (uint32_t k = 0; k < n && !is_closed; k++) u[k] = next[k] * (1 + 1e-3);
  }
  for (uint32_t k = 0; k < n; k++) m->in[k] = is_closed ? u[k] : INFINITY;
}

/* -- terms of degree 4 */

int discs_carry(const zono *z) { return z->modes->old.any && z->modes->now.any && !z->modes->cycle; }

double discs_turned(const zono *z, uint32_t i) {
  const discs *d = &z->modes->now;
  double sum = 0;
  for (uint32_t k = 0; k < z->nx && d->any; k++) sum += d->S[(size_t)i * z->nx + k] * d->a[k];
  return sum * ABOVE;
}

static int is_conjugate(uint32_t n, const number *x, const number *y) {
  for (uint32_t i = 0; i < n; i++)
    if (creal(x[i]) != creal(y[i]) || cimag(x[i]) != -cimag(y[i])) return 0;
  return 1;
}

/* Terms that came up in this step are not turned yet: what turns make of them is new errors. */
void discs_turn(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  double *re = m->work, *im = re + n, *fresh = im + n;
  if (!m->now.any || m->cycle) return;
  for (uint32_t k = 0; k < n; k++) {
    const number *row = m->now.W + (size_t)k * n;
    if (k > 0 && is_conjugate(n, row - n, row)) {
      m->now.a[k] = m->now.a[k - 1], fresh[k] = fresh[k - 1];
      continue;
    }
    for (uint32_t i = 0; i < n; i++) re[i] = creal(row[i]), im[i] = cimag(row[i]);
    m->now.a[k] = length(quartic_through(z, re), quartic_through(z, im)) * ABOVE;
    fresh[k] = discs_carry(z) ? length(quartic_fresh(z, re), quartic_fresh(z, im)) * ABOVE : m->now.a[k];
  }
  for (uint32_t k = 0; k < n; k++) {
    double turned = 0, rounded = 0; /* U_j W P_4 is V T_j W P_4 but for it */
    for (uint32_t l = 0; l < n; l++) {
      double tilt = m->now.tilt[(size_t)k * n + l];
      turned += tilt * fresh[l], rounded += tilt * (fresh[l] + m->now.a[l]);
    }
    m->in[k] += turned * ABOVE;
    for (uint32_t i = 0; i < n; i++) m->box[i] += 8 * (n + 4) * UNIT * modulus(m->now.V[i * n + k]) * rounded;
  }
}

void discs_finish(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  for (uint32_t i = 0; i < n && m->now.any && !m->cycle; i++) {
    number *x = m->A;
    double sum = 0;
    for (uint32_t o = 0; o < ORIGINS; o++) sum += *box(z, o, i), *box(z, o, i) = 0;
    if (sum == 0) continue;
    memset(x, 0, n * sizeof *x), x[i] = 1;
    put(z, x, sum * ABOVE);
  }
  if (m->now.any) close_turns(z);
  for (uint32_t k = 0; k < n && m->now.any; k++) m->now.b[k] += m->in[k] * ABOVE;
  for (uint32_t i = 0; i < n; i++) {
    double rounding = LEAST; /* U_j is V T_j but for it */
    for (uint32_t l = 0; l < n && m->now.any; l++)
      for (uint32_t k = 0; k < n; k++) rounding += modulus(m->now.V[i * n + l]) * m->now.tilt[l * n + k] * m->now.b[k];
    *box(z, FROM_MIXED, i) += (m->box[i] + 8 * (n + 4) * UNIT * rounding) * ABOVE;
  }
}
