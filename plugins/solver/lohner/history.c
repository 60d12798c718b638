/* history.c -- the generators of everything that is not due to the unknowns: a box per step, condensed by and by.
**
** A group is n generators. The youngest groups are the boxes of the last steps, moved along with the flow and so not
** wrapped at all. When `keep` groups of one level are there, the older half is replaced by one group of the next
** level: the box along the principal axes of their sum. Groups of the highest level are condensed into their own
** level. With keep = 32 no box is wrapped more than three times in the first 65536 boxes (steps, and cuts by
** invariants), and memory is bounded.
** keep = 0 is Lohner's classical set: one orthogonal frame, renewed at every step [Lohner 1988].
**
** Change of frame: let F = D Q, D powers of two, and E = I - Q^T Q with |E| <= eps < 1 in the row-sum norm. Then
**   z = sum_c w_c e_c d_c = F y,  y = (I - E)^-1 Q^T D^-1 z,  |y_j| <= v_j + eps / (1 - eps) max v,
**   v_j = sum_c w_c |Q^T D^-1 d_c|_j.
** Principal axes are taken in coordinates in which every state has about the same size, so they do not depend on
** units.
*/
#include "history.h"
#include "shared/axes.h"
#include <string.h>

#define TOP_LEVEL 3
#define BLOCK 8
#define LARGEST_EXPONENT 900
#define SMALLEST_ENTRY 0x1p-100 /* of a frame: products with powers of two stay normal, hence exact */

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, count ? count * size : size); }

int history_open(const ambit_host *h, history *g, uint32_t n, uint32_t keep) {
  *g = (history) { .n = n, .keep = keep, .room = keep ? (TOP_LEVEL + 1) * keep + 1 : 2 };
  g->pitch = ((size_t)g->room * n + BLOCK - 1) / BLOCK * BLOCK;
  g->level = room(h, g->room, sizeof *g->level);
  g->direction = room(h, g->pitch * n, sizeof(double));
  g->weight = room(h, g->pitch, sizeof(double));
  g->block = room(h, (size_t)n * BLOCK, sizeof(double));
  g->frame = room(h, (size_t)n * n, sizeof(double));
  g->shape = room(h, (size_t)n * n, sizeof(double));
  g->size = room(h, n, sizeof(double));
  g->sum = room(h, n, sizeof(double));
  g->unit = room(h, n, sizeof(double));
  g->order = room(h, n, sizeof *g->order);
  return g->level && g->direction && g->weight && g->block && g->frame && g->shape && g->size && g->sum && g->unit &&
         g->order;
}

static size_t columns(const history *g) { return (size_t)g->group * g->n; }
static size_t padded(const history *g) { return (columns(g) + BLOCK - 1) / BLOCK * BLOCK; }

void history_clear(history *g) {
  g->group = 0;
  memset(g->weight, 0, g->pitch * sizeof(double));
  memset(g->direction, 0, g->pitch * g->n * sizeof(double));
}

/* -- sums and products; columns behind the last group are zero */

void history_sum(const history *g, double *rest) {
  size_t count = padded(g);
  for (uint32_t i = 0; i < g->n; i++) {
    const double *row = g->direction + i * g->pitch;
    double sum[BLOCK] = { 0 };
    for (size_t c = 0; c < count; c += BLOCK)
      for (int k = 0; k < BLOCK; k++) sum[k] += fabs(row[c + (size_t)k]) * g->weight[c + (size_t)k];
    rest[i] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
  }
}

static void multiply_block(history *g, const double *M, size_t pitch, size_t c) {
  for (uint32_t j = 0; j < g->n; j++)
    memcpy(g->block + (size_t)j * BLOCK, g->direction + j * g->pitch + c, BLOCK * sizeof(double));
  for (uint32_t i = 0; i < g->n; i++) {
    double sum[BLOCK] = { 0 };
    for (uint32_t j = 0; j < g->n; j++) {
      double m = M[i * pitch + j];
      const double *b = g->block + (size_t)j * BLOCK;
      for (int k = 0; k < BLOCK; k++) sum[k] += m * b[k];
    }
    memcpy(g->direction + i * g->pitch + c, sum, sizeof sum);
  }
}

