/* prove.c -- the errors of a piece, from its start to its end, in upward mode.
**
** With e = B z the distance of a solution from P, z' = B^-1 ((eta/2) J B - B') z - B^-1 d, J the mean of the slopes
** between P and the solution, d the defect. As long as |z_b| < R_b, blocks of z obey D+ |z| <= M |z| + delta with the
** Metzler matrix M of rates.c over the tube of R; so |z| <= v e^(alpha t) as soon as v >= |z| at the start and
** M v + delta <= alpha v, and if that stays below R, |z| never reaches R, and the solution exists on the whole piece
** (docs/numerics/stiff.md).
*/
#include "stiff.h"
#include <string.h>

#define LENGTH 2.0 /* of s in [-1, 1] */
#define TRIES 6
#define MOST_GROWTH 20.0 /* of alpha times LENGTH */

typedef struct errors {
  uint32_t m; /* blocks */
  double first[N_MAX], delta[N_MAX], R[N_MAX], v[N_MAX], most[N_MAX], last[N_MAX];
  square M;
} errors;

/* -- the start: B^-1 (gap + B_old z_old) */

static int middle_inverse(uint32_t n, const iv *B, double *C) {
  square middle;
  for (uint32_t i = 0; i < n * n; i++) middle[i] = iv_middle(B[i]);
  return matrix_inverse(n, middle, C);
}

/* z [new_blocks]: bounds in the 2-norm of blocks of T x for blocks of x bounded by w, |T| <= T [n x n] entrywise. The
** norm of a block of T is at most its Frobenius norm, and the root of the product of its row and column sums: a block
** that is nearly the unit matrix loses nothing. */
static void carry(uint32_t n, const double *T, const carried *from, const split *to, double *z) {
  uint32_t m = from->blocks;
  square rows, squares, columns; /* [to->blocks x m], [to->blocks x n] */
  memset(rows, 0, (size_t)to->blocks * m * sizeof *rows), memset(squares, 0, (size_t)to->blocks * m * sizeof *squares);
  memset(columns, 0, (size_t)to->blocks * n * sizeof *columns);
  for (uint32_t i = 0; i < n; i++) {
    double row[N_MAX] = { 0 }, *all = squares + (size_t)to->block[i] * m, *most = rows + (size_t)to->block[i] * m;
    for (uint32_t k = 0; k < n; k++) {
      double x = T[i * n + k];
      row[from->block[k]] += x, all[from->block[k]] += x * x, columns[to->block[i] * n + k] += x;
    }
    for (uint32_t c = 0; c < m; c++) most[c] = larger(most[c], row[c]);
  }
  for (uint32_t b = 0; b < to->blocks; b++) {
    double column[N_MAX] = { 0 };
    for (uint32_t k = 0; k < n; k++) column[from->block[k]] = larger(column[from->block[k]], columns[b * n + k]);
    z[b] = 0;
    for (uint32_t c = 0; c < m; c++)
      z[b] += smaller(sqrt(squares[b * m + c]), sqrt(rows[b * m + c] * column[c])) * from->w[c];
  }
}

/* row i of T [n x m], its columns in blocks in the 2-norm, times w */
static double in_blocks(uint32_t n, const double *row, const uint32_t *block, uint32_t blocks, const double *w) {
  double norm[N_MAX], sum = 0;
  bound_blocks(n, block, blocks, row, norm);
  for (uint32_t k = 0; k < blocks; k++) sum += norm[k] * w[k];
  return sum;
}

static int enter(stiff *s, errors *e) {
  const frame *f = &s->frame;
  const carried *old = &s->carried;
  uint32_t n = s->n;
  square C, T;
  iv X[N_MAX * N_MAX], gap[N_MAX];
  double jump[N_MAX], z[N_MAX];
  for (uint32_t i = 0; i < n * n; i++) X[i] = iv_of(old->B[i]);
  for (uint32_t i = 0; i < n; i++) gap[i] = (iv) { s->gap_error[i] - s->gap[i], s->gap_error[i] + s->gap[i] };
  if (!middle_inverse(n, f->start, C) || !bound_solution(n, C, f->start, n, X, T) ||
      !bound_solution(n, C, f->start, 1, gap, jump))
    return 0;
  carry(n, T, old, &f->split, z);
  bound_blocks(n, f->split.block, f->split.blocks, jump, e->first);
  for (uint32_t b = 0; b < f->split.blocks; b++) e->first[b] += z[b];
  return 1;
}

/* -- the defect: |B^-1 d|, d coefficient by coefficient through C and Gi before magnitudes are taken */

