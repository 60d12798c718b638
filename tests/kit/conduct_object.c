/* conduct_object.c -- finds an object among those that are loaded (ELF).
**
** Allocations are counted where the object calls them: in its table of imported addresses the entries of malloc and its
** relatives are replaced. So neither another object nor the kernel is counted, and the command needs no malloc of its
** own.
*/
#include "kit/conduct_object.h"
#include "kit/conduct.h"
#include <elf.h>
#include <link.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* -- counters */

static _Thread_local size_t count;

size_t conduct_allocations(void) { return count; }

static void *counted_malloc(size_t bytes) { return count++, malloc(bytes); }
static void *counted_calloc(size_t n, size_t bytes) { return count++, calloc(n, bytes); }
static void *counted_realloc(void *old, size_t bytes) { return count++, realloc(old, bytes); }
static void *counted_aligned(size_t alignment, size_t bytes) { return count++, aligned_alloc(alignment, bytes); }
static int counted_memalign(void **out, size_t alignment, size_t bytes) {
  return count++, posix_memalign(out, alignment, bytes);
}
static char *counted_strdup(const char *text) { return count++, strdup(text); }

static const struct {
  const char *name;
  void (*call)(void);
} counter[] = {
  { "malloc", (void (*)(void))counted_malloc },
  { "calloc", (void (*)(void))counted_calloc },
  { "realloc", (void (*)(void))counted_realloc },
  { "aligned_alloc", (void (*)(void))counted_aligned },
  { "posix_memalign", (void (*)(void))counted_memalign },
  { "strdup", (void (*)(void))counted_strdup },
};

/* -- imported addresses */

typedef struct imports {
  ElfW(Addr) base;
  const ElfW(Sym) * symbol;
  const char *text;
  const ElfW(Rela) * rela[2];
  size_t count[2];
} imports;

static bool is_import(size_t type) {
#if defined(__x86_64__)
  return type == R_X86_64_JUMP_SLOT || type == R_X86_64_GLOB_DAT;
#elif defined(__aarch64__)
  return type == R_AARCH64_JUMP_SLOT || type == R_AARCH64_GLOB_DAT;
#else
  return (void)type, false;
#endif
}

static void write_address(ElfW(Addr) at, void (*call)(void)) {
  uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), from = at / page * page,
            to = (at + sizeof call + page - 1) / page * page;
  /* the page may be read-only since it was relocated; it stays writable */
  if (mprotect((void *)from, to - from, PROT_READ | PROT_WRITE) != 0) return;
  memcpy((void *)(uintptr_t)at, &call, sizeof call);
}

static void count_calls(const imports *i) {
  for (int table = 0; table < 2; table++)
    for (size_t k = 0; k < i->count[table]; k++) {
      const ElfW(Rela) *r = &i->rela[table][k];
      if (!is_import(ELF64_R_TYPE(r->r_info))) continue;
      const char *name = i->text + i->symbol[ELF64_R_SYM(r->r_info)].st_name;
      for (size_t c = 0; c < sizeof counter / sizeof *counter; c++)
        if (strcmp(name, counter[c].name) == 0) write_address(i->base + r->r_offset, counter[c].call);
    }
}

static void read_dynamic(const ElfW(Dyn) * d, imports *i) {
  for (; d->d_tag != DT_NULL; d++) {
    ElfW(Addr) at = d->d_un.d_ptr < i->base ? d->d_un.d_ptr + i->base : d->d_un.d_ptr; /* glibc relocates them */
    const void *pointer = (const void *)(uintptr_t)at;
    switch (d->d_tag) {
    case DT_SYMTAB: i->symbol = pointer; break;
    case DT_STRTAB: i->text = pointer; break;
    case DT_RELA: i->rela[0] = pointer; break;
    case DT_JMPREL: i->rela[1] = pointer; break;
    case DT_RELASZ: i->count[0] = d->d_un.d_val / sizeof(ElfW(Rela)); break;
    case DT_PLTRELSZ: i->count[1] = d->d_un.d_val / sizeof(ElfW(Rela)); break;
    default: break;
    }
  }
}

