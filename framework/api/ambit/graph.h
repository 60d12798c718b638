/* graph.h -- expressions: hash-consed nodes, sound folding, derivatives, additive terms.
**
** A node is a number; equal expressions have equal numbers. Every node knows bounds that hold for all real values of
** the symbols (`range`) and whether it is defined for all of them (`total`): rules such as 0*x -> 0, x - x -> 0, x/x
** -> 1 fire only where x is total (and nonzero). Folding of constants uses the kernel's interval functions and is
** done only if the result is exact, so that arithmetics of higher precision lose nothing; the tape folds the rest.
** Algebra: sums and products are kept in a canonical order, a*a -> sqr, repeated products -> pown, sin^2 + cos^2 ->
** 1, cos a cos b - sin a sin b -> cos(a + b) and its three relatives. Every rule is an identity of real functions on
** the whole domain, so any enclosure of the result encloses the original (docs/numerics.md). Not thread safe: [main].
*/
#ifndef AMBIT_GRAPH_H
#define AMBIT_GRAPH_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include <ambit/element.h> /* ambit_expr */
#include <ambit/interval.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_graph ambit_graph;

#define AMBIT_NO_EXPR UINT32_MAX /* out of memory, or an error that the failure explains */

/* What a node is: an AMBIT_OP_*, or one of these leaves. */
#define AMBIT_LEAF_CONSTANT 0x100u /* value: enclosure; text: decimal, or NULL */
#define AMBIT_LEAF_UNKNOWN 0x101u  /* a fixed but unknown datum in `value`; the same node is the same unknown */
#define AMBIT_LEAF_SYMBOL 0x102u   /* a named variable of a model (state, parameter, effort): any real number */
#define AMBIT_LEAF_TIME 0x103u
/* a function of time, measurable and in `value` at almost all times; the same node is the same function. None of it is
** known but that: it has no derivative by time, and is constant for no solver that takes data for constants. */
#define AMBIT_LEAF_VARYING 0x104u
#define AMBIT_LEAF_NONE 0x1ffu /* the number of no node: it was freed */

/* Is it a leaf with a range: a datum, or a function of time? */
static inline bool ambit_leaf_is_uncertain(uint32_t op) { return op == AMBIT_LEAF_UNKNOWN || op == AMBIT_LEAF_VARYING; }

typedef struct ambit_node {
  uint32_t op;          /* AMBIT_OP_* or AMBIT_LEAF_* */
  ambit_expr a, b;      /* operands; b == a when unary; POWN: b is the int32 exponent */
  ambit_interval value; /* leaf CONSTANT, UNKNOWN, VARYING: its set */
  ambit_interval inner; /* UNKNOWN, VARYING: values that it surely takes, inside `value`; empty: none is known */
  ambit_interval range; /* bounds over all reals (UNKNOWN, VARYING: over its set) */
  bool total;           /* defined for all real values of the leaves */
  bool constant;        /* no UNKNOWN, VARYING, SYMBOL or TIME below */
  bool plain;           /* UNKNOWN: a plain interval that stands in a formula, until it is named as a datum */
  const char
      *text; /* CONSTANT: literal or "pi"; SYMBOL, UNKNOWN, VARYING: name or NULL; ABS, MIN, MAX: writer or NULL */
  const char *unit; /* SYMBOL: SI unit; UNKNOWN, VARYING: the line that made it, "scene.lua:12", or NULL */
} ambit_node;

AMBIT_EXPORT ambit_graph *ambit_graph_open(void); /* NULL: out of memory; node 0 is the constant 0 */
AMBIT_EXPORT void ambit_graph_close(ambit_graph *g);
AMBIT_EXPORT const ambit_node *ambit_graph_node(
    const ambit_graph *g, ambit_expr e);                       /* valid until the next node is made */
AMBIT_EXPORT uint32_t ambit_graph_count(const ambit_graph *g); /* all node numbers are below */
/* A number that no other leaf of the graph ever has; leaves are in the order of these. */
AMBIT_EXPORT uint64_t ambit_graph_birth(const ambit_graph *g, ambit_expr leaf);
AMBIT_EXPORT uint64_t ambit_graph_made(const ambit_graph *g);          /* nodes ever made */
AMBIT_EXPORT double ambit_graph_sealing_seconds(const ambit_graph *g); /* of CPU time, for all tapes so far */

/* exactly this double; NaN or infinite: NO_EXPR */
AMBIT_EXPORT ambit_expr ambit_graph_number(ambit_graph *g, double x);
/* a constant known only to lie in x (nonempty) */
AMBIT_EXPORT ambit_expr ambit_graph_interval(ambit_graph *g, ambit_interval x);
/* point literal, rational, "pi" */
AMBIT_EXPORT ambit_expr ambit_graph_decimal(ambit_graph *g, const char *text, ambit_failure *f);
AMBIT_EXPORT ambit_expr ambit_graph_pi(ambit_graph *g);
/* fresh at each call; name may be NULL. Every value of `range` is allowed: its inner range is the same. */
AMBIT_EXPORT ambit_expr ambit_graph_unknown(ambit_graph *g, const char *name, ambit_interval range);
/* An uncertain datum whose range is known from both sides only: allowed values lie in `outer`, all of `inner` are
** allowed (cut to `outer`; reversed or empty: none is known to be). place, name: or NULL. */
AMBIT_EXPORT ambit_expr ambit_graph_datum(
    ambit_graph *g, const char *name, const char *place, ambit_interval outer, ambit_interval inner);
