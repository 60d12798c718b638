/* verify.c -- the error of a step: r' = (half J) r + ((half J) B - B') z + d, r(-1) small, with slopes J of the
** right-hand side over the tube (slope.c) and d = half f(p) - p' the defect of the approximate solution.
**
** In a basis V of blocks of one or two columns (eigen.c), eta_b the norm of block b of V^-1 r, every solution obeys
**   D+ eta_b <= mu_b eta_b + sum_(c != b) m_bc eta_c + gamma_b,
** mu_b the logarithmic norm of a diagonal block, so while eta <= omega also (exponential enclosure)
**   eta_b(sigma) <= e^(mu_b (sigma + 1)) eta_b(-1) + (e^(mu_b (sigma + 1)) - 1) / mu_b (sum m_bc omega_c + gamma_b).
** If that stays strictly below omega, and the tube was at least as wide, eta never reaches omega: the solution exists
** on the whole step and stays in the tube. The paper's iteration is the same with |A_bb| in place of mu_b and no
** exponential. Proof: docs/numerics/valencia.md.
*/
#include "valencia.h"
#include <string.h>

#define WIDENINGS 12
#define ROUNDS 60
#define REFINEMENTS 4
#define PARTS_MAX 64u

/* -- what is known before anything of the right-hand side */

static interval at_start(const double *c, uint32_t n) {
  interval r = point(0);
  for (uint32_t m = 0; m < n; m++) r = m % 2 ? minus(r, point(c[m])) : plus(r, point(c[m]));
  return r;
}

static interval lost_entry(const valencia *s, size_t at) {
  uint32_t n = s->stages.n + 1;
  return minus(point(s->b[at]), at_start(s->frame + at * n, n));
}

static void bound_start(valencia *s) {
  uint32_t n = s->stages.n + 1;
  for (uint32_t i = 0; i < s->nx; i++) {
    double error = 0, lost = 0, reach = 0;
    for (uint32_t k = 0; k < s->terms.n; k++) {
      size_t at = (size_t)i * s->terms.n + k;
      error += magnitude(minus(point(s->p[at]), at_start(s->curve + at * n, n)));
    }
    for (uint32_t j = 0; j < s->nx; j++) {
      size_t at = (size_t)i * s->nx + j;
      double sum = 0;
      for (uint32_t m = 0; m < n; m++) sum += fabs(s->frame[at * n + m]);
      lost += magnitude(lost_entry(s, at)) * s->w[j];
      reach += sum * s->w[j];
    }
    s->rounding[i] = error, s->start[i] = error + lost, s->reach_z[i] = reach;
  }
}

/* -- the inhomogeneous part: (half J) c(sigma) - c'(sigma) of the columns */

static const double *column_of(const valencia *s, uint32_t i, uint32_t dir) {
  uint32_t n = s->stages.n + 1, own = s->ncolumn - s->nx;
  return dir < own ? s->curve + ((size_t)i * s->terms.n + 1 + dir) * n : s->frame + ((size_t)i * s->nx + dir - own) * n;
}

/* with slopes over the whole tube and step: for want of series, or tighter than they are where the data are wide */
static void column_slopes(valencia *s, uint32_t dir, int known) {
  uint32_t n = s->stages.n + 1, own = s->ncolumn - s->nx;
  interval *residual = s->residual + (size_t)dir * s->nx;
  for (uint32_t i = 0; i < s->nx; i++) {
    interval r = point(0);
    const interval *row = s->jacobian + (size_t)i * s->ndir;
    for (uint32_t m = 0; m < n; m++) {
      interval sum = point(0);
      for (uint32_t k = 0; k < s->nx; k++) sum = plus(sum, scaled(row[k], column_of(s, k, dir)[m]));
      for (uint32_t k = 0; k < s->np && m == 0 && dir < own; k++)
        sum = plus(sum, scaled(row[s->nx + k], s->reach[(size_t)k * s->nu + dir]));
      sum = times(s->half, sum);
      if (m + 1 < n) sum = minus(sum, scaled(point(column_of(s, i, dir)[m + 1]), m + 1));
      r = plus(r, m ? within(magnitude(sum)) : sum);
    }
    residual[i] = known ? meet(residual[i], r) : r;
  }
}

