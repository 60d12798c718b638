/* map.c -- what a step makes of discs.
**
** With Y + sum_j xi_j M_j the map of the step, V and U_j = V T_j at its start, V', W', T'_j at its end and any matrices
** C, D_j, S_ij,
**   (Y + sum xi_j M_j) (V + sum xi_j U_j) = V' (I + sum xi_j T'_j) (C + sum xi_j D_j + sum xi_i xi_j S_ij) + R(xi),
** and |(C + sum xi_j D_j + sum xi_i xi_j S_ij) w| bounds the new discs. R is bounded from what multiplying out leaves:
** R_0 = Y V - V' C, R_j = M_j V + Y U_j - V' (T'_j C + D_j), R_ij = M_i U_j - V' (T'_i D_j + S_ij), and products of
** three data by size. C, D_j and S_ij are W' times what these would be without them, so they are rounding. Where only
** frequencies depend on the data, |C_kk + sum xi_j D_j,kk + ...| is |C_kk| but for squares, and discs do not grow.
**
** Of P_4 = V w, |w| <= a, C w moves as it is, and what D_j and S_ij make are new errors. What is known of two data at
** once is in S_ij.
*/
#include "modes.h"
#include "proof.h"
#include "quartic.h"

#define TINY 1e-100 /* nothing is divided by less */

typedef struct sizes {
  double *terms;          /* of one sum, for its rounding */
  double *along, *across; /* what is added to C: its real and its imaginary share by C */
  double *G, *D, *S;      /* sum_j |G_j|, sum_j |D_j|, sum_ij |S_ij|; all sizes [nx x nx] */
  double *slack, *work;   /* what D and S are off by */
} sizes;

/* to := Y x (j: NULL) or M_j x, x [nx x nx]; size += sizes of the terms */
static void through(const zono *z, const uint32_t *j, const number *x, number *to, double *size) {
  uint32_t n = z->nx;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t l = 0; l < n; l++) {
      double y = j ? modes_mixed(z, *j, i, l) : modes_flow(z, i, l);
      for (uint32_t k = 0; k < n && y != 0; k++) {
        number part = y * x[l * n + k];
        to[i * n + k] += part, size[i * n + k] += modulus(part);
      }
    }
}

/* P - V' c, its size with rounding, times b: into the box; or into `rest` */
static void leave(zono *z, const number *P, const number *c, const double *size, double *rest) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      number left = P[i * n + k];
      double all = 2 * size[i * n + k]; /* twice: T_j is V^-1 U_j but for rounding */
      for (uint32_t l = 0; l < n; l++) {
        number part = m->now.V[i * n + l] * c[l * n + k];
        left -= part, all += modulus(part);
      }
      double bound = (modulus(left) + 16 * (n + 4) * UNIT * all) * ABOVE;
      if (rest)
        rest[i * n + k] += bound;
      else
        m->box[i] += bound * m->all[k];
    }
}

/* to [nx x nx] += a b by, for matrices of bounds */
static void bound_product(uint32_t n, const double *a, const double *b, double by, double *to) {
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++)
      for (uint32_t j = 0; j < n; j++) to[i * n + j] += a[i * n + k] * b[k * n + j] * by;
}

/* to [nx] += a b */
static void add_bound(uint32_t n, const double *a, const double *b, double *to) {
  for (uint32_t i = 0; i < n; i++) {
    double sum = 0;
    for (uint32_t k = 0; k < n; k++) sum += a[i * n + k] * b[k];
    to[i] += sum * ABOVE;
  }
}

/* x, times a symbol, beside C_e */
static void beside(const modes *m, const sizes *s, size_t e, number x) {
  double c = modulus(m->C[e]);
  number by = c > TINY ? x * conj(m->C[e]) / c : modulus(x);
  s->along[e] += fabs(creal(by)), s->across[e] += fabs(cimag(by));
}

/* C, and what it leaves */
static void map_mean(zono *z, const sizes *s) {
  modes *m = z->modes;
  size_t n = z->nx, square = n * n;
  memset(m->A, 0, square * sizeof *m->A), memset(s->terms, 0, square * sizeof *s->terms);
  through(z, NULL, m->old.V, m->A, s->terms);
  modes_product(n, m->now.W, m->A, m->C);
  leave(z, m->A, m->C, s->terms, NULL);
}

/* D_j and G_j = W' M_j V, and what they leave */
static void map_datum(zono *z, const sizes *s, uint32_t j, double *rest) {
  modes *m = z->modes;
  size_t n = z->nx, square = n * n;
  number *D = m->D + j * square, *G = m->G + j * square;
  memset(m->A, 0, square * sizeof *m->A), memset(s->terms, 0, square * sizeof *s->terms);
  through(z, &j, m->old.V, m->A, s->terms);
  modes_product(n, m->now.W, m->A, G);
  leave(z, m->A, G, s->terms, rest);
  through(z, NULL, m->old.U + j * square, m->A, s->terms);
  modes_product(n, m->now.W, m->A, D); /* T' C + D, as one */
  leave(z, m->A, D, s->terms, NULL);
  modes_product(n, m->now.T + j * square, m->C, m->B);
  for (size_t e = 0; e < square; e++) {
    D[e] -= m->B[e];
    beside(m, s, e, D[e]), s->D[e] += modulus(D[e]), s->G[e] += modulus(G[e]);
  }
}

