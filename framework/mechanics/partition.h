/* partition.h -- which speeds depend on the others, by which rows, and in what order they are found: coordinate
** partitioning (Wehage & Haug 1982).
**
** The rows of G at a reference configuration are eliminated with threshold pivoting: of the entries at least a tenth of
** the largest one in the last column is taken, so that the first joints stay independent, and there the one that fills
** in least (Markowitz 1957; Duff, Erisman & Reid 1986, ch. 7). Rows left with entries below AMBIT_RANK_TOLERANCE (each
** row scaled to 1) are called redundant. That is a choice in floating point at one configuration, not a proof; rank.h
** proves that the chosen rows and columns are regular over a set.
**
** The chosen square block G_d is then ordered into irreducible blocks, lower block triangular (Tarjan 1972): each small
** loop of a big mechanism is solved by itself.
*/
#ifndef AMBIT_PARTITION_H
#define AMBIT_PARTITION_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AMBIT_RANK_TOLERANCE 1e-7

typedef struct ambit_partition {
  size_t n, nu, rank;
  uint32_t *row, *column; /* [rank] kept rows and dependent speeds: row[k], column[k] are the pivots, block by block */
  size_t nblock;
  uint32_t *block;       /* [nblock + 1] where each begins */
  uint32_t *independent; /* [nu - rank] ascending */
  uint32_t *redundant;   /* [n - rank] ascending */
} ambit_partition;

/* value [n*nu]: G at the reference; nonzero [n*nu]: may the entry differ from 0 anywhere? keep [nu] (or NULL): speeds
** that must stay independent. */
ambit_status ambit_partition_choose(ambit_arena *arena, size_t n, size_t nu, const double *value, const bool *nonzero,
    const bool *keep, ambit_partition *p, ambit_failure *f);
/* The pivots alone: returns the rank. */
size_t ambit_partition_rank(ambit_arena *arena, size_t n, size_t nu, const double *value, ambit_failure *f);
#endif
