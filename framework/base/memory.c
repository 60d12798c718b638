/* memory.c -- the limits as Linux tells them in text files, and RLIMIT_AS.
**
** An allocation succeeds on an overcommitting system even when the memory is not there; the process is killed when it
** writes. So big requests are compared with what is there first. Between the question and the use others may take
** memory: this is a courtesy, not a guarantee.
*/
#include "base/memory.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define SMALL ((size_t)64 << 20) /* bytes that are granted without asking */

static size_t less(size_t a, size_t b) { return a < b ? a : b; }
static size_t rest(size_t all, size_t used) { return all > used ? all - used : 0; }

/* the number in a file that holds only one; SIZE_MAX if there is none ("max") */
static size_t number_in(const char *path) {
  FILE *file = fopen(path, "r");
  unsigned long long value;
  int found = file ? fscanf(file, "%llu", &value) : 0;
  if (file) fclose(file);
  return found == 1 && value < SIZE_MAX ? (size_t)value : SIZE_MAX;
}

static size_t of_machine(void) {
  FILE *file = fopen("/proc/meminfo", "r");
  char line[128];
  size_t kilobytes, bytes = SIZE_MAX;
  while (file && fgets(line, sizeof line, file))
    if (sscanf(line, "MemAvailable: %zu kB", &kilobytes) == 1) bytes = kilobytes * 1024;
  if (file) fclose(file);
  return bytes;
}

static size_t of_control_group(void) {
  size_t all = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  return all == SIZE_MAX || used == SIZE_MAX ? SIZE_MAX : rest(all, used);
}

static size_t of_address_space(void) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return SIZE_MAX;
  size_t pages = number_in("/proc/self/statm"); /* its first number */
  return rest((size_t)limit.rlim_cur, pages == SIZE_MAX ? 0 : pages * (size_t)sysconf(_SC_PAGESIZE));
}

size_t ambit_memory_available(void) { return less(of_machine(), less(of_control_group(), of_address_space())); }

bool ambit_memory_allows(size_t bytes) { return bytes <= SMALL || bytes <= ambit_memory_available(); }
