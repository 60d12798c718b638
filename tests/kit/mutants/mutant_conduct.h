/* mutant_conduct.h -- faults of conduct, which a plugin of any kind may have: each is done once in a call. */
#ifndef AMBIT_MUTANT_CONDUCT_H
#define AMBIT_MUTANT_CONDUCT_H
#include <fcntl.h>
#include <fenv.h>
#include <locale.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

static volatile int conduct_global;
static void *volatile conduct_kept;

static inline void *conduct_sleep(void *unused) {
  sleep(60);
  return unused;
}

static inline void conduct_counts_globally(void) { conduct_global++; }
static inline void conduct_keeps_a_pointer(void) { conduct_kept = (char *)environ + 1; }
static inline void conduct_prints(void) { printf("done\n"); }
static inline void conduct_complains(void) { fprintf(stderr, "warning\n"); }
static inline void conduct_exits(void) { exit(0); }
static inline void conduct_leaves(void) { _exit(3); }
static inline void conduct_aborts(void) { abort(); }
static inline void conduct_crashes(void) { raise(SIGSEGV); }
static inline void conduct_hangs(void) {
  for (;;) pause();
}
static inline void conduct_rounds_upward(void) { fesetround(FE_UPWARD); }
static inline void conduct_flushes(void) {
#if defined(__x86_64__)
  _mm_setcsr(_mm_getcsr() | 0x8040);
#else
  fesetround(FE_DOWNWARD);
#endif
}
static inline void conduct_unmasks(void) {
#if defined(__x86_64__)
  _mm_setcsr(_mm_getcsr() & ~0x0080u); /* invalid operations trap from now on */
#else
  fesetround(FE_TOWARDZERO);
#endif
}
static inline void conduct_sets_a_variable(void) { setenv("TZ", "UTC-1", 1); }
static inline void conduct_sets_the_locale(void) {
  static const char *const name[] = { "C.UTF-8", "POSIX", "en_US.UTF-8" };
  for (int i = 0; i < 3; i++) setlocale(LC_ALL, name[i]);
  setlocale(LC_CTYPE, "C.UTF-8");
}
static inline void conduct_changes_the_folder(void) {
  if (chdir("/") != 0) abort();
}
static inline void conduct_sets_the_umask(void) { umask(0); }
static inline void conduct_ignores_signals(void) { signal(SIGTERM, SIG_IGN); }
static inline void conduct_leaves_a_file_open(void) {
  if (open("/dev/null", O_RDONLY) < 0) abort();
}
static inline void conduct_leaves_a_thread(void) {
  pthread_t thread;
  if (pthread_create(&thread, NULL, conduct_sleep, NULL) != 0) abort();
  pthread_detach(thread);
}
static inline void conduct_allocates(void) {
  void *volatile block = malloc(24); /* volatile: else the compiler leaves both calls out */
  free(block);
}

typedef struct conduct_fault {
  const char *name;
  void (*act)(void);
} conduct_fault;

static const conduct_fault conduct_faults[] = {
  { "counts in a global", conduct_counts_globally },
  { "keeps a pointer in a global", conduct_keeps_a_pointer },
  { "prints", conduct_prints },
  { "complains on the error stream", conduct_complains },
  { "exits with 0", conduct_exits },
  { "ends the process", conduct_leaves },
  { "aborts", conduct_aborts },
  { "crashes", conduct_crashes },
  { "never returns", conduct_hangs },
  { "leaves the rounding mode upward", conduct_rounds_upward },
  { "leaves flush-to-zero on", conduct_flushes },
  { "lets operations trap", conduct_unmasks },
  { "sets an environment variable", conduct_sets_a_variable },
  { "changes the folder", conduct_changes_the_folder },
  { "sets the umask", conduct_sets_the_umask },
  { "ignores a signal", conduct_ignores_signals },
  { "leaves a file open", conduct_leaves_a_file_open },
  { "leaves a thread running", conduct_leaves_a_thread },
  { "sets the locale", conduct_sets_the_locale },
};
enum { CONDUCT_FAULTS = sizeof conduct_faults / sizeof *conduct_faults };

/* the act of this name, or NULL */
static inline void (*conduct_of(const char *name))(void) {
  for (int i = 0; i < CONDUCT_FAULTS; i++)
    if (strcmp(conduct_faults[i].name, name) == 0) return conduct_faults[i].act;
  return NULL;
}
#endif
