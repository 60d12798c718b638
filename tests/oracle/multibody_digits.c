/* multibody_digits.c -- prints digits of chains for scripts/bench/robots/rows.lua, in quadruple precision and with two
** tolerances: cc -O2 -DMULTIBODY_QUAD multibody*.c (without multibody_lua.c) -lquadmath -lm && ./a.out LINKS TIME
** DAMPING
*/
#include "multibody.h"
#ifdef MULTIBODY_QUAD
#include <stdio.h>
#include <stdlib.h>

static void chain(multibody *m, int n, multibody_real damping) {
  m->n = n;
  m->gravity[1] = -9.81Q;
  for (int i = 0; i < n; i++) {
    m->body[i] = (multibody_body) { .parent = i - 1,
      .axis = { 0, 0, 1 },
      .offset = { i ? 0.5Q : 0 },
      .turn_axis = { 0, 0, 1 },
      .mass = 1,
      .centre = { 0.5Q },
      .damping = damping };
  }
}

int main(int argc, char **argv) {
  if (argc != 4) return fputs("LINKS TIME DAMPING\n", stderr), 2;
  int n = atoi(argv[1]);
  for (int fine = 0; fine < 2; fine++) {
    static multibody m;
    chain(&m, n, strtoflt128(argv[3], NULL));
    multibody_real q[MULTIBODY_MOST] = { 0 }, v[MULTIBODY_MOST] = { 0 };
    if (!multibody_integrate(&m, 0, strtoflt128(argv[2], NULL), fine ? 1e-21Q : 1e-18Q, q, v)) return puts("no"), 1;
    for (int i = 0, stride = n > 4 ? n / 4 : 1; i < n; i += stride) {
      char a[64], b[64];
      quadmath_snprintf(a, sizeof a, "%.20Qg", q[i]);
      quadmath_snprintf(b, sizeof b, "%.20Qg", v[i]);
      printf("q%d = \"%s\", [\"q%d'\"] = \"%s\",\n", i + 1, a, i + 1, b);
    }
  }
  return 0;
}
#endif
