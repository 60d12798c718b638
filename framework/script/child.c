/* child.c -- a Lua function in a process of its own: whatever it does (crash, hang, take all memory), the caller goes
** on and is told. The child is a fork, so it sees everything that the caller built; what it returns is one text.
**
** Three limits: `cpu` is the budget, at which running verbs are stopped and keep what they proved (as core.deadline);
** the child is killed at `wall` seconds, not counting those in which a busy machine let it wait, and when it takes much
** more CPU than its budget (by whoever waits for it: a limit of the system's would make the child's own CPU clock as
** coarse as the timer tick); allocations beyond `memory` bytes more than it started with fail. Sanitized builds know
** no memory limit: they reserve address space by the terabyte.
**
** A child has ended when its process has: the end of its pipe says less, as what it runs may close every file and go
** on, or start a process that keeps the pipe open.
*/
#include "script/core.h"
#include "script/interrupt.h"
#include "script/limit.h"
#include "script/request.h"
#include "script/sanitized.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define TYPE "ambit.child"
#define SLICE_MS 50               /* how often limits and Ctrl-C are looked at */
#define LONGEST ((size_t)1 << 30) /* bytes that a child may say */
#define LEAVING_MS 1              /* and whether a child whose pipe is at its end has left */

typedef struct child {
  pid_t pid; /* 0: waited for */
  int pipe;  /* -1: closed */
  double began, wall;
  double cpu;          /* at which it is killed, s */
  bool late;           /* killed at one of these limits */
  bool ended;          /* its pipe is at its end */
  bool unheard;        /* killed because there was no room for what it said */
  size_t resident;     /* bytes at the start */
  size_t length, room; /* of what it has said so far */
  char *text;          /* [room], malloc */
} child;

typedef struct limits {
  double cpu, wall, memory; /* s, s, bytes; INFINITY: none */
} limits;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double cpu_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* -- in the child */

/* Bytes of address space and of resident memory, 0 if the system does not say. */
static void memory_now(size_t *space, size_t *resident) {
  unsigned long pages = 0, held = 0;
  FILE *f = fopen("/proc/self/statm", "r");
  if (f && fscanf(f, "%lu %lu", &pages, &held) != 2) pages = held = 0;
  if (f) fclose(f);
  size_t page = (size_t)sysconf(_SC_PAGESIZE);
  *space = pages * page;
  *resident = held * page;
}

/* Allocations of so many bytes more than there are now fail. */
static void limit_space(double more) {
#if defined(AMBIT_SANITIZED)
  (void)more;
#else
  size_t space, resident;
  memory_now(&space, &resident);
  double most = (double)space + more;
  struct rlimit old;
  if (!(most < 1e18) || getrlimit(RLIMIT_AS, &old) != 0) return;
  rlim_t n = (rlim_t)most;
  if (old.rlim_cur != RLIM_INFINITY && n > old.rlim_cur) n = old.rlim_cur;
  struct rlimit limit = { n, old.rlim_max };
  setrlimit(RLIMIT_AS, &limit);
#endif
}

static void limit_child(ambit_lua *core, const limits *most) {
  core->deadline = isfinite(most->cpu) ? cpu_now() + most->cpu : 0;
  struct rlimit none = { 0, 0 };
  setrlimit(RLIMIT_CORE, &none);
  limit_space(most->memory);
}

static void say(int fd, const char *text, size_t length) {
  while (length) {
    ssize_t n = write(fd, text, length);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    text += n;
    length -= (size_t)n;
  }
}

/* The first byte says how it went: '+' and what was returned, '-' and the error, 'm' for no memory. */
_Noreturn static void be_child(lua_State *L, ambit_lua *core, const limits *most, int fd, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  int null = open("/dev/null", O_WRONLY);
  if (null >= 0) dup2(null, STDOUT_FILENO);
  core->records = NULL; /* the lines in it are the parent's to write */
  core->progress = false;
  ambit_limit_forget();
  limit_child(core, most);
  lua_pushvalue(L, 1);
  int status = lua_pcall(L, 0, 1, 0);
  size_t length = 0;
  const char *text = lua_tolstring(L, -1, &length);
  say(fd, status == LUA_OK ? "+" : status == LUA_ERRMEM ? "m" : "-", 1);
  if (text) say(fd, text, length);
  _exit(0);
}

/* -- in the parent */

static double limit_field(lua_State *L, const char *key) {
  double value = INFINITY;
  if (lua_istable(L, 2) && lua_getfield(L, 2, key) != LUA_TNIL) value = luaL_checknumber(L, -1);
  if (lua_istable(L, 2)) lua_pop(L, 1);
  return value;
}

