/* collocation.c -- the approximate solution of a step: collocation polynomials by Newton's method, in plain doubles.
**
** In sigma in [-1, 1] the derivative of each curve is the polynomial through its values at the flipped Chebyshev-Radau
** points cos(2 pi j / (2 n - 1)), j < n, the last of which is the end of the step: implicit and stiffly accurate, so
** that stiffness does not bound the step (Hairer & Wanner, Solving Ordinary Differential Equations II, IV.5). A
** curve is computed for the middle of the unknowns and for each sample of them (terms.c); the frame B solves the
** equation linearised about the middle. Nothing here is proved, and nothing needs to be.
*/
#include "valencia.h"
#include <string.h>

#define NEWTON_MAX 12
#define SMALL 1e-9 /* of the largest state: see note_magnitudes() */

static double *room(const valencia *s, size_t n) { return s->host->alloc(s->host, (n + 1) * sizeof(double)); }

/* Chebyshev polynomials by powers of sigma, one row each */
static void find_chebyshev(stages *g) {
  uint32_t n = g->n;
  double *c = g->chebyshev;
  memset(c, 0, (size_t)n * n * sizeof *c);
  c[0] = 1;
  if (n > 1) c[n + 1] = 1;
  for (uint32_t l = 2; l < n; l++)
    for (uint32_t m = 0; m <= l; m++)
      c[l * n + m] = 2 * (m ? c[(l - 1) * n + m - 1] : 0) - (m < l ? c[(l - 2) * n + m] : 0);
}

/* From values at the nodes to Chebyshev coefficients, the inverse of T_l(node_i): T_l(node_i) = cos(2 pi k l / (2 n -
** 1)), k counted from the last node, are orthogonal with weight 1/2 at the last node: a discrete cosine transform. */
static void find_transform(stages *g) {
  uint32_t n = g->n;
  for (uint32_t l = 0; l < n; l++)
    for (uint32_t j = 0; j < n; j++) {
      double weight = j + 1 == n ? 0.5 : 1, angle = 2 * M_PI * (n - 1.0 - j) * l / (2.0 * n - 1);
      g->transform[(size_t)l * n + j] = (l ? 4 : 2) * weight * cos(angle) / (2.0 * n - 1);
    }
}

/* integrals from -1 to each node, by those of T_l: (T_(l+1)/(l+1) - T_(l-1)/(l-1)) / 2 */
static double antiderivative(uint32_t l, double angle) {
  if (l == 0) return cos(angle);
  if (l == 1) return 0.25 * cos(2 * angle);
  return 0.5 * (cos((l + 1.0) * angle) / (l + 1.0) - cos((l - 1.0) * angle) / (l - 1.0));
}

static void find_integrals(stages *g) {
  uint32_t n = g->n;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) {
      double sum = 0, angle = 2 * M_PI * (n - 1.0 - i) / (2.0 * n - 1);
      for (uint32_t l = 0; l < n; l++)
        sum += g->transform[(size_t)l * n + j] * (antiderivative(l, angle) - antiderivative(l, M_PI));
      g->integral[(size_t)i * n + j] = sum;
    }
}

int valencia_stages_open(valencia *s) {
  stages *g = &s->stages;
  size_t n = s->options.order, nx = s->nx, size = n * nx;
  g->n = (uint32_t)n;
  g->node = room(s, n), g->integral = room(s, n * n), g->chebyshev = room(s, n * n);
  g->transform = room(s, n * n);
  g->rate = room(s, size), g->jacobian = room(s, size * s->ndir), g->matrix = room(s, size * size);
  g->right = room(s, size * (1 + nx)), g->slot = room(s, (size_t)s->problem.rhs->nslot * (1 + s->ndir));
  g->pivot = s->host->alloc(s->host, (size + 1) * sizeof *g->pivot);
  if (!g->node || !g->integral || !g->chebyshev || !g->transform || !g->rate || !g->jacobian || !g->matrix ||
      !g->right || !g->slot || !g->pivot)
    return 0;
  for (uint32_t i = 0; i < g->n; i++) g->node[i] = cos(2 * M_PI * (g->n - 1 - i) / (2.0 * g->n - 1));
  find_chebyshev(g);
  find_transform(g);
  find_integrals(g);
  return 1;
}

