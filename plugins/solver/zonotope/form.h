/* form.h -- linear forms: c + sum_v l_v sigma_v +- rad, all sigma_v in [-1, 1].
**
** A form is  c | l [n] | rad | norm | mass | seen:  norm >= sum |l_v| (up to date after form_close()), mass a bound of
** what was added up so far, for rounding. A form encloses a function of (xi, eps, s): for each of their values, the
** function's value minus the linear part is within rad. All sums that bound are of numbers >= 0, in round-to-nearest;
** the last user adds 1e-9 of them (docs/numerics/zonotope.md).
*/
#ifndef ZONOTOPE_FORM_H
#define ZONOTOPE_FORM_H
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define UNIT 0x1p-53 /* relative error of one operation */
#define ABOVE (1 + 1e-9)
#define LEAST 1e-280 /* above all that underflow may lose */

typedef struct forms {
  uint32_t n, stride; /* sigmas; doubles of a form */
  int powers;         /* sigma_v is Chebyshev's polynomial T_v of one sigma, time */
} forms;

static inline forms forms_of(uint32_t n, int powers) { return (forms) { n, (n + 5 + 3) & ~3u, powers }; }
static inline double *form_rad(const forms *f, double *x) { return x + 1 + f->n; }
static inline double form_norm(const forms *f, const double *x) { return x[2 + f->n]; }
static inline double form_mass(const forms *f, const double *x) { return x[3 + f->n]; }
/* of everything but the centre; of everything */
static inline double form_moving(const forms *f, const double *x) { return x[2 + f->n] + x[1 + f->n]; }
static inline double form_total(const forms *f, const double *x) { return fabs(x[0]) + form_moving(f, x); }
/* was anything put into it since it was cleared? */
static inline int form_seen(const forms *f, const double *x) { return x[4 + f->n] != 0; }
static inline void form_clear(const forms *f, double *x) { memset(x, 0, f->stride * sizeof *x); }

void form_constant(const forms *f, double *x, double c);
void form_close(const forms *f, double *x); /* brings norm up to date, charges rounding */
/* to += scale a, scale exact; to is to be closed again */
void form_add(const forms *f, double *to, double scale, const double *a);
/* to += scale a b; scale is 1 or -1 or another power of two; to is neither a nor b */
void form_product(const forms *f, double *to, double scale, const double *a, const double *b);
/* to := 1 / (a +- more); 0: may vanish */
int form_inverse(const forms *f, double *to, const double *a, double more);
/* to := a, its radius raised by `more` */
void form_widen(const forms *f, double *to, const double *a, double more);
#endif
