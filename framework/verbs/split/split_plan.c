/* split_plan.c -- from what is asked to a grid of pieces. */
#include "verbs/split/split_plan.h"
#include "verbs/split/probe.h"
#include <stdbool.h>
#include <string.h>

#define INTERVALS 64

static bool is_ascending(const double *t, size_t n) {
  for (size_t i = 1; i < n; i++)
    if (!(t[n - 1] > t[0] ? t[i] > t[i - 1] : t[i] < t[i - 1])) return false;
  return true;
}

const double *ambit_split_plan_instants(ambit_arena *arena, const double *time, size_t *n) {
  if (*n != 2) return time;
  double *t = ambit_arena_alloc(arena, (INTERVALS + 1) * sizeof *t);
  if (!t) return NULL;
  for (uint32_t i = 0; i <= INTERVALS; i++) {
    double s = (double)i / INTERVALS;
    t[i] = i == 0 ? time[0] : i == INTERVALS ? time[1] : time[0] * (1 - s) + time[1] * s;
  }
  if (!is_ascending(t, INTERVALS + 1)) return time; /* not so many doubles in between, or times that make no sense */
  *n = INTERVALS + 1;
  return t;
}

const ambit_cut_band *ambit_split_plan_band(
    ambit_arena *arena, const ambit_cut_band *band, uint32_t nx, size_t given, size_t now) {
  if (given == now) return band;
  size_t before = (now - given) * nx, n = (given - 1) * nx; /* of two instants, the last is now the last of many */
  ambit_cut_band *own = ambit_arena_alloc(arena, sizeof *own);
  double *lo = ambit_arena_alloc(arena, 2 * (before + n) * sizeof *lo), *hi = lo + before + n;
  if (!own || !lo) return NULL;
  memset(lo, 0, 2 * (before + n) * sizeof *lo); /* what has no width does not count */
  memcpy(lo + before, band->lo, n * sizeof *lo);
  memcpy(hi + before, band->hi, n * sizeof *hi);
  *own = *band;
  own->lo = lo, own->hi = hi;
  return own;
}

static ambit_status read_cuts(const ambit_problem *p, const ambit_expr *unknown, size_t ncut, const ambit_cut *cut,
    uint32_t *parts, const char **name, ambit_failure *f) {
  for (size_t i = 0; i < ncut; i++) {
    uint32_t j = 0;
    while (j < p->nu && unknown[j] != cut[i].unknown) j++;
    if (j < p->nu && !name[j]) name[j] = cut[i].name;
    if (cut[i].parts == 0) continue;
    if (j == p->nu)
      return ambit_fail(f, AMBIT_INVALID, "split: the run does not depend on `%s`, or it is no uncertain datum",
          cut[i].name ? cut[i].name : "?");
    if (parts[j])
      return ambit_fail(f, AMBIT_INVALID, "split: `%s` and `%s` are the same uncertain datum", name[j], cut[i].name);
    parts[j] = cut[i].parts;
  }
  return AMBIT_OK;
}

ambit_status ambit_split_plan_make(const ambit_problem *p, const ambit_tape *initial, const ambit_expr *unknown,
    size_t ncut, const ambit_cut *cut, uint32_t total, ambit_arena *arena, ambit_split_plan *plan, ambit_failure *f) {
  uint32_t *parts = ambit_arena_alloc(arena, (p->nu + 1u) * sizeof *parts);
  const char **name = ambit_arena_alloc(arena, (p->nu + 1u) * sizeof *name);
  double *influence = ambit_arena_alloc(arena, (p->nu + 1u) * sizeof *influence);
  if (!parts || !name || !influence) return ambit_no_memory(f);
  ambit_status status = read_cuts(p, unknown, ncut, cut, parts, name, f);
  if (status == AMBIT_OK && total) {
    status = ambit_probe_influence(p, initial, arena, influence);
    if (status != AMBIT_OK) return ambit_fail(f, status, "out of memory");
    ambit_pieces_deal(p->nu, influence, total, parts);
  }
  for (uint32_t j = 0; j < p->nu; j++) {
    if (!parts[j]) parts[j] = 1;
    if (!name[j] && p->unknown_name) name[j] = p->unknown_name[j];
  }
  if (status == AMBIT_OK) status = ambit_pieces_cut(arena, p->nu, p->u_lo, p->u_hi, parts, &plan->pieces, f);
  plan->name = name;
  return status;
}
