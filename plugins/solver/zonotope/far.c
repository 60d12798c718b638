/* far.c -- terms of degree 3 in data that have no triples in rows.
**
** Rows hold triples of the first data only: their number grows with the cube. What products leave out of the others
** is known at the middle of the step, like terms of degree 4 (quartic.c). That costs one product a step instead of one
** for each two orders in time, and no memory in rows. Data are taken in groups, and of three groups all triples or
** none: those whose triples are worth most for their number.
*/
#include "quartic.h"
#include "proof.h"

#define MOST 30000 /* triples */
#define ROOM 1e6   /* doubles of sums by states and triples, at most */
#define NEAR 3     /* groups of data that have triples in rows */
#define OF_GROUP 8 /* data, about, in others */

static size_t triples_of(size_t n) { return n * (n + 1) * (n + 2) / 6; }

/* do rows have all pairs? */
static int has_pairs(const shape *s) {
  for (uint32_t i = 0; i < s->m; i++)
    if (s->reach[i] < s->m) return 0;
  return 1;
}

int far_open(zono *z) {
  quartic *q = z->proof->quartic;
  far *f = &q->far;
  uint32_t m = z->m, near = z->shape.cubic, others = m - near, room = FAR_GROUPS - NEAR;
  q->shape = &z->shape;
  if (others == 0 || q->most == 0 || !has_pairs(&z->shape)) return 1;
  uint32_t parts = (others + OF_GROUP - 1) / OF_GROUP;
  if (parts > room) parts = room;
  for (uint32_t g = 0; g < NEAR; g++) f->from[g] = g * near / NEAR;
  for (uint32_t g = 0; g <= parts; g++) f->from[NEAR + g] = near + g * others / parts;
  f->groups = NEAR + parts;
  size_t all = triples_of(m) - triples_of(near), runs = (size_t)m * (m + 1) / 2 * f->groups;
  size_t most = (size_t)(ROOM / z->nx);
  if (most > MOST) most = MOST;
  f->most = (uint32_t)(all < most ? all : most);
  f->run = z->host->alloc(z->host, runs * sizeof *f->run);
  return f->run != NULL;
}

/* -- choice */

/* of a datum and a pair in groups g and u <= v: the place of their triples in a table */
static size_t sorted(uint32_t g, uint32_t u, uint32_t v) {
  uint32_t first = g < u ? g : u, last = g > v ? g : v, middle = g + u + v - first - last;
  return ((size_t)first * FAR_GROUPS + middle) * FAR_GROUPS + last;
}

/* sizes of linear terms by group, of pairs by groups */
static void find_blocks(const quartic *q, const double *row, double *l, double pairs[FAR_GROUPS][FAR_GROUPS]) {
  const shape *s = q->shape;
  const uint32_t *from = q->far.from, n = q->far.groups;
  memset(pairs, 0, FAR_GROUPS * sizeof *pairs);
  for (uint32_t g = 0; g < n; g++) {
    l[g] = 0;
    for (uint32_t i = from[g]; i < from[g + 1]; i++) {
      const double *x = row + s->pair[i] - i;
      l[g] += fabs(row[1 + i]);
      for (uint32_t h = g; h < n && row_q(s, row) > 0; h++) {
        double sum = 0;
        for (uint32_t j = h == g ? i : from[h]; j < from[h + 1]; j++) sum += fabs(x[j]);
        pairs[g][h] += sum;
      }
    }
  }
}

/* worth += what products drop of each triple of groups at order 0, by the budgets of the states */
static void find_worth(zono *z) {
  quartic *q = z->proof->quartic;
  const ambit_tape *t = z->program.tape;
  double *worth = &q->far.worth[0][0][0], l[2][FAR_GROUPS], pairs[2][FAR_GROUPS][FAR_GROUPS];
  memset(q->far.worth, 0, sizeof q->far.worth);
  for (uint32_t j = 0; j < z->nslot; j++) {
    if (!q->chosen[j] || !(z->rr[j] > 0)) continue;
    uint32_t i = q->made[j], a = t->a[i], b = t->op[i] == AMBIT_OP_SQR ? a : t->b[i];
    find_blocks(q, row_at(z, a, 0), l[0], pairs[0]), find_blocks(q, row_at(z, b, 0), l[1], pairs[1]);
    for (int n = 0; n < 2; n++)
      for (uint32_t g = 0; g < q->far.groups; g++)
        for (uint32_t u = 0; u < q->far.groups; u++)
          for (uint32_t v = u; v < q->far.groups; v++) {
            double size = l[n][g] * pairs[!n][u][v];
            if (size > 0) worth[sorted(g, u, v)] += q->weight[j] / z->rr[j] * size; /* a weight may be infinite */
          }
  }
}

