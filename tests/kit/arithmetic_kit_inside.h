/* arithmetic_kit_inside.h -- what the files of the arithmetic kit share. */
#ifndef AMBIT_ARITHMETIC_KIT_INSIDE_H
#define AMBIT_ARITHMETIC_KIT_INSIDE_H
#include "kit/arithmetic_kit.h"

enum { KIT_SLOTS = 64, KIT_PITCH = 21, KIT_NVAR = 6, KIT_OPTIONS = 128 };

typedef struct kit_set {
  double lo, hi;
} kit_set;

/* The floating-point environment in which the caller of a plugin lives. */
typedef struct kit_environment {
  const char *name;
  int mode;       /* FE_... */
  unsigned flush; /* bits of MXCSR: flush-to-zero, denormals-are-zero */
} kit_environment;

/* A host of the kit's own: counts, limits and fails allocations, keeps the last message. */
typedef struct kit_host {
  ambit_host host; /* first */
  const ambit_host *inner;
  void *first;                  /* chain of blocks */
  size_t bytes, count, fail_at; /* fail_at: the allocation that fails, counted from 1; 0: none */
  char message[256];
} kit_host;

/* How often each promise was found broken in a section: only the first findings are told one by one. */
typedef struct kit_tally {
  const char *promise[16];
  unsigned count[16];
} kit_tally;

typedef struct kit_state {
  const arithmetic_kit *kit;
  const ambit_arithmetic *full;
  const kit_environment *environment;
  kit_host host;
  double option[KIT_OPTIONS];
  void *ctx;
  bool rigorous;
  uint32_t nvar;
  double *partial; /* [2 * nvar] room for a gradient */
  size_t elem, pitch, findings;
  char *block, *pattern; /* KIT_SLOTS x pitch elements; one element of bytes that no operation writes */
  uint64_t random;
  double deadline; /* s of CPU time: rounds beyond the least number end there */
  const char *section;
  size_t judged;
  kit_tally tally; /* of the section */
} kit_state;

extern const char *const kit_op_name[AMBIT_OP_COUNT]; /* "ADD", ... */
extern const int kit_op_arity[AMBIT_OP_COUNT];
bool kit_is_own(const arithmetic_kit *kit, uint32_t op); /* offered by the plugin itself */

/* -- bookkeeping */
void kit_find(kit_state *s, const char *promise, const char *format, ...) AMBIT_PRINTF(3, 4);
void kit_slice(kit_state *s, double seconds); /* the rounds that follow have this long */
bool kit_more(const kit_state *s, int round, int usual);
void kit_reseed(kit_state *s, uint64_t item); /* so that findings do not depend on how many rounds went before */

/* -- a context and its block; false: a finding, or refused[0] says why if `refused` is not NULL */
bool kit_open(kit_state *s, const arithmetic_kit *kit, const double *option, uint32_t nvar,
    const kit_environment *environment, const char **refused);
void kit_close(kit_state *s);
void kit_take(kit_state *into, const kit_state *from); /* findings and counts of another state */
void kit_host_open(kit_host *h, const ambit_host *inner);
void kit_host_close(kit_host *h);

/* -- operands */
uint64_t kit_random(kit_state *s);
double kit_uniform(kit_state *s, double lo, double hi);
kit_set kit_any_set(kit_state *s);
kit_set kit_set_within(kit_state *s, double lo, double hi); /* often thin */
double kit_point_of(kit_state *s, kit_set x);               /* an end of x, or something between; finite */
bool kit_is_empty(kit_set x);

/* -- calls, each in the environment of the state, which is checked afterwards */
void *kit_at(const kit_state *s, uint32_t slot, size_t lane);
void kit_set_variable(kit_state *s, uint32_t slot, size_t lane, kit_set x, int32_t var);
void kit_set_element(kit_state *s, uint32_t slot, size_t lane, kit_set x);
kit_set kit_bounds_of(kit_state *s, uint32_t slot, size_t lane);
kit_set kit_through(kit_state *s, uint32_t slot, kit_set x); /* set and bounds between enter and leave */
uint32_t kit_run(
    kit_state *s, uint32_t op, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b, size_t lanes);
uint32_t kit_apply(kit_state *s, uint32_t op, uint32_t dst, uint32_t a, uint32_t b, size_t lanes);
uint32_t kit_eval_tape(kit_state *s, const ambit_tape *t, size_t lanes);
uint32_t kit_dot(
    kit_state *s, uint32_t dst, const void *a, ptrdiff_t sa, const void *b, ptrdiff_t sb, size_t m, size_t lanes);
/* false: none is known; of the first KIT_NVAR variables, of which the context must have so many */
bool kit_gradient(kit_state *s, uint32_t slot, size_t lane, double lo[KIT_NVAR], double hi[KIT_NVAR]);
bool kit_set_text(kit_state *s, uint32_t slot, const char *text);

/* -- sections */
void kit_check_elements(kit_state *s);
void kit_check_operations(kit_state *s);
void kit_check_special_sets(kit_state *s);
void kit_check_isotonic(kit_state *s);
void kit_check_identities(kit_state *s);
void kit_check_programs(kit_state *s);
void kit_check_dot(kit_state *s);
void kit_check_text(kit_state *s);
void kit_check_jets(kit_state *s);
void kit_check_environments(kit_state *s);
void kit_check_contexts(kit_state *s);
void kit_check_options(kit_state *s);
void kit_check_briefly(kit_state *s, int rounds); /* every operation: for other contexts */
#endif
