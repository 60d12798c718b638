/* host.c -- a C program that hosts Ambit: encloses x^2 - 2x for x in [0, 2] in the arithmetic named by its argument. */
#include <ambit/graph.h>
#include <ambit/registry.h>
#include <ambit/evaluate.h>
#include <stdio.h>

int main(int argc, char **argv) {
  ambit_failure f = { 0 };
  ambit_graph *g = ambit_graph_open();
  ambit_registry *r = ambit_registry_open(NULL);
  if (argc < 2 || !g || !r) return 2;
  ambit_expr x = ambit_graph_unknown(g, "x", (ambit_interval) { 0, 2 });
  ambit_expr two = ambit_graph_number(g, 2);
  ambit_expr y = ambit_graph_op(g, AMBIT_OP_SUB, ambit_graph_pown(g, x, 2), ambit_graph_op(g, AMBIT_OP_MUL, two, x));
  ambit_evaluate_request q = { .graph = g, .registry = r, .arithmetic = argv[1], .nexpr = 1, .expr = &y };
  ambit_interval out = AMBIT_EMPTY;
  uint32_t flags = 0;
  ambit_status status = ambit_evaluate(&q, &out, &flags, NULL, &f);
  if (status == AMBIT_OK)
    printf("[%.17g, %.17g]\n", out.lo, out.hi);
  else
    fprintf(stderr, "%s\n", f.message);
  ambit_registry_close(r);
  ambit_graph_close(g);
  return status == AMBIT_OK && out.lo <= -1 && out.hi >= 0 ? 0 : 1;
}
