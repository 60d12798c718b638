/* guarded.h -- copies that end where memory ends: who reads beyond one crashes. */
#ifndef AMBIT_GUARDED_H
#define AMBIT_GUARDED_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static inline size_t guarded_span(size_t bytes) {
  size_t page = (size_t)sysconf(_SC_PAGESIZE);
  return (bytes + page - 1) / page * page + page;
}

/* `bytes` of memory, copied from `from` unless it is NULL; NULL: no memory */
static inline void *guarded_open(const void *from, size_t bytes) {
  size_t page = (size_t)sysconf(_SC_PAGESIZE), span = guarded_span(bytes);
  char *start = mmap(NULL, span, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (start == MAP_FAILED) return NULL;
  mprotect(start + span - page, page, PROT_NONE);
  char *at = start + span - page - bytes;
  if (from) memcpy(at, from, bytes);
  return at;
}

static inline void guarded_close(void *at, size_t bytes) {
  size_t page = (size_t)sysconf(_SC_PAGESIZE), span = guarded_span(bytes);
  if (at) munmap((char *)at + bytes + page - span, span);
}
#endif
