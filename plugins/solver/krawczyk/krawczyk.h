/* krawczyk.h -- what the files of the krawczyk plugin share.
**
** All roots x of f(x, p) = 0 in a box, for every value of the parameters p in theirs. A box of the search has n + np
** components: where x is sought, and the part of the parameters' ranges for which. Rigorous operations are those of the
** services ambit.num/1 and ambit.contract/1, of the problem's arithmetic, and of the few functions marked "upward mode"
** (bound.c); everything else chooses points, matrices and boxes, which may be anything without harm. Proofs:
** docs/numerics/krawczyk.md.
*/
#ifndef KRAWCZYK_H
#define KRAWCZYK_H
#include <ambit/block.h>
#include <ambit/contract.h>
#include <ambit/num.h>
#include <ambit/root_finder.h>

typedef struct span {
  double lo, hi;
} span;

/* an interval matrix by rows, bounds in arrays of their own */
typedef struct matrix {
  double *lo, *hi;
} matrix;

enum operation { OPERATOR_AUTO, OPERATOR_NEWTON, OPERATOR_KRAWCZYK, OPERATOR_HANSEN_SENGUPTA };

typedef struct options {
  double tolerance;
  uint32_t boxes_max, undecided_max, roots_max, operation, pieces; /* pieces 0: automatic */
} options;

/* boxes, one behind the other */
typedef struct boxes {
  span *x;
  double *share; /* of the searched box, for progress; NULL: not kept */
  uint32_t count, room;
} boxes;

/* what the Newton operator says about the roots in a box */
enum verdict {
  VERDICT_NONE,    /* there are none */
  VERDICT_UNIQUE,  /* exactly one for each value of the parameters */
  VERDICT_AT_MOST, /* at most one for each */
  VERDICT_UNKNOWN
};

/* why the search ended */
enum why { WHY_DONE, WHY_STOPPED, WHY_BOXES, WHY_UNDECIDED, WHY_ROOTS };

/* no root has its component `at` between lo and hi; lo < hi, or there is no gap */
typedef struct gap {
  uint32_t at;
  double lo, hi;
} gap;

typedef struct krawczyk {
  const ambit_host *host;
  ambit_root_problem problem;
  const ambit_num_service *num;
  const ambit_contract_service *contract;
  ambit_work *counted;
  options options;
  uint32_t n, np, m;                     /* m = n + np */
  ambit_lane equations, jacobian, slope; /* f, df/dx, df/dp */
  ambit_contractor *shape;               /* of f */
  ambit_contractor *further;             /* of the further equations, or NULL */
  span *searched;                        /* [m] */

  /* -- the Newton operator */
  span *mid, *f, *f_mid, *b, *shift, *z, *row; /* [n]; mid [m] */
  span *estimate;       /* [m] if A is regular: where roots of the last box can be at most, also outside of it */
  span *p_off;          /* [np] */
  matrix J, A, off;     /* [n x n] Jacobian; preconditioned; without its diagonal */
  span *diagonal;       /* [n] of A */
  matrix H, part;       /* [n x n] slopes, column by column */
  matrix S, CS;         /* [n x np] df/dp, preconditioned */
  double *C, *B, *work; /* [n x n], approximate inverses of the middle of J, of <A> */
  span *hull;           /* [n] */
  double *scale, *margin, *best; /* [n] u and <A> u of the proof that A is regular */
  matrix in, out;                /* [max(n, np)] operands of products */
  double *in_lo, *in_hi;         /* [m] operand of contractors */
  gap gap;                       /* the widest that the last operator saw */
  int has_J, has_S;              /* are J, S those of the last box? */

  /* -- the search */
  double *blur;                          /* [n] how far the parameters alone spread the equations */
  double *weight;                        /* [m] how much each component contributes to the equations' spread */
  boxes stack, undecided;                /* of m */
  span *box, *left, *enclosure, *around; /* [m] */
  span *common, *other;                  /* [m] */
  uint32_t examined;                     /* boxes so far */
  double done;                           /* share of the searched box */

  /* -- what is proved: pieces of branches */
  boxes proved, region;   /* of m; region: where the root of proved is the only one */
  uint32_t *branch;       /* [roots_max] a piece of the same branch, or itself */
  uint8_t *emitted, *kin; /* [roots_max] */
  boxes half;             /* of m, while an enclosure is tightened */
  boxes cover;            /* of m */
} krawczyk;

/* memory.c */
ambit_status krawczyk_open(const ambit_host *h, const ambit_root_problem *p, const double *option, void **self);
void krawczyk_close(void *self);

