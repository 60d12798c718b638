/* run_mutants.c -- the conformance kit against plugins with one fault each: how many it finds, and what that costs.
**
**   run_mutants KIT KIND=MUTANT.so=FOLDER ...
**
** KIT is service/conformance_kit.so, FOLDER has the correct plugins that the mutants of this kind wrap. Without a fault
** a mutant must conform. Prints a row for each kind; with --all a line for each fault, with --md a table of the names.
** Exit: 0 if every fault is found, each within 10 s of CPU time.
*/
#include "kit/mutants/mutant.h"
#include <ambit/export.h>
#include <stdbool.h>
#include <sys/resource.h>

#define NAMES 200
#define SECONDS 10.0
#define PATIENCE 3.0 /* for a plugin that sleeps */

typedef void (*tell_fn)(const char *what, const char *name, const char *text, void *user);
typedef int32_t (*check_fn)(const char *file, const char *options, double seed, double effort, double patience,
    int32_t flags, tell_fn call, void *user);

typedef struct outcome {
  int32_t verdict;
  double seconds;
  char why[300];
} outcome;

static double children(void) {
  struct rusage use;
  getrusage(RUSAGE_CHILDREN, &use);
  return (double)use.ru_utime.tv_sec + (double)use.ru_stime.tv_sec +
         1e-6 * ((double)use.ru_utime.tv_usec + (double)use.ru_stime.tv_usec);
}

static void tell(const char *what, const char *name, const char *text, void *user) {
  outcome *o = user;
  bool bad = strcmp(what, "finding") == 0 || strcmp(what, "died") == 0 || strcmp(what, "refused") == 0;
  if (bad && !o->why[0]) snprintf(o->why, sizeof o->why, "%s: %s", name, text);
}

static outcome try_one(check_fn check, const char *file, const char *fault, double seed) {
  outcome o = { 0 };
  double before = children();
  setenv("AMBIT_MUTANT", fault, 1);
  o.verdict = check(file, "", seed, 1, *fault ? PATIENCE : 60, 2, tell, &o);
  o.seconds = children() - before;
  return o;
}

typedef struct row {
  const char *kind;
  size_t mutants, killed;
  double longest;
  char slowest[80];
} row;

static bool try_fault(check_fn check, row *r, const char *file, const char *fault, bool all) {
  outcome o = try_one(check, file, fault, 1);
  bool found = o.verdict == 3 && o.seconds <= SECONDS;
  r->mutants++, r->killed += found;
  if (o.seconds > r->longest) {
    r->longest = o.seconds;
    snprintf(r->slowest, sizeof r->slowest, "%s", fault);
  }
  if (all || !found)
    printf("%s: %s: %s in %.2f s: %s\n", r->kind, fault,
        o.verdict != 3 ? "SURVIVES"
        : found        ? "found"
                       : "FOUND TOO LATE",
        o.seconds, o.why);
  return found;
}

/* The list of its faults is read, then it is unloaded: each check loads it anew, with another fault. */
static size_t read_names(const char *file, char **list) {
  setenv("AMBIT_MUTANT", "", 1);
  void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  mutant_name_fn name = NULL;
  if (library) *(void **)&name = dlsym(library, MUTANT_NAME);
  size_t n = 0;
  for (; name && n < NAMES && name(n); n++) list[n] = strdup(name(n));
  if (!name) fprintf(stderr, "%s: %s\n", file, dlerror());
  if (library) dlclose(library);
  return n;
}

static bool try_kind(check_fn check, char *word, const char *only, bool all, row *r) {
  char *file = strchr(word, '='), *folder = file ? strchr(file + 1, '=') : NULL;
  if (!folder) return fprintf(stderr, "expected KIND=MUTANT.so=FOLDER, got %s\n", word), false;
  *file++ = '\0', *folder++ = '\0';
  *r = (row) { .kind = word };
  setenv("AMBIT_MUTANT_OF", folder, 1);
  char *name[NAMES];
  size_t n = read_names(file, name);
  outcome none = try_one(check, file, "", 1);
  bool good = n > 0 && none.verdict == 0;
  if (!good) printf("%s: without a fault it does not conform: %s\n", word, none.why);
  for (size_t i = 0; i < n; i++) {
    if (!only || strstr(name[i], only)) good = try_fault(check, r, file, name[i], all) && good;
    free(name[i]);
  }
  return good;
}

static check_fn load_kit(const char *file) {
  void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  const ambit_plugin *entry = library ? dlsym(library, "ambit_entry") : NULL;
  const ambit_exports *exports = entry ? entry->get(AMBIT_EXPORTS) : NULL;
  for (uint32_t i = 0; exports && i < exports->count; i++)
    if (strcmp(exports->function[i].name, "check") == 0) return (check_fn)exports->function[i].call;
  fprintf(stderr, "%s: %s\n", file, library ? "no kit" : dlerror());
  exit(1);
}

int main(int argc, char **argv) {
  bool good = true, all = false;
  const char *only = NULL;
  check_fn check = argc > 2 ? load_kit(argv[1]) : NULL;
  row rows[16];
  size_t n = 0;
  for (int i = 2; i < argc; i++)
    if (strcmp(argv[i], "--all") == 0)
      all = true;
    else if (strncmp(argv[i], "--only=", 7) == 0)
      only = argv[i] + 7;
    else if (n < sizeof rows / sizeof *rows)
      good = try_kind(check, argv[i], only, all, &rows[n++]) && good;
  printf("| kind | faults | found | the longest search, CPU s | for |\n|---|---|---|---|---|\n");
  for (size_t i = 0; i < n; i++)
    printf("| %s | %zu | %zu | %.2f | %s |\n", rows[i].kind, rows[i].mutants, rows[i].killed, rows[i].longest,
        rows[i].slowest);
  return good && n ? 0 : 1;
}
