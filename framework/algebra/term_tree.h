/* term_tree.h -- equations as nested sums of terms, for model reduction (after Wichmann 2001; Mikelsons and Brandt,
** DETC2009-86954).
**
** Level 0 is the whole right-hand side, level 1 has its summands, level n + 1 the summands of the maximal sums inside a
** term of level n: in arguments of functions, factors, numerators, denominators, bases of powers. A sum is maximal
** where it is not itself an operand of a sum. A term is known by its equation, its sum and its body: a sum that occurs
** several times within one equation is listed once, at the smallest of its levels, below the first term that holds it,
** and a change of one of its terms is a change wherever it occurs as a maximal sum. The same sum in another equation
** has other terms.
** Work and memory grow with the distinct nodes below each equation, plus the number of terms listed.
*/
#ifndef AMBIT_TERM_TREE_H
#define AMBIT_TERM_TREE_H
#include <ambit/graph.h>

#define AMBIT_NO_TERM UINT32_MAX
#define AMBIT_TERM_TREE_MAX 100000u /* terms; sums of sums can have very many */

typedef struct ambit_tree_term {
  uint32_t equation, level;
  uint32_t parent; /* the term it is inside of, always before it; AMBIT_NO_TERM at level 0 */
  ambit_expr e;    /* with its sign and coefficient: the sum is the sum of its terms */
} ambit_tree_term;

/* Terms [first, first + count) are the summands of `node`, which is a sum but where a right-hand side is none. */
typedef struct ambit_tree_sum {
  uint32_t first, count;
  ambit_expr node; /* not a NEG: where the right-hand side is -(a + b), that of a + b */
  bool negative;   /* then, the terms are those of -node */
} ambit_tree_sum;

typedef struct ambit_term_tree {
  uint32_t max_level;
  size_t nequation, nterm, nsum;
  ambit_expr *rate, *expanded; /* [nequation] as given; as the terms of level 1 add up to it */
  ambit_tree_term *term;       /* [nterm] by equation, then level */
  ambit_tree_sum *sum;         /* [nsum] by first */
  uint32_t *first_sum;         /* [nequation + 1] equation i has sums [first_sum[i], first_sum[i + 1]) */
  size_t term_capacity, sum_capacity;
} ambit_term_tree;

/* The terms up to max_level of rate[0..n). expand_limit: ambit_graph_expand is applied to the right-hand sides first;
** 0: not. INVALID: too many terms. The tree is closed by the caller in every case. */
ambit_status ambit_term_tree_open(ambit_graph *g, size_t n, const ambit_expr *rate, uint32_t max_level,
    size_t expand_limit, ambit_term_tree *tree, ambit_failure *f);
void ambit_term_tree_close(ambit_term_tree *tree);

/* rate[i] := equation i with terms index[0..n) replaced; AMBIT_ZERO leaves a term out. A term replaced takes what is
** inside it along: replacements inside it count only where the same sum also occurs elsewhere. An equation without any
** is as it was given, and so is every part without a replaced term below it. */
ambit_status ambit_term_tree_rewrite(ambit_graph *g, const ambit_term_tree *tree, size_t n, const uint32_t *index,
    const ambit_expr *replacement, ambit_expr *rate, ambit_failure *f);
#endif
