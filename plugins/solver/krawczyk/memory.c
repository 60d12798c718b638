/* memory.c -- options, and everything that a run needs. */
#include "krawczyk.h"
#include <math.h>
#include <string.h>

#define CUTS_PER_UNKNOWN 300 /* depth of the search; beyond it boxes are undecided */

#define PIECES 64 /* of the parameters' ranges, for a tighter enclosure */
#define PIECES_MAX 65536
#define COVER_DEPTH 256

enum { OPTION_TOLERANCE, OPTION_BOXES, OPTION_UNDECIDED, OPTION_ROOTS, OPTION_OPERATOR, OPTION_PIECES };

static ambit_status check_options(const ambit_host *h, const double *o, options *out) {
  static const char *const name[] = { "tolerance", "boxes_max", "undecided_max", "roots_max" };
  if (!(o[OPTION_TOLERANCE] >= 0 && o[OPTION_TOLERANCE] < 1))
    return h->fail(h, AMBIT_INVALID, "option `tolerance` must be in [0, 1), not %g", o[OPTION_TOLERANCE]);
  for (int i = OPTION_BOXES; i <= OPTION_ROOTS; i++)
    if (!(o[i] >= 1 && o[i] <= (i == OPTION_BOXES ? 4e9 : 1e6)))
      return h->fail(
          h, AMBIT_INVALID, "option `%s` must be 1 to %g, not %g", name[i], i == OPTION_BOXES ? 4e9 : 1e6, o[i]);
  if (!(o[OPTION_PIECES] >= 0 && o[OPTION_PIECES] <= PIECES_MAX))
    return h->fail(h, AMBIT_INVALID, "option `parameter_pieces` must be 0 to %d, not %g", PIECES_MAX, o[OPTION_PIECES]);
  *out = (options) { o[OPTION_TOLERANCE], (uint32_t)o[OPTION_BOXES], (uint32_t)o[OPTION_UNDECIDED],
    (uint32_t)o[OPTION_ROOTS], (uint32_t)o[OPTION_OPERATOR], (uint32_t)o[OPTION_PIECES] };
  return AMBIT_OK;
}

/* -- rooms; the first failure makes all later ones fail */

typedef struct rooms {
  const ambit_host *host;
  int good;
} rooms;

static void *take(rooms *r, size_t count, size_t size) {
  void *room = r->good ? r->host->alloc(r->host, (count + 1) * size) : NULL;
  r->good = room != NULL;
  return room;
}

static double *take_doubles(rooms *r, size_t n) { return take(r, n, sizeof(double)); }
static span *take_spans(rooms *r, size_t n) { return take(r, n, sizeof(span)); }

static matrix take_matrix(rooms *r, size_t entries) {
  double *lo = take_doubles(r, entries);
  return (matrix) { lo, take_doubles(r, entries) };
}

static boxes take_boxes(rooms *r, uint32_t n, uint32_t room) {
  return (boxes) { .x = take_spans(r, (size_t)n * room), .room = room };
}

static void take_operator(rooms *r, krawczyk *k) {
  uint32_t n = k->n, np = k->np, longest = n > np ? n : np;
  span **const vector[] = { &k->f, &k->f_mid, &k->b, &k->shift, &k->z, &k->row, &k->diagonal, &k->hull };
  for (size_t i = 0; i < sizeof vector / sizeof *vector; i++) *vector[i] = take_spans(r, n);
  span **const box[] = { &k->mid, &k->estimate, &k->searched, &k->box, &k->left, &k->enclosure, &k->around, &k->common,
    &k->other };
  for (size_t i = 0; i < sizeof box / sizeof *box; i++) *box[i] = take_spans(r, k->m);
  k->p_off = take_spans(r, np);
  matrix *const square[] = { &k->J, &k->A, &k->off, &k->H, &k->part };
  for (size_t i = 0; i < sizeof square / sizeof *square; i++) *square[i] = take_matrix(r, (size_t)n * n);
  k->S = take_matrix(r, (size_t)n * np);
  k->CS = take_matrix(r, (size_t)n * np);
  k->C = take_doubles(r, (size_t)n * n);
  k->B = take_doubles(r, (size_t)n * n);
  k->work = take_doubles(r, (size_t)n * n);
  k->in = take_matrix(r, longest);
  k->out = take_matrix(r, longest);
  k->in_lo = take_doubles(r, k->m);
  k->in_hi = take_doubles(r, k->m);
  k->weight = take_doubles(r, k->m);
  k->blur = take_doubles(r, n);
  double **const scalars[] = { &k->scale, &k->margin, &k->best };
  for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) *scalars[i] = take_doubles(r, n);
}

