/* records.c -- JSON lines through yajl's generator, whose buffer is reused from line to line.
**
** Numbers are the shortest decimal text that reads back as the same double, independent of locale. Text that is not
** UTF-8 gets U+FFFD for every bad byte, because a line that no reader takes is worse than a wrong letter in a name. */
#include "verbs/run/records.h"
#include "num/decimal.h"
#include "num/interval.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <yajl/yajl_gen.h>

struct ambit_records {
  int file;
  yajl_gen generator;
  char *path;
  bool failed;     /* a write failed and was reported */
  uint64_t length; /* bytes of the lines that were written */
  volatile sig_atomic_t writing;
  ambit_status (*before)(void *user, ambit_failure *f);
  void *user;
  bool inside;           /* `before` is writing */
  ambit_failure trouble; /* what it failed with */
  ambit_interval shift;
  bool holds; /* lines wait here */
  unsigned char *held;
  size_t nheld, capacity;
};

static void destroy(ambit_records *r) {
  if (r->generator) yajl_gen_free(r->generator);
  free(r->path);
  free(r->held);
  free(r);
}

ambit_status ambit_records_open(const char *path, ambit_records **out, ambit_failure *f) {
  *out = NULL;
  ambit_records *r = calloc(1, sizeof *r);
  if (!r) return ambit_no_memory(f);
  bool standard = strcmp(path, "-") == 0;
  r->path = strdup(standard ? "standard output" : path);
  r->generator = yajl_gen_alloc(NULL);
  if (!r->path || !r->generator) {
    destroy(r);
    return ambit_no_memory(f);
  }
  yajl_gen_config(r->generator, yajl_gen_validate_utf8, 1);
  r->file = standard ? STDOUT_FILENO : open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (r->file < 0) {
    ambit_fail(f, AMBIT_INVALID, "cannot write records to %s: %s", path, strerror(errno));
    destroy(r);
    return AMBIT_INVALID;
  }
  *out = r;
  return AMBIT_OK;
}

/* -- building a line */

/* Bytes of the valid UTF-8 sequence (RFC 3629) at s, 0 if there is none; s is terminated. */
static size_t sequence(const unsigned char *s) {
  if (s[0] < 0x80) return 1;
  size_t n = s[0] >= 0xc2 && s[0] <= 0xdf ? 2 : (s[0] & 0xf0) == 0xe0 ? 3 : s[0] >= 0xf0 && s[0] <= 0xf4 ? 4 : 0;
  for (size_t i = 1; i < n; i++)
    if ((s[i] & 0xc0) != 0x80) return 0;
  if (s[0] == 0xe0 && s[1] < 0xa0) return 0; /* overlong */
  if (s[0] == 0xed && s[1] > 0x9f) return 0; /* surrogate */
  if (s[0] == 0xf0 && s[1] < 0x90) return 0; /* overlong */
  if (s[0] == 0xf4 && s[1] > 0x8f) return 0; /* beyond U+10FFFF */
  return n;
}

static void put_repaired(ambit_records *r, const char *text) {
  static const char replacement[] = "\xef\xbf\xbd";
  char *clean = malloc(3 * strlen(text) + 1);
  if (!clean) return;
  size_t used = 0;
  for (const char *s = text; *s;) {
    size_t n = sequence((const unsigned char *)s);
    memcpy(clean + used, n ? s : replacement, n ? n : 3);
    used += n ? n : 3;
    s += n ? n : 1;
  }
  yajl_gen_string(r->generator, (const unsigned char *)clean, used);
  free(clean);
}

static void put_text(ambit_records *r, const char *text) {
  if (yajl_gen_string(r->generator, (const unsigned char *)text, strlen(text)) == yajl_gen_invalid_string)
    put_repaired(r, text);
}

static void put_number(ambit_records *r, double x) {
  char text[AMBIT_DECIMAL_MAX];
  if (x != x) {
    yajl_gen_null(r->generator);
    return;
  }
  int length = ambit_decimal_shortest(text, x);
  if (x < -1.7976931348623157e308 || x > 1.7976931348623157e308)
    yajl_gen_string(r->generator, (const unsigned char *)text, (size_t)length);
  else
    yajl_gen_number(r->generator, text, (size_t)length);
}

