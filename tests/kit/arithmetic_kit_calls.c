/* arithmetic_kit_calls.c -- contexts, and every call of the plugin, in the floating-point environment of its caller.
**
** No function that changes the environment computes with doubles: compilers move such operations across the change.
*/
#include "host/params.h"
#include "kit/arithmetic_kit_inside.h"
#include "kit/conduct.h"
#include <fenv.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__x86_64__) || defined(__i386__)
#include <xmmintrin.h>
#define CONTROL 0xffc0u /* of MXCSR: rounding, flushing, traps; fegetround sees only the x87 unit */
static unsigned control_get(void) { return _mm_getcsr() & CONTROL; }
static void control_set(unsigned bits) { _mm_setcsr((_mm_getcsr() & ~CONTROL) | bits); }
static unsigned control_with(unsigned flush) { return control_get() | flush; }
#else
static unsigned control_get(void) { return 0; }
static void control_set(unsigned bits) { (void)bits; }
static unsigned control_with(unsigned flush) { return (void)flush, 0; }
#endif

/* -- the host */

#define BLOCK_HEAD 64u
#define MEMORY_MAX ((size_t)1 << 30) /* of one context: more is refused, as a small machine would */

static void *host_alloc(const ambit_host *host, size_t bytes) {
  kit_host *h = (kit_host *)(uintptr_t)host;
  if (++h->count == h->fail_at || bytes > MEMORY_MAX - h->bytes) return NULL;
  size_t size = (bytes + 2 * BLOCK_HEAD - 1) / BLOCK_HEAD * BLOCK_HEAD;
  char *block = aligned_alloc(BLOCK_HEAD, size);
  if (!block) return NULL;
  memset(block, 0, size);
  memcpy(block, &h->first, sizeof h->first);
  h->first = block, h->bytes += bytes;
  return block + BLOCK_HEAD;
}

static ambit_status host_fail(const ambit_host *host, ambit_status status, const char *format, ...) {
  kit_host *h = (kit_host *)(uintptr_t)host;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(h->message, sizeof h->message, format, arguments);
  va_end(arguments);
  return status;
}

static ambit_status host_fail_code(
    const ambit_host *host, ambit_status status, const char *code, const char *format, ...) {
  kit_host *h = (kit_host *)(uintptr_t)host;
  va_list arguments;
  (void)code;
  va_start(arguments, format);
  vsnprintf(h->message, sizeof h->message, format, arguments);
  va_end(arguments);
  return status;
}

static void host_note(const ambit_host *host, const char *format, ...) { (void)host, (void)format; }

static const void *host_service(const ambit_host *host, const char *id) {
  const ambit_host *inner = ((const kit_host *)(const void *)host)->inner;
  return inner->service(inner, id);
}

void kit_host_open(kit_host *h, const ambit_host *inner) {
  *h = (kit_host) { .host = { sizeof h->host, inner->abi, host_alloc, host_fail, host_note, host_service,
                        host_fail_code },
    .inner = inner };
}

void kit_host_close(kit_host *h) {
  while (h->first) {
    void *next;
    memcpy(&next, h->first, sizeof next);
    free(h->first);
    h->first = next;
  }
}

/* -- the environment */

typedef struct saved {
  int mode, own_mode;
  unsigned control, own_control;
} saved;

static saved change(const kit_state *s) {
  saved old = { fegetround(), s->environment->mode, control_get(), 0 };
  fesetround(s->environment->mode);
  old.own_control = control_with(s->environment->flush);
  control_set(old.own_control);
  return old;
}

static void restore(kit_state *s, saved old, const char *what) {
  bool kept = fegetround() == old.own_mode && control_get() == old.own_control;
  fesetround(old.mode);
  control_set(old.control);
  if (!kept)
    kit_find(s, "environment", "%s does not restore the rounding mode (called in %s)", what, s->environment->name);
}

/* -- contexts */

static bool refuse(kit_state *s, const char **refused, const char *why) {
  if (refused)
    *refused = why;
  else
    kit_find(s, "open", "%s", why);
  return false;
}

static bool make_block(kit_state *s, const char **refused) {
  if (s->elem == 0 || s->elem % 8 != 0) {
    kit_find(s, "open", "elements of %zu bytes; a positive multiple of 8 is asked for", s->elem);
    return false;
  }
  s->pitch = s->elem <= 4096 ? KIT_PITCH : 3;
  size_t count, bytes;
  if (__builtin_mul_overflow(KIT_SLOTS, s->pitch, &count) || __builtin_mul_overflow(count, s->elem, &bytes) ||
      bytes > MEMORY_MAX || (s->full->gradient && s->nvar > MEMORY_MAX / (2 * sizeof(double))))
    return refuse(s, refused, "elements too large for the kit");
  s->block = aligned_alloc(64, (bytes + 63) / 64 * 64), s->pattern = malloc(s->elem);
  if (s->full->gradient) s->partial = malloc(2 * (size_t)s->nvar * sizeof(double) + 1);
  if (!s->block || !s->pattern || (s->full->gradient && !s->partial)) return refuse(s, refused, "no memory");
  memset(s->block, 0, bytes);
  memset(s->pattern, 0x5a, s->elem);
  ambit_status status = AMBIT_OK;
  if (s->full->init) {
    saved old = change(s);
    status = s->full->init(s->ctx, s->block, count);
    restore(s, old, "init");
  }
  if (status == AMBIT_OK) return true;
  free(s->block);
  s->block = NULL;
  return refuse(s, refused, "init cannot make the elements");
}

