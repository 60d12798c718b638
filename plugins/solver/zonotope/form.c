/* form.c -- sums, products and inverses of linear forms. */
#include "form.h"

void form_constant(const forms *f, double *x, double c) {
  form_clear(f, x);
  x[0] = c, x[3 + f->n] = fabs(c), x[4 + f->n] = 1;
}

/* mass bounds every partial sum's size: k additions lose k UNIT mass at most; `seen` counts them */
void form_close(const forms *f, double *x) {
  double norm = 0;
  for (uint32_t v = 1; v <= f->n; v++) norm += fabs(x[v]);
  x[1 + f->n] += (x[4 + f->n] + 8) * UNIT * x[3 + f->n];
  x[2 + f->n] = norm * ABOVE;
  x[3 + f->n] = fabs(x[0]) + x[2 + f->n];
  x[4 + f->n] = x[4 + f->n] != 0;
}

void form_add(const forms *f, double *to, double scale, const double *a) {
  double size = fabs(scale);
  for (uint32_t v = 0; v <= f->n; v++) to[v] += scale * a[v];
  to[1 + f->n] += size * a[1 + f->n];
  to[3 + f->n] += size * (fabs(a[0]) + a[2 + f->n]);
  to[4 + f->n] += 1;
}

/* l_a l_b, with T_i T_j = (T_(i+j) + T_|i-j|) / 2; what is above degree n into the radius */
static void multiply_powers(const forms *f, double *to, double scale, const double *a, const double *b) {
  double high = 0;
  for (uint32_t i = 1; i <= f->n; i++) {
    double half = 0.5 * scale * a[i];
    for (uint32_t j = 1; j <= f->n; j++) {
      double part = half * b[j];
      to[i > j ? i - j : j - i] += part;
      if (i + j <= f->n)
        to[i + j] += part;
      else
        high += fabs(part);
    }
  }
  to[1 + f->n] += high;
  to[4 + f->n] += 2 * f->n; /* additions to each coefficient, at most */
}

void form_product(const forms *f, double *to, double scale, const double *a, const double *b) {
  double ca = scale * a[0], cb = scale * b[0], size = fabs(scale);
  double ra = a[1 + f->n], rb = b[1 + f->n], la = a[2 + f->n], lb = b[2 + f->n];
  to[0] += ca * b[0];
  if (la == 0)
    for (uint32_t v = 1; v <= f->n; v++) to[v] += ca * b[v];
  else if (lb == 0)
    for (uint32_t v = 1; v <= f->n; v++) to[v] += cb * a[v];
  else
    for (uint32_t v = 1; v <= f->n; v++) to[v] += ca * b[v] + cb * a[v];
  double square = size * la * lb;
  to[1 + f->n] += fabs(ca) * rb + fabs(cb) * ra + size * (la * rb + ra * (lb + rb)) + (f->powers ? 0 : square);
  to[3 + f->n] += fabs(ca) * (fabs(b[0]) + lb) + fabs(cb) * la + (f->powers ? square : 0);
  if (f->powers && square > 0) multiply_powers(f, to, scale, a, b);
  to[4 + f->n] += 1;
}

/* With u = (x - c) / c, |u| <= q < 1 and w = sqrt(1 - q^2): 1 / (1 + u) lies between the chord 1 / w^2 - u / w^2 and
** the parallel tangent 2 / w - 1 / w^2 - u / w^2. */
int form_inverse(const forms *f, double *to, const double *a, double more) {
  double c = a[0], q = (form_moving(f, a) + more) / fabs(c) * ABOVE;
  if (!(q < 1) || !isfinite(1 / c)) return 0;
  double w2 = (1 - q) * (1 + q), w = sqrt(w2), slope = -1 / (w2 * c * c);
  form_clear(f, to);
  to[0] = 1 / (w * c);
  for (uint32_t v = 1; v <= f->n; v++) to[v] = slope * a[v];
  to[1 + f->n] = (1 / w2 - 1 / w) / fabs(c) + fabs(slope) * (a[1 + f->n] + more);
  to[3 + f->n] = 4 / (w2 * fabs(c)); /* what is rounded in it, generously */
  to[4 + f->n] = 1;
  form_close(f, to);
  return 1;
}

void form_widen(const forms *f, double *to, const double *a, double more) {
  memcpy(to, a, f->stride * sizeof *to);
  to[1 + f->n] += more;
}
