/* held_set.c -- from a solver's set to expressions: coefficients and centres are exact doubles. */
#include "script/held_set.h"
#include "base/vector.h"
#include <stdlib.h>
#include <string.h>

static void mark(ambit_holder *holder, ambit_graph *g) {
  const ambit_held_set *held = (const ambit_held_set *)(const void *)holder;
  ambit_graph_mark(g, held->nu, held->unknown);
}

bool ambit_held_set_begin(ambit_held_set *held, ambit_graph *g, size_t nu, const ambit_expr *unknown) {
  ambit_expr *copy = malloc((nu + 1) * sizeof *copy);
  if (!copy) return false;
  if (nu) memcpy(copy, unknown, nu * sizeof *copy);
  free(held->unknown);
  held->unknown = copy;
  held->nu = nu;
  held->set = (ambit_set) { 0 };
  if (held->holder.link) return true;
  held->holder.mark = mark;
  ambit_graph_hold(g, &held->holder);
  return true;
}

void ambit_held_set_clear(ambit_held_set *held) {
  ambit_graph_release(&held->holder);
  free(held->unknown);
  free(held->number);
  free(held->exponent);
  *held = (ambit_held_set) { 0 };
}

void ambit_held_set_swap(ambit_held_set *a, ambit_held_set *b) {
  ambit_holder of_a = a->holder, of_b = b->holder;
  ambit_held_set keep = *a;
  *a = *b, *b = keep;
  a->holder = of_a, b->holder = of_b;
}

static const double *copy_numbers(double **to, const double *from, size_t n) {
  double *start = *to;
  if (n) memcpy(start, from, n * sizeof *start);
  *to += n;
  return start;
}

bool ambit_held_set_put(ambit_held_set *held, uint32_t nx, const ambit_set *set) {
  held->set = (ambit_set) { 0 };
  if (!set || set->size < sizeof *set || set->nu != held->nu || !set->nterm) return true;
  size_t exponents = (size_t)set->nterm * set->nu, coefficients = (size_t)nx * set->nterm;
  double *number =
      ambit_vector_reserve(held->number, &held->room_number, 2 * held->nu + coefficients + nx, sizeof *number);
  if (!number) return false;
  held->number = number;
  uint32_t *exponent = ambit_vector_reserve(held->exponent, &held->room_exponent, exponents + 1, sizeof *exponent);
  if (!exponent) return false;
  held->exponent = exponent;
  held->set = *set;
  held->set.about = copy_numbers(&number, set->about, set->nu);
  held->set.scale = copy_numbers(&number, set->scale, set->nu);
  held->set.coefficient = copy_numbers(&number, set->coefficient, coefficients);
  held->set.rest = copy_numbers(&number, set->rest, nx);
  if (exponents) memcpy(exponent, set->exponent, exponents * sizeof *exponent);
  held->set.exponent = exponent;
  return true;
}

/* v_j = (u_j - about_j) / scale_j */
static ambit_expr normalised(const ambit_held_set *held, ambit_graph *g, uint32_t j) {
  ambit_expr about = ambit_graph_number(g, held->set.about[j]), scale = ambit_graph_number(g, held->set.scale[j]);
  return ambit_graph_op(g, AMBIT_OP_DIV, ambit_graph_op(g, AMBIT_OP_SUB, held->unknown[j], about), scale);
}

static ambit_expr monomial(const ambit_held_set *held, ambit_graph *g, uint32_t term, double coefficient) {
  ambit_expr product = ambit_graph_number(g, coefficient);
  const uint32_t *exponent = held->set.exponent + (size_t)term * held->set.nu;
  for (uint32_t j = 0; j < held->set.nu; j++)
    if (exponent[j])
      product =
          ambit_graph_op(g, AMBIT_OP_MUL, product, ambit_graph_pown(g, normalised(held, g, j), (int32_t)exponent[j]));
  return product;
}

void ambit_held_set_express(const ambit_held_set *held, ambit_graph *g, size_t nx, ambit_expr *x) {
  const ambit_set *set = &held->set;
  for (size_t i = 0; i < nx; i++) {
    double rest = set->rest[i];
    x[i] = rest > 0 ? ambit_graph_datum(g, NULL, NULL, (ambit_interval) { -rest, rest }, AMBIT_EMPTY)
                    : ambit_graph_number(g, 0);
    for (uint32_t t = 0; t < set->nterm; t++) {
      double coefficient = set->coefficient[i * set->nterm + t];
      if (coefficient != 0) x[i] = ambit_graph_op(g, AMBIT_OP_ADD, x[i], monomial(held, g, t, coefficient));
    }
  }
}