bool kit_open(kit_state *s, const arithmetic_kit *kit, const double *option, uint32_t nvar,
    const kit_environment *environment, const char **refused) {
  *s = (kit_state) { .kit = kit,
    .full = kit->full,
    .rigorous = kit->full->rigorous != 0,
    .nvar = nvar,
    .environment = environment,
    .section = "open" };
  memcpy(s->option, option, ambit_params_doubles(kit->full->param) * sizeof *option);
  kit_host_open(&s->host, kit->host);
  kit_reseed(s, 0);
  if (s->full->open) {
    saved old = change(s);
    ambit_status status = s->full->open(&s->host.host, s->option, nvar, &s->ctx);
    restore(s, old, "open");
    if (status != AMBIT_OK) {
      s->ctx = NULL;
      bool silent = !s->host.message[0] && status != AMBIT_NOMEM;
      if (silent) kit_find(s, "open", "refuses without a message (status %d)", (int)status);
      return refuse(s, refused, s->host.message[0] ? s->host.message : "no memory");
    }
  }
  s->elem = s->full->elem(s->ctx);
  return make_block(s, refused);
}

void kit_close(kit_state *s) {
  if (s->block && s->full->clear) s->full->clear(s->ctx, s->block, KIT_SLOTS * s->pitch);
  if (s->ctx && s->full->close) s->full->close(s->ctx);
  free(s->block), free(s->pattern), free(s->partial);
  kit_host_close(&s->host);
  s->block = s->pattern = NULL, s->partial = NULL, s->ctx = NULL;
}

void kit_take(kit_state *into, const kit_state *from) {
  into->findings += from->findings, into->judged += from->judged;
}

/* -- calls */

void *kit_at(const kit_state *s, uint32_t slot, size_t lane) { return s->block + (slot * s->pitch + lane) * s->elem; }

void kit_set_variable(kit_state *s, uint32_t slot, size_t lane, kit_set x, int32_t var) {
  saved old = change(s);
  s->full->set(s->ctx, kit_at(s, slot, lane), 1, &x.lo, &x.hi, var);
  restore(s, old, "set");
}

void kit_set_element(kit_state *s, uint32_t slot, size_t lane, kit_set x) { kit_set_variable(s, slot, lane, x, -1); }

kit_set kit_bounds_of(kit_state *s, uint32_t slot, size_t lane) {
  kit_set x = { NAN, NAN };
  saved old = change(s);
  s->full->bounds(s->ctx, kit_at(s, slot, lane), 1, &x.lo, &x.hi);
  restore(s, old, "bounds");
  return x;
}

static void enter(const kit_state *s) {
  if (s->full->enter) s->full->enter(s->ctx);
}

static void leave(const kit_state *s) {
  if (s->full->leave) s->full->leave(s->ctx);
}

kit_set kit_through(kit_state *s, uint32_t slot, kit_set x) {
  kit_set got = { NAN, NAN };
  saved old = change(s);
  enter(s);
  s->full->set(s->ctx, kit_at(s, slot, 0), 1, &x.lo, &x.hi, -1);
  s->full->bounds(s->ctx, kit_at(s, slot, 0), 1, &got.lo, &got.hi);
  leave(s);
  restore(s, old, "set or bounds");
  return got;
}

uint32_t kit_run(
    kit_state *s, uint32_t op, size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b, size_t lanes) {
  saved old = change(s);
  size_t allocated = conduct_allocations();
  enter(s);
  uint32_t flags = s->full->run[op](s->full, s->ctx, s->block, s->pitch, lanes, count, dst, a, b);
  leave(s);
  restore(s, old, kit_op_name[op]);
  allocated = conduct_allocations() - allocated;
  if (allocated) kit_find(s, "allocations", "%s allocates %zu times", kit_op_name[op], allocated);
  return flags;
}

uint32_t kit_apply(kit_state *s, uint32_t op, uint32_t dst, uint32_t a, uint32_t b, size_t lanes) {
  return kit_run(s, op, 1, &dst, &a, &b, lanes);
}

uint32_t kit_eval_tape(kit_state *s, const ambit_tape *t, size_t lanes) {
  saved old = change(s);
  enter(s);
  uint32_t flags = s->full->eval_tape(s->ctx, t, s->block, s->pitch, lanes);
  leave(s);
  restore(s, old, "eval_tape");
  return flags;
}

uint32_t kit_dot(
    kit_state *s, uint32_t dst, const void *a, ptrdiff_t sa, const void *b, ptrdiff_t sb, size_t m, size_t lanes) {
  saved old = change(s);
  enter(s);
  uint32_t flags = s->full->dot(s->ctx, kit_at(s, dst, 0), a, sa, b, sb, m, lanes);
  leave(s);
  restore(s, old, "dot");
  return flags;
}

/* only for contexts of KIT_NVAR variables or more */
bool kit_gradient(kit_state *s, uint32_t slot, size_t lane, double lo[KIT_NVAR], double hi[KIT_NVAR]) {
  saved old = change(s);
  bool known = s->full->gradient(s->ctx, kit_at(s, slot, lane), s->partial, s->partial + s->nvar) != 0;
  restore(s, old, "gradient");
  for (uint32_t j = 0; known && j < KIT_NVAR; j++) lo[j] = s->partial[j], hi[j] = s->partial[s->nvar + j];
  return known;
}

bool kit_set_text(kit_state *s, uint32_t slot, const char *text) {
  saved old = change(s);
  bool known = s->full->set_text(s->ctx, kit_at(s, slot, 0), text) != 0;
  restore(s, old, "set_text");
  return known;
}
