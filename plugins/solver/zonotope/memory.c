/* memory.c -- what phase 2 needs, all at once, and how each x' is found. */
#include "proof.h"
#include "basis.h"
#include "change.h"
#include "depend.h"
#include "jump.h"
#include "modes.h"
#include "quartic.h"
#include "residual.h"
#include "strip.h"

static int doubles(const ambit_host *h, size_t n, double **to) {
  *to = h->alloc(h, (n ? n : 1) * sizeof(double));
  return *to != NULL;
}
static int numbers(const ambit_host *h, size_t n, uint32_t **to) {
  *to = h->alloc(h, (n ? n : 1) * sizeof(uint32_t));
  return *to != NULL;
}

/* x'_i is a state, an unknown, or a target of its own */
static void find_links(zono *z) {
  proof *p = z->proof;
  p->ntarget = z->na;
  for (uint32_t i = 0; i < z->nx; i++) {
    uint32_t slot = slot_out(z)[i];
    p->link[i] = LINK_TARGET;
    for (uint32_t j = 0; j < z->nx; j++)
      if (slot == slot_x(z, j)) p->link[i] = LINK_STATE, p->link_to[i] = j;
    for (uint32_t k = 0; k < z->na; k++)
      if (slot == slot_a(z, k)) p->link[i] = LINK_UNKNOWN, p->link_to[i] = k;
    if (p->link[i] != LINK_TARGET) continue;
    p->target_out[p->ntarget - z->na] = i;
    p->link_to[i] = p->ntarget++;
  }
}

/* stage by stage, each in the order of its pivots */
static void find_order(zono *z) {
  uint32_t *to = z->proof->order;
  for (uint32_t s = 0, from = 0; s < z->program.nstage; from = z->program.stage_end[s++])
    for (uint32_t n = 0; n < z->na; n++) {
      uint32_t k = z->program.pivot ? z->program.pivot[n] : n;
      if (k >= from && k < z->program.stage_end[s]) *to++ = k;
    }
}

static int takes_slope(uint32_t op) {
  switch (op) {
  case AMBIT_OP_DIV:
  case AMBIT_OP_SQRT:
  case AMBIT_OP_EXP:
  case AMBIT_OP_LOG:
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_ATAN:
  case AMBIT_OP_ATAN2:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
  case AMBIT_OP_TANH: return 1;
  default: return 0;
  }
}

static void find_slopes(zono *z) {
  const ambit_tape *t = z->program.tape;
  for (uint32_t j = 0; j < z->nslot; j++) z->proof->slope_at[j] = AMBIT_NO_SLOT;
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (takes_slope(t->op[i])) z->proof->slope_at[t->dst[i]] = z->proof->nslope, z->proof->nslope += 2;
}

static int open_slots(zono *z) {
  proof *p = z->proof;
  const ambit_host *h = z->host;
  const ambit_tape *t = z->program.tape;
  size_t rows = 0, n = z->nslot;
  for (uint32_t j = 0; j < z->nslot; j++) rows += t->degree[j] ? z->K_max + 1u : 1u;
  return doubles(h, rows, &p->total) && doubles(h, rows, &p->drop) && doubles(h, rows, &p->scaled) &&
         doubles(h, n, &p->high) && doubles(h, n, &p->low) && doubles(h, n, &p->delta) && doubles(h, n, &p->late) &&
         numbers(h, n, &p->slope_at) && doubles(h, (z->nx + 1u) * (size_t)z->shape.stride, &p->end);
}

static int open_targets(zono *z) {
  proof *p = z->proof;
  const ambit_host *h = z->host;
  size_t nx = z->nx, na = z->na;
  if (!numbers(h, na, &p->order) || !numbers(h, nx, &p->target_out) || !numbers(h, nx, &p->link) ||
      !numbers(h, nx, &p->link_to))
    return 0;
  find_links(z), find_order(z), find_slopes(z);
  size_t c = p->ntarget * (size_t)z->nslot, l = p->ntarget * na;
  return doubles(h, c, &p->C) && doubles(h, c, &p->dC) && doubles(h, c, &p->dC_new) && doubles(h, l, &p->dL_new) &&
         doubles(h, l, &p->rho) && doubles(h, l, &p->close) && doubles(h, c, &p->weight) && doubles(h, l, &p->L) &&
         doubles(h, l, &p->dL) && doubles(h, l, &p->weight_L) && doubles(h, z->program.tape->nin, &p->input) &&
         sweep_open(z, &p->forms, is_certain(z) ? POWERS : z->shape.m + z->shape.nx + 1, is_certain(z)) &&
         sweep_open(z, &p->points, 0, 0);
}

static int open_states(zono *z) {
  proof *p = z->proof;
  const ambit_host *h = z->host;
  size_t nx = z->nx, square = nx * nx, lumps = 2 * ((size_t)z->nslot + z->nout + z->na + nx), jumps = jump_columns(z),
         columns = z->ngen_max + (lumps > jumps ? lumps : jumps) + nx + 6 * (size_t)z->shape.m + strip_columns(z);
  double **matrix[] = { &p->J, &p->dJ, &p->mean, &p->tilt, &p->reach, &p->wobble, &p->power, &p->power_new, &p->size,
    &p->size_new, &p->jacobian_size };
  for (size_t n = 0; n < sizeof matrix / sizeof *matrix; n++)
    if (!doubles(h, square, matrix[n])) return 0;
  return doubles(h, nx, &p->zeta) && doubles(h, nx, &p->ramp) && doubles(h, 2 * nx, &p->zeta_new) &&
         doubles(h, z->na, &p->alpha) && doubles(h, z->na, &p->alpha_new) && doubles(h, nx, &p->grow) &&
         doubles(h, nx, &p->grow_path) && doubles(h, ORIGINS * nx, &p->boxes) && doubles(h, nx, &p->spread) &&
         doubles(h, nx, &p->largest) && doubles(h, nx, &p->budget) && doubles(h, nx, &p->natural) &&
         doubles(h, 4 * nx, &p->worth) && doubles(h, nx, &p->unit) && doubles(h, 4 * (nx + z->na), &p->work) &&
         doubles(h, columns * nx, &p->columns) && doubles(h, (z->ngen_max + nx + 7) * (nx + 1), &p->turned) &&
         doubles(h, nx * (nx + 3), &p->moves) && doubles(h, columns, &p->score) &&
         (p->origin = h->alloc(h, columns + 1)) != NULL && (p->from = h->alloc(h, z->ngen_max + nx + 1)) != NULL &&
         (p->source = h->alloc(h, (columns + 1) * sizeof *p->source)) != NULL &&
         (p->made_by = h->alloc(h, (z->ngen_max + nx + 1) * sizeof *p->made_by)) != NULL &&
         doubles(h, 2 * z->shape.m, &p->range) && doubles(h, columns, &p->sorted);
}

int zono_open_proof(zono *z) {
  proof *p = z->proof = z->host->alloc(z->host, sizeof *p);
  if (!p || !open_slots(z) || !open_targets(z) || !open_states(z)) return 0;
  if (!quartic_open(z) || !depend_open(z) || !change_open(z) || !residual_open(z) || !modes_open(z) || !cycle_open(z) ||
      !basis_open(z) || !strip_open(z))
    return 0;
  slope_open(p);
  if ((z->problem.extras & AMBIT_EXTRA_DENSE) && z->nx && !dense_open(z)) return 0;
  return !(z->problem.extras & AMBIT_EXTRA_SET) || !z->nx || set_open(z);
}
