/* loop_solver.h -- G_d x = b and G_d^T y = b inside the graph, block by block.
**
** A block of at most AMBIT_CRAMER rows is solved by Cramer's rule: x = adj(B) b / det B needs det B != 0 and nothing
** else. Elimination would also divide by its pivots, which may vanish on the way although the block stays regular, and
** its enclosures are wider (of a ring of seven hinges 12 times); it is used for larger blocks only, with the pivots
** chosen at the reference configuration. Six rows are the most that one closure has. Every step is an identity
** where the divisors are not 0.
*/
#ifndef AMBIT_LOOP_SOLVER_H
#define AMBIT_LOOP_SOLVER_H
#include <ambit/graph.h>
#include "mechanics/partition.h"

#define AMBIT_CRAMER 6u

typedef struct ambit_loop_block {
  size_t first, n; /* pivots first .. first + n of the partition */
  ambit_expr *a;   /* [n*n] Cramer: adj(B); else L (unit, below) and U */
  ambit_expr det;  /* Cramer */
} ambit_loop_block;

typedef struct ambit_loop_solver {
  ambit_graph *g;
  const ambit_partition *p;
  const ambit_expr *velocity; /* [n*nu] G */
  ambit_loop_block *block;    /* [p->nblock] */
  ambit_expr *work;           /* [rank] */
} ambit_loop_solver;

ambit_status ambit_loop_solver_open(ambit_graph *g, ambit_arena *arena, const ambit_partition *p,
    const ambit_expr *velocity, ambit_loop_solver *s, ambit_failure *f);
/* x[column] := solution of G_d x = b[row]; other entries of x are left alone. b [n], x [nu] */
ambit_status ambit_loop_solve(const ambit_loop_solver *s, const ambit_expr *b, ambit_expr *x, ambit_failure *f);
/* y[row] := solution of G_d^T y = b[column]; b [nu], y [n] */
ambit_status ambit_loop_solve_transposed(
    const ambit_loop_solver *s, const ambit_expr *b, ambit_expr *y, ambit_failure *f);
#endif