static void take_search(rooms *r, krawczyk *k) {
  uint64_t depth = (uint64_t)k->m * CUTS_PER_UNKNOWN + 2, all = (uint64_t)k->options.boxes_max + 2;
  uint32_t room = (uint32_t)(depth < all ? depth : all), pieces = k->options.pieces;
  k->stack = take_boxes(r, k->m, room);
  k->stack.share = take_doubles(r, room);
  k->undecided = take_boxes(r, k->m, k->options.undecided_max);
  k->proved = take_boxes(r, k->m, k->options.roots_max);
  k->region = take_boxes(r, k->m, k->options.roots_max);
  k->branch = take(r, k->options.roots_max, sizeof *k->branch);
  k->emitted = take(r, k->options.roots_max, sizeof *k->emitted);
  k->kin = take(r, k->options.roots_max, sizeof *k->kin);
  if (!k->np) return;
  k->half = take_boxes(r, k->m, pieces > PIECES ? pieces : PIECES);
  k->cover = take_boxes(r, k->m, COVER_DEPTH);
}

/* -- the problem */

static int is_box(const double *lo, const double *hi, uint32_t n) {
  for (uint32_t i = 0; i < n; i++)
    if (!(lo[i] <= hi[i])) return 0;
  return 1;
}

static ambit_status check_problem(const ambit_host *h, const ambit_root_problem *p) {
  if (!p->nx) return h->fail(h, AMBIT_INVALID, "there are no unknowns");
  if (!p->f || !p->jacobian || p->f->nout != p->nx) return h->fail(h, AMBIT_INVALID, "the problem is not one of roots");
  if (!is_box(p->x_lo, p->x_hi, p->nx) || !is_box(p->p_lo, p->p_hi, p->np))
    return h->fail(h, AMBIT_INVALID, "the box is empty");
  for (uint32_t i = 0; i < p->np; i++)
    if (!isfinite(p->p_lo[i]) || !isfinite(p->p_hi[i]))
      return h->fail(h, AMBIT_INVALID, "parameter `%s` is not bounded", p->name[p->nx + i]);
  return AMBIT_OK;
}

static void copy_boxes(krawczyk *k) {
  const ambit_root_problem *p = &k->problem;
  for (uint32_t i = 0; i < k->n; i++) k->searched[i] = (span) { p->x_lo[i], p->x_hi[i] };
  for (uint32_t i = 0; i < k->np; i++) k->searched[k->n + i] = (span) { p->p_lo[i], p->p_hi[i] };
}

static ambit_status open_tapes(krawczyk *k) {
  const ambit_root_problem *p = &k->problem;
  const ambit_host *h = k->host;
  ambit_status status = ambit_lane_open(&k->equations, h, p->f, p->arithmetic, p->actx);
  if (status == AMBIT_OK) status = ambit_lane_open(&k->jacobian, h, p->jacobian, p->arithmetic, p->actx);
  if (status == AMBIT_OK && p->slope) status = ambit_lane_open(&k->slope, h, p->slope, p->arithmetic, p->actx);
  if (status == AMBIT_OK) status = k->contract->open(h, p->f, &k->shape);
  if (status == AMBIT_OK && p->nfurther) status = k->contract->open(h, p->further, &k->further);
  return status;
}

void krawczyk_close(void *self) {
  krawczyk *k = self;
  ambit_lane_close(&k->equations);
  ambit_lane_close(&k->jacobian);
  ambit_lane_close(&k->slope);
}

ambit_status krawczyk_open(const ambit_host *h, const ambit_root_problem *p, const double *option, void **self) {
  krawczyk *k = h->alloc(h, sizeof *k);
  if (!k) return h->fail(h, AMBIT_NOMEM, "out of memory");
  memcpy(&k->problem, p, p->size < sizeof k->problem ? p->size : sizeof k->problem);
  k->host = h, k->n = p->nx, k->np = p->np, k->m = p->nx + p->np;
  k->num = h->service(h, AMBIT_NUM_SERVICE);
  k->contract = h->service(h, AMBIT_CONTRACT_SERVICE);
  k->counted = ambit_work_open(h);
  if (!k->num || !k->contract) return h->fail(h, AMBIT_INVALID, "the host lends too few services");
  ambit_status status = check_options(h, option, &k->options);
  if (status == AMBIT_OK) status = check_problem(h, &k->problem);
  if (status != AMBIT_OK) return status;
  rooms r = { h, 1 };
  take_operator(&r, k);
  take_search(&r, k);
  if (!r.good) return h->fail(h, AMBIT_NOMEM, "out of memory; lower `roots_max` or `undecided_max`");
  copy_boxes(k);
  status = open_tapes(k);
  if (status != AMBIT_OK) {
    krawczyk_close(k);
    return h->fail(h, status, "out of memory");
  }
  *self = k;
  return AMBIT_OK;
}
