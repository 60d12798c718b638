/* split.c -- pieces side by side. */
#include "verbs/split/split.h"
#include "host/pool.h"
#include "verbs/run/allocation.h"
#include "verbs/split/merge.h"
#include "verbs/split/piece.h"
#include "verbs/split/refine.h"
#include <stdio.h>

typedef struct job {
  const ambit_split *s;
  ambit_merge *merge;
  ambit_piece *piece; /* [ncontext] */
  bool alone;         /* the caller's thread does the pieces, so it must look at the sink meanwhile */
} job;

static int32_t meanwhile(void *user) {
  const job *j = user;
  return ambit_merge_forward(j->merge, j->s->sink);
}

static int32_t look(void *user) {
  const job *j = user;
  return j->alone ? ambit_merge_forward(j->merge, j->s->sink) : 0;
}

static ambit_status do_piece(void *user, uint32_t item, uint32_t worker) {
  job *j = user;
  return ambit_piece_run(&j->piece[worker], j->s, j->merge, item, look, j);
}

static ambit_status make_pieces(job *j, ambit_arena *arena) {
  j->piece = ambit_arena_alloc(arena, j->s->ncontext * sizeof *j->piece);
  if (!j->piece) return AMBIT_NOMEM;
  for (uint32_t i = 0; i < j->s->ncontext; i++)
    if (ambit_piece_prepare(&j->piece[i], j->s, &j->s->context[i], arena) != AMBIT_OK) return AMBIT_NOMEM;
  return AMBIT_OK;
}

ambit_status ambit_split_run(const ambit_split *s, ambit_arena *arena, ambit_split_outcome *out, ambit_failure *f) {
  if (s->band) return ambit_refine_run(s, arena, out, f);
  job j = { .s = s };
  *out = (ambit_split_outcome) { .pieces = s->pieces->count };
  ambit_pool *pool = NULL;
  ambit_status status = ambit_merge_open(arena, s->problem, s->pieces->count, &j.merge);
  if (status == AMBIT_OK) status = make_pieces(&j, arena);
  if (status == AMBIT_OK) status = ambit_pool_open(NULL, s->ncontext, &pool);
  if (status == AMBIT_OK) {
    out->threads = ambit_pool_threads(pool);
    j.alone = out->threads == 1;
    status = ambit_pool_run(pool, s->pieces->count, do_piece, &j, meanwhile);
    ambit_pool_close(pool);
    for (uint32_t i = 0; i < s->ncontext; i++) ambit_work_add(&out->work, &j.piece[i].work);
    if (status == AMBIT_OK || status == AMBIT_STOPPED) {
      bool stopped = ambit_merge_forward(j.merge, s->sink) != 0 || status == AMBIT_STOPPED;
      out->said = stopped ? AMBIT_STOPPED : ambit_merge_outcome(j.merge, &out->why);
      status = AMBIT_OK;
    } else {
      ambit_merge_outcome(j.merge, &out->why);
    }
  }
  ambit_allocation_forbid(0); /* the guard of the merged records has forbidden it since the first of them */
  ambit_merge_close(j.merge);
  if (status == AMBIT_OK) return status;
  return ambit_fail_code(f, status, out->why.code, "%s", out->why.message[0] ? out->why.message : "out of memory");
}