/* d at the middle of the unknowns, then slopes times unknowns: as far as p is linear in them. Fills the residuals. */
static int mean_value_defect(valencia *s, interval *d) {
  uint32_t own = s->ncolumn - s->nx;
  int known = valencia_series(s, d);
  int in_series = known && valencia_column_series(s);
  for (uint32_t j = 0; j < s->ncolumn && !(in_series && s->centred); j++) column_slopes(s, j, in_series);
  if (s->terms.n > 1 + s->nu) return 0;
  if (!known) {
    uint32_t flags = valencia_symbols_run(s, NULL, 1, d);
    if (flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED)) return 0;
  }
  for (uint32_t i = 0; i < s->nx; i++) s->steerable[i] = 2 * magnitude(d[i]);
  for (uint32_t j = 0; j < own; j++)
    for (uint32_t i = 0; i < s->nx; i++) d[i] = plus(d[i], within(magnitude(s->residual[(size_t)j * s->nx + i])));
  return 1;
}

/* needs slopes; keeps what valencia_symbols_run() found before */
static enum why find_defect(valencia *s) {
  interval *mean = s->column + s->nx;
  int known = s->symbols.keeps;
  if (known) {
    uint32_t flags = valencia_symbols_run(s, NULL, 0, s->defect);
    known = !(flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED));
  }
  if (mean_value_defect(s, mean)) {
    for (uint32_t i = 0; i < s->nx; i++) s->defect[i] = known ? meet(s->defect[i], mean[i]) : mean[i];
    known = 1;
  } else
    for (uint32_t i = 0; i < s->nx && known; i++) s->steerable[i] = 2 * magnitude(s->defect[i]);
  return known ? WHY_NOTHING : WHY_DOMAIN;
}

/* -- in the basis */

static interval transformed(const valencia *s, uint32_t row, const interval *x) {
  interval r = point(0);
  for (uint32_t i = 0; i < s->nx; i++) r = plus(r, times(s->basis.inverse[(size_t)row * s->nx + i], x[i]));
  return r;
}

static double norm_of(const valencia *s, uint32_t block, const double *x) {
  const uint32_t *first = s->basis.first + block;
  return first[1] - first[0] == 1 ? x[first[0]] : sqrt(x[first[0]] * x[first[0]] + x[first[0] + 1] * x[first[0] + 1]);
}

/* each entry's magnitude -> the norm of each block */
static void to_blocks(const valencia *s, const double *x, double *norm) {
  for (uint32_t b = 0; b < s->basis.nblock; b++) norm[b] = norm_of(s, b, x);
}

static void find_matrix(valencia *s) {
  uint32_t nx = s->nx;
  for (uint32_t j = 0; j < nx; j++) {
    for (uint32_t i = 0; i < nx; i++) {
      interval sum = point(0);
      for (uint32_t k = 0; k < nx; k++)
        sum = plus(sum, scaled(s->jacobian[(size_t)i * s->ndir + k], s->basis.v[(size_t)k * nx + j]));
      s->column[i] = times(s->half, sum);
    }
    for (uint32_t i = 0; i < nx; i++) s->matrix[(size_t)i * nx + j] = transformed(s, i, s->column);
  }
}

static double block_norm(const valencia *s, uint32_t b, uint32_t c) {
  double square = 0;
  const uint32_t *first = s->basis.first;
  if (first[b + 1] - first[b] == 1 && first[c + 1] - first[c] == 1)
    return magnitude(s->matrix[(size_t)first[b] * s->nx + first[c]]);
  for (uint32_t i = first[b]; i < first[b + 1]; i++)
    for (uint32_t j = first[c]; j < first[c + 1]; j++) {
      double x = magnitude(s->matrix[(size_t)i * s->nx + j]);
      square += x * x;
    }
  return sqrt(square);
}

