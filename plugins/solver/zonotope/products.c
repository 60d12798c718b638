/* products.c -- memory of quartic.c, and which products and data it takes.
**
** Products that a sum takes and nothing else are a group: the coefficient of each in everything is the sum's, up to the
** sign. Products that add little to the states' sets are left to their lumps.
*/
#include "quartic.h"
#include "proof.h"

#define MOST 27  /* data */
#define ROOM 1e6 /* doubles of sums, at most */
#define LEFT 1   /* of the states' budgets: what is left to lumps that add little */
#define WORTH 1  /* of the states' budgets: what lumps must add, or they are left as they are */

static int doubles(const ambit_host *h, size_t n, double **to) {
  *to = h->alloc(h, (n + 4) * sizeof(double));
  return *to != NULL;
}
static int numbers(const ambit_host *h, size_t n, uint32_t **to) {
  *to = h->alloc(h, (n ? n : 1) * sizeof(uint32_t));
  return *to != NULL;
}

static size_t monomials(size_t n) { return n * (n + 1) * (n + 2) * (n + 3) / 24; }

static int open_operand(const ambit_host *h, operand *o, size_t n, size_t nx, size_t m) {
  return doubles(h, n, &o->l) && doubles(h, n * (n + 1) / 2, &o->q) && doubles(h, n * (n + 1) * (n + 2) / 6, &o->c) &&
         doubles(h, nx, &o->r) && doubles(h, n * nx, &o->x) && doubles(h, m, &o->all_l) &&
         doubles(h, m * (m + 1) / 2, &o->all_q);
}

static int is_product(uint32_t op) { return op == AMBIT_OP_MUL || op == AMBIT_OP_SQR; }
static int has_second(uint32_t op) {
  return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 ||
         op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}

/* A slot that is used once, in a sum, has the sum's coefficient in everything, up to the sign. */
static void find_roots(zono *z, uint32_t *uses) {
  quartic *q = z->proof->quartic;
  const ambit_tape *t = z->program.tape;
  for (uint32_t j = 0; j < z->nslot; j++) q->root[j] = j, q->next[j] = AMBIT_NO_SLOT, q->sign[j] = 1, uses[j] = 0;
  for (uint32_t o = 0; o < z->nout; o++) uses[slot_out(z)[o]] = 2;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uses[t->a[i]]++;
    if (has_second(t->op[i])) uses[t->b[i]]++;
  }
  for (uint32_t i = t->ninstr; i-- > 0;) {
    uint32_t op = t->op[i], dst = t->dst[i], a = t->a[i], b = t->b[i];
    q->made[dst] = i;
    if (op != AMBIT_OP_ADD && op != AMBIT_OP_SUB && op != AMBIT_OP_NEG) continue;
    if (uses[a] == 1) q->root[a] = q->root[dst], q->sign[a] = op == AMBIT_OP_NEG ? -q->sign[dst] : q->sign[dst];
    if (op != AMBIT_OP_NEG && uses[b] == 1)
      q->root[b] = q->root[dst], q->sign[b] = op == AMBIT_OP_SUB ? -q->sign[dst] : q->sign[dst];
  }
}

/* lists of the products of a sum: the first by uses[root] */
static void find_groups(zono *z, uint32_t *last) {
  quartic *q = z->proof->quartic;
  const ambit_tape *t = z->program.tape;
  for (uint32_t j = 0; j < z->nslot; j++) last[j] = AMBIT_NO_SLOT;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t dst = t->dst[i], *end = last + q->root[dst];
    if (!is_product(t->op[i])) continue;
    if (*end != AMBIT_NO_SLOT) q->next[*end] = dst;
    *end = dst;
  }
}

static int open_groups(zono *z) {
  quartic *q = z->proof->quartic;
  const ambit_host *h = z->host;
  size_t n = z->nslot + 1u;
  uint32_t *work;
  if (!doubles(h, n, &q->weight)) return 0;
  q->chosen = h->alloc(h, n), q->sign = h->alloc(h, n);
  if (!q->chosen || !q->sign || !numbers(h, n, &q->root) || !numbers(h, n, &q->next) || !numbers(h, n, &q->made) ||
      !numbers(h, n, &work))
    return 0;
  find_roots(z, work);
  find_groups(z, work);
  return 1;
}

static int open_squares(zono *z) {
  quartic *q = z->proof->quartic;
  size_t square = (size_t)z->nx * z->nx;
  q->squares = z->nvarying > 0;
  return !q->squares ||
         (doubles(z->host, square, &q->square_group) && doubles(z->host, (z->nx + z->na) * square, &q->square_sum));
}

