/* share.c -- sets of equations carried backwards over a tape. */
#include "verbs/run/share.h"
#include "base/meter.h"
#include <stdio.h>
#include <stdlib.h>

#define MOST 4096 /* equations that are told apart */

typedef struct reach {
  const ambit_tape *tape;
  uint32_t n;
  size_t words;  /* of a set */
  uint64_t *set; /* [nslot x words] equations that need a slot */
} reach;

static uint64_t *set_of(const reach *r, uint32_t slot) { return r->set + slot * r->words; }

static void need(const reach *r, uint32_t slot, const uint64_t *by) {
  uint64_t *set = set_of(r, slot);
  for (size_t w = 0; w < r->words; w++) set[w] |= by[w];
}

/* A helper slot may lie behind its user: a second pass brings what it needs, for no helper's helper is new. */
static void carry(const reach *r) {
  const ambit_tape *t = r->tape;
  uint32_t each = t->nout / r->n;
  for (uint32_t o = 0; o < t->nout; o++) {
    uint32_t e = o / (each ? each : 1);
    if (e < r->n) set_of(r, t->out[o])[e / 64] |= UINT64_C(1) << e % 64;
  }
  for (int pass = 0; pass < 2; pass++)
    for (uint32_t i = t->ninstr; i-- > 0;) {
      const uint64_t *by = set_of(r, t->dst[i]);
      need(r, t->a[i], by);
      if (t->op[i] != AMBIT_OP_POWN) need(r, t->b[i], by);
      if (t->aux[i] < t->nslot) need(r, t->aux[i], by);
    }
}

static bool has(const uint64_t *set, uint32_t e) { return set[e / 64] >> e % 64 & 1; }

static uint32_t size_of(const reach *r, const uint64_t *set) {
  uint32_t n = 0;
  for (size_t w = 0; w < r->words; w++) n += (uint32_t)__builtin_popcountll(set[w]);
  return n;
}

static void count(const reach *r, ambit_meter_table *table) {
  const ambit_tape *t = r->tape;
  for (uint32_t i = 0; i < t->ninstr; i++) {
    const uint64_t *set = set_of(r, t->dst[i]);
    uint32_t users = size_of(r, set);
    for (uint32_t e = 0; e < r->n; e++) {
      double *row = table->value + (size_t)e * table->columns;
      if (!has(set, e)) continue;
      if (users == 1) row[t->op[i]] += 1;
      row[AMBIT_OP_END + t->op[i]] += 1.0 / users;
      for (uint32_t other = 0; other < r->n; other++) row[2 * AMBIT_OP_END + other] += has(set, other);
    }
  }
}

void ambit_share_note(const ambit_tape *t, const char *title, uint32_t n, const char *const *name) {
  if (!t || n == 0 || n > MOST || !ambit_meter_is_on()) return;
  reach r = { .tape = t, .n = n, .words = (n + 63u) / 64u };
  r.set = calloc(t->nslot * r.words + 1, sizeof *r.set);
  ambit_meter_table *table = r.set ? ambit_meter_tabulate(title, n, 2 * AMBIT_OP_END + n) : NULL;
  if (table) {
    for (uint32_t e = 0; e < n; e++) {
      if (name)
        snprintf(table->name[e], sizeof table->name[e], "%.95s", name[e]);
      else
        snprintf(table->name[e], sizeof table->name[e], "%u", e + 1);
    }
    carry(&r);
    count(&r, table);
  }
  free(r.set);
}
