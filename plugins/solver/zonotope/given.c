/* given.c -- sums of monomials with point coefficients and a bound of the rest, for start.c.
**
** The set of a run with 50 data has thousands of terms for each state, and a row for each operation on the way would
** take gigabytes. Here a slot is a list of terms in any order, the same monomial any number of times, and a radius: the
** slot is the sum of its terms, within the radius, for all xi. Lists are given back after their last use, and are added
** to where they lie.
*/
#include "given.h"
#include "form.h"
#include "shared/constant.h"

#define LARGE 3000 /* instructions */
#define U 0x1p-53
#define MOST 1e200
#define SIZES 40 /* of free lists: 8, 16, 32, ... terms */
#define BLOCK (1u << 16)

typedef struct term {
  uint32_t of[3], unused; /* numbers of data + 1, falling; 0: none */
  double c;
} term;

typedef struct list {
  term *term;
  uint32_t n, size; /* room for 8 << size */
  double rad;
} list;

typedef struct given {
  zono *z;
  list *slot;             /* [nslot] */
  uint32_t *last;         /* [nslot] instruction that uses it last; UINT32_MAX: an output, or a constant or input */
  double *dense;          /* [stride] 0, but while terms are collected */
  term *touched;          /* [stride] */
  term *free_list[SIZES]; /* linked through their first bytes */
  term *block;            /* where new lists come from; */
  size_t left;            /* terms left of it */
} given;

int given_is_large(const ambit_tape *t) {
  if (t->ninstr < LARGE) return 0;
  for (uint32_t i = 0; i < t->ninstr; i++) switch (t->op[i]) {
    case AMBIT_OP_DIV:
      if (t->b[i] >= t->nconst) return 0;
      break;
    case AMBIT_OP_ADD:
    case AMBIT_OP_SUB:
    case AMBIT_OP_NEG:
    case AMBIT_OP_MUL:
    case AMBIT_OP_SQR: break;
    default: return 0;
    }
  return 1;
}

/* -- room: pieces of powers of 2, free ones in lists; each begins with the address of the next one */

enum { LINK = sizeof(term *) };

static term *take(given *g, uint32_t size) {
  term *found = g->free_list[size];
  size_t n = (size_t)8 << size;
  if (found) {
    memcpy(&g->free_list[size], found, LINK);
    return found;
  }
  if (g->left < n) {
    g->left = n > BLOCK ? n : BLOCK;
    g->block = g->z->host->alloc(g->z->host, g->left * sizeof *g->block);
    if (!g->block) return NULL;
  }
  found = g->block;
  g->block += n, g->left -= n;
  return found;
}

static void give_back(given *g, list *l) {
  if (l->term) {
    memcpy(l->term, &g->free_list[l->size], LINK);
    g->free_list[l->size] = l->term;
  }
  *l = (list) { 0 };
}

static int reserve(given *g, list *l, size_t n) {
  if (l->term && n <= (size_t)8 << l->size) return 1;
  list larger = { .n = l->n, .rad = l->rad };
  while (n > (size_t)8 << larger.size)
    if (++larger.size == SIZES) return 0;
  larger.term = take(g, larger.size);
  if (!larger.term) return 0;
  if (l->n) memcpy(larger.term, l->term, l->n * sizeof *l->term);
  give_back(g, l);
  *l = larger;
  return 1;
}

/* -- monomials */

static uint32_t triples_of(uint32_t n) { return n * (n + 1) / 2 * (n + 2) / 3; }

/* where rows hold it, or UINT32_MAX */
static uint32_t place(const shape *s, const uint32_t of[3]) {
  if (!of[0]) return 0;
  if (!of[1]) return of[0]; /* linear terms start at 1 */
  if (!of[2]) {
    uint32_t i = of[1] - 1, j = of[0] - 1;
    return j < s->reach[i] ? s->pair[i] + j - i : UINT32_MAX;
  }
  uint32_t i = of[2] - 1, j = of[1] - 1 - i, k = of[0] - 1 - i, n = s->cubic - i;
  if (of[0] > s->cubic) return UINT32_MAX;
  return s->cube + triples_of(s->cubic) - triples_of(n) + j * n - j * (j - (j > 0)) / 2 + k - j;
}

/* the product of two monomials; 0: its degree is more than 3 */
static int join(const uint32_t a[3], const uint32_t b[3], uint32_t to[3]) {
  uint32_t i = 0, j = 0, n = 0;
  to[0] = to[1] = to[2] = 0;
  while ((i < 3 && a[i]) || (j < 3 && b[j])) {
    if (n == 3) return 0;
    uint32_t x = i < 3 ? a[i] : 0, y = j < 3 ? b[j] : 0;
    to[n++] = x > y ? x : y;
    if (x > y)
      i++;
    else
      j++;
  }
  return 1;
}