int quartic_open(zono *z) {
  const ambit_host *h = z->host;
  quartic *q = z->proof->quartic = h->alloc(h, sizeof *q);
  if (!q) return 0;
  q->nx = z->nx;
  q->most = z->K_max == 0 ? 0 : z->shape.cubic < MOST ? z->shape.cubic : MOST;
  while (q->most > 0 && (double)monomials(q->most) * z->nx > ROOM) q->most--;
  if (!far_open(z)) return 0;
  size_t n = q->most, length = monomials(n) + q->far.most;
  q->multiply = quartic_portable, q->multiply_far = far_portable, q->add = add_portable;
#if defined(__x86_64__)
  if (z->shape.sum == sum_avx2) q->multiply = quartic_avx2, q->multiply_far = far_avx2, q->add = add_avx2;
#endif
  return numbers(h, n, &q->datum) && numbers(h, n, &q->pair) && numbers(h, n * n, &q->triple) &&
         numbers(h, n * (n + 1) / 2, &q->pair_at) && numbers(h, n * (n + 1) * (n + 2) / 6, &q->triple_at) &&
         open_operand(h, &q->a, n, z->nx, z->m) && open_operand(h, &q->b, n, z->nx, z->m) &&
         doubles(h, n * (n + 1) / 2 * z->nx, &q->near) && doubles(h, n * (n + 1) / 2 * z->nx * z->nx, &q->near_sum) &&
         doubles(h, length, &q->product) && doubles(h, length * z->nx, &q->sum) &&
         doubles(h, length * z->nx, &q->term) && doubles(h, length * z->nx, &q->moved) &&
         doubles(h, z->nx + z->na, &q->rounding) && doubles(h, z->nx, &q->size) && doubles(h, length, &q->group) &&
         doubles(h, n * (n + 1) / 2 * z->nx, &q->near_group) && open_squares(z) && open_groups(z);
}

/* -- choice */

/* the rate of lump j by the budgets of the states (pace.c), the most */
static double weight_of(const zono *z, uint32_t j) {
  const proof *p = z->proof;
  double most = 0;
  for (uint32_t i = 0; i < z->nx && z->rr[j] > 0; i++) {
    double c = p->link[i] == LINK_STATE ? 0 : fabs(p->C[(size_t)p->link_to[i] * z->nslot + j]);
    if (c > 0) most = fmax(most, c * z->rr[j] / p->budget[i]);
  }
  return most;
}

/* sum of the weights of products below `least` */
static double left_below(const zono *z, double least) {
  const ambit_tape *t = z->program.tape;
  double sum = 0;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    double w = is_product(t->op[i]) ? z->proof->quartic->weight[t->dst[i]] : 0;
    if (w < least) sum += w;
  }
  return sum;
}

/* the largest products: those that are left to their lumps add up to LEFT at most */
static int choose_slots(zono *z) {
  const ambit_tape *t = z->program.tape;
  quartic *q = z->proof->quartic;
  double all = 0, least = 0, above = LEFT;
  q->count = 0;
  for (uint32_t j = 0; j < z->nslot; j++) all += q->weight[j] = weight_of(z, j), q->chosen[j] = 0;
  if (!(all > WORTH)) return 0;
  for (int n = 0; n < 20; n++) {
    double middle = 0.5 * (least + above);
    if (left_below(z, middle) <= LEFT)
      least = middle;
    else
      above = middle;
  }
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (is_product(t->op[i]) && q->weight[t->dst[i]] >= least) q->chosen[t->dst[i]] = 1, q->count++;
  return q->count > 0;
}

/* does a state depend on the datum? */
static int moves(const zono *z, uint32_t d) {
  for (uint32_t i = 0; i < z->nx; i++)
    for (uint32_t k = 0; k < orders(z, slot_x(z, i)); k++)
      if (row_at(z, slot_x(z, i), k)[1 + d] != 0) return 1;
  return 0;
}

/* once: those that move the states */
static void choose_data(zono *z) {
  quartic *q = z->proof->quartic;
  for (uint32_t d = 0; d < z->shape.cubic && q->n < q->most; d++)
    if (moves(z, d)) q->datum[q->n++] = d;
}

/* where what is in a row */
static void place(zono *z) {
  quartic *q = z->proof->quartic;
  const shape *s = &z->shape;
  uint32_t n = q->n, pairs = 0, triples = 0, cubic = s->cubic;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t u = q->datum[i];
    q->pair[i] = pairs;
    for (uint32_t j = i; j < n; j++) {
      uint32_t v = q->datum[j], left = cubic - u;
      /* triples of data below u, and of u and data below v, are before it */
      uint32_t at = s->triples - left * (left + 1) * (left + 2) / 6;
      at += left * (left + 1) / 2 - (cubic - v) * (cubic - v + 1) / 2;
      q->pair_at[pairs++] = s->pair[u] + v - u;
      q->triple[i * n + j] = triples;
      for (uint32_t k = j; k < n; k++) q->triple_at[triples++] = s->cube + at + q->datum[k] - v;
    }
  }
  q->pairs = pairs, q->triples = triples, q->length = q->fourth = (uint32_t)monomials(n);
}

int quartic_begin(zono *z) {
  quartic *q = z->proof->quartic;
  if ((q->most == 0 && !q->squares) || !choose_slots(z)) return 0;
  if (q->n == 0) choose_data(z), place(z);
  if (q->n == 0 && !q->squares) return q->count = 0, 0;
  if (!q->held) far_choose(z);
  if (!q->held) memset(q->moved, 0, (size_t)z->nx * q->length * sizeof(double));
  for (uint32_t i = 0; i < z->nx; i++) memset(q->sum + (size_t)i * q->length, 0, q->length * sizeof(double));
  memset(q->near_sum, 0, (size_t)z->nx * q->pairs * z->nx * sizeof(double));
  memset(q->rounding, 0, (z->nx + z->na) * sizeof(double));
  if (q->squares) memset(q->square_sum, 0, (z->nx + z->na) * (size_t)z->nx * z->nx * sizeof(double));
  return 1;
}
