/* allocations.c -- malloc and its relatives in front of glibc's own, which they call.
**
** Linked into a test, it counts. Linked into the kernel (AMBIT_COUNT_ALLOCATIONS), it makes every run abort that
** allocates between its first and its last record. Needs glibc; not for sanitizer builds, which bring a malloc of
** their own.
*/
#include "kit/allocations.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *old, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);

static _Thread_local size_t count __attribute__((tls_model("initial-exec")));
static _Thread_local int forbidden __attribute__((tls_model("initial-exec")));

size_t ambit_allocation_count(void) { return count; }
void ambit_allocation_forbid(int on) { forbidden = on; }

static void notice(const char *what) {
  count++;
  if (!forbidden) return;
  forbidden = 0; /* abort() may allocate */
  static const char why[] = ": an allocation between the first and the last record of a run\n";
  if (write(STDERR_FILENO, what, strlen(what)) >= 0 && write(STDERR_FILENO, why, sizeof why - 1) >= 0) abort();
  abort();
}

void *malloc(size_t bytes) {
  notice("malloc");
  return __libc_malloc(bytes);
}

void *calloc(size_t n, size_t bytes) {
  notice("calloc");
  return __libc_calloc(n, bytes);
}

void *realloc(void *old, size_t bytes) {
  notice("realloc");
  return __libc_realloc(old, bytes);
}

void *memalign(size_t alignment, size_t bytes);
void *memalign(size_t alignment, size_t bytes) {
  notice("memalign");
  return __libc_memalign(alignment, bytes);
}

void *aligned_alloc(size_t alignment, size_t bytes) {
  notice("aligned_alloc");
  return __libc_memalign(alignment, bytes);
}

int posix_memalign(void **out, size_t alignment, size_t bytes) {
  notice("posix_memalign");
  void *p = __libc_memalign(alignment, bytes);
  if (!p) return ENOMEM;
  *out = p;
  return 0;
}
