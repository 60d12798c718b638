/* limit.c -- time by a timer whose signal comes again and again, memory by the system's limit of writable memory,
** output by streams in the place of C's own, which count. */
#include "script/limit.h"
#include "script/interrupt.h"
#include "script/sanitized.h"
#include <ambit/code.h>
#include <errno.h>
#include <fcntl.h>
#include <lauxlib.h>
#include <lualib.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define TICK_US 50000        /* how often the signal comes, once it has come */
#define GRACE 3.0            /* s, in which a run that was asked to stop must end */
#define GRACE_PART 0.25      /* of the time that it has, if that is less */
#define RESERVE (64 << 10)   /* bytes that the command itself may still say where the output is used up */
#define PATIENCE 20          /* ticks for which a line that is being written is waited for */
#define LONGEST_SENTENCE 128 /* with its end */

static const struct {
  const char *option, *code;
} kind[AMBIT_LIMITS] = { { "--time", AMBIT_CODE_STOPPED_TIME }, { "--memory", AMBIT_CODE_STOPPED_MEMORY },
  { "--output", AMBIT_CODE_STOPPED_OUTPUT } };

/* Static: a signal handler reaches nothing else. */
static char sentence[AMBIT_LIMITS][LONGEST_SENTENCE], last[AMBIT_LIMITS][LONGEST_SENTENCE + 96];
static double most[AMBIT_LIMITS];           /* 0: no such limit */
static double ends, grace = GRACE;          /* by the monotonic clock, s */
static volatile sig_atomic_t reached = -1;  /* ambit_limit, or -1 */
static volatile sig_atomic_t waits;         /* ticks for which the end was put off */
static volatile double told;                /* when it was reached */
static const ambit_records *volatile lines; /* of the run, or NULL */
static _Atomic uint64_t printed;            /* bytes */
static uint64_t recorded, closed;           /* all that was recorded; of files that are closed */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

bool ambit_limit_reached(const char **code, const char **said) {
  if (reached < 0) return false;
  if (code) *code = kind[reached].code;
  if (said) *said = sentence[reached];
  return true;
}

/* -- the end */

static void put(int file, const char *text, size_t length) {
  while (length) {
    ssize_t n = write(file, text, length);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    text += n, length -= (size_t)n;
  }
}

/* In the signal handler: the run does not end by itself. */
static void end_here(void) {
  static const char head[] = "ambit: ", tail[] = "; the run did not stop by itself, and was ended\n";
  int file = lines ? ambit_records_idle_file(lines) : -1;
  if (lines && file < 0 && waits < PATIENCE) {
    waits = waits + 1;
    return;
  }
  if (file >= 0) put(file, last[reached], strlen(last[reached]));
  put(STDERR_FILENO, head, sizeof head - 1);
  put(STDERR_FILENO, sentence[reached], strlen(sentence[reached]));
  put(STDERR_FILENO, tail, sizeof tail - 1);
  _exit(AMBIT_LIMIT_EXIT);
}

static void tick_again(void) {
  struct itimerval every = { { 0, TICK_US }, { 0, TICK_US } };
  setitimer(ITIMER_REAL, &every, NULL);
}

static void reach(ambit_limit which) {
  if (reached >= 0) return;
  told = now();
  reached = (sig_atomic_t)which;
  ambit_interrupt_limit(sentence[which], AMBIT_LIMIT_EXIT);
  tick_again();
}

#if defined(AMBIT_SANITIZED)
/* Bytes of resident memory, from /proc/self/statm, by functions that a signal handler may call. */
static double resident(void) {
  char text[64] = "";
  int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  ssize_t n = read(file, text, sizeof text - 1);
  close(file);
  char *second = n > 0 ? strchr(text, ' ') : NULL;
  double pages = 0;
  for (const char *s = second ? second + 1 : ""; *s >= '0' && *s <= '9'; s++) pages = 10 * pages + (*s - '0');
  return pages * (double)sysconf(_SC_PAGESIZE);
}
#endif

static void on_tick(int number) {
  (void)number;
  int before = errno;
  if (reached >= 0 && now() - told >= grace) end_here();
#if defined(AMBIT_SANITIZED)
  if (most[AMBIT_LIMIT_MEMORY] > 0 && resident() > most[AMBIT_LIMIT_MEMORY]) reach(AMBIT_LIMIT_MEMORY);
#endif
  if (most[AMBIT_LIMIT_TIME] > 0 && now() >= ends) reach(AMBIT_LIMIT_TIME);
  errno = before;
}

/* -- beginning */

static void watch_clock(void) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_tick;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, NULL);
}

/* The first signal comes when the time is over; before that nobody needs one, where memory is the system's affair. */
static void start_clock(void) {
#if defined(AMBIT_SANITIZED)
  tick_again();
#else
  double left = fmin(fmax(ends - now(), 1e-6), 1e9);
  struct itimerval first = { { 0, TICK_US }, { (time_t)left, (suseconds_t)(1e6 * (left - floor(left))) } };
  if (most[AMBIT_LIMIT_TIME] > 0) setitimer(ITIMER_REAL, &first, NULL);
#endif
}

