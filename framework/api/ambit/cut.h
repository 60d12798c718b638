/* cut.h -- how uncertain data are cut, so that each piece is a run of its own. */
#ifndef AMBIT_CUT_REQUEST_H
#define AMBIT_CUT_REQUEST_H
#include <ambit/element.h> /* ambit_expr */

/* parts == 0: not cut, but it has this name, and may be cut by choice. */
typedef struct ambit_cut {
  ambit_expr unknown;
  const char *name;
  uint32_t parts;
} ambit_cut;
#endif
