/* arithmetic_kit.c -- the order of the sections, findings, random operands. */
#include "host/params.h"
#include "kit/arithmetic_kit_inside.h"
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <mpfr.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

const char *const kit_op_name[AMBIT_OP_COUNT] = {
#define NAME(name, arity, symbol) #name,
  AMBIT_OPS(NAME)
#undef NAME
};
const int kit_op_arity[AMBIT_OP_COUNT] = {
#define ARITY(name, arity, symbol) arity,
  AMBIT_OPS(ARITY)
#undef ARITY
};

/* -- bookkeeping */

void kit_find(kit_state *s, const char *promise, const char *format, ...) {
  char message[640];
  va_list arguments;
  size_t i = 0, most = sizeof s->tally.count / sizeof *s->tally.count;
  s->findings++;
  while (i < most - 1 && s->tally.promise[i] && strcmp(s->tally.promise[i], promise) != 0) i++;
  s->tally.promise[i] = promise;
  if (s->tally.count[i]++ >= 5) return;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  s->kit->finding(s->kit->user, promise, message);
}

static double cpu_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double effort_of(const kit_state *s) { return s->kit->effort > 0 ? s->kit->effort : 1; }

void kit_slice(kit_state *s, double seconds) { s->deadline = cpu_seconds() + seconds * effort_of(s); }

bool kit_more(const kit_state *s, int round, int usual) {
  double most = usual * effort_of(s);
  return round < 1 || (round < most && (round <= usual / 20 || cpu_seconds() < s->deadline));
}

/* Steele, Lea and Flood's mixer of 2014 (splitmix64) of the seed and what is checked */
void kit_reseed(kit_state *s, uint64_t item) {
  uint64_t z = s->kit->seed + item * 0x9E3779B97F4A7C15ull;
  for (const char *c = s->section; c && *c; c++) z = (z ^ (unsigned char)*c) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  s->random = (z ^ (z >> 31)) | 1;
}

/* -- operands */

uint64_t kit_random(kit_state *s) { /* xorshift64*, Vigna 2016 */
  s->random ^= s->random >> 12, s->random ^= s->random << 25, s->random ^= s->random >> 27;
  return s->random * 0x2545F4914F6CDD1Dull;
}

double kit_uniform(kit_state *s, double lo, double hi) {
  return lo + (hi - lo) * ((double)(kit_random(s) >> 11) * 0x1p-53);
}

static double any_double(kit_state *s) {
  static const double nasty[] = { 0.0, -0.0, 1, -1, 0.5, 2, DBL_MIN, -0x1p-1074, 0x1p-1074, DBL_MAX, -DBL_MAX, 0x1p53,
    1e300, 1e-300, 0x1.921fb54442d18p+0, 0x1.921fb54442d18p+1, 0x1.fffffffffffffp-1, 0x1.0000000000001p0, 709.78,
    -745.2 };
  uint64_t r = kit_random(s);
  if (r % 6 == 0) return nasty[(r >> 8) % (sizeof nasty / sizeof *nasty)];
  if (r % 6 == 1) return ldexp(kit_uniform(s, -1, 1), (int)((r >> 8) % 2098) - 1074);
  if (r % 6 == 2)
    return ldexp((double)((r >> 8) % 65536) - 32768, -(int)((r >> 32) % 20)); /* few bits: exact results */
  return kit_uniform(s, -8, 8);
}

kit_set kit_any_set(kit_state *s) {
  double a = any_double(s), b = any_double(s);
  switch (kit_random(s) % 8) {
  case 0:
  case 1: return (kit_set) { a, a };
  case 2: return (kit_set) { a, a < DBL_MAX ? nextafter(a, INFINITY) : a };
  case 3: return (kit_set) { -INFINITY, a };
  case 4: return (kit_set) { a, INFINITY };
  default: return a <= b ? (kit_set) { a, b } : (kit_set) { b, a };
  }
}

