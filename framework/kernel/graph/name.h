/* name.h -- what the uncertain data of a graph are called: the one place that makes these names.
**
** A datum has the name that the script gave it, or else that of the place where it was first used: "upper.offset.x",
** "initial angle". Until then it is called after its range and the line that made it.
*/
#ifndef AMBIT_NAME_H
#define AMBIT_NAME_H
#include <ambit/graph.h>

#define AMBIT_DATUM_NAME_MAX 256

/* Calls the unnamed data below e `label`, "label (2)", ... in the order in which they were made; false: out of memory.
*/
bool ambit_graph_name_data(ambit_graph *g, ambit_expr e, const char *label);
/* The name of a leaf: of a datum without one "datum in [1, 2] (scene.lua:12)". */
void ambit_graph_leaf_name(const ambit_graph *g, ambit_expr leaf, char out[AMBIT_DATUM_NAME_MAX]);
/* Those of several leaves, told apart: equal ones get the lines where they were made, and where these are equal too a
** number. Texts in the arena; false: out of memory. */
bool ambit_graph_leaf_names(
    const ambit_graph *g, ambit_arena *arena, size_t n, const ambit_expr *leaf, const char **name);
#endif
