/* names.c -- edit distance (Levenshtein 1966) over short names; the same letters in another order are nearer still. */
#include "base/names.h"
#include <stdbool.h>
#include <string.h>

#define LONGEST 63

static size_t smaller(size_t a, size_t b) { return a < b ? a : b; }

static size_t distance(const char *a, const char *b) {
  size_t row[LONGEST + 1], na = strlen(a), nb = strlen(b);
  if (na > LONGEST || nb > LONGEST) return LONGEST;
  for (size_t j = 0; j <= nb; j++) row[j] = j;
  for (size_t i = 1; i <= na; i++) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= nb; j++) {
      size_t change = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = smaller(change, smaller(row[j], row[j - 1]) + 1);
    }
  }
  return row[nb];
}

static bool has_same_letters(const char *a, const char *b) {
  int count[256] = { 0 };
  for (; *a; a++) count[(unsigned char)*a]++;
  for (; *b; b++) count[(unsigned char)*b]--;
  for (int i = 0; i < 256; i++)
    if (count[i] != 0) return false;
  return true;
}

const char *ambit_names_nearest(const char *name, const char *const *candidate, size_t count) {
  const char *best = NULL;
  size_t limit = strlen(name) / 3 + 1, least = limit + 1;
  for (size_t i = 0; i < count; i++) {
    size_t d = has_same_letters(name, candidate[i]) ? 0 : distance(name, candidate[i]);
    if (d < least) {
      least = d;
      best = candidate[i];
    }
  }
  return best;
}
