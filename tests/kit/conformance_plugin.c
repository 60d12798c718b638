/* conformance_plugin.c -- the conformance kits as a service plugin, which `ambit check` loads and nothing else.
**
** It is a host program in the shape of a plugin: checking plugins means loading them, by a kernel of its own.
*/
#include "kit/conformance.h"
#include <ambit/export.h>
#include <stdlib.h>
#include <string.h>

typedef void (*tell_fn)(const char *what, const char *name, const char *text, void *user);

typedef struct listener {
  tell_fn call;
  void *user;
} listener;

static void forward(void *user, const char *what, const char *name, const char *text) {
  const listener *l = user;
  l->call(what, name, text, l->user);
}

enum { OPTIONS_MAX = 64 };
enum { CHECK_ISOTONIC = 1, CHECK_FIRST = 2 };

/* "degree=5\nsymbols=10", cut up in place */
static size_t split_options(char *text, ambit_option *option) {
  size_t n = 0;
  for (char *line = text; line && *line && n < OPTIONS_MAX;) {
    char *next = strchr(line, '\n'), *equals = strchr(line, '=');
    if (next) *next++ = '\0';
    if (equals) *equals = '\0', option[n++] = (ambit_option) { line, equals + 1 };
    line = next;
  }
  return n;
}

static int32_t check(const char *file, const char *options, double seed, double effort, double patience, int32_t flags,
    tell_fn call, void *user) {
  ambit_option option[OPTIONS_MAX];
  listener l = { call, user };
  char *text = strdup(options);
  if (!text) return NOT_LOADED;
  conformance c = { .file = file,
    .noption = split_options(text, option),
    .option = option,
    .seed = (uint64_t)seed,
    .effort = effort,
    .isotonic = (flags & CHECK_ISOTONIC) != 0,
    .first = (flags & CHECK_FIRST) != 0,
    .tell = forward,
    .user = &l };
  int verdict = conformance_run_apart(&c, patience);
  free(text);
  return verdict;
}

static void trust(const char *folder) { ambit_trust_folder(folder, NULL); }

static const ambit_function functions[] = {
  { "check", "i(ssdddi(v(sss)))", (void (*)(void))check,
      "runs the kit on FILE with OPTIONS (lines name=value), seed, effort, patience in s, and flags (1: "
      "isotonicity is demanded, 2: end at the first broken promise); tells what happens; 0 conforms, 1 cannot be "
      "loaded, 3 broken promises" },
  { "trust", "v(s)", (void (*)(void))trust, "plugins may be loaded from FOLDER whoever may write there" },
  { "allow_shadow", "v()", ambit_trust_shadows, "a plugin may take a name of Ambit's own" },
};
static const ambit_exports exports = { sizeof exports, sizeof functions / sizeof *functions, functions };

static const void *get(const char *id) { return strcmp(id, AMBIT_EXPORTS) == 0 ? &exports : NULL; }

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.conformance_kit", "1.0",
  "The conformance kits of arithmetics, elements and solvers: what `ambit check` runs.", get };
