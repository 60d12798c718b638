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

/* A run of parts that are cut again only where its sets reach far beyond a band about the truth, such as a sampled
** hull; the band proves nothing, and nothing that is proved depends on it. At the k-th time behind the first, state i
** is wide where it reaches beyond lo[k nx + i] or hi[k nx + i] by more than `limit` (hi - lo); where hi > lo does not
** hold, it does not count. The same parts come out for any number of threads, and on every machine. */
typedef struct ambit_cut_band {
  uint32_t most;         /* runs */
  double limit, work;    /* operations (ambit/work.h) after which no part is cut any more; 0: no such limit */
  const double *lo, *hi; /* [ntime - 1][nx] */
} ambit_cut_band;
#endif
