/* mixed.c -- how the movement of old generators depends on the data.
**
** The mixed terms move the states by sum_j xi_j Y_j eps. What one datum does goes few ways for the most part: a
** stiffness acts on all states along one vector. So Y_j = sum_r u_r w_r' + R_j, crosses through the largest entries of
** what is left, and u_r xi_j (w_r' eps) is one generator, of size |w_r' eps|. Boxed, it would move the states
** independently of each other, and slow ones by what shakes stiff ones. What R_j makes goes into the box.
*/
#include "change.h"
#include "depend.h"
#include "modes.h"
#include "proof.h"
#include "quartic.h"

#define SUMS 128 /* that are measured together */

void mixed_prepare(zono *z) {
  proof *p = z->proof;
  size_t n = mixed_stride(z);
  for (uint32_t i = 0; i < z->nx; i++) {
    double *to = p->turned + i * n;
    for (uint32_t c = 0; c < z->ngen; c++) to[c] = z->G[(size_t)c * z->nx + i];
    for (size_t c = z->ngen; c < n; c++) to[c] = 0;
  }
}

void mixed_through(const zono *z, const double *y, double *to) {
  const proof *p = z->proof;
  uint32_t n = z->ngen;
  memset(to, 0, n * sizeof *to);
  for (uint32_t k = 0; k < z->nx; k++) {
    const double *from = p->turned + k * mixed_stride(z);
    if (y[k] == 0) continue;
    for (uint32_t c = 0; c < n; c++) to[c] += y[k] * from[c];
  }
}

/* a bound of sum_k y_k (G rho)_k, y [count x nx]: of all y together */
static double of_generators(const zono *z, const double *y, size_t count) {
  const proof *p = z->proof;
  size_t n = mixed_stride(z);
  double sum = 0;
  while (count > 0) {
    uint32_t some = count < SUMS ? (uint32_t)count : SUMS;
    double each[SUMS] = { 0 };
    p->depend->measure(p->turned, n, n, z->nx, y, some, each);
    for (uint32_t r = 0; r < some; r++) sum += each[r];
    y += (size_t)some * z->nx, count -= some;
  }
  return sum;
}

/* of sum_k y_k P_4,k: by the sizes of terms of each state */
static double of_quartic(const zono *z, const double *y) {
  double sum = 0;
  for (uint32_t k = 0; k < z->nx; k++) sum += fabs(y[k]) * quartic_size(z, k);
  return sum;
}

double mixed_sizes(const zono *z, const double *y, size_t count, double *kept) {
  double sum = 0;
  *kept = of_generators(z, y, count);
  for (; count > 0; count--, y += z->nx) *kept += depend_through(z, y), sum += of_quartic(z, y) + discs_size(z, y);
  return *kept + sum;
}

double mixed_size(const zono *z, const double *y) {
  double kept;
  return mixed_sizes(z, y, 1, &kept);
}

/* -- crosses */

/* B [nx x nx] := Y_j; is it anything? */
static int take_moves(const zono *z, uint32_t j, double *B) {
  uint32_t nx = z->nx;
  int any = 0;
  for (uint32_t i = 0; i < nx; i++) {
    const double *y = z->proof->end + (size_t)i * z->shape.stride + z->shape.mix + (size_t)j * nx;
    for (uint32_t k = 0; k < nx; k++) B[(size_t)i * nx + k] = y[k], any |= y[k] != 0;
  }
  return any;
}

/* the largest entry of B by the size of its state; 0: there is none */
static int find_pivot(const zono *z, const double *B, uint32_t *row, uint32_t *column) {
  double most = 0;
  for (uint32_t i = 0; i < z->nx; i++)
    for (uint32_t k = 0; k < z->nx; k++) {
      double size = fabs(B[(size_t)i * z->nx + k]) * z->E[k] / (z->E[i] > 0 ? z->E[i] : LEAST);
      if (size > most) most = size, *row = i, *column = k;
    }
  return most > 0;
}

/* B -= u w', u its column k and w its row i over the pivot; box += rounding, of sums along w and rows of B as well */
static void split(zono *z, double *B, uint32_t i, uint32_t k, double *u, double *w) {
  uint32_t nx = z->nx;
  double pivot = B[(size_t)i * nx + k];
  for (uint32_t l = 0; l < nx; l++) u[l] = B[(size_t)l * nx + k], w[l] = B[(size_t)i * nx + l] / pivot;
  for (uint32_t a = 0; a < nx; a++) {
    double rounded = 0;
    for (uint32_t b = 0; b < nx; b++) {
      double part = u[a] * w[b], *at = B + (size_t)a * nx + b;
      rounded += (fabs(*at) + fabs(part)) * z->E[b];
      *at -= part;
    }
    *box(z, FROM_START, a) += 2 * (nx + 8) * UNIT * rounded;
  }
}

/* Terms xi_j M_j G rho are part of what generators depend on (depend.c) if that is followed; then M_j acts on what they
** depend on, and on terms of degree 4. */
uint32_t mixed_add(zono *z, uint32_t at) {
  proof *p = z->proof;
  depend *d = p->depend;
  uint32_t nx = z->nx, i = 0, k = 0, first = at, crosses = 0;
  double *B = p->moves;
  int carried = discs_carry(z);
  for (uint32_t j = 0; j < z->shape.mixed; j++) {
    if (!take_moves(z, j, B)) continue;
    for (int r = 0; r < CROSSES && find_pivot(z, B, &i, &k); r++)
      split(z, B, i, k, p->columns + (size_t)at++ * nx, d->turn + (size_t)crosses++ * nx);
    for (uint32_t a = 0; a < nx; a++) {
      const double *y = B + (size_t)a * nx;
      double old = d->any ? depend_through(z, y) : of_generators(z, y, 1);
      *box(z, FROM_MIXED, a) += (old + (carried ? 0 : of_quartic(z, y))) * ABOVE;
    }
  }
  depend_along(z, d->turn, crosses, d->along);
  for (uint32_t c = 0; c < crosses; c++) {
    double *u = p->columns + (size_t)(first + c) * nx, *w = d->turn + (size_t)c * nx;
    double size = ((d->any ? d->along[c] : of_generators(z, w, 1)) + (carried ? 0 : quartic_through(z, w))) * ABOVE;
    for (uint32_t a = 0; a < nx; a++) u[a] *= size, *box(z, FROM_START, a) += UNIT * fabs(u[a]);
    p->source[first + c] = 0, p->origin[first + c] = FROM_MIXED;
  }
  return at;
}
