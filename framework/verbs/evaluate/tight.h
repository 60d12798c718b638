/* tight.h -- the number that a constant expression is, to a few units in the last place.
**
** The graph's own range of a constant expression comes from doubles and is wide where digits cancel. The ends of an
** uncertain datum are such expressions; what lies between both bounds of an end is neither allowed nor excluded, so
** they are evaluated with as many digits as it takes.
*/
#ifndef AMBIT_TIGHT_H
#define AMBIT_TIGHT_H
#include <ambit/graph.h>
#include <ambit/registry.h>

/* Encloses the constant expression e. Where the graph's range is wide the arithmetic `mpfr` evaluates e; without that
** plugin, or where 8192 bits do not suffice, what is known stays as wide as it is. Never loaded for literals. */
ambit_interval ambit_tight(ambit_graph *g, ambit_registry *registry, ambit_expr e);
#endif
