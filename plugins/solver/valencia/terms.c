/* terms.c -- monomials in the normalised unknowns, and how coefficients are found from values at sample points.
**
** Coefficients are those of least squares over the samples (one unknown: Chebyshev points, where it is interpolation;
** more: a Halton sequence with the Chebyshev density), by modified Gram-Schmidt, twice. They are an approximation like
** everything that makes p(sigma, xi); only valencia_terms_range() is a bound.
*/
#include "valencia.h"

static double choose(double n, double k) {
  double r = 1;
  for (double i = 1; i <= k; i++) r = r * (n - k + i) / i;
  return r;
}

/* the most monomials of degree <= d that are allowed */
static uint32_t fitting_degree(uint32_t nu, uint32_t d) {
  while (d > 1 && choose(nu + d, d) > TERMS_MAX) d--;
  return d;
}

/* degree by degree: each monomial of the degree before, times every unknown from its last one on */
static void list(terms *t, uint32_t nu, uint32_t degree) {
  uint32_t from = 0, to = 1, n = 1;
  for (uint32_t d = 1; d <= degree; d++, from = to, to = n)
    for (uint32_t a = from; a < to; a++) {
      uint32_t last = 0;
      for (uint32_t j = 0; j < nu; j++)
        if (t->exponent[(size_t)a * nu + j]) last = j;
      for (uint32_t j = last; j < nu; j++, n++) {
        uint32_t *e = t->exponent + (size_t)n * nu;
        for (uint32_t k = 0; k < nu; k++) e[k] = t->exponent[(size_t)a * nu + k] + (k == j);
        t->parent[2 * n] = a, t->parent[2 * n + 1] = j;
      }
    }
}

static double halton(uint32_t index, uint32_t base) {
  double r = 0, f = 1;
  for (; index; index /= base) f /= base, r += f * (index % base);
  return r;
}

static int is_prime(uint32_t p) {
  for (uint32_t k = 2; k * k <= p; k++)
    if (p % k == 0) return 0;
  return 1;
}

static void place_samples(terms *t, uint32_t nu) {
  uint32_t prime = 2;
  for (uint32_t j = 0; j < nu; j++) {
    for (uint32_t q = 0; q < t->nsample; q++)
      t->sample[(size_t)q * nu + j] = nu == 1 ? cos(M_PI * (q + 0.5) / t->nsample) : cos(M_PI * halton(q + 1, prime));
    do prime++;
    while (!is_prime(prime));
  }
}

static double dot(uint32_t n, const double *a, const double *b) {
  double r = 0;
  for (uint32_t i = 0; i < n; i++) r += a[i] * b[i];
  return r;
}

/* rows of q: the monomials at the samples, V = R^T Q made orthonormal by Gram-Schmidt */
static void orthonormalise(terms *t) {
  uint32_t n = t->n, m = t->nsample;
  for (uint32_t a = 0; a < n; a++) {
    double *row = t->q + (size_t)a * m;
    for (int pass = 0; pass < 2; pass++)
      for (uint32_t c = 0; c < a; c++) {
        double share = dot(m, t->q + (size_t)c * m, row);
        for (uint32_t k = 0; k < m; k++) row[k] -= share * t->q[(size_t)c * m + k];
        t->r[(size_t)c * n + a] += share;
      }
    double norm = sqrt(dot(m, row, row));
    t->r[(size_t)a * n + a] = norm;
    for (uint32_t k = 0; k < m; k++) row[k] /= norm;
  }
}

/* Coefficients of the orthonormal polynomials first: the trailing ones that are only rounding noise are dropped, which
** would be amplified by the monomials. */
void valencia_terms_fit(const terms *t, const double *value, double noise, double *c) {
  uint32_t n = t->n, last = 0;
  for (uint32_t a = 0; a < n; a++) {
    c[a] = dot(t->nsample, t->q + (size_t)a * t->nsample, value);
    if (fabs(c[a]) > noise) last = a;
  }
  for (uint32_t a = n; a-- > 0;) {
    double v = a <= last ? c[a] : 0;
    for (uint32_t b = a + 1; b <= last; b++) v -= t->r[(size_t)a * n + b] * c[b];
    c[a] = v / t->r[(size_t)a * n + a];
  }
}

int valencia_terms_open(valencia *s) {
  terms *t = &s->terms;
  uint32_t nu = s->nu, degree = nu ? fitting_degree(nu, s->options.degree) : 0;
  t->n = (uint32_t)(choose(nu + degree, degree) + 0.5);
  t->nsample = nu == 1 ? t->n : nu ? 2 * t->n : 0;
  const ambit_host *h = s->host;
  t->exponent = h->alloc(h, ((size_t)t->n * nu + 1) * sizeof *t->exponent);
  t->parent = h->alloc(h, 2u * t->n * sizeof *t->parent);
  t->sample = h->alloc(h, ((size_t)t->nsample * nu + 1) * sizeof *t->sample);
  t->q = h->alloc(h, ((size_t)t->n * t->nsample + 1) * sizeof *t->q);
  t->r = h->alloc(h, (size_t)t->n * t->n * sizeof *t->r);
  if (!t->exponent || !t->parent || !t->sample || !t->q || !t->r) return 0;
  if (nu) list(t, nu, degree), place_samples(t, nu);
  for (uint32_t k = 0; k < t->nsample; k++)
    for (uint32_t a = 0; a < t->n; a++) {
      const double *above = t->q + (size_t)t->parent[2 * a] * t->nsample;
      t->q[(size_t)a * t->nsample + k] = a ? above[k] * t->sample[(size_t)k * nu + t->parent[2 * a + 1]] : 1;
    }
  if (nu) orthonormalise(t);
  return 1;
}

/* -- bounds */

#define PARTS 32

/* of one unknown, over a part of [-1, 1], about its middle: by Horner's rule for the shifted polynomial's slope */
static interval range_of_one(uint32_t n, const double *c, size_t stride, interval x) {
  interval value = point(c[(n - 1) * stride]), slope = point(0), centre = point(middle(x));
  for (uint32_t k = n - 1; k-- > 0;) {
    slope = plus(times(slope, x), value);
    value = plus(times(value, centre), point(c[k * stride]));
  }
  return plus(value, times(slope, minus(x, centre)));
}

interval valencia_terms_range(const terms *t, uint32_t nu, const double *c, size_t stride) {
  interval r = point(c[0]);
  if (nu == 1 && t->n > 2) {
    r = range_of_one(t->n, c, stride, (interval) { -1, -1 + 2.0 / PARTS });
    for (int k = 1; k < PARTS; k++)
      r = hull_of(r, range_of_one(t->n, c, stride, (interval) { -1 + 2.0 * k / PARTS, -1 + 2.0 * (k + 1) / PARTS }));
    return r;
  }
  for (uint32_t a = 1; a < t->n; a++) {
    int even = 1;
    for (uint32_t j = 0; j < nu; j++) even = even && t->exponent[(size_t)a * nu + j] % 2 == 0;
    r = plus(r, scaled((interval) { even ? 0 : -1, 1 }, c[a * stride]));
  }
  return r;
}