kit_set kit_set_within(kit_state *s, double lo, double hi) {
  double a = kit_uniform(s, lo, hi), b = kit_uniform(s, lo, hi);
  switch (kit_random(s) % 4) {
  case 0: b = a; break;
  case 1: b = fmin(hi, nextafter(a, INFINITY)); break;
  case 2: b = fmin(hi, a + ldexp(hi - lo, -(int)(kit_random(s) % 40) - 2)); break;
  default: break;
  }
  return a <= b ? (kit_set) { a, b } : (kit_set) { b, a };
}

double kit_point_of(kit_state *s, kit_set x) {
  double lo = fmax(x.lo, -DBL_MAX), hi = fmin(x.hi, DBL_MAX), p = 0;
  switch (kit_random(s) % 4) {
  case 0: return lo;
  case 1: return hi;
  case 2: p = lo / 2 + hi / 2; break;
  default: p = hi - lo < 1 ? kit_uniform(s, lo, hi) : any_double(s); break;
  }
  return p < lo ? lo : p > hi ? hi : p;
}

bool kit_is_empty(kit_set x) { return x.lo == INFINITY && x.hi == -INFINITY; }

/* -- sections */

static const struct {
  const char *name;
  void (*run)(kit_state *s);
  double seconds;
} sections[] = {
  { "elements", kit_check_elements, 0.1 },
  { "operations", kit_check_operations, 1.2 },
  { "special sets", kit_check_special_sets, 0.4 },
  { "isotonicity", kit_check_isotonic, 0.2 },
  { "identities", kit_check_identities, 0.4 },
  { "programs", kit_check_programs, 0.8 },
  { "dot", kit_check_dot, 0.2 },
  { "set_text", kit_check_text, 0.1 },
  { "jets", kit_check_jets, 0.2 },
  { "environments", kit_check_environments, 0.6 },
  { "contexts", kit_check_contexts, 0.3 },
  { "options", kit_check_options, 0.5 },
};

bool kit_is_own(const arithmetic_kit *kit, uint32_t op) {
  bool exists = offsetof(ambit_arithmetic, run) + (op + 1) * sizeof(ambit_run_fn) <= kit->plugin->size;
  return exists && kit->plugin->run[op];
}

static void tell_fallbacks(const arithmetic_kit *kit) {
  for (uint32_t op = 0; op < AMBIT_OP_COUNT && kit->fallback; op++)
    if (!kit_is_own(kit, op)) kit->fallback(kit->user, kit_op_name[op]);
}

static const kit_environment usual = { "round to nearest", FE_TONEAREST, 0 };

size_t arithmetic_kit_run(const arithmetic_kit *kit) {
  kit_state s;
  double option[KIT_OPTIONS];
  ambit_failure f = { 0 };
  s = (kit_state) { .kit = kit, .full = kit->full, .section = "open" };
  if (kit->begin) kit->begin(kit->user, "open");
  if (ambit_params_doubles(kit->full->param) > KIT_OPTIONS)
    kit_find(&s, "options", "more than %d numbers", (int)KIT_OPTIONS);
  else if (ambit_params_resolve(kit->full->param, "the arithmetic", kit->noption, kit->option, option, &f) != AMBIT_OK)
    kit_find(&s, "options", "%s", f.message);
  else if (kit_open(&s, kit, option, KIT_NVAR, &usual, NULL)) {
    if (kit->done) kit->done(kit->user, "open", 1, s.findings);
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
      size_t before = s.findings;
      s.section = sections[i].name, s.judged = 0, s.tally = (kit_tally) { 0 };
      if (kit->begin) kit->begin(kit->user, s.section);
      kit_reseed(&s, 0);
      kit_slice(&s, sections[i].seconds);
      sections[i].run(&s);
      if (kit->done) kit->done(kit->user, s.section, s.judged, s.findings - before);
    }
    tell_fallbacks(kit);
    kit_close(&s);
    mpfr_free_cache();
  }
  return s.findings;
}
