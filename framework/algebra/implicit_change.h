/* implicit_change.h -- the implicit form of a system that was made of another one: leaves replaced, states added. */
#ifndef AMBIT_IMPLICIT_CHANGE_H
#define AMBIT_IMPLICIT_CHANGE_H
#include <ambit/system.h>

/* The new system is `of` with leaf[n] (data, time; no states, no unknowns of the form) replaced by value[n], and with
** further states y_k = g_k(x, t) behind those of `of`, in terms of its leaves before they are replaced: y_k' is written
** with F. Nothing is written before it is asked for. */
typedef struct ambit_implicit_change {
  const ambit_system *of; /* has to live as long as the new one */
  size_t n, nfurther;
  const ambit_expr *leaf, *value, *g;
} ambit_implicit_change;

/* NULL: `of` has no implicit form, or (f) out of memory. Copies the lists into the arena, that of the new system. */
ambit_system_source *ambit_implicit_change_open(
    const ambit_implicit_change *change, ambit_arena *arena, ambit_failure *f);
#endif
