/* signature.c -- reads "d(Ddd)" and "d(dd(d(d)))". */
#include "script/signature.h"
#include <string.h>

typedef struct reader {
  ambit_arena *arena;
  const char *text, *at;
  ambit_failure *f;
} reader;

static void *refuse(reader *r, const char *why) {
  ambit_fail(r->f, AMBIT_INVALID, "signature \"%s\": %s at \"%s\"", r->text, why, r->at);
  return NULL;
}

static ffi_type *type_of(char kind) {
  switch (kind) {
  case 'v': return &ffi_type_void;
  case 'i': return &ffi_type_sint32;
  case 'l': return &ffi_type_sint64;
  case 'd': return &ffi_type_double;
  default: return &ffi_type_pointer;
  }
}

static ffi_type *type_of_count(void) { return sizeof(size_t) == 8 ? &ffi_type_uint64 : &ffi_type_uint32; }

static ambit_signature *read_one(reader *r, int depth);

/* one argument; false: refused */
static int read_argument(reader *r, ambit_signature *s, int depth) {
  char kind = *r->at;
  if (s->count == AMBIT_SIGNATURE_MAX) return refuse(r, "too many arguments") != NULL;
  if (!strchr("ildsD(", kind) || !kind) return refuse(r, "expected one of i l d s D or a callback in brackets") != NULL;
  if (kind == '(' && depth > 0) return refuse(r, "a callback cannot take callbacks") != NULL;
  r->at++;
  s->type[s->c_count++] = type_of(kind);
  if (kind == 'D') s->type[s->c_count++] = type_of_count();
  if (kind == '(') {
    s->type[s->c_count++] = &ffi_type_pointer;
    s->callback[s->count] = read_one(r, depth + 1);
    if (!s->callback[s->count]) return 0;
    if (*r->at != ')') return refuse(r, "expected )") != NULL;
    r->at++;
  }
  s->kind[s->count++] = kind;
  return 1;
}

static ambit_signature *read_one(reader *r, int depth) {
  ambit_signature *s = ambit_arena_alloc(r->arena, sizeof *s);
  if (!s) return refuse(r, "out of memory");
  s->result = *r->at;
  if (!s->result || !strchr(depth ? "vild" : "vilds", s->result))
    return refuse(r, "expected a result: v i l d, or s of a function");
  r->at++;
  if (*r->at != '(') return refuse(r, "expected (");
  r->at++;
  while (*r->at && *r->at != ')')
    if (!read_argument(r, s, depth)) return NULL;
  if (*r->at != ')') return refuse(r, "expected )");
  r->at++;
  if (depth) s->type[s->c_count++] = &ffi_type_pointer;
  if (ffi_prep_cif(&s->cif, FFI_DEFAULT_ABI, (unsigned)s->c_count, type_of(s->result), s->type) != FFI_OK)
    return refuse(r, "libffi cannot call this");
  return s;
}

ambit_signature *ambit_signature_read(ambit_arena *arena, const char *text, ambit_failure *f) {
  reader r = { arena, text ? text : "", text ? text : "", f };
  ambit_signature *s = read_one(&r, 0);
  return s && *r.at ? refuse(&r, "unexpected text") : s;
}