static void put_interval(ambit_records *r, ambit_interval x) {
  yajl_gen_array_open(r->generator);
  if (!ambit_interval_is_empty(x)) {
    put_number(r, x.lo);
    put_number(r, x.hi);
  }
  yajl_gen_array_close(r->generator);
}

void ambit_records_watch(ambit_records *r, ambit_status (*before)(void *user, ambit_failure *f), void *user) {
  r->before = before, r->user = user;
}

static void write_before(ambit_records *r) {
  if (!r->before || r->inside || r->failed) return;
  r->inside = true;
  if (r->before(r->user, &r->trouble) != AMBIT_OK && r->trouble.status == AMBIT_OK)
    ambit_fail(&r->trouble, AMBIT_STOPPED, "what a record rests on could not be written");
  r->inside = false;
}

void ambit_records_begin(ambit_records *r, const char *kind) {
  write_before(r);
  yajl_gen_reset(r->generator, NULL);
  yajl_gen_clear(r->generator);
  yajl_gen_map_open(r->generator);
  ambit_records_text(r, "record", kind);
}

void ambit_records_text(ambit_records *r, const char *key, const char *value) {
  put_text(r, key);
  put_text(r, value);
}

void ambit_records_number(ambit_records *r, const char *key, double value) {
  put_text(r, key);
  put_number(r, value);
}

void ambit_records_flag(ambit_records *r, const char *key, bool value) {
  put_text(r, key);
  yajl_gen_bool(r->generator, value);
}

void ambit_records_interval(ambit_records *r, const char *key, ambit_interval value) {
  put_text(r, key);
  put_interval(r, value);
}

void ambit_records_open_object(ambit_records *r, const char *key) {
  put_text(r, key);
  yajl_gen_map_open(r->generator);
}

void ambit_records_close_object(ambit_records *r) { yajl_gen_map_close(r->generator); }

/* -- writing it */

