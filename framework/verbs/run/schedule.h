/* schedule.h -- the samples of a run: when the states of a system jump, in the order of the true instants.
**
** A clock's instants are start + first + k period, real numbers. Decimals and their quotients are compared as what they
** are; instants of other clocks (pi / 100) are compared as far as doubles tell.
** docs/numerics/instants.md.
*/
#ifndef AMBIT_SCHEDULE_H
#define AMBIT_SCHEDULE_H
#include <ambit/registry.h>
#include <ambit/system.h>

typedef struct ambit_schedule {
  const ambit_system *system;
  ambit_registry *registry;
  double start;
  /* how far a double is off its instant, at most; 0: none is */
  double error;
  uint32_t n;
  /* [n] for each sample a double beside its instant, before the end of the run: ascending, the same for samples of one
  ** instant only; the last double that is not behind the instant. */
  double *time;
  uint32_t *number; /* [n] of the jump; at one instant in the order of the system's jumps */
  uint32_t *count;  /* [n] which sample of this jump it is, from 0 on */
} ambit_schedule;

/* All samples from `start` to before `final`, the true end, NULL: it is the double `end`; else `end` is not before it.
** The schedule lives in the arena. UNABLE: two instants are nearer than doubles can hold apart, or it cannot be told
** which is earlier. INVALID: more samples than anybody can follow. */
ambit_status ambit_schedule_build(const ambit_system *s, ambit_registry *registry, double start, double end,
    const ambit_expr *final, ambit_arena *arena, ambit_schedule *to, ambit_failure *f);
/* *n := how many samples are before the instant t, a constant expression; UNABLE: not known. */
ambit_status ambit_schedule_before(const ambit_schedule *s, ambit_expr t, uint32_t *n, ambit_failure *f);
#endif
