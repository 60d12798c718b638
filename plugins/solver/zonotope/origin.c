/* origin.c -- where the width of the generators comes from, for reasons and for whoever improves the solver. */
#include "proof.h"
#include <stdio.h>

static const char *const names[ORIGINS] = {
  [FROM_START] = "rounding",
  [FROM_DEGREE] = "higher degrees in the data",
  [FROM_TIME] = "truncation in time",
  [FROM_SQUARE] = "products of errors",
  [FROM_KERNEL] = "errors' action within a step",
  [FROM_SLOPE] = "errors' dependence on the data",
  [FROM_JACOBIAN] = "slopes' dependence on the data",
  [FROM_MIXED] = "older errors' dependence on the data",
};

void origin_text(const zono *z, uint32_t i, char *text, size_t room) {
  double share[ORIGINS] = { 0 };
  size_t at = 0;
  for (uint32_t c = 0; c < z->ngen; c++) share[z->proof->from[c]] += fabs(z->G[(size_t)c * z->nx + i]);
  if (room) text[0] = 0;
  for (int n = 0; n < ORIGINS && at < room; n++) {
    int most = 0;
    for (int o = 1; o < ORIGINS; o++)
      if (share[o] > share[most]) most = o;
    double percent = z->E[i] > 0 ? 100 * share[most] / z->E[i] : 0;
    if (percent < 1) return;
    at += (size_t)snprintf(text + at, room - at, "%s%s %.0f %%", at ? ", " : "", names[most], percent);
    share[most] = -1;
  }
}
