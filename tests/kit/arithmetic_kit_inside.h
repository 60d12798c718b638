/* arithmetic_kit_inside.h -- what the files of the arithmetic kit share. */
#ifndef AMBIT_ARITHMETIC_KIT_INSIDE_H
#define AMBIT_ARITHMETIC_KIT_INSIDE_H
#include "kit/arithmetic_kit.h"

enum { KIT_A, KIT_B, KIT_R, KIT_T, KIT_SLOTS = 64, KIT_PITCH = 7 };

typedef struct kit_set {
  double lo, hi;
} kit_set;

typedef struct kit_state {
  const arithmetic_kit *kit;
  const ambit_arithmetic *full;
  void *ctx;
  bool rigorous;
  size_t elem, pitch, findings, repeats;
  char *block, *pattern; /* KIT_SLOTS x pitch elements; one element of bytes that no operation writes */
  const char *last;      /* check of the last finding */
  uint64_t random;
} kit_state;

void kit_find(kit_state *s, const char *check, const char *format, ...) AMBIT_PRINTF(3, 4);
uint64_t kit_random(kit_state *s);
double kit_uniform(kit_state *s, double lo, double hi);
kit_set kit_any_set(kit_state *s);
void *kit_at(const kit_state *s, uint32_t slot, size_t lane);
void kit_set_element(kit_state *s, uint32_t slot, size_t lane, kit_set x);
kit_set kit_bounds_of(kit_state *s, uint32_t slot, size_t lane);
uint32_t kit_apply(kit_state *s, uint32_t op, uint32_t dst, uint32_t a, uint32_t b, size_t lanes);
void kit_check_tier_2(kit_state *s);
#endif