static double size_of(const list *l) {
  double sum = 0;
  for (uint32_t i = 0; i < l->n; i++) sum += fabs(l->term[i].c);
  return sum;
}

/* sums up equal monomials; what no row holds goes into the radius */
static void collect(given *g, list *l) {
  const shape *s = &g->z->shape;
  uint32_t n = 0;
  double rad = l->rad;
  for (uint32_t i = 0; i < l->n; i++) {
    uint32_t at = place(s, l->term[i].of);
    if (at == UINT32_MAX) {
      rad += fabs(l->term[i].c);
      continue;
    }
    if (g->dense[at] == 0) g->touched[n++] = l->term[i];
    double sum = g->dense[at] + l->term[i].c;
    rad += U * fabs(sum);
    g->dense[at] = sum != 0 ? sum : 0x1p-1000; /* it is among what was touched; far below LEAST */
  }
  l->n = 0, l->rad = rad;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t at = place(s, g->touched[i].of);
    if (g->dense[at] == 0) continue;
    l->term[l->n] = g->touched[i], l->term[l->n++].c = g->dense[at];
    g->dense[at] = 0;
  }
}

/* -- operations */

static int copy(given *g, list *to, const list *a) {
  if (!reserve(g, to, a->n)) return 0;
  if (a->n) memcpy(to->term, a->term, a->n * sizeof *a->term);
  to->n = a->n, to->rad = a->rad;
  return 1;
}

static int append(given *g, list *to, double sign, const list *b) {
  size_t n = (size_t)to->n + b->n;
  if (to->term && n > (size_t)8 << to->size) collect(g, to);
  n = (size_t)to->n + b->n;
  if (!reserve(g, to, 2 * n > 16 ? n + n / 2 : n)) return 0;
  for (uint32_t i = 0; i < b->n; i++) to->term[to->n] = b->term[i], to->term[to->n++].c *= sign;
  to->rad += b->rad;
  return 1;
}

static int multiply(given *g, list *to, list *a, list *b) {
  if (a->n > 8) collect(g, a);
  if (b->n > 8 && b != a) collect(g, b);
  double sizes = size_of(a), other = size_of(b), rad = a->rad * other + b->rad * sizes + a->rad * b->rad;
  if (!reserve(g, to, (size_t)a->n * b->n)) return 0;
  for (uint32_t i = 0; i < a->n; i++)
    for (uint32_t j = 0; j < b->n; j++) {
      term *t = &to->term[to->n];
      t->c = a->term[i].c * b->term[j].c;
      if (join(a->term[i].of, b->term[j].of, t->of)) {
        rad += U * fabs(t->c) + LEAST;
        to->n++;
      } else {
        rad += fabs(t->c) * (1 + 2 * U) + LEAST;
      }
    }
  to->rad = rad;
  if (to->n > 64) collect(g, to);
  return 1;
}

/* by a constant d +- r: x / (d + e) = x / d - x e / (d (d + e)) */
static int divide(given *g, list *to, const list *a, const list *b) {
  double d = b->n == 1 ? b->term[0].c : 0, least = fabs(d) - b->rad * ABOVE;
  if (!(least > 0)) return 0;
  if (!copy(g, to, a)) return 0;
  double sizes = size_of(a);
  to->rad = (a->rad + sizes * (b->rad / fabs(d) + U)) / least * ABOVE + LEAST * (1 + a->n);
  for (uint32_t k = 0; k < to->n; k++) to->term[k].c /= d;
  return 1;
}

/* a list that may be changed: that of the operand where nobody needs it any more */
static int take_over(given *g, uint32_t i, uint32_t from, list *to) {
  if (g->last[from] != i) return copy(g, to, &g->slot[from]);
  *to = g->slot[from], g->slot[from] = (list) { 0 };
  return 1;
}

static int add(given *g, uint32_t i, double sign) {
  const ambit_tape *t = g->z->problem.initial;
  uint32_t a = t->a[i], b = t->b[i], dst = t->dst[i];
  list sum = { 0 };
  int swaps = a != b && (g->last[a] != i || g->slot[a].n < g->slot[b].n) && g->last[b] == i;
  if (!take_over(g, i, swaps ? b : a, &sum)) return 0;
  for (uint32_t k = 0; swaps && sign < 0 && k < sum.n; k++) sum.term[k].c = -sum.term[k].c;
  list twice = { 0 };
  if (a == b && !copy(g, &twice, &sum)) return 0; /* it may have been taken over */
  if (!append(g, &sum, swaps ? 1 : sign, a == b ? &twice : &g->slot[swaps ? a : b])) return 0;
  give_back(g, &twice);
  g->slot[dst] = sum;
  return 1;
}