/* -- the Newton matrix I - (h/2) A x J, node by node */

static void fill_matrix(const valencia *s, double half) {
  const stages *g = &s->stages;
  size_t n = g->n, nx = s->nx, size = n * nx;
  for (size_t i = 0; i < n; i++)
    for (size_t a = 0; a < nx; a++)
      for (size_t j = 0; j < n; j++)
        for (size_t b = 0; b < nx; b++)
          g->matrix[(i * nx + a) * size + j * nx + b] =
              (double)(i == j && a == b) - half * g->integral[i * n + j] * g->jacobian[(i * nx + a) * s->ndir + b];
}

static int decompose(const valencia *s) {
  const stages *g = &s->stages;
  size_t n = (size_t)g->n * s->nx;
  double *m = g->matrix;
  for (size_t k = 0; k < n; k++) {
    size_t best = k;
    for (size_t i = k + 1; i < n; i++)
      if (fabs(m[i * n + k]) > fabs(m[best * n + k])) best = i;
    g->pivot[k] = (uint32_t)best;
    if (!(fabs(m[best * n + k]) > 0)) return 0;
    for (size_t j = 0; j < n && best != k; j++) {
      double x = m[k * n + j];
      m[k * n + j] = m[best * n + j], m[best * n + j] = x;
    }
    for (size_t i = k + 1; i < n; i++) {
      double f = m[i * n + k] /= m[k * n + k];
      for (size_t j = k + 1; j < n && f != 0; j++) m[i * n + j] -= f * m[k * n + j];
    }
  }
  return 1;
}

/* right [n x columns] in place */
static void solve(const valencia *s, size_t columns) {
  const stages *g = &s->stages;
  size_t n = (size_t)g->n * s->nx;
  double *m = g->matrix, *r = g->right;
  for (size_t k = 0; k < n; k++) {
    for (size_t c = 0; c < columns && g->pivot[k] != k; c++) {
      double x = r[k * columns + c];
      r[k * columns + c] = r[g->pivot[k] * columns + c], r[g->pivot[k] * columns + c] = x;
    }
  }
  for (size_t k = 0; k < n; k++)
    for (size_t i = k + 1; i < n; i++)
      for (size_t c = 0; c < columns; c++) r[i * columns + c] -= m[i * n + k] * r[k * columns + c];
  for (size_t k = n; k-- > 0;)
    for (size_t c = 0; c < columns; c++) {
      double x = r[k * columns + c];
      for (size_t j = k + 1; j < n; j++) x -= m[k * n + j] * r[j * columns + c];
      r[k * columns + c] = x / m[k * n + k];
    }
}

/* -- curves */

static double at_node(const valencia *s, const double *start, uint32_t i, uint32_t a, double half) {
  const stages *g = &s->stages;
  double x = 0;
  for (uint32_t j = 0; j < g->n; j++) x += g->integral[(size_t)i * g->n + j] * g->rate[(size_t)j * s->nx + a];
  return start[a] + half * x;
}

/* one Newton step from the derivatives `rate`; returns the largest change relative to the states, < 0: not finite */
static double newton(valencia *s, const double *start, const double *p, double half, double time, double *x) {
  const stages *g = &s->stages;
  size_t nx = s->nx;
  for (uint32_t i = 0; i < g->n; i++) {
    for (uint32_t a = 0; a < nx; a++) x[a] = at_node(s, start, i, a, half);
    if (!valencia_point(s, x, p, time + half * g->node[i], g->right + i * nx, g->jacobian + i * nx * s->ndir))
      return -1;
  }
  for (size_t k = 0; k < g->n * nx; k++) g->right[k] -= g->rate[k];
  fill_matrix(s, half);
  if (!decompose(s)) return -1;
  solve(s, 1);
  double change = 0, most = 0;
  for (size_t k = 0; k < g->n * nx; k++) {
    g->rate[k] += g->right[k];
    most = larger_or_nan(most, fabs(half * g->rate[k]));
  }
  for (size_t k = 0; k < g->n * nx; k++) {
    /* all there is of a state that starts at 0; beside much larger ones it may be nothing but rounding */
    double moved = larger(fabs(half * g->rate[k]), SMALL * most);
    double size = larger(larger(fabs(start[k % nx]), s->magnitude[k % nx]), moved) + 1e-300;
    change = larger_or_nan(change, fabs(half * g->right[k]) / size);
  }
  return change < INFINITY ? change : -1;
}