static void bound_defect(const stiff *s, errors *e) {
  const frame *f = &s->frame;
  uint32_t n = s->n, w = (s->q.N + 1) * (s->spread ? s->terms.count : 1);
  double plain[N_MAX] = { 0 }, back[N_MAX] = { 0 }, tail[N_MAX], z[N_MAX];
  for (uint32_t i = 0; i < n; i++) {
    tail[i] = 0;
    for (uint32_t a = 0; a < s->nx; a++) tail[i] += fabs(f->C[i * n + a]) * s->defect_tail[a];
  }
  for (uint32_t k = 0; k < w; k++) {
    iv v[N_MAX];
    for (uint32_t i = 0; i < n; i++) {
      v[i] = (iv) { 0, 0 };
      for (uint32_t a = 0; a < s->nx; a++) v[i] = iv_fma(v[i], iv_of(s->defect[a * w + k]), f->C[i * n + a]);
      plain[i] += iv_mag(v[i]);
    }
    for (uint32_t i = 0; i < n; i++) {
      iv sum = { 0, 0 };
      for (uint32_t a = 0; a < n; a++) sum = iv_fma(sum, v[a], f->Gi[i * n + a]);
      back[i] += iv_mag(sum);
    }
  }
  for (uint32_t i = 0; i < n; i++) {
    plain[i] += tail[i];
    for (uint32_t a = 0; a < n; a++) back[i] += fabs(f->Gi[i * n + a]) * tail[a];
  }
  double turned[N_MAX];
  bound_multiply(n, n, 1, f->E, plain, turned);
  for (uint32_t i = 0; i < n; i++) {
    z[i] = back[i];
    for (uint32_t a = 0; a < n; a++) z[i] += f->EG[i * n + a] * back[a] + f->Gi_size[i * n + a] * turned[a];
  }
  bound_blocks(n, f->split.block, e->m, z, e->delta);
}

/* -- the tube */

/* |B z| for |z_b| <= bound */
static void spread(const stiff *s, const double *bound, double *radius) {
  const frame *f = &s->frame;
  for (uint32_t i = 0; i < s->n; i++)
    radius[i] = in_blocks(s->n, f->reach + i * s->n, f->split.block, f->split.blocks, bound);
}

/* the series run in round-to-nearest */
static AMBIT_WORKER int slopes_anew(stiff *s, uint32_t j, uint32_t pieces) {
  ambit_rounding up = ambit_round_nearest();
  int good = evaluate_slopes(s, j, pieces);
  ambit_rounding_restore(up);
  return good;
}

/* slopes over the tube of R, computed anew only if it left the last one, around P as it was then */
static int cover(stiff *s, const errors *e, uint32_t j, uint32_t pieces) {
  double radius[N_MAX];
  int outgrown = 0;
  spread(s, e->R, radius);
  for (uint32_t i = 0; i < s->n; i++) outgrown |= !(radius[i] + s->shift[i] <= s->box[i]);
  if (!outgrown) return 1;
  for (uint32_t i = 0; i < s->n; i++) {
    if (!(radius[i] < INFINITY)) return 0;
    s->box[i] = larger(s->box[i], radius[i]);
    s->shift[i] = 0;
  }
  return slopes_anew(s, j, pieces);
}

static void guess_R(const stiff *s, errors *e) {
  const split *p = &s->frame.split;
  for (uint32_t b = 0; b < e->m; b++) e->R[b] = 2 * e->first[b] + 2 * e->delta[b] * LENGTH;
  for (uint32_t i = p->slow; i < s->n; i++) {
    double rate = s->frame.decay[i]; /* a fast one only builds up over 1 / rate */
    uint32_t b = p->block[i];
    if (rate * LENGTH > 1) e->R[b] = 2 * e->first[b] + 4 * e->delta[b] / rate;
  }
}

/* M v + delta over v, the largest component */
static double exponent(const errors *e, double *rate) {
  double alpha = 0;
  bound_multiply(e->m, e->m, 1, e->M, e->v, rate);
  for (uint32_t b = 0; b < e->m; b++) {
    rate[b] += e->delta[b];
    alpha = larger(alpha, rate[b] / e->v[b]);
  }
  return alpha;
}

/* v >= first with a small alpha: components that grow by more than their size over the piece are made larger */
static double find_v(errors *e) {
  double rate[N_MAX], alpha = 0;
  for (uint32_t b = 0; b < e->m; b++) e->v[b] = larger(e->first[b], e->delta[b] * 1e-6) + DD_TINY;
  for (int turn = 0; turn < 60; turn++) {
    alpha = exponent(e, rate);
    if (alpha * LENGTH <= 1) return alpha;
    for (uint32_t b = 0; b < e->m; b++) {
      if (!(rate[b] * LENGTH > 0.9 * e->v[b])) continue;
      double own = e->M[b * e->m + b], others = rate[b] - own * e->v[b];
      double wanted = own < 0 ? others / (0.8 / LENGTH - own) : rate[b] * LENGTH;
      e->v[b] = larger(e->v[b] * 1.05, wanted * 1.05);
    }
  }
  return exponent(e, rate);
}

