/* conformance_apart.c -- the check in a child process, so that a plugin that crashes or hangs leaves its report.
**
** The child writes one line for everything it has to tell: what, name and text, separated by tabs; the parent reads
** them. The last line is "end" with the verdict, so that a plugin that calls exit() is noticed.
*/
#include "kit/conformance.h"
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define LINE_MAX_BYTES 4096

/* -- the child */

static void write_line(void *user, const char *what, const char *name, const char *text) {
  char line[LINE_MAX_BYTES];
  int length = snprintf(line, sizeof line - 1, "%s\t%s\t%s", what, name, text);
  size_t n = length < 0 ? 0 : (size_t)length < sizeof line - 2 ? (size_t)length : sizeof line - 2;
  for (size_t i = 0; i < n; i++)
    if (line[i] == '\n') line[i] = ' ';
  line[n++] = '\n';
  for (size_t done = 0; done < n;) {
    ssize_t wrote = write(*(const int *)user, line + done, n - done);
    if (wrote < 0 && errno != EINTR) _exit(NOT_LOADED); /* the parent is gone */
    if (wrote > 0) done += (size_t)wrote;
  }
}

/* ends at the first broken promise */
static void write_first(void *user, const char *what, const char *name, const char *text) {
  char verdict[16];
  write_line(user, what, name, text);
  if (strcmp(what, "finding") != 0) return;
  snprintf(verdict, sizeof verdict, "%d", BROKEN);
  write_line(user, "end", verdict, "");
  _exit(0);
}

static _Noreturn void be_child(const conformance *c, int out, int printed) {
  static const int usual[] = { SIGINT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE };
  char verdict[16];
  conformance own = *c;
  for (size_t i = 0; i < sizeof usual / sizeof *usual; i++) signal(usual[i], SIG_DFL);
  setrlimit(RLIMIT_CORE, &(struct rlimit) { 0, 0 });
  dup2(printed, STDOUT_FILENO), dup2(printed, STDERR_FILENO);
  own.tell = c->first ? write_first : write_line, own.user = &out;
  int result = conformance_run(&own);
  fflush(NULL);
  snprintf(verdict, sizeof verdict, "%d", result);
  write_line(&out, "end", verdict, "");
  _exit(0);
}

/* -- the parent */

/* What it has printed so far, in one line; false: nothing. */
static bool was_printed(int file, char *text, size_t room) {
  char start[80];
  off_t bytes = lseek(file, 0, SEEK_END);
  if (bytes <= 0) return false;
  ssize_t n = pread(file, start, sizeof start - 1, 0);
  start[n > 0 ? n : 0] = '\0';
  for (char *c = start; *c; c++)
    if ((unsigned char)*c < ' ') *c = ' ';
  snprintf(text, room, "it prints %lld bytes: `%s`", (long long)bytes, start);
  return true;
}

typedef struct reader {
  const conformance *c;
  char buffer[2 * LINE_MAX_BYTES], section[64];
  size_t filled;
  int verdict; /* -1: not said yet */
} reader;

static void take_line(reader *r, char *line) {
  char *name = strchr(line, '\t'), *text = name ? strchr(name + 1, '\t') : NULL;
  if (!text) return;
  *name++ = '\0', *text++ = '\0';
  if (strcmp(line, "begin") == 0) snprintf(r->section, sizeof r->section, "%s", name);
  if (strcmp(line, "end") == 0)
    r->verdict = atoi(name);
  else
    r->c->tell(r->c->user, line, name, text);
}

static void take_lines(reader *r) {
  char *start = r->buffer, *end = r->buffer + r->filled, *newline;
  while ((newline = memchr(start, '\n', (size_t)(end - start)))) {
    *newline = '\0';
    take_line(r, start);
    start = newline + 1;
  }
  r->filled = (size_t)(end - start);
  memmove(r->buffer, start, r->filled);
}

/* false: nothing came for so long */
static bool read_all(reader *r, int in, double patience) {
  for (;;) {
    struct pollfd ready = { in, POLLIN, 0 };
    int n = poll(&ready, 1, (int)(patience * 1000));
    if (n == 0) return false;
    if (n < 0 && errno == EINTR) continue; /* the signal reaches the child too */
    ssize_t got = n < 0 ? -1 : read(in, r->buffer + r->filled, sizeof r->buffer - r->filled);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true;
    r->filled += (size_t)got;
    take_lines(r);
    if (r->filled == sizeof r->buffer) r->filled = 0; /* no line is that long: the plugin writes where it may not */
  }
}

static int died(const reader *r, const char *how) {
  r->c->tell(r->c->user, "died", r->section, how);
  return BROKEN;
}

static int judge_end(reader *r, int status, bool in_time, double patience) {
  char how[128];
  if (r->verdict >= 0 && in_time) return r->verdict;
  if (!in_time)
    snprintf(how, sizeof how, "no end within %g s", patience);
  else if (WIFSIGNALED(status))
    snprintf(how, sizeof how, "crashed: %s", strsignal(WTERMSIG(status)));
  else
    snprintf(how, sizeof how, "it ended the whole process (exit code %d)", WEXITSTATUS(status));
  return died(r, how);
}

static int be_parent(reader *r, pid_t child, int in, int printed, double patience) {
  char text[200];
  int status = 0;
  bool in_time = read_all(r, in, patience);
  if (!in_time) kill(child, SIGKILL);
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  int verdict = judge_end(r, status, in_time, patience);
  if (!was_printed(printed, text, sizeof text)) return verdict;
  if (verdict != CONFORMS) {
    r->c->tell(r->c->user, "note", "", text);
    return verdict;
  }
  r->c->tell(r->c->user, "finding", "conduct", text);
  return BROKEN;
}

int conformance_run_apart(const conformance *c, double patience) {
  int ends[2];
  reader r = { .c = c, .section = "loading", .verdict = -1 };
  FILE *printed = tmpfile();
  if (!printed || pipe(ends) != 0) {
    if (printed) fclose(printed);
    return died(&r, strerror(errno));
  }
  fflush(NULL); /* else the child has a copy of what is not written yet */
  pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    be_child(c, ends[1], fileno(printed));
  }
  close(ends[1]);
  int verdict = child < 0 ? died(&r, strerror(errno)) : be_parent(&r, child, ends[0], fileno(printed), patience);
  close(ends[0]);
  fclose(printed);
  return verdict;
}
