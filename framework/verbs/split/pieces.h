/* pieces.h -- a box of uncertain data cut into a grid of boxes that cover it exactly: neighbours share the numbers at
** which they meet, the outermost ones are those of the box.
*/
#ifndef AMBIT_PIECES_H
#define AMBIT_PIECES_H
#include <ambit/arena.h>
#include <ambit/status.h>
#include <stdint.h>

#define AMBIT_PIECES_MAX 65536

typedef struct ambit_pieces {
  uint32_t nu, count;
  const uint32_t *parts;     /* [nu] */
  const double *const *edge; /* [nu][parts + 1] ascending */
  const double *box;         /* or, instead of a grid, any boxes: [count][2 nu], lo and hi */
} ambit_pieces;

/* Cuts the range of each unknown into parts[j] >= 1 equal parts, or into fewer where there are not so many doubles
** (no part is a point unless the range is). INVALID: more than AMBIT_PIECES_MAX in all. */
ambit_status ambit_pieces_cut(ambit_arena *arena, uint32_t nu, const double *lo, const double *hi,
    const uint32_t *parts, ambit_pieces *p, ambit_failure *f);

/* The ranges of piece `item` < count; in a grid the last unknown varies fastest. */
void ambit_pieces_range(const ambit_pieces *p, uint32_t item, double *lo, double *hi);

/* Deals at most `total` pieces out to the unknowns with parts[j] == 0, those with parts[j] > 0 being fixed: always one
** more part to the unknown whose parts have the most influence left, by influence[j] / parts, as long as the product
** allows it. */
void ambit_pieces_deal(uint32_t nu, const double *influence, uint32_t total, uint32_t *parts);
#endif