static double count_of(const far *f, uint32_t g, uint32_t h, uint32_t l) {
  double a = f->from[g + 1] - f->from[g], b = f->from[h + 1] - f->from[h], c = f->from[l + 1] - f->from[l];
  if (g == l) return a * (a + 1) * (a + 2) / 6;
  return g == h ? a * (a + 1) / 2 * c : h == l ? a * b * (b + 1) / 2 : a * b * c;
}

/* holds the triples of three groups that are worth most for their number, and fit; returns how many: 0, none */
static double hold_next(far *f, double room) {
  double most = 0, count = 0;
  uint8_t *best = NULL;
  for (uint32_t g = 0; g < f->groups; g++)
    for (uint32_t h = g; h < f->groups; h++)
      for (uint32_t l = h > NEAR ? h : NEAR; l < f->groups; l++) {
        double n = count_of(f, g, h, l);
        if (f->held[g][h][l] || n == 0 || n > room || !(f->worth[g][h][l] / n > most)) continue;
        most = f->worth[g][h][l] / n, count = n, best = &f->held[g][h][l];
      }
  if (best) *best = 1;
  return count;
}

/* triples of datum i and those from j on: the runs of a row of the table; returns how many */
static uint32_t list_runs(far *f, uint32_t g, uint32_t i, uint32_t h, uint32_t j) {
  uint32_t count = 0, first = f->nrun;
  for (uint32_t l = h; l < f->groups; l++) {
    uint32_t from = l == h ? j : f->from[l], to = f->from[l + 1];
    if (!f->held[g][h][l]) continue;
    count += to - from;
    if (f->nrun > first && f->run[f->nrun - 1].to == from)
      f->run[f->nrun - 1].to = to;
    else
      f->run[f->nrun++] = (far_run) { i, j, from, to };
  }
  return count;
}

void far_choose(zono *z) {
  quartic *q = z->proof->quartic;
  far *f = &q->far;
  double room = f->most, count;
  f->nrun = 0, q->length = q->fourth;
  if (f->groups == 0 || q->n == 0) return;
  memset(f->held, 0, sizeof f->held);
  find_worth(z);
  while ((count = hold_next(f, room)) > 0) room -= count;
  for (uint32_t g = 0; g < f->groups; g++)
    for (uint32_t i = f->from[g]; i < f->from[g + 1]; i++)
      for (uint32_t h = g; h < f->groups; h++)
        for (uint32_t j = h == g ? i : f->from[h]; j < f->from[h + 1]; j++) q->length += list_runs(f, g, i, h, j);
}

/* -- operands */

void far_take(const zono *z, operand *o, uint32_t slot, double power) {
  const quartic *q = z->proof->quartic;
  const shape *s = &z->shape;
  const uint8_t *held = &q->far.held[0][0][0];
  uint32_t n = q->far.groups, pairs = s->mix - s->pair[0];
  double block[FAR_GROUPS][FAR_GROUPS];
  memset(o->all_l, 0, s->m * sizeof(double)), memset(o->all_q, 0, pairs * sizeof(double));
  for (uint32_t k = 0; k < orders(z, slot); k++, power *= 0.5 * z->h) {
    const double *row = row_at(z, slot, k);
    find_blocks(q, row, o->size_group[k], block);
    q->add(o->all_l, power, row + 1, s->m);
    if (row_q(s, row) > 0) q->add(o->all_q, power, row + s->pair[0], pairs);
    for (uint32_t g = 0; g < n; g++) {
      o->size_with[k][g] = 0;
      for (uint32_t u = 0; u < n; u++)
        for (uint32_t v = u; v < n; v++)
          if (held[sorted(g, u, v)]) o->size_with[k][g] += block[u][v];
    }
  }
}

double far_size(const quartic *q, uint32_t i, uint32_t j) {
  const operand *a = &q->a, *b = &q->b;
  double sum = 0;
  for (uint32_t g = 0; g < q->far.groups && q->far.nrun; g++)
    sum += a->size_group[i][g] * b->size_with[j][g] + a->size_with[i][g] * b->size_group[j][g];
  return sum;
}