/* All of it, in one system call if the system takes it so; 0 or errno. */
static int write_all(int file, const unsigned char *text, size_t length) {
  while (length) {
    ssize_t n = write(file, text, length);
    if (n >= 0) {
      text += n;
      length -= (size_t)n;
    } else if (errno == EAGAIN) {
      poll(&(struct pollfd) { .fd = file, .events = POLLOUT }, 1, -1);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

/* Writes without dying of SIGPIPE: it is blocked in this thread, and if this write raised it, taken away again. */
static int write_line(const ambit_records *r, const unsigned char *text, size_t length) {
  sigset_t pipe, old, pending;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  sigpending(&pending);
  bool before = sigismember(&pending, SIGPIPE) == 1;
  pthread_sigmask(SIG_BLOCK, &pipe, &old);
  if (r->file == STDOUT_FILENO) fflush(stdout); /* keep the order with what was printed */
  int problem = write_all(r->file, text, length);
  if (problem == EPIPE && !before) sigtimedwait(&pipe, NULL, &(struct timespec) { 0, 0 });
  pthread_sigmask(SIG_SETMASK, &old, NULL);
  return problem;
}

static ambit_status put_down(ambit_records *r, const unsigned char *text, size_t length, ambit_failure *f) {
  r->writing = 1;
  int problem = write_line(r, text, length);
  r->length += length;
  r->writing = problem != 0;
  if (problem == 0) return AMBIT_OK;
  r->failed = true;
  bool torn = r->file != STDOUT_FILENO && ftruncate(r->file, (off_t)(r->length - length)) != 0; /* no part of a line */
  (void)torn; /* of a pipe: nothing can be taken back */
  return ambit_fail(f, AMBIT_STOPPED, "cannot write records to %s: %s", r->path, strerror(problem));
}

static ambit_status put_aside(ambit_records *r, const unsigned char *text, size_t length, ambit_failure *f) {
  if (r->nheld + length > r->capacity) {
    size_t capacity = 2 * (r->nheld + length);
    unsigned char *held = realloc(r->held, capacity);
    if (!held) return ambit_no_memory(f);
    r->held = held, r->capacity = capacity;
  }
  memcpy(r->held + r->nheld, text, length);
  r->nheld += length;
  return AMBIT_OK;
}

uint64_t ambit_records_length(const ambit_records *r) { return r->length; }
int ambit_records_idle_file(const ambit_records *r) { return r->writing ? -1 : r->file; }

void ambit_records_hold(ambit_records *r) { r->holds = true; }

ambit_status ambit_records_release(ambit_records *r, bool keep, ambit_failure *f) {
  ambit_status status = keep && r->nheld && !r->failed ? put_down(r, r->held, r->nheld, f) : AMBIT_OK;
  free(r->held);
  r->held = NULL, r->nheld = r->capacity = 0, r->holds = false;
  return status;
}

ambit_status ambit_records_end(ambit_records *r, ambit_failure *f) {
  if (r->failed) return AMBIT_STOPPED; /* said once */
  if (r->trouble.status != AMBIT_OK && !r->inside) {
    r->failed = true;
    return ambit_fail(f, AMBIT_STOPPED, "%s", r->trouble.message);
  }
  yajl_gen_map_close(r->generator);
  const unsigned char *text;
  size_t length;
  if (yajl_gen_get_buf(r->generator, &text, &length) != yajl_gen_status_ok || length == 0 || text[length - 1] != '}')
    return ambit_fail(f, AMBIT_BROKEN, "a record was not built as JSON");
  yajl_gen_reset(r->generator, "\n"); /* the separator of the next value ends this line, in the same buffer */
  yajl_gen_get_buf(r->generator, &text, &length);
  return r->holds && !r->inside ? put_aside(r, text, length, f) : put_down(r, text, length, f);
}

ambit_status ambit_records_close(ambit_records *r, ambit_failure *f) {
  if (!r) return AMBIT_OK;
  bool good = r->file == STDOUT_FILENO || close(r->file) == 0;
  ambit_status status = AMBIT_OK;
  if (r->failed)
    status = ambit_fail(f, AMBIT_STOPPED, "the records in %s are incomplete: a write failed", r->path);
  else if (!good)
    status = ambit_fail(f, AMBIT_STOPPED, "cannot write records to %s: %s", r->path, strerror(errno));
  destroy(r);
  return status;
}

/* -- a solver's record */

void ambit_records_shift(ambit_records *r, ambit_interval shift) { r->shift = shift; }

static void put_states(ambit_records *r, const char *key, const ambit_record *step, const double *lo, const double *hi,
    const char *const *name) {
  ambit_records_open_object(r, key);
  for (uint32_t i = 0; i < step->nx; i++) ambit_records_interval(r, name[i], (ambit_interval) { lo[i], hi[i] });
  ambit_records_close_object(r);
}

/* From one time of the clock to another. */
static ambit_interval between(const ambit_records *r, double a, double b) {
  return ambit_interval_add(a <= b ? (ambit_interval) { a, b } : (ambit_interval) { b, a }, r->shift);
}

/* step: "t" is the instant of "x", "span" the time of "tube"; event: "t" encloses its instant. */
static ambit_status put_root(ambit_records *r, const ambit_record *root, const char *const *name, ambit_failure *f) {
  ambit_records_begin(r, "root");
  static const char *const proved[] = { "undecided", "unique", "partly" }; /* AMBIT_ROOT_* */
  ambit_records_text(r, "proved", proved[root->event]);
  put_states(r, "x", root, root->lo, root->hi, name);
  return ambit_records_end(r, f);
}

ambit_status ambit_records_solver(
    ambit_records *r, const ambit_record *step, const char *const *name, ambit_failure *f) {
  if (step->kind == AMBIT_REC_ROOT) return put_root(r, step, name, f);
  bool event = step->kind == AMBIT_REC_EVENT;
  ambit_records_begin(r, event ? "event" : "step");
  if (event) {
    ambit_records_interval(r, "t", between(r, step->t_from, step->t_to));
    ambit_records_number(r, "event", step->event);
  } else {
    ambit_records_interval(r, "t", between(r, step->t_to, step->t_to));
    ambit_records_interval(r, "span", between(r, step->t_from, step->t_to));
  }
  if (step->lo && step->hi) put_states(r, "x", step, step->lo, step->hi, name);
  if (step->tube_lo && step->tube_hi) put_states(r, "tube", step, step->tube_lo, step->tube_hi, name);
  if (step->order) ambit_records_number(r, "order", step->order);
  put_text(r, "rigorous");
  yajl_gen_bool(r->generator, step->rigorous != 0);
  return ambit_records_end(r, f);
}
