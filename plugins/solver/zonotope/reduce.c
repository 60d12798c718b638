/* reduce.c -- fewer generators.
**
** In units of the states' sizes, the columns that are nearest to an axis, or shortest, leave [Girard 2005]. One that is
** nearly parallel to one that stays is joined with it: for symbols p and q,
** a p + s b q = (share p + (1 - share) q) (a + s b) + what goes into the box (docs/numerics/zonotope.md, section 7).
** The others go into the box, or into discs where there are any.
*/
#include "reduce.h"
#include "depend.h"
#include "modes.h"
#include "proof.h"
#include "vary.h"

#define FEW 4        /* columns for each state, beside discs */
#define PARALLEL 0.1 /* what a join may cost, in parts of what the column costs in the box */
#define NOTHING 0.01 /* of the mean size of those that leave: what is smaller is not worth a join */

/* -- two become one */

joint joint_of(const zono *z, const double *a, const double *b) {
  const double *unit = z->proof->spread;
  double aa = 0, ab = 0, bb = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    double x = a[i] / unit[i], y = b[i] / unit[i];
    aa += x * x, ab += x * y, bb += y * y;
  }
  joint j = { 0.5, ab < 0 ? -1 : 1, 0 };
  double whole = aa + 2 * fabs(ab) + bb;
  if (whole > 0) j.share = fmin(fmax((aa + fabs(ab)) / whole, 0), 1);
  for (uint32_t i = 0; i < z->nx; i++) j.left += 2 * fabs((1 - j.share) * a[i] - j.share * j.sign * b[i]) / unit[i];
  return j;
}

void join(zono *z, double *a, const double *b, joint j, enum origin from) {
  for (uint32_t i = 0; i < z->nx; i++) {
    double other = j.sign * b[i], sum = a[i] + other;
    double left = fabs(a[i] - j.share * sum) + fabs(other - (1 - j.share) * sum);
    *box(z, from, i) += left + 8 * UNIT * (fabs(a[i]) + fabs(other));
    a[i] = sum;
  }
}

double boxed_size(const zono *z, const double *g) {
  double sum = 0, most = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    double u = fabs(g[i]) / z->proof->spread[i];
    sum += u, most = fmax(most, u);
  }
  return 2 * (sum - most);
}

/* -- those that stay */

/* the k-th largest of x [n], which is rearranged */
static double ranked(double *x, uint32_t n, uint32_t k) {
  uint32_t from = 0, to = n - 1;
  while (from < to) {
    double pivot = x[from + (to - from) / 2];
    uint32_t i = from, j = to;
    while (i <= j) {
      while (x[i] > pivot) i++;
      while (x[j] < pivot) j--;
      if (i > j) break;
      double old = x[i];
      x[i++] = x[j], x[j] = old;
      if (j == 0) break;
      j--;
    }
    if (k <= j)
      to = j;
    else if (k >= i)
      from = i;
    else
      break;
  }
  return x[k];
}

static void find_scores(const zono *z, uint32_t n) {
  const proof *p = z->proof;
  for (uint32_t c = 0; c < n; c++) {
    const double *g = p->columns + (size_t)c * z->nx;
    double sum = 0, most = 0;
    for (uint32_t i = 0; i < z->nx; i++) {
      double u = (fabs(g[i]) + depend_depth(z, c, i)) / p->spread[i];
      sum += u, most = fmax(most, u);
    }
    p->score[c] = p->source[c] ? INFINITY : sum - most;
  }
}

/* scores of columns that are not kept := 0; of equal ones, many of which may be along one state, the first are */
static void choose_columns(const zono *z, uint32_t n, uint32_t room) {
  const proof *p = z->proof;
  if (n <= room) {
    for (uint32_t c = 0; c < n; c++) p->score[c] = 1;
    return;
  }
  find_scores(z, n);
  memcpy(p->sorted, p->score, n * sizeof(double));
  double least = ranked(p->sorted, n, room - 1);
  uint32_t ties = room;
  for (uint32_t c = 0; c < n; c++) ties -= p->score[c] > least;
  for (uint32_t c = 0; c < n; c++)
    if (p->score[c] == least && ties > 0)
      p->score[c] = 1, ties--;
    else if (!(p->score[c] > least))
      p->score[c] = 0;
}

/* sizes of the states' sets at the end, for scores */
static void find_spread(const zono *z, uint32_t n) {
  proof *p = z->proof;
  for (uint32_t i = 0; i < z->nx; i++) p->spread[i] = 0;
  for (uint32_t c = 0; c < n; c++)
    for (uint32_t i = 0; i < z->nx; i++)
      p->spread[i] += fabs(p->columns[(size_t)c * z->nx + i]) + depend_depth(z, c, i);
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *y = p->end + (size_t)i * z->shape.stride;
    p->spread[i] += row_l(&z->shape, y) + row_q(&z->shape, y) + row_c(&z->shape, y);
    for (uint32_t o = 0; o < ORIGINS; o++) p->spread[i] += *box(z, o, i);
    if (!(p->spread[i] > LEAST / UNIT)) p->spread[i] = 1; /* nothing but what underflows */
  }
}