static int operate(given *g, uint32_t i) {
  const ambit_tape *t = g->z->problem.initial;
  list result = { 0 };
  switch (t->op[i]) {
  case AMBIT_OP_ADD: return add(g, i, 1);
  case AMBIT_OP_SUB: return add(g, i, -1);
  case AMBIT_OP_NEG:
    if (!take_over(g, i, t->a[i], &result)) return 0;
    for (uint32_t k = 0; k < result.n; k++) result.term[k].c = -result.term[k].c;
    break;
  case AMBIT_OP_DIV:
    if (!divide(g, &result, &g->slot[t->a[i]], &g->slot[t->b[i]])) return 0;
    break;
  case AMBIT_OP_SQR:
    if (!multiply(g, &result, &g->slot[t->a[i]], &g->slot[t->a[i]])) return 0;
    break;
  default:
    if (!multiply(g, &result, &g->slot[t->a[i]], &g->slot[t->b[i]])) return 0;
  }
  g->slot[t->dst[i]] = result;
  return 1;
}

/* -- the tape */

static int put_term(given *g, uint32_t slot, uint32_t datum, double c) {
  list *l = &g->slot[slot];
  if (!reserve(g, l, l->n + 1u)) return 0;
  l->term[l->n++] = (term) { .of = { datum }, .c = c };
  return 1;
}

static int put_inputs(given *g, const double *off) {
  const zono *z = g->z;
  const ambit_problem *p = &z->problem;
  const ambit_tape *t = p->initial;
  for (uint32_t i = 0; i < t->nconst; i++) {
    dd c;
    double wrong = constant_at(t, i, &c);
    if (!put_term(g, i, 0, c.hi)) return 0;
    g->slot[i].rad = (fabs(c.lo) + wrong) * ABOVE;
  }
  for (uint32_t u = 0; u < p->nu; u++) {
    if (!put_term(g, t->nconst + u, 0, 0.5 * (p->u_lo[u] + p->u_hi[u]))) return 0;
    g->slot[t->nconst + u].rad = off[u];
  }
  for (uint32_t j = 0; j < z->m; j++)
    if (z->unknown[j] != AMBIT_NO_SLOT && !put_term(g, t->nconst + z->unknown[j], j + 1, z->scale[j])) return 0;
  return 1;
}

static void find_last(const ambit_tape *t, uint32_t *last) {
  for (uint32_t s = 0; s < t->nslot; s++) last[s] = UINT32_MAX;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    last[t->a[i]] = i;
    if (t->op[i] != AMBIT_OP_NEG && t->op[i] != AMBIT_OP_SQR) last[t->b[i]] = i;
  }
  for (uint32_t s = 0; s < t->nconst + t->nin; s++) last[s] = UINT32_MAX;
  for (uint32_t o = 0; o < t->nout; o++) last[t->out[o]] = UINT32_MAX;
}

static void drop(given *g, uint32_t i, uint32_t slot) {
  if (g->last[slot] == i) give_back(g, &g->slot[slot]);
}

static int put_row(given *g, const list *l, double *to, double *rad) {
  const shape *s = &g->z->shape;
  double sum = l->rad;
  for (uint32_t i = 0; i < l->n; i++) {
    uint32_t at = place(s, l->term[i].of);
    if (at != UINT32_MAX) to[at] += l->term[i].c;
    sum += at != UINT32_MAX ? U * fabs(to[at]) : fabs(l->term[i].c);
  }
  row_norms_all(s, to);
  *rad = sum * ABOVE + (sum > 0 ? LEAST : 0);
  return *rad < MOST && row_total(s, to) < MOST;
}

int given_evaluate(zono *z, const double *off) {
  const ambit_host *h = z->host;
  const ambit_tape *t = z->problem.initial;
  given g = { .z = z };
  size_t stride = z->shape.stride;
  g.slot = h->alloc(h, t->nslot * sizeof *g.slot), g.last = h->alloc(h, t->nslot * sizeof *g.last);
  g.dense = h->alloc(h, stride * sizeof *g.dense), g.touched = h->alloc(h, stride * sizeof *g.touched);
  if (!g.slot || !g.last || !g.dense || !g.touched || !put_inputs(&g, off)) return 0;
  find_last(t, g.last);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    if (!operate(&g, i)) return 0;
    drop(&g, i, t->a[i]);
    if (t->op[i] != AMBIT_OP_NEG && t->op[i] != AMBIT_OP_SQR) drop(&g, i, t->b[i]);
  }
  int good = 1;
  for (uint32_t o = 0; o < z->nx; o++) good &= put_row(&g, &g.slot[t->out[o]], z->start + o * stride, z->start_rad + o);
  for (uint32_t o = 0; o < z->np; o++)
    good &= put_row(&g, &g.slot[t->out[z->nx + o]], z->start_p + o * stride, z->start_p_rad + o);
  return good;
}
