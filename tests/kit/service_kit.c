/* service_kit.c -- the table of exported functions. */
#include "kit/service_kit.h"
#include "kit/guarded.h"
#include "num/random.h"
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define MESSAGES 5
#define CALLS 40
#define NUMBERS 9

void service_kit_find(service_kit *k, const char *promise, const char *format, ...) {
  char message[400];
  va_list arguments;
  if (k->findings++ >= MESSAGES) return;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  k->finding(k->user, promise, message);
}

/* "d(Ddd)", with signatures of callbacks inside; NULL: what comes first is none */
static const char *skip_signature(const char *c, int depth) {
  if (!*c || !strchr("vilds", *c) || *++c != '(' || depth > 3) return NULL;
  for (c++; *c && *c != ')';) {
    if (*c == '(') {
      c = skip_signature(c + 1, depth + 1);
      if (!c || *c != ')') return NULL;
      c++;
    } else if (strchr("ildsD", *c))
      c++;
    else
      return NULL;
  }
  return *c == ')' ? c + 1 : NULL;
}

static bool is_name(const char *name) {
  if (!name || !(isalpha((unsigned char)*name) || *name == '_')) return false;
  for (; *name; name++)
    if (!isalnum((unsigned char)*name) && *name != '_') return false;
  return true;
}

/* a random number, or one that hurts */
static double any(ambit_random *random) {
  static const double nasty[] = { 0, -0.0, 1, INFINITY, -INFINITY, NAN, 0x1p-1074, 1e308 };
  uint64_t bits = ambit_random_bits(random);
  if (bits % 4 == 0) return nasty[(bits >> 8) % (sizeof nasty / sizeof *nasty)];
  return ambit_random_in(random, (ambit_interval) { -8, 8 });
}

/* functions of one to three numbers, or of an array that ends where memory ends; others are not called */
static bool call(const ambit_function *f, const double *x, const double *array, double *y) {
  if (strcmp(f->signature, "d(d)") == 0)
    *y = ((double (*)(double))f->call)(x[0]);
  else if (strcmp(f->signature, "d(dd)") == 0)
    *y = ((double (*)(double, double))f->call)(x[0], x[1]);
  else if (strcmp(f->signature, "d(ddd)") == 0)
    *y = ((double (*)(double, double, double))f->call)(x[0], x[1], x[2]);
  else if (strcmp(f->signature, "d(D)") == 0)
    *y = ((double (*)(const double *, size_t))f->call)(array, NUMBERS);
  else if (strcmp(f->signature, "d(Dd)") == 0)
    *y = ((double (*)(const double *, size_t, double))f->call)(array, NUMBERS, x[0]);
  else
    return false;
  return true;
}

static void call_twice(service_kit *k, const ambit_function *f) {
  ambit_random random = { k->seed };
  double *array = guarded_open(NULL, NUMBERS * sizeof *array), x[3], first, second;
  for (int i = 0; array && i < CALLS; i++) {
    for (int j = 0; j < 3; j++) x[j] = any(&random);
    for (int j = 0; j < NUMBERS; j++) array[j] = any(&random);
    if (!call(f, x, array, &first)) break;
    call(f, x, array, &second);
    k->judged++;
    if (memcmp(&first, &second, sizeof first) != 0 && !(isnan(first) && isnan(second)))
      service_kit_find(k, "exports", "`%s` of (%a, ...) is %a, then %a", f->name, x[0], first, second);
  }
  guarded_close(array, NUMBERS * sizeof *array);
}

void service_kit_exports(service_kit *k, const ambit_exports *e) {
  for (uint32_t i = 0; i < e->count; i++) {
    const ambit_function *f = &e->function[i];
    k->judged += 4;
    const char *end = f->signature ? skip_signature(f->signature, 0) : NULL;
    bool sound = f->call && end && !*end;
    if (!is_name(f->name)) service_kit_find(k, "exports", "function %u has no name", i);
    if (!end || *end)
      service_kit_find(k, "exports", "`%s` has no signature: `%s`", f->name, f->signature ? f->signature : "");
    if (!f->call) service_kit_find(k, "exports", "`%s` is no function", f->name);
    if (!f->doc || strlen(f->doc) < 3) service_kit_find(k, "exports", "`%s` has no sentence", f->name);
    for (uint32_t j = 0; j < i && is_name(f->name); j++)
      if (is_name(e->function[j].name) && strcmp(e->function[j].name, f->name) == 0)
        service_kit_find(k, "exports", "two functions are called `%s`", f->name);
    if (sound) call_twice(k, f);
  }
}
