/* agreement.h -- one random expression in every arithmetic: who encloses what, and do they contradict each other?
**
** Every rigorous arithmetic that the registry lists takes part, once as it is and once with options drawn at random
** from those it declares. Each computes three forms of the expression: as it was asked for, operation by operation
** (PLAIN: nothing folded, not even constants); as the graph folds it; and simplified. All results must
**   contain the value at every sampled point of the box where there is one (MPFR, expression_oracle.h),
**   say so (AMBIT_F_PARTIAL) if a sampled point lies outside the domain,
**   have a point in common, as soon as one of them proves that the expression is defined on the whole box.
*/
#ifndef AMBIT_TEST_AGREEMENT_H
#define AMBIT_TEST_AGREEMENT_H
#include "host/params.h"
#include "expression_oracle.h"
#include "graph/interpreter.h"
#include "graph/store.h"
#include "graph/tape.h"
#include "verbs/run/context.h"
#include <ambit/evaluate.h>
#include <stdio.h>
#include <time.h>

#define AGREE_POINTS 5
#define AGREE_OPTIONS 8
#define AGREE_CANDIDATES 32
#define SIMPLIFY_TERMS 40

enum { PLAIN, FOLDED, SIMPLIFIED, FORMS };
static const char *const agree_form[] = { "as asked for", "folded", "simplified" };

/* An arithmetic with its options. */
typedef struct candidate {
  char name[32];
  const ambit_arithmetic *arithmetic;
  bool varied; /* options are drawn for each expression */
  size_t noption;
  ambit_option option[AGREE_OPTIONS];
  char text[AGREE_OPTIONS][32];
  size_t computed, refused, tightest; /* expressions; refused: the drawn options are not allowed */
  size_t bounded;
  double ratio; /* sum over `bounded` of ln(width / tightest width) */
  double seconds;
} candidate;

typedef struct agree_result {
  ambit_status status;
  ambit_interval x;
  uint32_t flags;
  char message[240];
} agree_result;

typedef struct agreement {
  ambit_registry *registry;
  size_t ncandidate;
  candidate candidate[AGREE_CANDIDATES];
  expression_oracle oracle[AGREE_POINTS];
  random_expression x;
  double point[AGREE_POINTS][RANDOM_DATA_MAX];
  ambit_graph *graph;
  ambit_expr datum[RANDOM_DATA_MAX];
  ambit_expr form[FORMS][RANDOM_NODES_MAX];
  agree_result result[AGREE_CANDIDATES][FORMS];
  char failure[800];
} agreement;

static inline void agree_open(agreement *s) {
  *s = (agreement) { .registry = ambit_registry_open(NULL) };
  ambit_listing entry[256];
  size_t n = ambit_registry_list(s->registry, 256, entry);
  for (size_t i = 0; i < n && i < 256; i++) {
    candidate c = { 0 };
    ambit_failure f = { 0 };
    if (strcmp(entry[i].kind, "arithmetic") != 0) continue;
    snprintf(c.name, sizeof c.name, "%s", entry[i].name);
    if (ambit_registry_arithmetic(s->registry, c.name, &c.arithmetic, &f) != AMBIT_OK) {
      fprintf(stderr, "%s\n", f.message);
      exit(EXIT_FAILURE);
    }
    if (!c.arithmetic->rigorous) continue;
    s->candidate[s->ncandidate++] = c;
    c.varied = true;
    if (ambit_params_count(c.arithmetic->param) > 0) s->candidate[s->ncandidate++] = c;
  }
  for (size_t p = 0; p < AGREE_POINTS; p++) oracle_open(&s->oracle[p]);
}

static inline void agree_close(agreement *s) {
  for (size_t p = 0; p < AGREE_POINTS; p++) oracle_close(&s->oracle[p]);
  ambit_registry_close(s->registry);
}

/* -- the expression, its points, its forms */

/* a word of "rk4|rk8pd|msbdf" */
static inline void draw_word(random_expression *x, const char *words, char *text, size_t room) {
  uint32_t n = 1;
  for (const char *c = words; *c; c++) n += *c == '|';
  for (uint32_t skip = random_below(x, n); skip > 0; skip--) words = strchr(words, '|') + 1;
  snprintf(text, room, "%.*s", (int)strcspn(words, "|"), words);
}

static inline void draw_options(random_expression *x, candidate *c) {
  c->noption = 0;
  for (const ambit_param *p = c->arithmetic->param; p && p->name && c->noption < AGREE_OPTIONS; p++) {
    char *text = c->text[c->noption];
    if (!p->fallback || random_chance(x, 30)) continue;
    if (strchr(p->shape, '|'))
      draw_word(x, p->shape, text, sizeof c->text[0]);
    else if (strcmp(p->shape, "flag") == 0)
      snprintf(text, sizeof c->text[0], "%s", random_chance(x, 50) ? "true" : "false");
    else if (strcmp(p->shape, "integer") == 0) {
      uint32_t usual = (uint32_t)labs(atol(p->fallback));
      snprintf(text, sizeof c->text[0], "%u", random_below(x, usual + 3));
    } else
      continue;
    c->option[c->noption++] = (ambit_option) { p->name, text };
  }
}