static int find_curve(valencia *s, const double *start, const double *p, double *x) {
  double half = middle(s->half), time = middle(s->time), before = INFINITY;
  for (int k = 0; k < NEWTON_MAX; k++) {
    double change = newton(s, start, p, half, time, x);
    if (change < 0) return 0;
    if (change < 1e-15 || (change < 1e-10 && change > 0.3 * before)) return 1;
    before = change;
  }
  return before < 1e-6;
}

#define EPSILON 0x1p-51

/* About what rounding of states and time does to the computed derivatives: trailing coefficients below
** are noise, which powers of sigma and xi would amplify, and are dropped. */
static void find_noise(valencia *s, double *x) {
  stages *g = &s->stages;
  uint32_t nx = s->nx, i = g->n / 2;
  const double *jacobian = g->jacobian + (size_t)i * nx * s->ndir;
  double half = middle(s->half), t = middle(s->time) + half * g->node[i],
         later = t + 0x1p-20 * larger(fabs(t), fabs(half));
  for (uint32_t a = 0; a < nx; a++) x[a] = s->p[(size_t)a * s->terms.n];
  for (uint32_t a = 0; a < nx; a++) {
    s->noise[a] = fabs(g->rate[i * nx + a]);
    for (uint32_t b = 0; b < nx; b++) s->noise[a] += fabs(jacobian[a * s->ndir + b]) * s->magnitude[b];
  }
  double *early = s->coefficients, *late = early + nx, *derivative = late + nx;
  if (s->problem.uses_time && valencia_point(s, x, s->middle, t, early, derivative) &&
      valencia_point(s, x, s->middle, later, late, derivative))
    for (uint32_t a = 0; a < nx; a++) s->noise[a] += fabs((late[a] - early[a]) / (later - t) * t);
  for (uint32_t a = 0; a < nx; a++) s->noise[a] = EPSILON * larger(s->noise[a], s->magnitude[a] / fabs(half));
}

/* the curve with derivatives `rate` at the nodes, by powers of sigma */
static void to_powers(const valencia *s, const double *rate, size_t apart, double start, double noise, double *c) {
  const stages *g = &s->stages;
  uint32_t n = g->n, last = 0;
  double half = middle(s->half), sum = 0, *t = s->coefficients;
  for (uint32_t l = 0; l < n; l++) {
    t[l] = 0;
    for (uint32_t j = 0; j < n; j++) t[l] += g->transform[(size_t)l * n + j] * rate[j * apart];
    if (fabs(t[l]) > noise) last = l;
  }
  for (uint32_t m = 0; m < n; m++) {
    double x = 0;
    for (uint32_t l = m; l <= last; l++) x += g->chebyshev[(size_t)l * n + m] * t[l];
    c[m + 1] = half * x / (m + 1.0);
    sum += m % 2 ? c[m + 1] : -c[m + 1];
  }
  c[0] = start - sum;
}

static void start_rate(valencia *s, const double *start, const double *p) {
  stages *g = &s->stages;
  valencia_point(s, start, p, middle(s->time) - middle(s->half), g->right, g->jacobian);
  for (uint32_t i = 0; i < g->n; i++) memcpy(g->rate + (size_t)i * s->nx, g->right, s->nx * sizeof(double));
}

static double column_size(const valencia *s, size_t c) {
  double most = 0;
  for (size_t b = 0; b < s->nx; b++) most = larger(most, fabs(s->kept[b * s->nx + c]) / s->scale[b]);
  return most;
}

