/* batch.h -- a tape over very many lanes: they stream through a small block, as many at a time as a cache holds.
**
** Slots of a tape are written once and never reused, so a block of 10^4 slots and 10^4 lanes would need gigabytes. A
** batch gives several slots the same place, once the first is read for the last time, and needs room for what is alive
** at the same time only. It works through run[]; an arithmetic's eval_tape wants the tape's own slots and is not used.
*/
#ifndef AMBIT_BATCH_H
#define AMBIT_BATCH_H
#include "graph/interpreter.h"
#include <ambit/work.h>

typedef struct ambit_batch ambit_batch;
/* The tape must outlive the batch. */
ambit_status ambit_batch_open(
    const ambit_tape *t, const ambit_arithmetic *full, void *ctx, ambit_batch **batch, ambit_failure *f);
void ambit_batch_close(ambit_batch *batch);
size_t ambit_batch_places(const ambit_batch *batch);          /* slots after sharing */
const ambit_work *ambit_batch_work(const ambit_batch *batch); /* done so far */
size_t ambit_batch_width(const ambit_batch *batch);           /* lanes at a time */
/* Inputs lo, hi [nin][lanes], outputs rlo, rhi [nout][lanes], which must not overlap. var [nin]: the number of the
** independent variable that an input is, or -1; NULL: none is. No allocation; AMBIT_F_* over all lanes. */
uint32_t ambit_batch_run(
    ambit_batch *batch, size_t lanes, const double *lo, const double *hi, const int32_t *var, double *rlo, double *rhi);
#endif