/* largest eigenvalue of the symmetric part, by Gershgorin */
static double logarithmic_norm(const valencia *s, uint32_t b) {
  uint32_t i = s->basis.first[b], nx = s->nx;
  const interval *m = s->matrix + (size_t)i * nx + i;
  if (s->basis.first[b + 1] - i == 1) return m[0].hi;
  return larger_or_nan(m[0].hi, m[nx + 1].hi) + 0.5 * magnitude(plus(m[1], m[nx]));
}

static void find_growth(valencia *s) {
  uint32_t n = s->basis.nblock;
  find_matrix(s);
  for (uint32_t b = 0; b < n; b++)
    for (uint32_t c = 0; c < n; c++)
      s->growth[(size_t)b * s->nx + c] =
          b == c && s->options.exponential != EXPONENTIAL_OFF ? logarithmic_norm(s, b) : block_norm(s, b, c);
}

static void find_forcing(valencia *s) {
  uint32_t nx = s->nx, own = s->ncolumn - nx;
  double *sum = s->scratch, *start = sum + nx;
  for (uint32_t i = 0; i < nx; i++) s->column[i] = within(s->rounding[i]);
  for (uint32_t i = 0; i < nx; i++) {
    sum[i] = magnitude(transformed(s, i, s->defect));
    start[i] = magnitude(transformed(s, i, s->column));
  }
  for (uint32_t j = 0; j < nx; j++) {
    if (s->w[j] == 0) continue;
    for (uint32_t i = 0; i < nx; i++) s->column[i] = lost_entry(s, (size_t)i * nx + j);
    for (uint32_t i = 0; i < nx; i++) {
      sum[i] += magnitude(transformed(s, i, s->residual + (size_t)(own + j) * nx)) * s->w[j];
      start[i] += magnitude(transformed(s, i, s->column)) * s->w[j];
    }
  }
  to_blocks(s, sum, s->forcing);
  to_blocks(s, start, s->eta);
}

/* -- the comparison */

#define NEARLY_ZERO 0x1p-20

/* e^(mu length) and (e^(mu length) - 1) / mu, bounded from above */
static void exponentials(const valencia *s, double mu, double length, double *growth, double *integral) {
  double x = mu * length, y = -(-mu * length), lo, hi, unused;
  s->num->elementary(AMBIT_OP_EXP, 1, &x, &x, &x, &x, &unused, &hi);
  s->num->elementary(AMBIT_OP_EXP, 1, &y, &y, &y, &y, &lo, &unused);
  *growth = hi;
  if (fabs(x) < NEARLY_ZERO)
    *integral = length * larger(hi, 1);
  else
    *integral = mu > 0 ? (hi - 1) / mu : (1 - lo) / -mu;
}

/* in how many parts of the step the comparison is made, so that what blocks do to each other is small; powers of
** two, so that their length is exact: a longer one would let decay go on beyond the end */
static uint32_t find_parts(const valencia *s) {
  double most = 0;
  for (uint32_t b = 0; b < s->basis.nblock; b++) {
    double row = 0;
    for (uint32_t c = 0; c < s->basis.nblock; c++)
      if (c != b || s->options.exponential == EXPONENTIAL_OFF) row += s->growth[(size_t)b * s->nx + c];
    most = larger(most, row);
  }
  uint32_t parts = 2;
  while (parts < PARTS_MAX && parts < 2 + 8 * most) parts *= 2;
  return parts;
}

static double end_of_block(const valencia *s, uint32_t b, const double *growth, const double *integral) {
  const double *row = s->growth + (size_t)b * s->nx;
  double sum = s->forcing[b];
  for (uint32_t c = 0; c < s->basis.nblock; c++)
    if (c != b || s->options.exponential == EXPONENTIAL_OFF) sum += row[c] * s->omega[c];
  return growth[b] * s->last[b] + integral[b] * sum;
}