/* the middle, two corners, two points anywhere */
static inline void draw_points(agreement *s) {
  random_expression *x = &s->x;
  for (size_t p = 0; p < AGREE_POINTS; p++)
    for (uint32_t i = 0; i < x->ndatum; i++) {
      ambit_interval box = x->box[i];
      double corner = random_chance(x, 50) ? box.lo : box.hi, inside = oracle_uniform(&x->state, box.lo, box.hi);
      double value = p == 0 ? ambit_interval_mid(box) : p <= 2 ? corner : inside;
      s->point[p][i] = fmin(fmax(value, box.lo), box.hi);
    }
}

static inline ambit_expr make_node(const agreement *s, const random_node *q, const ambit_expr *made, bool fold) {
  switch (q->op) {
  case LEAF_DATUM: return s->datum[q->a];
  case LEAF_NUMBER: return ambit_graph_number(s->graph, q->number);
  case LEAF_LITERAL: return ambit_graph_decimal(s->graph, q->text, NULL);
  case AMBIT_OP_POWN:
    return fold ? ambit_graph_pown(s->graph, made[q->a], q->n)
                : ambit_store_make(s->graph, q->op, made[q->a], (ambit_expr)q->n);
  default:
    return fold ? ambit_graph_op(s->graph, q->op, made[q->a], made[q->b])
                : ambit_store_make(s->graph, q->op, made[q->a], made[q->b]);
  }
}

static inline void make_forms(agreement *s) {
  s->graph = ambit_graph_open();
  for (uint32_t i = 0; i < s->x.ndatum; i++) s->datum[i] = ambit_graph_unknown(s->graph, NULL, s->x.box[i]);
  for (uint32_t i = 0; i < s->x.count; i++) {
    s->form[PLAIN][i] = make_node(s, &s->x.node[i], s->form[PLAIN], false);
    s->form[FOLDED][i] = make_node(s, &s->x.node[i], s->form[FOLDED], true);
  }
}

static inline void agree_draw(agreement *s, uint64_t seed) {
  random_make(&s->x, seed);
  draw_points(s);
  for (size_t c = 0; c < s->ncandidate; c++)
    if (s->candidate[c].varied) draw_options(&s->x, &s->candidate[c]);
  for (size_t p = 0; p < AGREE_POINTS; p++) oracle_evaluate(&s->oracle[p], &s->x, s->point[p]);
  make_forms(s);
}

/* -- computing */

/* Every datum a variable, every constant as it is: nothing is folded on the way. */
static inline ambit_status compute_plain(
    const agreement *s, const candidate *c, ambit_expr e, agree_result *r, ambit_failure *f) {
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  ambit_context context = { 0 };
  ambit_block *block = NULL;
  uint32_t n = s->x.ndatum;
  uint32_t seal = AMBIT_SEAL_KEEP | ambit_arithmetic_seal(c->arithmetic);
  ambit_status status = ambit_tape_seal(s->graph, arena, 1, &e, n, s->datum, 0, seal, &tape, f);
  if (status == AMBIT_OK) status = ambit_context_open(s->registry, c->name, c->noption, c->option, n, &context, f);
  if (status == AMBIT_OK) status = ambit_block_open(tape, context.arithmetic, context.ctx, 1, &block, f);
  if (status == AMBIT_OK) {
    for (uint32_t i = 0; i < n; i++) ambit_block_set(block, i, 0, s->x.box[i], (int32_t)i);
    r->flags = ambit_block_run(block);
    r->x = ambit_block_get(block, 0, 0);
  }
  ambit_block_close(block);
  ambit_context_close(&context);
  ambit_arena_close(arena);
  return status;
}

/* As a scene does. */
static inline ambit_status compute_scene(
    const agreement *s, const candidate *c, ambit_expr e, agree_result *r, ambit_failure *f) {
  ambit_evaluate_request q = { .graph = s->graph,
    .registry = s->registry,
    .arithmetic = c->name,
    .noption = c->noption,
    .option = c->option,
    .nexpr = 1,
    .expr = &e };
  return ambit_evaluate(&q, &r->x, &r->flags, NULL, f);
}

static inline void compute_node(agreement *s, uint32_t node) {
  ambit_expr e[FORMS] = { s->form[PLAIN][node], s->form[FOLDED][node],
    ambit_graph_simplify(s->graph, s->form[FOLDED][node], SIMPLIFY_TERMS) };
  for (size_t c = 0; c < s->ncandidate; c++) {
    double start = ambit_context_seconds();
    for (size_t k = 0; k < FORMS; k++) {
      agree_result *r = &s->result[c][k];
      ambit_failure f = { 0 };
      r->status = (k == PLAIN ? compute_plain : compute_scene)(s, &s->candidate[c], e[k], r, &f);
      snprintf(r->message, sizeof r->message, "%.230s", f.message);
    }
    s->candidate[c].seconds += ambit_context_seconds() - start;
  }
}

/* -- judging */

