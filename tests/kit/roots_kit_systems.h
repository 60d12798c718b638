/* roots_kit_systems.h -- equations whose roots are known. */
#ifndef AMBIT_ROOTS_KIT_SYSTEMS_H
#define AMBIT_ROOTS_KIT_SYSTEMS_H
#include <ambit/graph.h>

enum { ROOTS_UNKNOWNS = 6, ROOTS_FACTORS = 3, ROOTS_DATA = 2, ROOTS_ALL = 64 };

typedef struct roots_system {
  char name[64];
  uint32_t n, nu;
  uint32_t factors[ROOTS_UNKNOWNS]; /* of equation i: (y_i - root[i][0]) (y_i - root[i][1]) ... */
  double root[ROOTS_UNKNOWNS][ROOTS_FACTORS], weight[ROOTS_UNKNOWNS];
  int32_t datum[ROOTS_UNKNOWNS];   /* root[i][0] is this datum; -1: none */
  uint32_t a[ROOTS_UNKNOWNS];      /* phi_i = weight sin x_a or weight x_a^2 */
  bool sine[ROOTS_UNKNOWNS], wave; /* wave: one equation, sin(x) = 0 */
  bool twice, never;               /* the last equation is a square; has + 1 */
  ambit_interval box[ROOTS_UNKNOWNS], u[ROOTS_DATA];
  /* the model */
  ambit_graph *graph;
  ambit_expr x[ROOTS_UNKNOWNS], f[ROOTS_UNKNOWNS];
} roots_system;

void roots_system_make(roots_system *s, uint64_t seed, size_t item);
/* number 0, 1, ...: a double root, no root, a wave; false: there is no such one */
bool roots_system_special(roots_system *s, size_t item);
void roots_system_open(roots_system *s);
void roots_system_close(roots_system *s);
/* root number k for the data u; false: there are no more */
bool roots_system_root(const roots_system *s, size_t k, const double *u, ambit_interval *x);
#endif
