/* export.h -- "ambit.export/1": typed C functions that Lua sees with no glue.
**
** Signature: result, then arguments in brackets: v void, i int32, l int64, d double, s const char *, D array of double
** (a pointer, then a size_t count), (..) a callback with its own signature, followed by a void * user word.
** Example "d(Ddd)": double f(const double *, size_t, double, double).
*/
#ifndef AMBIT_EXPORT_H
#define AMBIT_EXPORT_H
#include "base.h"

#define AMBIT_EXPORTS "ambit.export/1"

typedef struct ambit_function {
  const char *name, *signature;
  void (*call)(void);
  const char *doc;
} ambit_function;

typedef struct ambit_exports {
  uint32_t size, count;
  const ambit_function *function; /* [count] */
} ambit_exports;
#endif