/* child(function, { cpu =, wall =, memory = }) -> a child that runs it */
static int start(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  luaL_checktype(L, 1, LUA_TFUNCTION);
  limits most = { limit_field(L, "cpu"), limit_field(L, "wall"), limit_field(L, "memory") };
  child *c = lua_newuserdatauv(L, sizeof *c, 0);
  *c = (child) { .pipe = -1, .began = now(), .wall = most.wall, .cpu = 2 * most.cpu + 5 };
  luaL_setmetatable(L, TYPE);
  size_t space;
  memory_now(&space, &c->resident);
  int end[2];
  if (pipe2(end, O_CLOEXEC) != 0) ambit_lua_error(L, "no pipe to a child process: %s", strerror(errno));
  fcntl(end[0], F_SETFL, O_NONBLOCK);
  fflush(NULL);
  pid_t parent = getpid(), pid = fork();
  if (pid == 0) be_child(L, core, &most, end[1], parent);
  close(end[1]);
  c->pipe = end[0];
  if (pid < 0) ambit_lua_error(L, "no child process: %s", strerror(errno));
  c->pid = pid;
  return 1;
}

static child *check_child(lua_State *L, int idx) { return luaL_checkudata(L, idx, TYPE); }

/* Takes some of what there is; false: there is no more now. */
static bool take_some(child *c) {
  if (c->length + 65536 > c->room) {
    char *larger = c->length < LONGEST ? realloc(c->text, 2 * c->room + 131072) : NULL;
    if (!larger) {
      c->unheard = c->ended = true;
      kill(c->pid, SIGKILL);
      return false;
    }
    c->text = larger;
    c->room = 2 * c->room + 131072;
  }
  ssize_t n = read(c->pipe, c->text + c->length, c->room - c->length);
  if (n > 0) c->length += (size_t)n;
  c->ended = n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN);
  return n > 0 || (n < 0 && errno == EINTR);
}