/* B' = J B, by the decomposed matrix of the middle curve */
static void find_frame(valencia *s) {
  stages *g = &s->stages;
  size_t nx = s->nx, n1 = g->n + 1u;
  for (size_t i = 0; i < g->n; i++)
    for (size_t a = 0; a < nx; a++)
      for (size_t c = 0; c < nx; c++) {
        double x = 0;
        for (size_t b = 0; b < nx; b++) x += g->jacobian[(i * nx + a) * s->ndir + b] * s->kept[b * nx + c];
        g->right[(i * nx + a) * nx + c] = x;
      }
  solve(s, nx);
  for (size_t a = 0; a < nx; a++)
    for (size_t c = 0; c < nx; c++)
      to_powers(s, g->right + a * nx + c, nx * nx, s->kept[a * nx + c],
          EPSILON * column_size(s, c) * s->scale[a] / fabs(middle(s->half)), s->frame + (a * nx + c) * n1);
}

static void start_of(const valencia *s, uint32_t sample, double *x, double *p) {
  const terms *t = &s->terms;
  const double *xi = t->sample + (size_t)sample * s->nu;
  double value[TERMS_MAX];
  value[0] = 1;
  for (uint32_t k = 1; k < t->n; k++) value[k] = value[t->parent[2 * k]] * xi[t->parent[2 * k + 1]];
  for (uint32_t i = 0; i < s->nx; i++) {
    x[i] = 0;
    for (uint32_t k = 0; k < t->n; k++) x[i] += s->p[(size_t)i * t->n + k] * value[k];
  }
  for (uint32_t i = 0; i < s->np; i++) {
    p[i] = s->middle[i];
    for (uint32_t j = 0; j < s->nu; j++) p[i] += s->reach[(size_t)i * s->nu + j] * xi[j];
  }
}

static void fit_samples(valencia *s) {
  size_t size = (size_t)s->stages.n * s->nx;
  double c[TERMS_MAX];
  for (size_t m = 0; m < size; m++) {
    double noise = 64 * sqrt(s->terms.nsample) * s->noise[m % s->nx];
    valencia_terms_fit(&s->terms, s->sampled + m * s->terms.nsample, noise, c);
    for (size_t k = 0; k < s->terms.n; k++) s->fitted[k * size + m] = c[k];
  }
}

/* The samples' derivatives are fitted, and each coefficient is integrated from its start: so rounding of the fit counts
** only as much as the step moves. */
int valencia_curve(valencia *s) {
  stages *g = &s->stages;
  size_t nx = s->nx, n = g->n, nt = s->terms.n;
  double *start = s->scratch, *x = start + nx, *p = x + nx;
  for (size_t i = 0; i < nx; i++) start[i] = s->p[i * nt];
  start_rate(s, start, s->middle);
  if (!find_curve(s, start, s->middle, x)) return 0;
  double *middle_rate = s->spectrum;
  memcpy(middle_rate, g->rate, n * nx * sizeof *middle_rate);
  find_noise(s, x);
  valencia_choose_basis(s, g->jacobian + (n / 2) * nx * s->ndir);
  find_frame(s);
  for (uint32_t q = 0; q < s->terms.nsample; q++) {
    start_of(s, q, start, p);
    if (!find_curve(s, start, p, x)) return 0;
    for (size_t m = 0; m < n * nx; m++) s->sampled[m * s->terms.nsample + q] = g->rate[m];
  }
  if (nt > 1) fit_samples(s);
  /* a polynomial of higher degree meets the samples; a linear one is best about a middle that is a solution */
  if (nt <= 1 + s->nu) memcpy(s->fitted, middle_rate, n * nx * sizeof *s->fitted);
  for (size_t i = 0; i < nx; i++)
    for (size_t k = 0; k < nt; k++)
      to_powers(s, s->fitted + k * n * nx + i, nx, s->p[i * nt + k], s->noise[i], s->curve + (i * nt + k) * (n + 1));
  return 1;
}

void valencia_freeze(valencia *s) {
  size_t nx = s->nx, n1 = s->stages.n + 1u, nt = s->terms.n;
  for (size_t i = 0; i < nx; i++) {
    for (size_t k = 1; k < nt; k++) {
      double *c = s->curve + (i * nt + k) * n1;
      memset(c, 0, n1 * sizeof *c);
      c[0] = s->p[i * nt + k];
    }
    for (size_t j = 0; j < nx; j++) {
      double *c = s->frame + (i * nx + j) * n1;
      memset(c, 0, n1 * sizeof *c);
      c[0] = s->b[i * nx + j];
    }
  }
  s->frozen = 1;
  valencia_unit_basis(s);
}