/* m->A += a b, sign 1 or -1; entries of b that are 0 cost nothing */
static void add_product(zono *z, double sign, const number *a, const number *b) {
  size_t n = z->nx;
  for (size_t k = 0; k < n; k++)
    for (size_t l = 0; l < n; l++) {
      number x = sign * b[k * n + l];
      for (size_t i = 0; i < n && x != 0; i++) z->modes->A[i * n + l] += a[i * n + k] * x;
    }
}

/* S_ij, with S_ji */
static void map_pair(zono *z, const sizes *s, uint32_t i, uint32_t j) {
  modes *m = z->modes;
  size_t square = (size_t)z->nx * z->nx;
  const number *T = m->old.T, *T_new = m->now.T;
  memset(m->A, 0, square * sizeof *m->A);
  add_product(z, 1, m->G + i * square, T + j * square), add_product(z, -1, T_new + i * square, m->D + j * square);
  if (i != j) add_product(z, 1, m->G + j * square, T + i * square);
  if (i != j) add_product(z, -1, T_new + j * square, m->D + i * square);
  for (size_t e = 0; e < square; e++) beside(m, s, e, m->A[e]), s->S[e] += modulus(m->A[e]);
}

/* slack := what D and S are off by: sums are, by 16 (nx + 4) UNIT of the sum of their terms' sizes. S += its own
** part. */
static void add_slack(zono *z, const sizes *s) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  size_t square = (size_t)n * n;
  double *of_D = s->slack, *of_S = s->terms, by = 16.0 * (n + 4) * UNIT;
  for (size_t e = 0; e < square; e++) s->work[e] = modulus(m->C[e]), of_D[e] = by * s->D[e], of_S[e] = by * s->S[e];
  bound_product(n, m->now.tilt, s->work, by, of_D);
  bound_product(n, s->G, m->old.tilt, by, of_S), bound_product(n, m->now.tilt, of_D, 2, of_S);
  for (size_t e = 0; e < square; e++) of_D[e] += of_S[e], s->S[e] += of_S[e];
}

/* to [nx] := bounds of |P_4 - V W P_4| at the start */
static void find_rest(const zono *z, double *to) {
  const modes *m = z->modes;
  uint32_t n = z->nx;
  for (uint32_t i = 0; i < n; i++) {
    to[i] = 0;
    for (uint32_t l = 0; l < n; l++) {
      number left = i == l;
      double size = 1;
      for (uint32_t k = 0; k < n; k++) {
        number part = m->old.V[i * n + k] * m->old.W[k * n + l];
        left -= part, size += modulus(part);
      }
      to[i] += (modulus(left) + 8 * (n + 4) * UNIT * size) * quartic_size(z, l);
    }
  }
}

/* M_j of the rest of P_4 = V w + rest, |w| <= a; and by how much W' Y P_4, by which P_4 will turn, differs from C w,
** turned. Y P_4 itself is quartic_move()'s. */
static void leave_fourth(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx, mixed = z->shape.mixed;
  double *rest = m->rest_of_fourth, *moved = m->all + n, *along = moved + n;
  find_rest(z, rest);
  for (uint32_t j = 0; j < mixed; j++)
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t l = 0; l < n; l++) m->box[i] += fabs(modes_mixed(z, j, i, l)) * rest[l] * ABOVE;
  memset(moved, 0, 2 * n * sizeof *moved);
  for (uint32_t l = 0; l < n; l++) {
    double off = rest[l];
    for (uint32_t k = 0; k < n; k++) off += 16 * (n + 4) * UNIT * modulus(m->old.V[l * n + k]) * m->old.a[k];
    for (uint32_t i = 0; i < n; i++) moved[i] += fabs(modes_flow(z, i, l)) * off;
  }
  for (uint32_t k = 0; k < n; k++)
    for (uint32_t i = 0; i < n; i++) along[k] += modulus(m->now.W[k * n + i]) * moved[i];
  add_bound(n, m->now.tilt, along, m->in);
}

static sizes sizes_of(const modes *m, size_t square) {
  double *at = m->sizes;
  return (sizes) { at, at + square, at + 2 * square, at + 3 * square, at + 4 * square, at + 5 * square, at + 6 * square,
    at + 7 * square };
}

