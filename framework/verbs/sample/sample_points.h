/* sample_points.h -- the points of a sample: number 0 is the midpoint of the box; then corners and points of the inside
** in turn, until there are no more corners than half of the draws; the rest are points of the inside.
**
** Functions that are nearly linear in each datum have their extremes at corners, which points of the inside do not come
** near in many dimensions; moments and extremes inside need points that are evenly spread. Those are a quasi-random
** sequence, all of it shifted by a random vector modulo 1 (Cranley & Patterson 1976), so that another seed is another
** sample. All corners are taken, in a random order of their bits, where they are few; otherwise random ones.
**
** A block of draws is the same whoever takes it: the sequence runs on behind a lock, blocks are numbered.
*/
#ifndef AMBIT_SAMPLE_POINTS_H
#define AMBIT_SAMPLE_POINTS_H
#include <ambit/registry.h>
#include <ambit/interval.h>
#include <stdbool.h>

typedef struct ambit_sample_points_request {
  size_t draws;
  uint64_t seed;
  const char *points; /* "sobol", "niederreiter", "halton", "reverse_halton", "random"; NULL: what suits the number */
  bool no_corners;
  size_t n;                    /* data */
  const ambit_interval *range; /* [n] bounded and not empty; must outlive the points */
} ambit_sample_points_request;

typedef struct ambit_sample_points ambit_sample_points;

/* Loads service/quasi_random unless `points` is "random". Where that is not installed, or there are more data than a
** sequence has dimensions, the draws are pseudo-random, unless a sequence was named: then it is INVALID. */
ambit_status ambit_sample_points_open(
    ambit_registry *registry, const ambit_sample_points_request *q, ambit_sample_points **points, ambit_failure *f);
void ambit_sample_points_close(ambit_sample_points *points);             /* NULL is allowed */
const char *ambit_sample_points_name(const ambit_sample_points *points); /* of the sequence, or "random" */
const char *ambit_sample_points_why(const ambit_sample_points *points);  /* pseudo-random ones: why; or "" */
/* [any] the next block of at most `most` draws: datum i of draw first + k in out[i * *count + k]; *count is 0 at the
** end. The same `most` for all blocks. */
ambit_status ambit_sample_points_next(
    ambit_sample_points *points, size_t most, double *out, size_t *first, size_t *count);
#endif
