/* roots_kit_systems.c -- see roots_kit_systems.h. */
#include "kit/roots_kit_systems.h"
#include "num/random.h"
#include "num/interval.h"
#include <math.h>
#include <stdio.h>

static uint32_t one_of(ambit_random *random, uint32_t n) { return (uint32_t)(ambit_random_bits(random) % n); }

static double coarse(ambit_random *random, double lo, double hi) {
  return floor(64 * ambit_random_in(random, (ambit_interval) { lo, hi })) / 64;
}

void roots_system_make(roots_system *s, uint64_t seed, size_t item) {
  ambit_random random = { seed * 0x9e3779b97f4a7c15u + item + 1 };
  *s = (roots_system) { .n = 1 + (uint32_t)(item % ROOTS_UNKNOWNS) };
  uint32_t combinations = 1;
  for (uint32_t i = 0; i < s->n; i++) {
    s->factors[i] = 1 + one_of(&random, combinations < 9 ? ROOTS_FACTORS : 1);
    combinations *= s->factors[i];
    for (uint32_t k = 0; k < s->factors[i]; k++) s->root[i][k] = coarse(&random, -1, -0.5) + 0.875 * k;
    s->weight[i] = i ? coarse(&random, -0.5, 0.5) : 0;
    s->a[i] = i ? one_of(&random, i) : 0, s->sine[i] = one_of(&random, 2), s->datum[i] = -1;
    double reach = i % 2 ? 1.25 : 3; /* some roots lie outside */
    s->box[i] = (ambit_interval) { -3.0625, reach };
  }
  for (uint32_t j = 0; j < item / 2 % (ROOTS_DATA + 1); j++) {
    uint32_t i = one_of(&random, s->n);
    if (s->datum[i] >= 0) continue;
    double radius = ldexp(1, -7 - (int)one_of(&random, 6));
    s->u[s->nu] = (ambit_interval) { s->root[i][0] - radius, s->root[i][0] + radius };
    s->datum[i] = (int32_t)s->nu++;
  }
  snprintf(s->name, sizeof s->name, "random equations %zu (%u unknowns, %u data)", item, s->n, s->nu);
}

bool roots_system_special(roots_system *s, size_t item) {
  static const char *const name[] = { "double root", "double root of two", "no root", "sin x = 0" };
  if (item >= sizeof name / sizeof *name) return false;
  *s = (roots_system) { .n = item == 1 ? 2 : 1 };
  snprintf(s->name, sizeof s->name, "%s", name[item]);
  for (uint32_t i = 0; i < s->n; i++)
    s->factors[i] = 1, s->root[i][0] = 0.375, s->datum[i] = -1, s->box[i] = (ambit_interval) { -2, 3 };
  s->twice = item < 2, s->never = item == 2, s->wave = item == 3;
  if (s->wave) s->box[0] = (ambit_interval) { -7, 20 };
  return true;
}

/* -- the model */

static ambit_expr op(roots_system *s, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(s->graph, code, a, b);
}

void roots_system_open(roots_system *s) {
  static const char *const name[ROOTS_UNKNOWNS] = { "a", "b", "c", "d", "e", "f" };
  ambit_expr u[ROOTS_DATA];
  s->graph = ambit_graph_open();
  for (uint32_t j = 0; j < s->nu; j++) u[j] = ambit_graph_unknown(s->graph, "u", s->u[j]);
  for (uint32_t i = 0; i < s->n; i++) s->x[i] = ambit_graph_symbol(s->graph, name[i], "1");
  for (uint32_t i = 0; i < s->n; i++) {
    ambit_expr xa = s->x[s->a[i]], y = s->x[i], f = ambit_graph_number(s->graph, 1);
    ambit_expr phi = op(s, s->sine[i] ? AMBIT_OP_SIN : AMBIT_OP_SQR, xa, xa);
    if (i) y = op(s, AMBIT_OP_SUB, y, op(s, AMBIT_OP_MUL, ambit_graph_number(s->graph, s->weight[i]), phi));
    for (uint32_t k = 0; k < s->factors[i]; k++) {
      ambit_expr r = k == 0 && s->datum[i] >= 0 ? u[s->datum[i]] : ambit_graph_number(s->graph, s->root[i][k]);
      f = op(s, AMBIT_OP_MUL, f, op(s, AMBIT_OP_SUB, y, r));
    }
    bool last = i + 1 == s->n;
    if (last && (s->twice || s->never)) f = op(s, AMBIT_OP_SQR, f, f);
    if (last && s->never) f = op(s, AMBIT_OP_ADD, f, ambit_graph_number(s->graph, 1));
    s->f[i] = s->wave ? op(s, AMBIT_OP_SIN, y, y) : f;
  }
}

void roots_system_close(roots_system *s) { ambit_graph_close(s->graph); }

/* -- the roots */

static ambit_interval apply(uint32_t code, ambit_interval a) {
  ambit_interval r;
  ambit_interval_op(code, &r, a, a);
  return r;
}

bool roots_system_root(const roots_system *s, size_t k, const double *u, ambit_interval *x) {
  size_t all = 1;
  if (s->never) return false;
  if (s->wave) {
    const ambit_interval pi = { 0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1 };
    double times = (double)k - 2;
    x[0] = ambit_interval_mul(pi, (ambit_interval) { times, times });
    return k < 9;
  }
  for (uint32_t i = 0; i < s->n; i++) all *= s->factors[i];
  if (k >= all) return false;
  for (uint32_t i = 0; i < s->n; i++) {
    uint32_t which = (uint32_t)(k % s->factors[i]);
    double y = which == 0 && s->datum[i] >= 0 ? u[s->datum[i]] : s->root[i][which];
    ambit_interval phi = i ? apply(s->sine[i] ? AMBIT_OP_SIN : AMBIT_OP_SQR, x[s->a[i]]) : (ambit_interval) { 0, 0 };
    phi = ambit_interval_mul(phi, (ambit_interval) { s->weight[i], s->weight[i] });
    x[i] = ambit_interval_add((ambit_interval) { y, y }, phi);
    k /= s->factors[i];
  }
  return true;
}