/* the box as columns behind the `kept` ones of G */
static uint32_t put_box(zono *z, uint32_t kept) {
  proof *p = z->proof;
  for (uint32_t i = 0; i < z->nx; i++) {
    double *g = z->G + (size_t)kept * z->nx, sum = 0, most = -1;
    for (uint32_t o = 0; o < ORIGINS; o++) {
      double part = *box(z, o, i);
      sum += part;
      if (part > most) most = part, p->from[kept] = (uint8_t)o;
    }
    if (sum == 0) continue;
    memset(g, 0, z->nx * sizeof *g);
    g[i] = sum * ABOVE;
    p->made_by[kept++] = 0;
  }
  return kept;
}

/* -- those that leave */

/* in four sums, none of which waits for the others */
static double product(const zono *z, const double *a, const double *weighed) {
  double sum[4] = { 0, 0, 0, 0 };
  uint32_t i = 0;
  for (; i + 4 <= z->nx; i += 4)
    for (uint32_t k = 0; k < 4; k++) sum[k] += a[i + k] * weighed[i + k];
  for (; i < z->nx; i++) sum[0] += a[i] * weighed[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* w := g in units of the states' sets, twice, so that products with it are those of directions */
static void weigh(const zono *z, const double *g, double *w) {
  for (uint32_t i = 0; i < z->nx; i++) w[i] = g[i] / z->proof->spread[i] / z->proof->spread[i];
}

/* the column of G [kept] whose direction is nearest to that of g; squares [kept] of them in these units; kept: none */
static uint32_t nearest(const zono *z, const double *g, uint32_t kept, const double *squares, double *w) {
  uint32_t best = kept;
  double most = 0;
  weigh(z, g, w);
  for (uint32_t c = 0; c < kept; c++) {
    double both = product(z, z->G + (size_t)c * z->nx, w), cosine = both * both;
    if (squares[c] > 0 && cosine > most * squares[c]) most = cosine / squares[c], best = c;
  }
  return best;
}

/* Columns [left] join those of G [kept], or go into discs or the box. */
static void leave(zono *z, uint32_t kept, uint32_t left) {
  proof *p = z->proof;
  uint32_t nx = z->nx, joins = z->modes->now.any || p->depend->any ? 0 : left;
  double *squares = p->sorted, *w = p->grow, all = 0;
  for (uint32_t c = 0; c < joins; c++) all += boxed_size(z, p->columns + (size_t)c * nx);
  for (uint32_t c = 0; c < kept && joins > 0; c++) {
    weigh(z, z->G + (size_t)c * nx, w);
    squares[c] = p->made_by[c] ? 0 : product(z, z->G + (size_t)c * nx, w);
  }
  for (uint32_t c = 0; c < left; c++) {
    const double *g = p->columns + (size_t)c * nx;
    double alone = joins > 0 ? boxed_size(z, g) : 0;
    uint32_t to = alone * joins > NOTHING * all ? nearest(z, g, kept, squares, w) : kept;
    joint j = to < kept ? joint_of(z, z->G + (size_t)to * nx, g) : (joint) { 0, 0, INFINITY };
    if (j.left < PARALLEL * alone) {
      join(z, z->G + (size_t)to * nx, g, j, p->origin[c]);
      weigh(z, z->G + (size_t)to * nx, w);
      squares[to] = product(z, z->G + (size_t)to * nx, w);
    } else
      discs_put(z, g, p->origin[c]);
  }
}

void reduce(zono *z, uint32_t n) {
  proof *p = z->proof;
  uint32_t nx = z->nx, room = z->ngen_max - nx, kept = 0, left = 0;
  if (z->modes->now.any && !z->problem.njump && FEW * nx < room) room = FEW * nx;
  find_spread(z, n);
  n = vary_merge(z, n);
  choose_columns(z, n, room);
  for (uint32_t c = 0; c < n; c++) {
    const double *g = p->columns + (size_t)c * nx;
    if (kept < room && p->score[c] > 0) { /* with NaN among them, more may have a score */
      p->from[kept] = p->origin[c], p->made_by[kept] = p->source[c], p->depend->kept[kept] = c;
      memcpy(z->G + (size_t)kept++ * nx, g, nx * sizeof *g);
    } else {
      for (uint32_t i = 0; i < nx; i++) *box(z, FROM_MIXED, i) += depend_depth(z, c, i) * ABOVE;
      memmove(p->columns + (size_t)left * nx, g, nx * sizeof *g);
      p->origin[left++] = p->origin[c];
    }
  }
  leave(z, kept, left);
  depend_keep(z, kept);
  discs_finish(z);
  z->ngen = put_box(z, kept);
}
