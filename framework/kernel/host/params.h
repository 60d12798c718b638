/* params.h -- options by name -> the flat array that open() takes. */
#ifndef AMBIT_PARAMS_H
#define AMBIT_PARAMS_H
#include <ambit/registry.h>

size_t ambit_params_count(const ambit_param *param);
size_t ambit_params_doubles(const ambit_param *param);
/* In declaration order, shapes flattened; NaN where an option that may be absent (fallback "") is. Numbers are the
** nearest double. Unknown name: error with the nearest. `owner`: "solver `lohner`", for messages. */
ambit_status ambit_params_resolve(
    const ambit_param *param, const char *owner, size_t n, const ambit_option *given, double *out, ambit_failure *f);
#endif
