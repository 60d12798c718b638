/* natural.c -- frames of states and of linear invariants, for sets in which eigenvectors turn too much.
**
** Where slopes vary by 1 percent over the unknowns, the frame of the centre's eigenvectors lets each fast direction
** leak 1 percent of its rate into slow ones and back, and bounds grow with 1e-4 of that rate. In coordinates of the
** states, of which some are replaced by invariants w . x, those exchanges are what they are in the equations, and often
** small.
** With an integer w such that w . f = 0 (invariant.c), w . e moves by the defect alone: its row of the matrix is zero.
*/
#include "invariant.h"
#include "stiff.h"
#include <string.h>

#define GAIN 1.0     /* in the exponent of growth, that makes another frame worth a change */
#define HOPELESS 1e3 /* exponent of a frame that cannot be used */

/* -- frames */

/* the state that invariant k takes the place of in frame `choice` - 1, of those with coefficient +-1; nx: none */
static uint32_t place_of(const stiff *s, const double *w, uint32_t choice, const int *taken) {
  uint32_t units[N_MAX], count = 0;
  for (uint32_t i = 0; i < s->nx; i++)
    if (fabs(w[i]) == 1 && !taken[i]) units[count++] = i;
  return count ? units[choice % count] : s->nx;
}

/* C with rows of w, U its exact inverse; 0: not both of integers */
static int fill(stiff *s, const double *w, uint32_t choice) {
  uint32_t n = s->nx;
  double *C = s->natural_C[choice], *U = s->natural_U[choice];
  int *still = s->natural_still + choice * n;
  for (uint32_t i = 0; i < n * n; i++) C[i] = i % (n + 1) == 0;
  for (uint32_t k = 0; k < s->ninvariant; k++) {
    uint32_t i = place_of(s, w + k * n, choice, still);
    if (i == n) continue;
    memcpy(C + i * n, w + k * n, n * sizeof *C);
    still[i] = 1;
  }
  if (!matrix_inverse(n, C, U)) return 0;
  for (uint32_t i = 0; i < n * n; i++) U[i] = rint(U[i]);
  square product;
  matrix_multiply(n, n, n, C, U, product); /* exact: small integers */
  for (uint32_t i = 0; i < n * n; i++)
    if (product[i] != (i % (n + 1) == 0) || !(fabs(U[i]) < INVARIANT_LARGEST)) return 0;
  return 1;
}

int natural_open(stiff *s) {
  const ambit_host *h = s->host;
  uint32_t nx = s->nx;
  double *w = h->alloc(h, (size_t)nx * nx * sizeof *w);
  double *rows = h->alloc(h, nx * ((size_t)s->problem.rhs->nslot + nx) * sizeof *rows);
  if (!w || !rows) return 0;
  s->ninvariant = invariant_find(s->problem.rhs, nx, rows, w);
  uint32_t wanted = s->ninvariant ? nx : 1;
  s->natural_C = h->alloc(h, wanted * sizeof *s->natural_C);
  s->natural_U = h->alloc(h, wanted * sizeof *s->natural_U);
  s->natural_still = h->alloc(h, (size_t)wanted * nx * sizeof *s->natural_still);
  if (!s->natural_C || !s->natural_U || !s->natural_still) return 0;
  size_t bytes = (size_t)nx * nx * sizeof(double);
  while (s->choices < wanted && fill(s, w, s->choices)) {
    if (s->choices > 0 && memcmp(s->natural_C[s->choices], s->natural_C[0], bytes) == 0) break; /* they repeat */
    s->choices++;
  }
  return 1;
}

void natural_frame(stiff *s, uint32_t choice) {
  frame *r = &s->frame;
  uint32_t n = s->n;
  square X, Y;
  r->order = 0, r->natural = 1;
  memcpy(r->C, s->natural_C[choice - 1], (size_t)n * n * sizeof(double));
  memcpy(r->U[0], s->natural_U[choice - 1], (size_t)n * n * sizeof(double));
  memcpy(r->still, s->natural_still + (size_t)(choice - 1) * n, n * sizeof *r->still);
  r->split.slow = 0, r->split.fast = r->split.blocks = n;
  for (uint32_t i = 0; i < n * n; i++) r->G[i] = r->Gi[i] = i % (n + 1) == 0;
  frame_apply_slopes(s, 0, n, r->U[0], X);
  matrix_multiply(n, n, n, r->C, X, Y);
  for (uint32_t i = 0; i < n; i++) {
    r->split.block[i] = i;
    r->decay[i] = fmax(-Y[i * n + i], 0);
  }
}

/* -- which one */

static AMBIT_WORKER int bound_up(stiff *s, double *M) {
  matrix_bounds A;
  if (!frame_verify(s)) return 0;
  rates_bound(s, &A);
  rates_in_blocks(s, &A, M);
  return 1;
}

/* the largest eigenvalue of the comparison matrix, about */
static double growth(stiff *s) {
  square M;
  double one[N_MAX];
  spectrum e;
  uint32_t m = s->frame.split.blocks;
  ambit_rounding nearest = ambit_round_up();
  int good = bound_up(s, M);
  ambit_rounding_restore(nearest);
  /* NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage) */
  for (uint32_t i = 0; i < m * m; i++) good &= isfinite(M[i]);
  if (!good) return INFINITY;
  for (uint32_t i = 0; i < m; i++) one[i] = 1;
  eigen_find(m, M, one, &e);
  return e.ok ? e.real[m - 1] : INFINITY;
}

/* A change costs about a factor: it is made when another frame would have saved GAIN by now. */
void natural_choose(stiff *s, uint32_t j, uint32_t pieces) {
  double now[N_MAX + 1];
  uint32_t best = s->choice;
  for (uint32_t c = 0; c <= s->choices; c++) {
    int good = 1;
    if (c)
      natural_frame(s, c);
    else
      good = frame_choose(s, j);
    now[c] = good ? fmin(growth(s) * 2 * pieces, HOPELESS) : HOPELESS;
  }
  for (uint32_t c = 0; c <= s->choices; c++) {
    s->savings[c] = fmax(s->savings[c] + now[s->choice] - now[c], 0);
    if (s->savings[c] > GAIN && (best == s->choice || s->savings[c] > s->savings[best])) best = c;
  }
  if (best == s->choice) return;
  s->choice = best;
  memset(s->savings, 0, sizeof s->savings);
}
