/* text.c -- constants by what they say: "0.1", "0x1.8p-3", "1/3", "pi", in the working precision.
**
** Literals come from the kernel, which has checked their grammar (IEEE 1788-2015); MPFR converts decimal and
** hexadecimal text of any length with correct rounding. A quotient is exact up to the roundings of its parts.
*/
#include "sets.h"
#include <string.h>

/* r := the number that text begins with; its end, or NULL */
static const char *read_number(set *r, const char *text) {
  const char *bare = text + (*text == '-' || *text == '+');
  if (!((*bare >= '0' && *bare <= '9') || *bare == '.')) return NULL;
  int base = bare[0] == '0' && (bare[1] == 'x' || bare[1] == 'X') ? 16 : 10;
  char *end;
  mpfr_strtofr(r->lo, text, &end, base, MPFR_RNDD);
  mpfr_strtofr(r->hi, text, &end, base, MPFR_RNDU);
  return end > text ? end : NULL;
}

int32_t sets_read(context *c, set *r, const char *text) {
  if (strcmp(text, "pi") == 0) {
    mpfr_const_pi(r->lo, MPFR_RNDD);
    mpfr_const_pi(r->hi, MPFR_RNDU);
    return 1;
  }
  set above = { { *c->work[0] }, { *c->work[1] } }, below = { { *c->work[2] }, { *c->work[3] } };
  const char *end = read_number(&above, text);
  if (!end || (*end && *end != '/')) return 0;
  if (*end == '/') {
    end = read_number(&below, end + 1);
    if (!end || *end || mpfr_sgn(below.lo) <= 0) return 0;
    sets_divide_by_positive(r, &above, &below);
    return 1;
  }
  mpfr_set(r->lo, above.lo, MPFR_RNDD);
  mpfr_set(r->hi, above.hi, MPFR_RNDU);
  return 1;
}