static inline const char *describe(const candidate *c, size_t form, char text[200]) {
  int n = snprintf(text, 200, "%s", c->name);
  for (size_t i = 0; i < c->noption && n < 160; i++)
    n += snprintf(text + n, 200 - (size_t)n, " %s=%s", c->option[i].name, c->option[i].text);
  snprintf(text + n, 200 - (size_t)n, ", %s", agree_form[form]);
  return text;
}

/* AMBIT_OK, or `failure` says what is wrong with this result. */
static inline bool judge_result(agreement *s, uint32_t node, size_t c, size_t form) {
  const agree_result *r = &s->result[c][form];
  char who[200];
  describe(&s->candidate[c], form, who);
  if (r->status != AMBIT_OK) {
    if (s->candidate[c].varied && r->status == AMBIT_INVALID) return true;
    snprintf(s->failure, sizeof s->failure, "%s: fails: %s", who, r->message);
    return false;
  }
  for (size_t p = 0; p < AGREE_POINTS; p++) {
    const oracle_value *v = &s->oracle[p].node[node];
    if (v->state == DEFINED && !oracle_inside(v, r->x)) {
      char value[120];
      mpfr_snprintf(value, sizeof value, "[%.20RDe, %.20RUe]", v->lo, v->hi);
      int n = snprintf(s->failure, sizeof s->failure, "%s: [%.17g, %.17g] does not contain %s, the value at", who,
          r->x.lo, r->x.hi, value);
      for (uint32_t i = 0; i < s->x.ndatum && n < 780; i++)
        n += snprintf(s->failure + n, sizeof s->failure - (size_t)n, " %.17g", s->point[p][i]);
      return false;
    }
    if (v->state == UNDEFINED && !(r->flags & AMBIT_F_PARTIAL)) {
      snprintf(s->failure, sizeof s->failure, "%s: a point outside the domain is not reported (AMBIT_F_PARTIAL)", who);
      return false;
    }
  }
  return true;
}

static inline bool judge_pair(agreement *s, const agree_result *a, const agree_result *b) {
  if (!ambit_interval_is_empty(ambit_interval_intersect(a->x, b->x))) return true;
  size_t i = (size_t)(a - &s->result[0][0]), k = (size_t)(b - &s->result[0][0]);
  char first[200], second[200];
  snprintf(s->failure, sizeof s->failure, "%s: [%.17g, %.17g] and %s: [%.17g, %.17g] have no point in common",
      describe(&s->candidate[i / FORMS], i % FORMS, first), a->x.lo, a->x.hi,
      describe(&s->candidate[k / FORMS], k % FORMS, second), b->x.lo, b->x.hi);
  return false;
}

/* Computes and judges one node; false: `failure` says why not. */
static inline bool agree_node(agreement *s, uint32_t node) {
  compute_node(s, node);
  bool total = false;
  for (size_t c = 0; c < s->ncandidate; c++)
    for (size_t k = 0; k < FORMS; k++) {
      if (!judge_result(s, node, c, k)) return false;
      total = total || (s->result[c][k].status == AMBIT_OK && !(s->result[c][k].flags & AMBIT_F_PARTIAL));
    }
  agree_result *all = &s->result[0][0];
  for (size_t i = 0; total && i < s->ncandidate * FORMS; i++)
    for (size_t k = 0; k < i; k++) {
      if (all[i].status != AMBIT_OK || all[k].status != AMBIT_OK) continue;
      if (!judge_pair(s, &all[k], &all[i])) return false;
    }
  return true;
}

/* -- who is tightest, as scenes compute */

static inline double folded_width(const agreement *s, size_t c) {
  const agree_result *r = &s->result[c][FOLDED];
  return r->status == AMBIT_OK && ambit_interval_is_bounded(r->x) ? ambit_interval_width(r->x) : INFINITY;
}

static inline void agree_count(agreement *s) {
  double least = INFINITY;
  for (size_t c = 0; c < s->ncandidate; c++)
    if (!s->candidate[c].varied) least = fmin(least, folded_width(s, c));
  for (size_t c = 0; c < s->ncandidate; c++) {
    candidate *k = &s->candidate[c];
    double width = folded_width(s, c);
    if (s->result[c][FOLDED].status == AMBIT_OK)
      k->computed++;
    else
      k->refused++;
    if (!isfinite(width)) continue;
    k->tightest += width <= least;
    if (least > 0 && width > 0) k->bounded++, k->ratio += log(width / least);
  }
}

static inline void agree_print_counts(const agreement *s, FILE *out) {
  fprintf(out, "%-24s %10s %10s %10s %16s %12s\n", "arithmetic", "computed", "refused", "tightest", "width/tightest",
      "us each");
  for (size_t c = 0; c < s->ncandidate; c++) {
    const candidate *k = &s->candidate[c];
    char name[48];
    snprintf(name, sizeof name, "%s%s", k->name, k->varied ? ", varied" : "");
    double tried = (double)(k->computed + k->refused) * FORMS;
    fprintf(out, "%-24s %10zu %10zu %10zu %16.4f %12.1f\n", name, k->computed, k->refused, k->tightest,
        k->bounded ? exp(k->ratio / (double)k->bounded) : 1, tried > 0 ? 1e6 * k->seconds / tried : 0);
  }
}
#endif
