/* conduct.c -- a watch over one loaded object: copies of its writable data, counters in front of its allocations, and
** the state of the process around it. */
#include "kit/conduct.h"
#include "kit/conduct_object.h"
#include <dirent.h>
#include <fenv.h>
#include <locale.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#if defined(__x86_64__) || defined(__i386__)
#include <xmmintrin.h>
#define CONTROL 0xffc0u /* of MXCSR: all but the flags that operations raise */
static unsigned control(void) { return _mm_getcsr() & CONTROL; }
#else
static unsigned control(void) { return 0; }
#endif

#define SIGNALS 32
#define WAITS 200 /* times 5 ms: a thread that was joined may still be on the kernel's list */

extern char **environ;

typedef struct surroundings {
  unsigned floating, mask;
  uint64_t variables;
  char locale[256], folder[1024];
  void (*handler[SIGNALS])(int);
  size_t files, threads;
} surroundings;

struct conduct {
  conduct_object object;
  surroundings before;
};

unsigned conduct_floating(void) { return control() | (unsigned)fegetround() << 16; }

static size_t entries(const char *folder) {
  size_t n = 0;
  DIR *d = opendir(folder);
  while (d && readdir(d)) n++;
  if (d) closedir(d);
  return n;
}

/* FNV-1a (Fowler, Noll, Vo 1991) of all texts */
static uint64_t digest_of(char **text) {
  uint64_t digest = 0xcbf29ce484222325u;
  for (; text && *text; text++)
    for (const char *c = *text;; c++) {
      digest = (digest ^ (unsigned char)*c) * 0x100000001b3u;
      if (!*c) break;
    }
  return digest;
}

static void look_around(surroundings *s) {
  const char *locale = setlocale(LC_ALL, NULL);
  memset(s, 0, sizeof *s);
  s->floating = conduct_floating();
  s->variables = digest_of(environ);
  snprintf(s->locale, sizeof s->locale, "%s", locale ? locale : "");
  if (!getcwd(s->folder, sizeof s->folder)) s->folder[0] = '\0';
  mode_t mask = umask(0);
  umask(mask);
  s->mask = mask;
  for (int i = 1; i < SIGNALS; i++) {
    struct sigaction action;
    if (sigaction(i, NULL, &action) == 0) s->handler[i] = action.sa_handler;
  }
  s->files = entries("/proc/self/fd");
  s->threads = entries("/proc/self/task");
}

conduct *conduct_open(const void *address) {
  conduct *c = calloc(1, sizeof *c);
  if (!c) return NULL;
  look_around(&c->before);
  if (!conduct_object_open(&c->object, address)) {
    free(c);
    return NULL;
  }
  return c;
}

static void wait_for_threads(size_t wanted) {
  for (int i = 0; i < WAITS && entries("/proc/self/task") > wanted; i++) usleep(5000);
}

size_t conduct_judge(conduct *c, void (*finding)(void *user, const char *rule, const char *message), void *user) {
  const surroundings *was = &c->before;
  surroundings is;
  char text[200];
  wait_for_threads(was->threads);
  look_around(&is);
  size_t changed = conduct_object_changed(&c->object);
  if (changed) {
    snprintf(
        text, sizeof text, "%zu bytes of its global data have changed: what a context needs belongs to it", changed);
    finding(user, "globals", text);
  }
  if (is.floating != was->floating) finding(user, "environment", "the rounding mode or flushing was left changed");
  if (is.variables != was->variables) finding(user, "environment", "an environment variable was changed");
  if (strcmp(is.locale, was->locale) != 0) finding(user, "environment", "the locale was changed");
  if (strcmp(is.folder, was->folder) != 0) finding(user, "environment", "the current folder was changed");
  if (is.mask != was->mask) finding(user, "environment", "the umask was changed");
  if (memcmp(is.handler, was->handler, sizeof is.handler) != 0)
    finding(user, "environment", "a signal handler was installed");
  if (is.files > was->files) finding(user, "leftovers", "a file stays open");
  if (is.threads > was->threads) finding(user, "leftovers", "a thread runs on");
  return 8 + (c->object.bytes > 0);
}

void conduct_close(conduct *c) {
  if (!c) return;
  conduct_object_close(&c->object);
  free(c);
}