/* growth, and the new discs */
static void grow(zono *z, const sizes *s) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  double *off = s->work;
  memset(m->now.b, 0, n * sizeof *m->now.b);
  for (size_t e = 0; e < (size_t)n * n; e++) {
    m->growth[e] = (length(modulus(m->C[e]) + s->along[e], s->across[e]) + s->slack[e]) * ABOVE;
    off[e] = s->D[e] + s->S[e] + s->slack[e];
  }
  add_bound(n, m->growth, m->old.b, m->now.b);
  add_bound(n, off, m->old.a, m->now.b);
}

void map_discs(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx, mixed = z->shape.mixed;
  size_t square = (size_t)n * n;
  double *rest = m->rest;
  sizes s = sizes_of(m, square);
  memset(m->sizes, 0, 8 * square * sizeof *m->sizes), memset(rest, 0, square * sizeof *rest);
  for (uint32_t k = 0; k < n; k++) m->all[k] = m->old.a[k] + m->old.b[k];
  map_mean(z, &s);
  for (uint32_t j = 0; j < mixed; j++) map_datum(z, &s, j, rest);
  for (uint32_t i = 0; i < mixed; i++)
    for (uint32_t j = i; j < mixed; j++) map_pair(z, &s, i, j);
  add_slack(z, &s);
  grow(z, &s);
  if (!m->cycle) leave_fourth(z);
  double *beyond = s.work; /* (M_j V - V' G_j) T_i, and V' T'_l S_ij, of three data: along V' alone, discs_finish() */
  memset(beyond, 0, square * sizeof *beyond);
  bound_product(n, rest, m->old.tilt, 1, beyond), add_bound(n, beyond, m->all, m->box);
  memset(beyond, 0, square * sizeof *beyond);
  bound_product(n, m->now.tilt, s.S, 1, beyond), add_bound(n, beyond, m->all, m->in);
  for (size_t e = 0; e < square; e++) m->growth[e] += beyond[e];
}

/* M_n := h mean N_n of pair n, and of its sizes */
static void take_pair(zono *z, uint32_t n, double *M, double *size) {
  uint32_t nx = z->nx;
  memset(M, 0, (size_t)nx * nx * sizeof *M), memset(size, 0, (size_t)nx * nx * sizeof *size);
  for (uint32_t x = 0; x < nx; x++) {
    const double *near = quartic_near(z, x, n);
    if (z->proof->link[x] == LINK_STATE) continue;
    for (uint32_t i = 0; i < nx; i++) {
      double by = z->h * z->proof->mean[(size_t)i * nx + x];
      for (uint32_t k = 0; k < nx; k++) M[i * nx + k] += by * near[k], size[i * nx + k] += fabs(by * near[k]);
    }
  }
}

/* M_n of all pairs are S_ij too, and S = sum |W' M_n V| more; of three data T'_l and T_l besides; M_n of P_4's rest */
void map_pairs(zono *z) {
  modes *m = z->modes;
  uint32_t n = z->nx;
  size_t square = (size_t)n * n;
  sizes s = sizes_of(m, square);
  double *M = m->work, *size = M + square, *second = size + square, *left = second + square, *beyond = s.work;
  memset(second, 0, square * sizeof *second), memset(left, 0, square * sizeof *left);
  for (uint32_t pair = 0; pair < z->proof->quartic->pairs; pair++) {
    take_pair(z, pair, M, size);
    memset(m->A, 0, square * sizeof *m->A), memset(s.terms, 0, square * sizeof *s.terms);
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t l = 0; l < n; l++)
        for (uint32_t k = 0; k < n && size[i * n + l] != 0; k++) {
          m->A[i * n + k] += M[i * n + l] * m->old.V[l * n + k];
          s.terms[i * n + k] += 2 * size[i * n + l] * modulus(m->old.V[l * n + k]);
        }
    modes_product(n, m->now.W, m->A, m->B);
    leave(z, m->A, m->B, s.terms, left);
    for (size_t e = 0; e < square; e++) beside(m, &s, e, m->B[e]), second[e] += modulus(m->B[e]);
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t l = 0; l < n; l++) m->box[i] += size[i * n + l] * m->rest_of_fourth[l] * ABOVE;
  }
  for (size_t e = 0; e < square; e++) {
    double slack = 16.0 * (n + 4) * UNIT * second[e];
    s.slack[e] += slack, s.S[e] += second[e] + slack;
  }
  grow(z, &s);
  add_bound(n, left, m->all, m->box);
  memset(beyond, 0, square * sizeof *beyond), bound_product(n, left, m->old.tilt, 1, beyond);
  add_bound(n, beyond, m->all, m->box);
  memset(beyond, 0, square * sizeof *beyond);
  bound_product(n, m->now.tilt, second, 1 + 1e-9, beyond), bound_product(n, second, m->old.tilt, 1 + 1e-9, beyond);
  add_bound(n, beyond, m->all, m->in);
}
