/* evaluate.h -- the verb `evaluate`: enclosures of expressions in a chosen arithmetic. */
#ifndef AMBIT_EVALUATE_H
#define AMBIT_EVALUATE_H
#include <ambit/graph.h>
#include <ambit/registry.h>
#include <ambit/report.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_evaluate_request {
  ambit_graph *graph;
  ambit_registry *registry;
  const char *arithmetic; /* "interval" */
  size_t noption;
  const ambit_option *option;
  size_t nexpr;
  const ambit_expr *expr;
  size_t nbinding; /* `at`: leaf := expression (over unknowns) */
  const ambit_expr *leaf, *value;
  uint8_t *partial; /* [nexpr], out: 1 where the result holds for a part of the data only; NULL: not asked for */
  char *blame;      /* [AMBIT_BLAME_MAX], out: the operation that left its domain first, or ""; NULL */
} ambit_evaluate_request;

#define AMBIT_BLAME_MAX 256

/* out [nexpr]; flags: AMBIT_F_*. Only uncertain data become variables of the arithmetic. A symbol without a value is
** INVALID and named. If the arithmetic tells derivatives, bounds are also sought at faces where a result is
** monotone. */
AMBIT_EXPORT ambit_status ambit_evaluate(
    const ambit_evaluate_request *q, ambit_interval *out, uint32_t *flags, ambit_report *report, ambit_failure *f);

#ifdef __cplusplus
}
#endif
#endif