/* A sum of n products, each operation with relative error 2^-52 at most, is off by (n + 1) 2^-52 times the sum of
** magnitudes at most [Higham, Accuracy and Stability, ch. 3], and by 2^-1074 for each product that underflows. */
void history_multiply(history *g, const double *M, size_t pitch, const double *rest, double *pad) {
  double weight = 0, gamma = (double)(g->n + 1) * 0x1p-52;
  for (size_t c = 0; c < columns(g); c++) weight += g->weight[c];
  for (uint32_t i = 0; i < g->n; i++) {
    double sum = 0;
    for (uint32_t j = 0; j < g->n; j++) sum += fabs(M[i * pitch + j]) * rest[j];
    pad[i] += gamma * sum + weight * ((double)g->n * 0x1p-1073);
  }
  for (size_t c = 0; c < padded(g); c += BLOCK) multiply_block(g, M, pitch, c);
}

/* -- how the generators lie to a subspace */

void history_spread(const history *g, uint32_t k, const double *J, size_t pitch, double *spread) {
  size_t count = padded(g);
  for (uint32_t r = 0; r < k; r++) {
    double *out = spread + r * g->pitch;
    memset(out, 0, g->pitch * sizeof *out);
    for (uint32_t i = 0; i < g->n; i++) {
      const double *row = g->direction + i * g->pitch;
      double factor = J[r * pitch + i];
      for (size_t c = 0; c < count && factor != 0; c++) out[c] += factor * row[c];
    }
    for (size_t c = 0; c < count; c++) out[c] *= g->weight[c];
  }
}

void history_correlate(const history *g, uint32_t k, const double *spread, double *cross, double *square) {
  size_t count = padded(g);
  for (uint32_t i = 0; i < g->n; i++) {
    const double *row = g->direction + i * g->pitch;
    double sum = 0;
    for (size_t c = 0; c < count; c++) sum += (row[c] * g->weight[c]) * (row[c] * g->weight[c]);
    square[i] = sum;
    for (uint32_t r = 0; r < k; r++) {
      double product = 0;
      for (size_t c = 0; c < count; c++) product += (row[c] * g->weight[c]) * spread[r * g->pitch + c];
      cross[(size_t)r * g->n + i] = product;
    }
  }
}

/* -- condensing */

/* the power of two near x */
static double unit_of(double x) {
  int exponent = 0;
  if (!(x > 0) || !(x < INFINITY)) return 1;
  frexp(x, &exponent);
  if (exponent > LARGEST_EXPONENT) exponent = LARGEST_EXPONENT;
  if (exponent < -LARGEST_EXPONENT) exponent = -LARGEST_EXPONENT;
  return ldexp(1, exponent);
}

static void choose_units(history *g, size_t from, size_t to) {
  for (uint32_t i = 0; i < g->n; i++) {
    double sum = 0;
    g->unit[i] = 1;
    if (!g->keep) continue; /* a frame that turns because units jump would wrap anew at every step */
    for (size_t c = from; c < to; c++) sum += fabs(g->direction[i * g->pitch + c]) * g->weight[c];
    g->unit[i] = unit_of(sum);
  }
}

/* shape := sum of w^2 d d^T, in units */
static void choose_axes(history *g, size_t from, size_t to) {
  uint32_t n = g->n;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j <= i; j++) {
      const double *a = g->direction + i * g->pitch, *b = g->direction + j * g->pitch;
      double sum = 0, u = 1 / g->unit[i], v = 1 / g->unit[j];
      for (size_t c = from; c < to; c++) sum += (a[c] * g->weight[c] * u) * (b[c] * g->weight[c] * v);
      g->shape[(size_t)i * n + j] = g->shape[(size_t)j * n + i] = sum;
    }
  shared_axes(n, g->shape, g->frame);
}

