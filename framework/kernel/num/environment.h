/* environment.h -- the floating-point environment of the calling thread, and rounding mode and locale for the C
** library's conversions.
**
** printf and strtod look at the mode of the whole environment (x87 control word included) and at the decimal point of
** the thread's locale; a host program or os.setlocale may have changed either.
*/
#ifndef AMBIT_ENVIRONMENT_H
#define AMBIT_ENVIRONMENT_H
#include <fenv.h>
#include <locale.h>
#include <stdbool.h>

/* Does the calling thread round to nearest, with subnormal numbers? Found by trying, so that it holds everywhere. */
bool ambit_environment_is_standard(void);

typedef struct ambit_environment {
  fenv_t floating;
  locale_t locale;
} ambit_environment;

/* nearest mode, C locale */
static inline ambit_environment ambit_environment_enter(void) {
  ambit_environment old;
  fegetenv(&old.floating);
  fesetenv(FE_DFL_ENV);
  old.locale = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); /* glibc: a static object, nothing to free */
  return old;
}

static inline void ambit_environment_down(void) { fesetround(FE_DOWNWARD); }
static inline void ambit_environment_up(void) { fesetround(FE_UPWARD); }

static inline void ambit_environment_leave(ambit_environment old) {
  uselocale(old.locale);
  fesetenv(&old.floating);
}
#endif