/* The same for a function of time within its range. */
AMBIT_EXPORT ambit_expr ambit_graph_varying(
    ambit_graph *g, const char *name, const char *place, ambit_interval outer, ambit_interval inner);
/* Marks an UNKNOWN as plain. */
AMBIT_EXPORT void ambit_graph_set_plain(ambit_graph *g, ambit_expr unknown);
/* A fresh UNKNOWN stands for a quantity that has no value for a part of the data: nothing made of it is total. */
AMBIT_EXPORT void ambit_graph_mark_partial(ambit_graph *g, ambit_expr unknown);
/* Calls an UNKNOWN or VARYING that has no name so; false: out of memory. */
AMBIT_EXPORT bool ambit_graph_name(ambit_graph *g, ambit_expr unknown, const char *name);
/* the same name is the same node */
AMBIT_EXPORT ambit_expr ambit_graph_symbol(ambit_graph *g, const char *name, const char *unit);
AMBIT_EXPORT ambit_expr ambit_graph_time(ambit_graph *g);

/* How operations that were asked for by the two functions below (also by rules and derivatives) were answered: a node
** that was there already, a constant or one of the operands; by new nodes all others. */
typedef struct ambit_graph_tally {
  uint64_t asked, shared, folded;
} ambit_graph_tally;

AMBIT_EXPORT ambit_graph_tally ambit_graph_answers(const ambit_graph *g);

/* unary: b ignored; POWN: use pown */
AMBIT_EXPORT ambit_expr ambit_graph_op(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b);
AMBIT_EXPORT ambit_expr ambit_graph_pown(ambit_graph *g, ambit_expr a, int32_t n);

/* de/dx for a leaf x, by the chain rule: valid where e is defined and differentiable, that is inside the domains (not
** at 0 of sqrt, at +-1 of asin) and off the cut of atan2, where the result may be defined although e jumps. ABS, MIN,
** MAX: AMBIT_NO_EXPR, and the failure names the opcode. */
AMBIT_EXPORT ambit_expr ambit_graph_derivative(ambit_graph *g, ambit_expr e, ambit_expr x, ambit_failure *f);
/* Total time derivative: leaf k counts as a function of time with derivative rate[k] (leaves not listed are fixed; TIME
** has 1). Valid where the derivative is. AMBIT_NO_EXPR where VARYING is below e. */
AMBIT_EXPORT ambit_expr ambit_graph_time_derivative(
    ambit_graph *g, ambit_expr e, size_t n, const ambit_expr *leaf, const ambit_expr *rate, ambit_failure *f);
/* The same where ABS, MIN and MAX do not switch; where they do, it is undefined. There is none of them in it, so that
** it has derivatives itself. */
AMBIT_EXPORT ambit_expr ambit_graph_rate_off_kinks(
    ambit_graph *g, ambit_expr e, size_t n, const ambit_expr *leaf, const ambit_expr *rate, ambit_failure *f);
/* e[i] with leaf from[k] replaced by to[k], in place; shared work. */
AMBIT_EXPORT ambit_status ambit_graph_substitute(
    ambit_graph *g, size_t ne, ambit_expr *e, size_t n, const ambit_expr *from, const ambit_expr *to, ambit_failure *f);
/* e with |a| as sqrt(a^2) and min, max by |a - b|: equal everywhere, but its derivatives are undefined at the kinks. */
AMBIT_EXPORT ambit_expr ambit_graph_kinks_as_roots(ambit_graph *g, ambit_expr e);
/* Additive terms of e: e = sum of term[i]; returns their number, writes at most `room`. */
AMBIT_EXPORT size_t ambit_graph_terms(
    const ambit_graph *g, ambit_expr e, size_t room, ambit_expr *term, bool *negative);
/* e as a polynomial in its non-polynomial subexpressions, expanded, sin^2 -> 1 - cos^2, collected; returned if it
** needs fewer operations than e and never more than `limit` terms, otherwise e itself. An identity on the domain of
** e. */
AMBIT_EXPORT ambit_expr ambit_graph_simplify(ambit_graph *g, ambit_expr e, size_t limit);
/* The leaves (UNKNOWN, VARYING, SYMBOL, TIME) that e[0..ne) reach, in the order in which they were made; returns how
** many, writes at most room. */
AMBIT_EXPORT size_t ambit_graph_leaves(
    const ambit_graph *g, size_t ne, const ambit_expr *e, size_t room, ambit_expr *leaf);
AMBIT_EXPORT size_t ambit_graph_size(
    const ambit_graph *g, size_t ne, const ambit_expr *e); /* distinct operations below */
/* "0.5*sin(beta1) + x"; at most room bytes, always terminated; returns the full length. */
AMBIT_EXPORT size_t ambit_graph_text(const ambit_graph *g, ambit_expr e, char *out, size_t room);

#ifdef __cplusplus
}
#endif
#endif
