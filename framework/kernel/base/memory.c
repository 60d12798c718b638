/* memory.c -- the limits as Linux tells them in text files (proc(5), cgroups(7)), and RLIMIT_AS.
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

/* the number behind a word in a file of lines "word number"; 0 if it is not there */
static size_t entry_in(const char *path, const char *word) {
  FILE *file = fopen(path, "r");
  char line[256];
  size_t value = 0, length = strlen(word);
  while (file && fgets(line, sizeof line, file))
    if (strncmp(line, word, length) == 0 && line[length] == ' ') sscanf(line + length, "%zu", &value);
  if (file) fclose(file);
  return value;
}

/* Where one version of control groups keeps its numbers. Pages of files that nobody uses now are counted as used, but
** given up when memory is short. */
typedef struct group_files {
  const char *mount, *limit, *used, *idle;
} group_files;

static size_t of_group(const group_files *files, const char *group) {
  char limit[1200], used[1200], stat[1200];
  snprintf(limit, sizeof limit, "%s%s/%s", files->mount, group, files->limit);
  snprintf(used, sizeof used, "%s%s/%s", files->mount, group, files->used);
  snprintf(stat, sizeof stat, "%s%s/memory.stat", files->mount, group);
  size_t all = number_in(limit), taken = number_in(used);
  return all == SIZE_MAX || taken == SIZE_MAX ? SIZE_MAX : rest(all, rest(taken, entry_in(stat, files->idle)));
}

/* A group is held by its own limit and by those of all groups it is in; in a container only the last part may be
** seen. */
static size_t of_groups(const group_files *files, char *group) {
  size_t least = SIZE_MAX;
  for (char *slash; (slash = strrchr(group, '/')) != NULL; *slash = '\0') least = less(least, of_group(files, group));
  return less(least, of_group(files, ""));
}

/* Lines of /proc/self/cgroup: "4:memory:/group" (version 1), "0::/group" (version 2). */
static size_t of_control_groups(void) {
  static const group_files first = { "/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
    "total_inactive_file" };
  static const group_files second = { "/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file" };
  FILE *file = fopen("/proc/self/cgroup", "r");
  char line[1024];
  size_t least = SIZE_MAX;
  while (file && fgets(line, sizeof line, file)) {
    line[strcspn(line, "\n")] = '\0';
    char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
    if (!group) continue;
    *group++ = '\0';
    if (strstr(controllers, "memory")) least = less(least, of_groups(&first, group));
    if (strcmp(controllers, ":") == 0) least = less(least, of_groups(&second, group));
  }
  if (file) fclose(file);
  return least;
}

static size_t of_address_space(void) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return SIZE_MAX;
  size_t pages = number_in("/proc/self/statm"); /* its first number */
  return rest((size_t)limit.rlim_cur, pages == SIZE_MAX ? 0 : pages * (size_t)sysconf(_SC_PAGESIZE));
}

size_t ambit_memory_available(void) { return less(of_machine(), less(of_control_groups(), of_address_space())); }

bool ambit_memory_allows(size_t bytes) { return bytes <= SMALL || bytes <= ambit_memory_available(); }
