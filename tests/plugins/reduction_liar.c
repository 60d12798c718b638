/* reduction_liar.c -- a solver of reductions that claims what was not proved, in the way of its option; for tests. */
#include <ambit/reduction.h>
#include <string.h>

enum { NONE, UNPROVED, OVER, MORE, OTHER, LOWERED, TWICE, BEYOND, NOTHING, REPEATED };

static const ambit_param param[] = {
  { "lie", "1", "none|unproved|over|more|other|lowered|twice|beyond|nothing|repeated", "none", "what it claims" },
  { NULL, NULL, NULL, NULL, NULL },
};

typedef struct liar {
  const ambit_reduction *r;
  int lie;
} liar;

static ambit_status open(const ambit_host *h, const ambit_reduction *r, const double *option, void **self) {
  liar *s = h->alloc(h, sizeof *s);
  if (!s) return AMBIT_NOMEM;
  *s = (liar) { r, (int)option[0] };
  *self = s;
  return AMBIT_OK;
}

static void close(void *self) { (void)self; }

static void claim(const liar *s, uint32_t n, const uint32_t *candidate) {
  static const double error = 0;
  const ambit_try t = {
    .size = sizeof t, .outcome = AMBIT_TRY_ACCEPTED, .ncandidate = n, .candidate = candidate, .error = &error
  };
  s->r->tried(s->r->user, &t);
}

/* candidates: 0 is within the bound, 1 is over it */
static ambit_status run(void *self, ambit_sink *sink) {
  static const uint32_t zero = 0, one = 1, beyond = 3, both[2] = { 0, 1 }, repeated[2] = { 0, 0 };
  const uint8_t cut_zero[3] = { 1, 0, 0 }, cut_one[3] = { 0, 1, 0 }, cut_two[3] = { 1, 0, 1 };
  const liar *s = self;
  double error[4];
  (void)sink;
  if (s->lie == OVER) s->r->prove(s->r->user, AMBIT_PROVE_FULL, cut_one, error);
  if (s->lie == LOWERED) s->r->prove(s->r->user, AMBIT_PROVE_LOWERED, cut_zero, error);
  if (s->lie != UNPROVED && s->lie != OVER && s->lie != LOWERED)
    s->r->prove(s->r->user, AMBIT_PROVE_FULL, s->lie == REPEATED ? cut_two : cut_zero, error);
  switch (s->lie) {
  case OVER:
  case OTHER: claim(s, 1, &one); break;
  case MORE: claim(s, 2, both); break;
  case BEYOND: claim(s, 1, &beyond); break;
  case NOTHING: claim(s, 0, &zero); break;
  case REPEATED: claim(s, 2, repeated); break; /* of two that were proved together, one twice */
  default: claim(s, 1, &zero); break;
  }
  if (s->lie == TWICE) claim(s, 1, &zero);
  return AMBIT_OK;
}

static const ambit_strategy interface = {
  .size = sizeof interface, .arithmetics = "real", .param = param, .open = open, .run = run, .close = close
};

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_STRATEGY) == 0 ? &interface : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.liar", "1.0",
  "Claims reductions that were not proved; for tests.", get };
