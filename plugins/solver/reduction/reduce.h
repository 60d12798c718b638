/* reduce.h -- what the files of the reduction plugin share.
**
** Rankings estimate what each candidate does to the outputs; they decide only the order of trials. What is cut is
** proved, by the kernel. Everything here is ordinary floating point. Mathematics: docs/numerics/ranking.md.
*/
#ifndef REDUCE_H
#define REDUCE_H
#include <ambit/block.h>
#include <ambit/reduction.h>

enum norm { NORM_RMS, NORM_MAX };
enum strategy { STRATEGY_CLUSTERS, STRATEGY_PREDICTED };

typedef struct options {
  uint32_t ranking;               /* AMBIT_RANK_*: decides the order */
  uint8_t also[AMBIT_RANK_COUNT]; /* computed besides */
  uint32_t norm, ends;            /* of RESIDUAL; of ADJOINT */
  uint32_t strategy;
  double cluster, give_up, proofs_max;
} options;

/* A tape at up to `width` nodes of a reference at once. */
typedef struct table {
  const ambit_tape *tape; /* NULL: there is none */
  const ambit_arithmetic *arithmetic;
  void *ctx, *base;
  size_t elem;
  uint32_t width;
  double *lo, *hi; /* [width] */
  double *value;   /* [width x nout] by rows; NaN: not defined there */
  ambit_work *counted;
} table;

/* Solutions of transposed systems, `stride` at once: entry i of number c at [i * stride + c]. */
typedef struct duals {
  uint32_t stride;
  double *matrix;                     /* [nx x nx] decomposed */
  uint32_t *row;                      /* [nx] its rows */
  double *x, *once, *twice, *scratch; /* [nx x stride] */
  double *weight;                     /* [nx x stride] what a change of each rate does to each functional */
  double *total;                      /* [ncandidate x stride] effects, added up */
  double *later_J, *later_effect;     /* [nx x nx], [neffect] of the node behind */
} duals;

/* candidates order[first .. first + count) */
typedef struct cluster {
  uint32_t first, count, depth; /* how often it was halved */
  uint32_t fails_at;            /* its proof fails if so many are accepted: it was part of one that failed */
} cluster;

#define DEPTH_MAX 34 /* halvings of 2^32 candidates */

typedef struct reducer {
  const ambit_host *host;
  ambit_reduction r;
  options options;
  ambit_sink *sink;
  uint32_t nx, width, longest; /* nodes at a time; of the longest reference */

  /* -- ranking */
  double *value[AMBIT_RANK_COUNT]; /* [ncandidate] of those that are asked for, else NULL */
  table effect, jacobian, output_jacobian, rates, output_value;
  double *scale;      /* [nx] > 0: how much each state varies */
  double *sum, *own;  /* [ncandidate] scratch of one node, of one reference */
  double *J, *C;      /* [width x nx x nx], [width x noutput x nx] df/dx and dy/dx at nodes: see slope_load */
  double *near;       /* [width x nin] points around a node, for difference quotients */
  uint32_t undefined; /* derivatives that had no value and count as 0 */
  duals duals;

  /* -- cancellation */
  uint32_t *order;                 /* [ncandidate] ascending */
  cluster *stack;                  /* [2 DEPTH_MAX] halves */
  uint32_t nstack, next, accepted; /* next: of the order, the first that no cluster holds */
  double used;                     /* greatest error of what is accepted, relative to its bound */
  double *known;               /* [DEPTH_MAX x noutput] errors of the clusters that failed, by depth of their halves */
  uint8_t is_known[DEPTH_MAX]; /* 0: nothing was proved of it */
  uint8_t *cut, *single;       /* [ncandidate] */
  double *error;               /* [noutput] */
  double proofs;
} reducer;

/* plugin.c */
ambit_status reduce_options(const ambit_host *h, const double *option, options *o);

/* open.c */
ambit_status reduce_open(const ambit_host *h, const ambit_reduction *r, const double *option, void **self);
void reduce_close(void *self);
void *reduce_room(reducer *s, size_t n, size_t size); /* NULL: out of memory */
int reduce_wants(const options *o, uint32_t ranking);
/* 1 is as much as the bounds allow */
int reduce_is_relative(uint32_t ranking);

/* table.c */
ambit_status table_open(table *t, reducer *s, const ambit_tape *tape, uint32_t width);
void table_close(table *t);
/* value := outputs at in [count x nin], count <= width */
void table_load(table *t, const double *in, uint32_t count);
static inline const double *table_at(const table *t, uint32_t lane) { return t->value + (size_t)lane * t->tape->nout; }

/* slope.c: J and C of nodes [first, first + count) of a reference, numbers everywhere */
void slope_load(reducer *s, const ambit_reference *at, uint32_t first, uint32_t count);

/* factor.c: P M = L U in place; a pivot that is nearly zero becomes a small one */
void factor_decompose(uint32_t n, double *M, uint32_t *row);
/* the first `count` of `stride` columns: x := M^-T b; x and b may be the same */
void factor_solve_transposed(uint32_t n, const duals *d, uint32_t count, const double *b, double *x);

/* rankings: value[] of each, infinite where it is not defined */
ambit_status rank_all(reducer *s); /* rank.c */
void residual_rank(reducer *s);
void residual_settle_scales(reducer *s);
void one_step_rank(reducer *s);
void adjoint_rank(reducer *s);
/* dual.c */
int dual_open(reducer *s, uint32_t stride); /* 0: out of memory */
/* total := 0 */
void dual_clear(reducer *s);
/* total += weight * effect of one node, `count` columns */
void dual_add(reducer *s, const double *effect, uint32_t count);
/* value := greatest |total| if that is more; not a number: infinite */
void dual_raise(reducer *s, double *value, uint32_t count);
ambit_status alone_rank(reducer *s, uint32_t ranking);
/* value relative to bounds; INFINITY if there is none */
double reduce_relative(const reducer *s, const double *error);
/* counts a proof; STOPPED if there were too many */
ambit_status reduce_prove(reducer *s, uint32_t how, const uint8_t *cut);
int reduce_is_stopped(reducer *s, double done, const char *message);

/* cancel.c: Algorithm 1 */
ambit_status cancel_run(reducer *s);
#endif