/* from `last` at the start of a part: omega that is never reached, then smaller bounds from that, and the end */
static int compare_part(valencia *s, const double *growth, const double *integral, double *end) {
  uint32_t n = s->basis.nblock;
  for (uint32_t b = 0; b < n; b++) s->omega[b] = 1.5 * (s->last[b] + integral[b] * s->forcing[b]) + 0x1p-1000;
  for (int round = 0, contained = 0; !contained; round++) {
    if (round == ROUNDS) return 0;
    contained = 1;
    for (uint32_t b = 0; b < n; b++) {
      end[b] = end_of_block(s, b, growth, integral);
      contained = contained && larger_or_nan(end[b], s->last[b]) < s->omega[b];
      if (!(end[b] < INFINITY)) return 0;
    }
    for (uint32_t b = 0; b < n && !contained; b++)
      s->omega[b] = larger(s->omega[b], 1.1 * larger(end[b], s->last[b]) + 0x1p-1000);
  }
  for (int round = 0; round < REFINEMENTS; round++)
    for (uint32_t b = 0; b < n; b++) {
      end[b] = smaller(end[b], end_of_block(s, b, growth, integral));
      s->omega[b] = smaller(s->omega[b], larger(end[b], s->last[b]));
    }
  return 1;
}

/* part by part; last: at the end, top: over the step */
static int compare(valencia *s) {
  uint32_t n = s->basis.nblock, parts = find_parts(s);
  double length = 2.0 / parts, *growth = s->scratch, *integral = growth + n, *end = integral + n;
  for (uint32_t b = 0; b < n; b++) {
    growth[b] = 1, integral[b] = length, s->last[b] = s->top[b] = s->eta[b];
    if (s->options.exponential != EXPONENTIAL_OFF)
      exponentials(s, s->growth[(size_t)b * s->nx + b], length, &growth[b], &integral[b]);
  }
  for (uint32_t k = 0; k < parts; k++) {
    if (!compare_part(s, growth, integral, end)) return 0;
    for (uint32_t b = 0; b < n; b++) s->top[b] = larger(s->top[b], s->omega[b]), s->last[b] = end[b];
  }
  return 1;
}

/* |V y| for blocks of norms y */
static void to_states(const valencia *s, const double *norm, double *x) {
  for (uint32_t i = 0; i < s->nx; i++) {
    x[i] = 0;
    for (uint32_t b = 0; b < s->basis.nblock; b++)
      for (uint32_t j = s->basis.first[b]; j < s->basis.first[b + 1]; j++)
        x[i] += fabs(s->basis.v[(size_t)i * s->nx + j]) * norm[b];
  }
}

/* does the tube that was looked at hold p +- (reach_z + error)? if not, a wider one */
static int fits(valencia *s, const double *error) {
  int fit = 1;
  for (uint32_t i = 0; i < s->nx; i++) fit = fit && s->reach_z[i] + error[i] < s->radius[i];
  for (uint32_t i = 0; i < s->nx && !fit; i++)
    s->radius[i] = larger(s->radius[i], s->reach_z[i] + (1.25 * error[i] + 0x1p-1000));
  return fit;
}

/* -- the two ways */

static int is_unusable(uint32_t flags) { return (flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED)) != 0; }

#define FAST 1.0 /* decay within half a step beyond which errors go into r, where the exponential takes them */

static double decay(const valencia *s, const double *a, uint32_t i) {
  double sum = 0;
  for (uint32_t k = 0; k < s->nx; k++)
    for (uint32_t l = 0; l < s->nx; l++)
      sum += middle(s->basis.inverse[(size_t)i * s->nx + k]) * a[(size_t)k * s->ndir + l] *
             s->basis.v[(size_t)l * s->nx + i];
  return -sum * middle(s->half);
}

static void drop_fast(valencia *s, const double *a) {
  uint32_t nx = s->nx;
  memcpy(s->kept, s->b, (size_t)nx * nx * sizeof *s->kept);
  for (uint32_t i = 0; i < nx && s->options.exponential != EXPONENTIAL_OFF; i++) {
    if (!(decay(s, a, i) > FAST)) continue;
    for (uint32_t j = 0; j < nx; j++) {
      double share = 0;
      for (uint32_t k = 0; k < nx; k++)
        share += middle(s->basis.inverse[(size_t)i * nx + k]) * s->b[(size_t)k * nx + j];
      for (uint32_t k = 0; k < nx; k++) s->kept[(size_t)k * nx + j] -= s->basis.v[(size_t)k * nx + i] * share;
    }
  }
}

