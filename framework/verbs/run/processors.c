/* processors.c -- AMBIT_THREADS, the affinity mask, and the quotas of the control groups around this process (cgroup
** v2: a limit in any of the parents holds for the children too). */
#include "verbs/run/processors.h"
#include <errno.h>
#include <limits.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_MAX_LENGTH 64

static uint32_t bounded(unsigned long n) { return n < AMBIT_THREADS_MAX ? (uint32_t)n : AMBIT_THREADS_MAX; }

static uint32_t count_allowed(void) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1; /* more processors than the set has room for */
  int n = CPU_COUNT(&set);
  return n > 0 ? bounded((unsigned long)n) : 1;
}

uint32_t ambit_processors_quota(const char *line) {
  char *rest;
  errno = 0;
  unsigned long quota = strtoul(line, &rest, 10);
  if (rest == line || errno || quota == 0) return 0;
  char *end;
  unsigned long period = strtoul(rest, &end, 10);
  if (end == rest || errno || period == 0) return 0;
  return bounded(quota / period + (quota % period != 0));
}

static uint32_t read_quota(const char *group) {
  char path[PATH_MAX + 32], line[LINE_MAX_LENGTH];
  int length = snprintf(path, sizeof path, "/sys/fs/cgroup%s/cpu.max", group);
  if (length < 0 || (size_t)length >= sizeof path) return 0;
  FILE *file = fopen(path, "r");
  if (!file) return 0;
  const char *read = fgets(line, sizeof line, file);
  fclose(file);
  return read ? ambit_processors_quota(line) : 0;
}

/* The path of this process in the unified hierarchy: the line "0::/a/b". */
static int find_group(char group[PATH_MAX]) {
  FILE *file = fopen("/proc/self/cgroup", "r");
  if (!file) return 0;
  char line[PATH_MAX];
  int found = 0;
  while (!found && fgets(line, sizeof line, file)) {
    if (strncmp(line, "0::/", 4) != 0) continue;
    line[strcspn(line, "\n")] = '\0';
    memcpy(group, line + 3, strlen(line + 3) + 1);
    found = 1;
  }
  fclose(file);
  return found;
}

static uint32_t count_granted(uint32_t n) {
  char group[PATH_MAX];
  if (!find_group(group)) return n;
  for (;;) {
    uint32_t quota = read_quota(group);
    if (quota && quota < n) n = quota;
    char *last = strrchr(group, '/');
    if (!last || !group[0]) return n;
    *last = '\0';
  }
}

ambit_status ambit_processors_threads(uint32_t *threads, ambit_failure *f) {
  const char *given = getenv("AMBIT_THREADS");
  if (!given || !*given) {
    *threads = count_granted(count_allowed());
    return AMBIT_OK;
  }
  char *end;
  errno = 0;
  long n = strtol(given, &end, 10);
  if (*end || errno || n < 1 || n > AMBIT_THREADS_MAX)
    return ambit_fail(
        f, AMBIT_INVALID, "AMBIT_THREADS is `%.40s`: expected a whole number from 1 to %d", given, AMBIT_THREADS_MAX);
  *threads = (uint32_t)n;
  return AMBIT_OK;
}