/* evaluate.c: tapes over boxes x [m], and products; 0: not defined everywhere, or not bounded */
int krawczyk_matrix(const krawczyk *k, ambit_lane *lane, const span *x, matrix M);
int krawczyk_vector(krawczyk *k, const span *x, span *f);
/* AMBIT_F_*; 0: f is defined and smooth over the whole box; KINK_ELSEWHERE: at least for each value of the
** parameters */
uint32_t krawczyk_inspect(const krawczyk *k, const span *x);
void krawczyk_map(const krawczyk *k, uint32_t op, span *r, const span *a, const span *b, uint32_t n);
/* r [n] := M v for a matrix of `cols` columns */
void krawczyk_multiply(const krawczyk *k, span *r, const double *Mlo, const double *Mhi, uint32_t cols, const span *v);

/* newton.c */
/* narrows x to where its roots are; UNIQUE: x is then the root's enclosure. AT_MOST: x may stay as it is */
enum verdict krawczyk_newton(krawczyk *k, span *x);

/* solution.c: the solutions z of A z = -b, b = k->b, A = k->A */
/* z := and estimate := mid + z, all solutions as the operator sees them, A being regular; 0: there are none */
int krawczyk_solve(krawczyk *k);
/* narrows z by rows solved for one unknown each, notes gaps; 0: no solution in z */
int krawczyk_sweep(krawczyk *k, span *z);

/* bound.c, in upward mode */
/* scale > 0 with margin <= <A> scale, margin > 0, if such is found: A is regular; 0: it is not */
int krawczyk_is_regular(const krawczyk *k);
/* z[i] := +-bound of |x_i| over all A x = -b */
void krawczyk_bound_solution(const krawczyk *k, span *z);
/* hull.c: z := an enclosure of all x with A x = -b; A is regular */
void krawczyk_hull_solution(krawczyk *k, span *z);
/* b_i + sum_{j != i} A_ij z_j */
span krawczyk_row(const krawczyk *k, uint32_t i, const span *z);

/* box.c: boxes of n components */
int box_is_empty(uint32_t n, const span *x);
int box_is_bounded(uint32_t n, const span *x);
int box_is_inside(uint32_t n, const span *x, const span *of);
int box_is_apart(uint32_t n, const span *x, const span *from);
int box_meet(uint32_t n, span *x, const span *y); /* x := x and y; 0: empty */
void box_join(uint32_t n, span *x, const span *y);
void box_copy(uint32_t n, span *to, const span *from);
double box_shrinking(uint32_t n, const span *x, const span *old); /* least ratio of widths; 1: nothing gained */
double box_point(span x);                                         /* where to cut it */
double box_extent(span x);                                        /* width relative to max(1, |x|) */
double box_middle(span x);                                        /* a double in it */
void box_inflate(uint32_t n, span *x, double floor);              /* each end by more than `floor` */
span *boxes_at(const boxes *b, uint32_t n, uint32_t i);
int boxes_push(boxes *b, uint32_t n, const span *x, double share); /* 0: full */

/* prove.c */
/* narrows x; if it has one root for each parameter: 1, x its enclosure, `around` a box in which there is no other and
** which holds what x was. 0: no root in x, -1: not proved */
int krawczyk_prove(krawczyk *k, span *x, span *around);
/* narrows x by f = 0 and the further equations; 0: no root */
int krawczyk_contract(krawczyk *k, span *x);
/* x is known to hold its root; its enclosure becomes as narrow as the arithmetic allows */
void krawczyk_refine(krawczyk *k, span *x);
/* the same, with the parameters' ranges cut as long as that pays */
void krawczyk_tighten(krawczyk *k, span *x);

/* cut.c */
int krawczyk_is_small(const krawczyk *k, const span *x, double times); /* against the tolerance */
/* into how many parts like that of x the parameters' ranges could be cut */
double krawczyk_count_parts(const krawczyk *k, const span *x);
/* both parts of x onto the stack; 0: it is not worth it, or there is no room */
int krawczyk_cut(krawczyk *k, const span *x, double share);

/* branch.c */
int krawczyk_is_known(const krawczyk *k, const span *x); /* its roots are that of a proved piece */
enum why krawczyk_keep_undecided(krawczyk *k, const span *x);
/* boxes for neighbouring parts of the parameters overlap: one hull each */
void krawczyk_join_undecided(krawczyk *k);
enum why krawczyk_keep_root(krawczyk *k, ambit_sink *sink, span *x, const span *around);
/* what keep_root did not emit; nonzero: stopped */
int32_t krawczyk_emit_branches(krawczyk *k, ambit_sink *sink);
int32_t krawczyk_emit(krawczyk *k, ambit_sink *sink, const span *x, uint32_t event);

/* cover.c: do the parameters' parts of the proved pieces of branch `root` cover all of their ranges? */
int krawczyk_covers(krawczyk *k, uint32_t root);
uint32_t krawczyk_root_of(const krawczyk *k, uint32_t piece); /* the piece that stands for its branch */

/* explain.c */
ambit_status krawczyk_explain(const krawczyk *k, enum why why, uint32_t undecided);

/* search.c */
ambit_status krawczyk_run(void *self, ambit_sink *sink);
#endif