/* -- the object */

typedef struct search {
  ElfW(Addr) address;
  conduct_object *object;
  bool good;
} search;

static bool holds(const struct dl_phdr_info *info, ElfW(Addr) address) {
  for (size_t i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr) *p = &info->dlpi_phdr[i];
    ElfW(Addr) from = info->dlpi_addr + p->p_vaddr;
    if (p->p_type == PT_LOAD && address >= from && address < from + p->p_memsz) return true;
  }
  return false;
}

/* With AddressSanitizer there are red zones between the globals of an object, which nobody may read, and the imported
** functions are its own: neither is looked at. */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED true
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED true
#endif
#endif
#ifndef SANITIZED
#define SANITIZED false
#endif

static bool keep(conduct_object *o, uintptr_t from, uintptr_t to) {
  if (SANITIZED || from >= to || o->nsegment == CONDUCT_SEGMENTS) return true;
  unsigned char *copy = malloc(to - from);
  if (!copy) return false;
  const unsigned char *at = (const unsigned char *)from;
  memcpy(copy, at, to - from);
  o->segment[o->nsegment].at = at, o->segment[o->nsegment].copy = copy, o->segment[o->nsegment++].size = to - from;
  o->bytes += to - from;
  return true;
}

/* all that is writable once relocation is over */
static bool keep_data(conduct_object *o, const struct dl_phdr_info *info) {
  uintptr_t fixed_from = 0, fixed_to = 0;
  bool good = true;
  for (size_t i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr) *p = &info->dlpi_phdr[i];
    if (p->p_type == PT_GNU_RELRO) fixed_from = info->dlpi_addr + p->p_vaddr, fixed_to = fixed_from + p->p_memsz;
  }
  for (size_t i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr) *p = &info->dlpi_phdr[i];
    uintptr_t from = info->dlpi_addr + p->p_vaddr, to = from + p->p_memsz;
    if (p->p_type != PT_LOAD || !(p->p_flags & PF_W)) continue;
    bool fixed = fixed_from >= from && fixed_to <= to && fixed_from < fixed_to;
    good = good && keep(o, from, fixed ? fixed_from : to) && keep(o, fixed ? fixed_to : to, to);
  }
  return good;
}

static int visit(struct dl_phdr_info *info, size_t size, void *user) {
  search *s = user;
  (void)size;
  if (!holds(info, s->address)) return 0;
  imports found = { .base = info->dlpi_addr };
  for (size_t i = 0; i < info->dlpi_phnum; i++)
    if (info->dlpi_phdr[i].p_type == PT_DYNAMIC)
      read_dynamic((const ElfW(Dyn) *)(uintptr_t)(info->dlpi_addr + info->dlpi_phdr[i].p_vaddr), &found);
  bool own = holds(info, (ElfW(Addr))(uintptr_t)&count_calls); /* the counters themselves */
  if (found.symbol && found.text && !own && !SANITIZED) count_calls(&found);
  s->good = keep_data(s->object, info);
  return 1;
}

bool conduct_object_open(conduct_object *o, const void *address) {
  *o = (conduct_object) { 0 };
  search s = { (ElfW(Addr))(uintptr_t)address, o, true };
  dl_iterate_phdr(visit, &s);
  if (!s.good) conduct_object_close(o);
  return s.good;
}

size_t conduct_object_changed(const conduct_object *o) {
  size_t changed = 0;
  for (size_t i = 0; i < o->nsegment; i++)
    for (size_t k = 0; k < o->segment[i].size; k++) changed += o->segment[i].at[k] != o->segment[i].copy[k];
  return changed;
}

void conduct_object_close(conduct_object *o) {
  for (size_t i = 0; i < o->nsegment; i++) free(o->segment[i].copy);
  *o = (conduct_object) { 0 };
}