static bool has_left(const child *c) {
  siginfo_t info;
  memset(&info, 0, sizeof info);
  return waitid(P_PID, (id_t)c->pid, &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == c->pid;
}

static const char *outcome_of(const child *c, int status) {
  if (c->late) return "late";
  if (c->unheard) return "out of memory";
  if (WIFSIGNALED(status)) return "crashed";
  if (WEXITSTATUS(status) != 0 || c->length == 0) return "crashed";
  return c->text[0] == '+' ? "done" : c->text[0] == 'm' ? "out of memory" : "failed";
}

static void forget(child *c) {
  if (c->pipe >= 0) close(c->pipe);
  free(c->text);
  c->pipe = -1;
  c->text = NULL;
  c->length = c->room = 0;
}

/* Pushes { outcome, value or message, signal, cpu_seconds, wall_seconds, peak_memory, memory }. */
static void push_result(lua_State *L, child *c) {
  int status = 0;
  struct rusage use;
  memset(&use, 0, sizeof use);
  while (wait4(c->pid, &status, 0, &use) < 0 && errno == EINTR) continue;
  c->pid = 0;
  const char *outcome = outcome_of(c, status);
  lua_createtable(L, 0, 8);
  ambit_lua_set_text(L, "outcome", outcome);
  if (c->length > 1) {
    lua_pushlstring(L, c->text + 1, c->length - 1);
    lua_setfield(L, -2, strcmp(outcome, "done") == 0 ? "value" : "message");
  }
  if (WIFSIGNALED(status)) ambit_lua_set_count(L, "signal", (uint32_t)WTERMSIG(status));
  double peak = 1024.0 * (double)use.ru_maxrss, before = (double)c->resident;
  ambit_lua_set_number(L, "cpu_seconds",
      (double)(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
          1e-6 * (double)(use.ru_utime.tv_usec + use.ru_stime.tv_usec));
  ambit_lua_set_number(L, "wall_seconds", now() - c->began);
  ambit_lua_set_number(L, "peak_memory", peak);
  ambit_lua_set_number(L, "memory", peak > before ? peak - before : 0);
  forget(c);
}

/* Seconds for which it was ready to run, but the machine had other work; 0 if the system does not say. */
static double queued(pid_t pid) {
  char name[64];
  unsigned long long ran = 0, waited = 0;
  snprintf(name, sizeof name, "/proc/%d/schedstat", (int)pid);
  FILE *f = fopen(name, "re");
  if (!f) return 0;
  if (fscanf(f, "%llu %llu", &ran, &waited) != 2) waited = 0;
  fclose(f);
  return 1e-9 * (double)waited;
}

static bool is_over(const child *c) {
  clockid_t clock;
  struct timespec t;
  double spent = now() - c->began;
  if (spent > c->wall && spent - queued(c->pid) > c->wall) return true;
  if (!isfinite(c->cpu) || clock_getcpuclockid(c->pid, &clock) != 0 || clock_gettime(clock, &t) != 0) return false;
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec > c->cpu;
}

/* Listens to it and keeps it within its limits; true: it has ended. */
static bool attend(child *c, bool spoke) {
  bool left = has_left(c);
  if (spoke && !c->ended) take_some(c);
  while (left && !c->ended && take_some(c)) continue;
  if (!left && !c->late && is_over(c)) {
    c->late = true;
    kill(c->pid, SIGKILL);
  }
  return left;
}

/* Listens until one has ended, Ctrl-C, or `until`; its place in the array, or -1. */
static int wait_for_one(child **c, uint32_t n, double until) {
  struct pollfd *watch = calloc(n, sizeof *watch);
  if (!watch) return -1;
  int ended = -1;
  while (ended < 0 && !ambit_interrupt_pending() && now() < until) {
    int most = SLICE_MS;
    for (uint32_t i = 0; i < n; i++) {
      watch[i] = (struct pollfd) { .fd = c[i]->ended ? -1 : c[i]->pipe, .events = POLLIN };
      if (c[i]->ended) most = LEAVING_MS;
    }
    if (poll(watch, n, most) < 0 && errno != EINTR) break;
    for (uint32_t i = 0; i < n && ended < 0; i++)
      if (attend(c[i], watch[i].revents & (POLLIN | POLLHUP | POLLERR))) ended = (int)i;
  }
  free(watch);
  return ended;
}

/* child_wait({child, ...}, seconds or nil) -> index, result of the first that ends; nil: none within that time, or
** Ctrl-C (then the second value is "interrupted"; the children go on) */
static int wait_any(lua_State *L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  double until = now() + luaL_optnumber(L, 2, INFINITY);
  int n = (int)luaL_len(L, 1);
  child **c = lua_newuserdatauv(L, (size_t)(n + 1) * sizeof *c, 0);
  for (int i = 0; i < n; i++) {
    lua_rawgeti(L, 1, i + 1);
    c[i] = check_child(L, -1);
    lua_pop(L, 1);
    if (!c[i]->pid) return luaL_error(L, "child_wait: child %d was already waited for", i + 1);
  }
  ambit_interrupt interrupt;
  ambit_interrupt_begin(&interrupt);
  int ended = n ? wait_for_one(c, (uint32_t)n, until) : -1;
  bool stopped = ambit_interrupt_pending();
  ambit_interrupt_end(&interrupt);
  if (ended < 0) {
    lua_pushnil(L);
    if (!stopped) return 1;
    lua_pushliteral(L, "interrupted");
    return 2;
  }
  lua_pushinteger(L, ended + 1);
  push_result(L, c[ended]);
  return 2;
}

/* child_kill(child): ends it at once, whatever it did so far is lost */
static int end_child(lua_State *L) {
  child *c = check_child(L, 1);
  if (c->pid) {
    kill(c->pid, SIGKILL);
    while (waitpid(c->pid, NULL, 0) < 0 && errno == EINTR) continue;
    c->pid = 0;
  }
  forget(c);
  return 0;
}

/* memory() -> bytes resident now, most ever */
static int memory(lua_State *L) {
  size_t space, resident;
  struct rusage use;
  memory_now(&space, &resident);
  getrusage(RUSAGE_SELF, &use);
  lua_pushnumber(L, (double)resident);
  lua_pushnumber(L, 1024.0 * (double)use.ru_maxrss);
  return 2;
}

void ambit_lua_open_child(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "child", start }, { "child_wait", wait_any }, { "child_kill", end_child },
    { "memory", memory }, { NULL, NULL } };
  static const luaL_Reg type[] = { { "__gc", end_child }, { NULL, NULL } };
  ambit_lua_new_type(L, core, TYPE, type);
  lua_pop(L, 1);
  ambit_lua_set_functions(L, core, functions);
#if defined(AMBIT_SANITIZED) /* is_sanitized: children have no limit of memory, and crash in another way */
  lua_pushboolean(L, true);
#else
  lua_pushboolean(L, false);
#endif
  lua_setfield(L, -2, "is_sanitized");
}