static void begin_time(double seconds) {
  ends = now() + seconds;
  grace = fmin(GRACE, GRACE_PART * seconds);
}

/* Writable memory that is not shared: what malloc gives, and the stacks of threads. Address space that is reserved
** only, which threads take much of, is not counted. */
static const char *begin_memory(double bytes) {
#if defined(AMBIT_SANITIZED)
  (void)bytes;
  return NULL;
#else
  struct rlimit old;
  if (getrlimit(RLIMIT_DATA, &old) != 0) return strerror(errno);
  rlim_t wanted = (rlim_t)bytes;
  if (old.rlim_cur != RLIM_INFINITY && wanted > old.rlim_cur) wanted = old.rlim_cur;
  struct rlimit limit = { wanted, old.rlim_max };
  return setrlimit(RLIMIT_DATA, &limit) == 0 ? NULL : strerror(errno);
#endif
}

/* -- output */

/* How much of so many bytes may go out, those of the command itself when it is over. */
static size_t allowed(size_t bytes, int file) {
  if (!(most[AMBIT_LIMIT_OUTPUT] > 0)) return bytes; /* a child process */
  double left = most[AMBIT_LIMIT_OUTPUT] - (double)printed - (double)recorded;
  if (file == STDERR_FILENO && reached >= 0) left += RESERVE;
  return left <= 0 ? 0 : left < (double)bytes ? (size_t)left : bytes;
}

/* Of a stream: what is beyond the limit is dropped, the run being about to end. */
static ssize_t write_counted(void *cookie, const char *text, size_t bytes) {
  int file = (int)(intptr_t)cookie;
  size_t length = allowed(bytes, file);
  printed += length;
  if (length < bytes) reach(AMBIT_LIMIT_OUTPUT);
  while (length) {
    ssize_t n = write(file, text, length);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return 0;
    text += n, length -= (size_t)n;
  }
  return (ssize_t)bytes;
}

#if defined(__GLIBC__)
/* Lua's io.NAME writes there too. */
static void give_to_lua(lua_State *L, const char *name, FILE *stream) {
  luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
  if (lua_getfield(L, -1, LUA_IOLIBNAME) == LUA_TTABLE) {
    lua_getfield(L, -1, name);
    luaL_Stream *own = luaL_testudata(L, -1, LUA_FILEHANDLE);
    if (own) own->f = stream;
    lua_pop(L, 1);
  }
  lua_pop(L, 2);
}

static const char *begin_output(lua_State *L) {
  static const cookie_io_functions_t functions = { .write = write_counted };
  FILE *out = fopencookie((void *)(intptr_t)STDOUT_FILENO, "w", functions); // NOLINT(performance-no-int-to-ptr)
  FILE *err = fopencookie((void *)(intptr_t)STDERR_FILENO, "w", functions); // NOLINT(performance-no-int-to-ptr)
  if (!out || !err) return "out of memory";
  fflush(stdout);
  setvbuf(err, NULL, _IONBF, 0);
  stdout = out, stderr = err;
  give_to_lua(L, "stdout", out);
  give_to_lua(L, "stderr", err);
  return NULL;
}
#else
static const char *begin_output(lua_State *L) {
  (void)L;
  return "this system's C library cannot count what is printed";
}
#endif

void ambit_limit_records(const ambit_records *r) {
  closed = recorded;
  lines = r;
}

void ambit_limit_recorded(const ambit_records *r) {
  recorded = closed + ambit_records_length(r);
  if (most[AMBIT_LIMIT_OUTPUT] > 0 && (double)printed + (double)recorded > most[AMBIT_LIMIT_OUTPUT])
    reach(AMBIT_LIMIT_OUTPUT);
}

/* -- all of them */

const char *ambit_limit_begin(lua_State *L, ambit_limit which, double value, const char *said) {
  snprintf(sentence[which], sizeof sentence[which], "the limit of %s, %s, is reached", kind[which].option, said);
  snprintf(last[which], sizeof last[which], "{\"record\":\"end\",\"code\":\"%s\",\"exit\":%d,\"reason\":\"%s\"}\n",
      kind[which].code, AMBIT_LIMIT_EXIT, sentence[which]);
  most[which] = value;
  watch_clock();
  const char *problem = NULL;
  if (which == AMBIT_LIMIT_TIME) begin_time(value);
  if (which == AMBIT_LIMIT_MEMORY) problem = begin_memory(value);
  if (which == AMBIT_LIMIT_OUTPUT) problem = begin_output(L);
  start_clock();
  setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* what was printed is out when the run must be ended */
  return problem;
}

void ambit_limit_blame_memory(void) {
  if (most[AMBIT_LIMIT_MEMORY] > 0) reach(AMBIT_LIMIT_MEMORY);
}

void ambit_limit_forget(void) {
  lines = NULL;
  memset(most, 0, sizeof most);
}