void valencia_choose_basis(valencia *s, const double *jacobian) {
  uint32_t nx = s->nx;
  double rate = 0, *a = s->scratch;
  for (uint32_t i = 0; i < nx; i++)
    for (uint32_t j = 0; j < nx; j++) a[(size_t)i * nx + j] = jacobian[(size_t)i * s->ndir + j];
  for (uint32_t i = 0; i < nx; i++)
    for (uint32_t j = 0; j < nx; j++) rate = larger(rate, sqrt(fabs(a[(size_t)i * nx + j] * a[(size_t)j * nx + i])));
  int wanted = s->options.exponential == EXPONENTIAL_ON ||
               (s->options.exponential == EXPONENTIAL_AUTO && rate * magnitude(s->half) > 0.25);
  if (!wanted || !valencia_eigenbasis(s, a)) valencia_unit_basis(s);
  drop_fast(s, jacobian);
}

/* natural evaluation over the tube, for right-hand sides that are only continuous: r' = half f - p' */
static enum why verify_frozen(valencia *s) {
  for (int widening = 0; widening < WIDENINGS; widening++) {
    if (is_unusable(valencia_symbols_run(s, s->radius, 0, s->defect))) return WHY_DOMAIN;
    for (uint32_t i = 0; i < s->nx; i++) {
      s->omega[i] = s->start[i] + 2 * magnitude(s->defect[i]) + 0x1p-1000;
      double mid = middle(s->defect[i]), radius = radius_about(s->defect[i], mid);
      s->shift[i] = 2 * mid, s->error[i] = s->start[i] + 2 * radius;
      s->steerable[i] = s->error[i];
    }
    memcpy(s->over, s->omega, s->nx * sizeof *s->over);
    if (fits(s, s->omega)) return WHY_NOTHING;
  }
  return WHY_NO_CONTAIN;
}

static enum why verify_slopes(valencia *s) {
  const ambit_tape *t = s->problem.rhs;
  const symbols *y = &s->symbols;
  for (int widening = 0; widening < WIDENINGS; widening++) {
    uint32_t flags = valencia_symbols_run(s, s->radius, 0, s->rate);
    s->kink = valencia_at_kink(s);
    if (is_unusable(flags)) return WHY_DOMAIN;
    if (!valencia_slopes(s->num, t, s->ndir, y->lo, y->hi, y->slope)) return WHY_NO_SLOPES;
    memcpy(s->tube_lo, y->lo + t->nconst, s->nx * sizeof(double));
    memcpy(s->tube_hi, y->hi + t->nconst, s->nx * sizeof(double));
    for (uint32_t i = 0; i < s->nx; i++)
      memcpy(s->jacobian + (size_t)i * s->ndir, y->slope + (size_t)t->out[i] * s->ndir, s->ndir * sizeof(interval));
    enum why why = widening == 0 || s->terms.n <= 1 + s->nu ? find_defect(s) : WHY_NOTHING;
    if (why != WHY_NOTHING) return why;
    find_growth(s);
    find_forcing(s);
    if (!compare(s)) return WHY_NO_CONTAIN;
    to_states(s, s->top, s->over);
    if (!fits(s, s->over)) continue;
    to_states(s, s->last, s->error);
    return WHY_NOTHING;
  }
  return WHY_NO_CONTAIN;
}

enum why valencia_verify(valencia *s) {
  s->frozen = 0;
  memset(s->shift, 0, s->nx * sizeof *s->shift);
  bound_start(s);
  for (uint32_t i = 0; i < s->nx; i++)
    s->radius[i] = s->reach_z[i] + 2 * s->start[i] + s->options.tolerance * s->magnitude[i];
  enum why why = verify_slopes(s);
  if (why != WHY_NO_SLOPES) return why;
  s->kink = 1;
  valencia_freeze(s);
  bound_start(s);
  why = verify_frozen(s);
  memcpy(s->tube_lo, s->symbols.lo + s->problem.rhs->nconst, s->nx * sizeof(double));
  memcpy(s->tube_hi, s->symbols.hi + s->problem.rhs->nconst, s->nx * sizeof(double));
  return why;
}