static enum why enclose(stiff *s, errors *e, uint32_t j, uint32_t pieces) {
  matrix_bounds A;
  guess_R(s, e);
  for (int i = 0; i < TRIES; i++) {
    if (!cover(s, e, j, pieces)) return WHY_UNDEFINED;
    rates_bound(s, &A);
    rates_in_blocks(s, &A, e->M);
    double alpha = find_v(e);
    if (!(alpha * LENGTH < MOST_GROWTH)) return WHY_GROWTH;
    double factor = exp_above(s->num, alpha * LENGTH);
    int inside = 1;
    for (uint32_t b = 0; b < e->m; b++) {
      e->most[b] = factor * e->v[b];
      inside &= e->most[b] < e->R[b];
    }
    if (inside) return WHY_NOTHING;
    for (uint32_t b = 0; b < e->m; b++) e->R[b] = larger(e->R[b], 2 * e->most[b]);
  }
  return WHY_GROWTH;
}

/* -- the end: the set in a frame of doubles near B(1), its slow columns of the size of the states */

/* Parameters do not move: where only the first np columns touch them, in rows B_p, and as single blocks, those z are
** B_p^-1 (p - middle), whatever happened on the way. */
static void hold_parameters(stiff *s) {
  carried *c = &s->carried;
  uint32_t n = s->n, nx = s->nx, np = s->np, nu = s->problem.nu;
  square middle, C, T;
  iv B[N_MAX * N_MAX], X[N_MAX * N_MAX];
  if (np == 0 || np + nu > N_MAX || n - c->fast < np) return;
  for (uint32_t i = 0; i < np; i++) {
    for (uint32_t k = np; k < n; k++)
      if (c->B[(nx + i) * n + k] != 0) return;
    for (uint32_t k = 0; k < np; k++) middle[i * np + k] = c->B[(nx + i) * n + k];
    for (uint32_t k = 0; k < nu; k++) X[i * (nu + np) + k] = iv_of(s->start_column[(nx + i) * nu + k]);
    for (uint32_t k = 0; k < np; k++) X[i * (nu + np) + nu + k] = iv_of(i == k ? s->start_rest[nx + i] : 0);
  }
  for (uint32_t i = 0; i < np * np; i++) B[i] = iv_of(middle[i]);
  if (!matrix_inverse(np, middle, C) || !bound_solution(np, C, B, nu + np, X, T)) return;
  for (uint32_t i = 0; i < np; i++) {
    double sum = 0;
    for (uint32_t k = 0; k < nu + np; k++) sum += T[i * (nu + np) + k];
    c->w[c->block[i]] = smaller(c->w[c->block[i]], sum); /* slow columns are blocks of their own */
  }
}

static int leave(stiff *s, const errors *e) {
  const frame *f = &s->frame;
  const split *p = &f->split;
  uint32_t n = s->n;
  carried *c = &s->carried;
  iv B[N_MAX * N_MAX];
  square C, T;
  double z[N_MAX];
  for (uint32_t k = 0; k < n; k++) {
    double most = 0;
    for (uint32_t i = 0; i < n; i++) most = larger(most, fabs(iv_middle(f->end[i * n + k])) / s->q.scale[i]);
    for (uint32_t i = 0; i < n; i++) {
      double x = iv_middle(f->end[i * n + k]);
      c->B[i * n + k] = k < p->slow ? x / most : x;
      int is_rounding = i >= s->nx && k >= s->np && fabs(c->B[i * n + k]) < 1e-9 * s->q.scale[i];
      if (is_rounding) c->B[i * n + k] = 0; /* any B will do, but a parameter in few columns can be held */
    }
  }
  for (uint32_t i = 0; i < n * n; i++) B[i] = iv_of(c->B[i]);
  if (!matrix_inverse(n, c->B, C) || !bound_solution(n, C, B, n, f->end, T)) return 0;
  memcpy(c->block, p->block, n * sizeof *c->block);
  memcpy(c->w, e->last, p->blocks * sizeof *c->w);
  c->blocks = p->blocks, c->fast = p->fast, c->valid = !f->natural;
  carry(n, T, c, p, z);
  memcpy(c->w, z, p->blocks * sizeof *c->w);
  hold_parameters(s);
  return 1;
}

enum why prove_piece(stiff *s, uint32_t j, uint32_t pieces) {
  errors e = { .m = s->frame.split.blocks };
  if (!frame_verify(s) || !enter(s, &e)) return WHY_FRAME;
  bound_defect(s, &e);
  enum why why = enclose(s, &e, j, pieces);
  if (why != WHY_NOTHING) return why;
  const metzler m = { s->num, e.m, e.M, e.delta, e.first, LENGTH, e.most };
  if (!metzler_propagate(&m, e.last)) return WHY_GROWTH;
  for (uint32_t b = 0; b < e.m; b++)
    if (!(e.last[b] < INFINITY && e.most[b] < INFINITY)) return WHY_GROWTH; /* NaN too */
  spread(s, e.most, s->radius);
  return leave(s, &e) ? WHY_NOTHING : WHY_FRAME;
}