static void choose_frame(history *g, size_t from) {
  uint32_t n = g->n;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++) g->shape[(size_t)i * n + j] = g->direction[i * g->pitch + from + j] / g->unit[i];
  frame_orthogonal(n, g->shape, n, g->weight + from, g->frame, g->order, g->size);
}

/* tiny entries dropped; the frame's defect, after falling back to the axes of coordinates if there is no better */
static double settle_frame(history *g) {
  size_t entries = (size_t)g->n * g->n;
  for (size_t k = 0; k < entries; k++)
    if (fabs(g->frame[k]) < SMALLEST_ENTRY) g->frame[k] = 0;
  double defect = frame_defect(g->n, g->frame);
  if (defect < 0.5) return defect;
  for (size_t k = 0; k < entries; k++) g->frame[k] = k % (g->n + 1u) == 0;
  return 0;
}

/* sum[j] >= |y_j| without the defect's share */
static void project(history *g, size_t from, size_t to) {
  uint32_t n = g->n;
  memset(g->sum, 0, n * sizeof(double));
  for (size_t c = from; c < to; c++) {
    for (uint32_t i = 0; i < n; i++) g->size[i] = g->direction[i * g->pitch + c] / g->unit[i];
    for (uint32_t j = 0; j < n; j++) {
      double above = 0, below = 0;
      for (uint32_t i = 0; i < n; i++) {
        double q = g->frame[(size_t)i * n + j], d = g->size[i];
        above += q * d;
        below += (-q) * d;
      }
      /* a quotient that underflows is off by 2^-1074 at most */
      g->sum[j] += (larger(above, below) + (double)n * 0x1p-1073) * g->weight[c];
    }
  }
}

/* groups [first, first + count) become one, of the given level */
static void condense(history *g, uint32_t first, uint32_t count, uint32_t level) {
  uint32_t n = g->n;
  size_t from = (size_t)first * n, to = from + (size_t)count * n, end = columns(g), gone = (size_t)(count - 1) * n;
  choose_units(g, from, to);
  if (g->keep)
    choose_axes(g, from, to);
  else
    choose_frame(g, from);
  double defect = settle_frame(g), most = 0;
  project(g, from, to);
  for (uint32_t j = 0; j < n; j++) most = larger(most, g->sum[j]);
  double pad = defect / -(defect - 1) * most;
  for (uint32_t i = 0; i < n; i++) {
    double *row = g->direction + i * g->pitch;
    for (uint32_t j = 0; j < n; j++) row[from + j] = g->unit[i] * g->frame[(size_t)i * n + j];
    memmove(row + from + n, row + to, (end - to) * sizeof *row);
    memset(row + end - gone, 0, gone * sizeof *row);
  }
  for (uint32_t j = 0; j < n; j++) g->weight[from + j] = g->sum[j] + pad;
  memmove(g->weight + from + n, g->weight + to, (end - to) * sizeof(double));
  memset(g->weight + end - gone, 0, gone * sizeof(double));
  g->level[first] = level;
  memmove(g->level + first + 1, g->level + first + count, (g->group - first - count) * sizeof *g->level);
  g->group -= count - 1;
}

/* levels descend from the oldest group to the youngest */
static void compact(history *g) {
  uint32_t end = g->group;
  for (uint32_t level = 0; level <= TOP_LEVEL; level++) {
    uint32_t first = end;
    while (first > 0 && g->level[first - 1] == level) first--;
    if (end - first < g->keep) return;
    condense(g, first, g->keep / 2, level < TOP_LEVEL ? level + 1 : level);
    end = first + 1;
  }
}

void history_push(history *g, const double *box) {
  uint32_t n = g->n;
  size_t from = columns(g);
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t j = 0; j < n; j++) g->direction[i * g->pitch + from + j] = i == j;
    g->weight[from + i] = box[i];
  }
  g->level[g->group++] = 0;
  if (g->keep)
    compact(g);
  else if (g->group == 2)
    condense(g, 0, 2, 0);
}
