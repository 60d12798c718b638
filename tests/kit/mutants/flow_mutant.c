/* flow_mutant.c -- solvers that advance in time, each with one fault: in its records, in what it takes from the
** problem, in the series that it builds on, or in its conduct. */
#include "kit/mutants/mutant_conduct.h"
#include "kit/mutants/solver_mutant.h"
#include <ambit/jet.h>
#include <math.h>

enum { ROOM = 16384, STATES = 12 };

typedef struct liar {
  ambit_sink sink; /* first */
  ambit_sink *outer;
  ambit_problem problem;
  ambit_record r;
  ambit_set set;
  uint32_t steps;
  int32_t stopped;
  double lo[STATES], hi[STATES], tube_lo[STATES], tube_hi[STATES], last_lo[STATES], last_hi[STATES], p_lo[ROOM / 8],
      p_hi[ROOM / 8], time[16];
  double mid[ROOM], rad[ROOM], column[ROOM], coefficient[ROOM], rest[STATES], about[STATES], scale[STATES];
  uint32_t exponent[ROOM], op[ROOM];
  double constant_lo[ROOM], constant_hi[ROOM];
  ambit_tape tape;
  void *inner;
  const ambit_host *host;
} liar;

typedef struct fault {
  const char *name;
  void (*record)(liar *l, ambit_record *r);   /* what it does to a record; */
  void (*problem)(liar *l, ambit_problem *p); /* to the problem; */
  void (*series)(ambit_jet_service *s);       /* to series; */
  void (*act)(void);                          /* at each record */
  uint32_t states, from_step, data;           /* only from so many states, steps, uncertain data on */
  int backwards;                              /* only then */
  const char *base;                           /* NULL: lohner */
  const char *word;                           /* what the sink or run() does, by name */
} fault;

typedef struct selection {
  fault f;
  ambit_solver base;
  ambit_jet_service lying;
  const ambit_jet_service *honest;
  uint32_t answers;
  void (*conduct)(void);
} selection;

static selection *chosen; /* set once, when the object is loaded */

static bool speaks(const char *word) { return chosen->f.word && strcmp(chosen->f.word, word) == 0; }

/* -- records */

static void cut(double *lo, double *hi, double share) {
  double mid = 0.5 * *lo + 0.5 * *hi, radius = 0.5 * (*hi - *lo);
  *lo = mid - (1 - share) * radius, *hi = mid + (1 - share) * radius;
}
static void cut_all(liar *l, double share) {
  for (uint32_t i = 0; i < l->r.nx; i++) cut(&l->lo[i], &l->hi[i], share);
}
static void cut_tenth(liar *l, ambit_record *r) { (void)r, cut_all(l, 0.1); }
static void cut_fiftieth(liar *l, ambit_record *r) { (void)r, cut_all(l, 0.02); }
static void cut_last(liar *l, ambit_record *r) { cut(&l->lo[r->nx - 1], &l->hi[r->nx - 1], 0.1); }
static void cut_first(liar *l, ambit_record *r) { (void)r, cut(&l->lo[0], &l->hi[0], 0.1); }
static void cut_below(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++) l->lo[i] += 0.05 * (l->hi[i] - l->lo[i]);
}
static void middle(liar *l, ambit_record *r) { (void)r, cut_all(l, 1); }
static void shift(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++) {
    double by = 1e-6 * (1 + fabs(l->hi[i])) + (l->hi[i] - l->lo[i]);
    l->lo[i] += by, l->hi[i] += by;
  }
}
static void exchange(liar *l, ambit_record *r) {
  double lo = l->lo[0], hi = l->hi[0];
  uint32_t n = r->nx - 1;
  l->lo[0] = l->lo[n], l->hi[0] = l->hi[n], l->lo[n] = lo, l->hi[n] = hi;
}
static void negate_last(liar *l, ambit_record *r) {
  double lo = l->lo[r->nx - 1];
  l->lo[r->nx - 1] = -l->hi[r->nx - 1], l->hi[r->nx - 1] = -lo;
}
static void repeat(liar *l, ambit_record *r) {
  if (l->steps < 2) return;
  memcpy(l->lo, l->last_lo, r->nx * sizeof(double)), memcpy(l->hi, l->last_hi, r->nx * sizeof(double));
}
static void nan_bound(liar *l, ambit_record *r) { l->hi[r->nx - 1] = NAN; }
static void inverted(liar *l, ambit_record *r) {
  (void)r;
  double lo = l->lo[0];
  l->lo[0] = l->hi[0] + 1e-9, l->hi[0] = lo;
}
static void infinite(liar *l, ambit_record *r) { (void)r, l->hi[0] = INFINITY; }
static void no_proof(liar *l, ambit_record *r) { (void)l, r->rigorous = 0; }
static void more_states(liar *l, ambit_record *r) { (void)l, r->nx++; }
static void small_size(liar *l, ambit_record *r) { (void)l, r->size -= 8; }
static void late(liar *l, ambit_record *r) { (void)l, r->t_to = nextafter(r->t_to, INFINITY); }
static void gap(liar *l, ambit_record *r) { (void)l, r->t_from = nextafter(r->t_from, r->t_to); }

static void tube_cut(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++) cut(&l->tube_lo[i], &l->tube_hi[i], 0.1);
}
static void tube_end(liar *l, ambit_record *r) {
  memcpy(l->tube_lo, l->lo, r->nx * sizeof(double)), memcpy(l->tube_hi, l->hi, r->nx * sizeof(double));
}
static void tube_chord(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx && l->steps > 1; i++)
    l->tube_lo[i] = fmin(l->last_lo[i], l->lo[i]), l->tube_hi[i] = fmax(l->last_hi[i], l->hi[i]);
}
static void tube_last(liar *l, ambit_record *r) { cut(&l->tube_lo[r->nx - 1], &l->tube_hi[r->nx - 1], 0.9); }

static void dense_moved(liar *l, ambit_record *r) {
  (void)r;
  l->mid[0] += 1e-3 + 2 * l->rad[0];
}
static void dense_sharp(liar *l, ambit_record *r) { memset(l->rad, 0, (size_t)r->nx * r->ndense * sizeof(double)); }
static void dense_nan(liar *l, ambit_record *r) { l->rad[(size_t)r->nx * r->ndense - 1] = NAN; }
static void dense_negative(liar *l, ambit_record *r) { (void)r, l->rad[0] = -1e-30; }
static void dense_short(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++)
    for (uint32_t k = r->ndense / 2; k < r->ndense; k++) l->mid[i * r->ndense + k] = l->rad[i * r->ndense + k] = 0;
}
static void dense_between(liar *l, ambit_record *r) { /* right at both ends */
  if (r->ndense < 3) return;
  double h = r->t_to - r->t_from;
  for (uint32_t i = 0; i < r->nx; i++) {
    double c = (1e-5 + l->hi[i] - l->lo[i]) * 8 / (h * h);
    l->mid[i * r->ndense + 1] += c * h, l->mid[i * r->ndense + 2] -= c;
  }
}
static void dense_mirrored(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++)
    for (uint32_t k = 1; k < r->ndense; k += 2) l->mid[i * r->ndense + k] *= -1;
}
static void dense_no_columns(liar *l, ambit_record *r) { (void)l, r->ncolumn = 0; }
static void dense_columns_cut(liar *l, ambit_record *r) {
  for (size_t k = 0; k < (size_t)r->nx * r->ncolumn * r->ncoef_column; k++) l->column[k] *= 0.8;
}
static void dense_late_columns(liar *l, ambit_record *r) { /* as wide as at the start */
  for (size_t i = 0; i < (size_t)r->nx * r->ncolumn; i++)
    for (uint32_t k = 1; k < r->ncoef_column; k++) l->column[i * r->ncoef_column + k] = 0;
}
static void set_turned(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx && l->set.nterm > 1; i++) l->coefficient[i * l->set.nterm + 1] *= -1;
}
static void set_sharp(liar *l, ambit_record *r) { (void)r, memset(l->rest, 0, sizeof l->rest); }
static void set_moved(liar *l, ambit_record *r) { (void)r, l->coefficient[0] += 1e-3 + 2 * l->rest[0]; }
static void set_wide(liar *l, ambit_record *r) { (void)r, l->rest[0] += 1 + l->hi[0] - l->lo[0]; }
static void set_scaled(liar *l, ambit_record *r) {
  (void)r;
  for (uint32_t j = 0; j < l->set.nu; j++) l->scale[j] *= 2;
}
static void set_about(liar *l, ambit_record *r) {
  (void)r;
  for (uint32_t j = 0; j < l->set.nu; j++) l->about[j] += 0.25 * l->scale[j];
}
static void set_exchanged(liar *l, ambit_record *r) {
  (void)r;
  for (uint32_t k = 0; k < l->set.nterm && l->set.nu > 1; k++) {
    uint32_t first = l->exponent[k * l->set.nu];
    l->exponent[k * l->set.nu] = l->exponent[k * l->set.nu + 1], l->exponent[k * l->set.nu + 1] = first;
  }
}
static void set_shrunk(liar *l, ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++)
    for (uint32_t k = 1; k < l->set.nterm; k++) l->coefficient[i * l->set.nterm + k] *= 0.9;
}
static void set_other(liar *l, ambit_record *r) { (void)r, l->set.nu++; }
static void no_set(liar *l, ambit_record *r) { (void)l, r->set = NULL; }
static void no_dense(liar *l, ambit_record *r) { (void)l, r->dense_mid = NULL; }

/* -- problems */

/* output `to` of the initial values becomes a copy of output `from` */
static void start_from(liar *l, ambit_problem *p, uint32_t to, uint32_t from) {
  if (to >= p->nx + p->np || from >= p->nx + p->np) return;
  l->tape = *p->initial;
  memcpy(l->exponent, p->initial->out, p->initial->nout * sizeof *l->exponent);
  l->exponent[to] = p->initial->out[from];
  l->tape.out = l->exponent;
  p->initial = &l->tape;
}
static void parameter_of_state(liar *l, ambit_problem *p) { start_from(l, p, p->nx, 0); }
static void second_is_first(liar *l, ambit_problem *p) { start_from(l, p, p->nx + 1, p->nx); }
static void last_starts_as_first(liar *l, ambit_problem *p) { start_from(l, p, p->nx - 1, 0); }
static void data_halved(liar *l, ambit_problem *p) {
  for (uint32_t i = 0; i < p->nu; i++) {
    l->p_lo[i] = p->u_lo[i], l->p_hi[i] = p->u_hi[i];
    cut(&l->p_lo[i], &l->p_hi[i], 0.5);
  }
  p->u_lo = l->p_lo, p->u_hi = l->p_hi;
}
static void clock_wrong(liar *l, ambit_problem *p) {
  (void)l;
  (void)p; /* see open: times are moved by 2^-10 */
}
static void own_tape(liar *l, ambit_problem *p) {
  l->tape = *p->rhs;
  memcpy(l->op, p->rhs->op, p->rhs->ninstr * sizeof *l->op);
  memcpy(l->constant_lo, p->rhs->lo, p->rhs->nconst * sizeof(double));
  memcpy(l->constant_hi, p->rhs->hi, p->rhs->nconst * sizeof(double));
  l->tape.lo = l->constant_lo, l->tape.hi = l->constant_hi;
  p->rhs = &l->tape;
}
static void constant_off(liar *l, ambit_problem *p) {
  if (p->rhs->nconst < 2) return;
  own_tape(l, p);
  uint32_t last = p->rhs->nconst - 1;
  l->constant_lo[last] *= 1 + 1e-7, l->constant_hi[last] *= 1 + 1e-7;
}
static void outputs_exchanged(liar *l, ambit_problem *p) {
  own_tape(l, p);
  memcpy(l->exponent, p->rhs->out, p->rhs->nout * sizeof *l->exponent);
  l->exponent[0] = p->rhs->out[p->nx - 1], l->exponent[p->nx - 1] = p->rhs->out[0];
  l->tape.out = l->exponent;
}
static void last_rate_zero(liar *l, ambit_problem *p) {
  own_tape(l, p);
  memcpy(l->exponent, p->rhs->out, p->rhs->nout * sizeof *l->exponent);
  l->exponent[p->nx - 1] = p->rhs->out[0];
  l->tape.out = l->exponent;
}
static void reads_time(liar *l, ambit_problem *p) { l->time[15] = p->time[p->ntime]; }
static void reads_start(liar *l, ambit_problem *p) { l->time[15] = p->x0_hi[p->nx]; }

/* -- series */

static ambit_status no_tail(
    ambit_jet *jet, uint32_t K, double h, const double *in, const double *din, double *out, double *dout) {
  ambit_status status = chosen->honest->tail(jet, K, h, in, din, out, dout);
  if (status == AMBIT_OK) out[0] = 0;
  return status;
}
static ambit_status small_tail(
    ambit_jet *jet, uint32_t K, double h, const double *in, const double *din, double *out, double *dout) {
  ambit_status status = chosen->honest->tail(jet, K, h, in, din, out, dout);
  if (status == AMBIT_OK) out[0] *= 0x1p-20;
  return status;
}
static void get_off(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  chosen->honest->get(jet, slot, k, mid, rad, dmid, drad);
  if (k >= 4) *mid *= 1 + 1e-6;
}
static void get_low(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  chosen->honest->get(jet, slot, k, mid, rad, dmid, drad);
  if (k == 1) *mid *= 1 + 1e-9;
}
static void get_slope(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  chosen->honest->get(jet, slot, k, mid, rad, dmid, drad);
  if (dmid && k >= 1) dmid[0] *= 0.5;
}
static void lie_no_tail(ambit_jet_service *s) { s->tail = no_tail; }
static void lie_small_tail(ambit_jet_service *s) { s->tail = small_tail; }
static void lie_order(ambit_jet_service *s) { s->get = get_off; }
static void lie_low(ambit_jet_service *s) { s->get = get_low; }
static void lie_slope(ambit_jet_service *s) { s->get = get_slope; }

/* -- the faults */

static const fault faults[] = {
  { "radius cut by 10 % from 3 states on", .record = cut_tenth, .states = 3 },
  { "radius cut by 10 % from 8 states on", .record = cut_tenth, .states = 8 },
  { "radius cut by 10 % with 12 states", .record = cut_tenth, .states = 12 },
  { "radius cut by 10 % backwards", .record = cut_tenth, .backwards = 1 },
  { "radius cut by 10 % with 2 data or more", .record = cut_tenth, .data = 2 },
  { "radius cut by 10 % with 3 data", .record = cut_tenth, .data = 3 },
  { "radius cut by 10 % after 3 steps", .record = cut_tenth, .from_step = 4 },
  { "radius cut by 2 % with 2 states or more", .record = cut_fiftieth, .states = 2 },
  { "radius of the last state cut by 10 %", .record = cut_last, .states = 2 },
  { "radius of the first state cut by 10 % from 6 states on", .record = cut_first, .states = 6 },
  { "lower bounds moved in by 5 %", .record = cut_below },
  { "middle instead of the enclosure", .record = middle, .from_step = 2 },
  { "enclosures moved by their width", .record = shift, .from_step = 3 },
  { "first and last state exchanged from 5 states on", .record = exchange, .states = 5 },
  { "wrong sign of the last state from 7 states on", .record = negate_last, .states = 7 },
  { "enclosure of the step before", .record = repeat, .states = 2 },
  { "a bound that is NaN", .record = nan_bound, .from_step = 2 },
  { "bounds exchanged", .record = inverted, .from_step = 2 },
  { "an infinite bound", .record = infinite, .from_step = 2 },
  { "records that prove nothing", .record = no_proof },
  { "one state too many", .record = more_states, .states = 2 },
  { "records of an older size", .record = small_size },
  { "steps that end one ulp late", .record = late, .from_step = 2 },
  { "gaps of one ulp between steps", .record = gap, .from_step = 2 },
  { "tube cut by 10 %", .record = tube_cut },
  { "tube of the end only", .record = tube_end },
  { "tube of start and end only", .record = tube_chord },
  { "tube of the last state cut from 9 states on", .record = tube_last, .states = 9 },
  { "dense enclosure moved", .record = dense_moved },
  { "dense enclosure without radii", .record = dense_sharp },
  { "dense enclosure with a NaN", .record = dense_nan },
  { "dense enclosure with a negative radius", .record = dense_negative },
  { "dense enclosure of half its order", .record = dense_short },
  { "dense enclosure wrong between the nodes", .record = dense_between, .states = 4 },
  { "dense enclosure mirrored backwards", .record = dense_mirrored, .backwards = 1 },
  { "dense enclosure without its columns", .record = dense_no_columns, .states = 2 },
  { "columns cut by 20 %", .record = dense_columns_cut },
  { "columns as they were at the start", .record = dense_late_columns, .states = 3 },
  { "half a dense enclosure", .record = no_dense, .states = 6 },
  { "set with a wrong sign", .record = set_turned },
  { "set without its rest", .record = set_sharp },
  { "set moved", .record = set_moved },
  { "set wider than the bounds", .record = set_wide },
  { "set with the wrong scale", .record = set_scaled },
  { "set about another point", .record = set_about, .states = 4 },
  { "data of the set exchanged", .record = set_exchanged, .data = 2 },
  { "linear terms of the set cut by 10 %", .record = set_shrunk },
  { "set of other data", .record = set_other },
  { "a state's start taken for the first parameter", .problem = parameter_of_state },
  { "second parameter taken for the first", .problem = second_is_first },
  { "last state starts as the first from 8 states on", .problem = last_starts_as_first, .states = 8 },
  { "data of half their width", .problem = data_halved },
  { "time-dependent terms taken 2^-10 s late", .problem = clock_wrong },
  { "a constant off by 1e-7 from 2 states on", .problem = constant_off, .states = 2 },
  { "rates of the first and last state exchanged", .problem = outputs_exchanged, .states = 4 },
  { "rate of the last state forgotten", .problem = last_rate_zero, .states = 10 },
  { "reads beyond the times", .problem = reads_time },
  { "reads beyond the initial set", .problem = reads_start },
  { "Taylor tail forgotten", .series = lie_no_tail },
  { "Taylor tail 2^20 times too small", .series = lie_small_tail },
  { "Taylor coefficients off by 1e-6 from order 4 on", .series = lie_order },
  { "first Taylor coefficient off by 1e-9", .series = lie_low },
  { "slopes of half their size", .series = lie_slope },
  { "goes on after the sink has stopped it", .word = "deaf" },
  { "goes on after progress has stopped it", .word = "deaf to progress" },
  { "says OK when it was stopped", .word = "OK if stopped" },
  { "says complete before the end", .word = "early" },
  { "leaves out every third step", .word = "skips" },
  { "every record twice", .word = "twice" },
  { "no progress", .word = "silent" },
  { "progress beyond 1", .word = "more than 1" },
  { "progress that falls back", .word = "falls back" },
  { "another answer the second time", .word = "second" },
  { "gives up without a reason", .word = "no reason" },
  { "a failure although it is done", .word = "complains" },
  { "stops at the end of existence as if it were done", .word = "OK always" },
  { "always gives up, with a reason", .word = "unable" },
  { "allocates at each record", .act = conduct_allocates },
  { "allocates with 5 states or more", .act = conduct_allocates, .states = 5 },
};
enum { FAULTS = sizeof faults / sizeof *faults };

AMBIT_EXPORT const char *ambit_mutant_name(size_t i);
const char *ambit_mutant_name(size_t i) {
  return i < FAULTS ? faults[i].name : i < FAULTS + CONDUCT_FAULTS ? conduct_faults[i - FAULTS].name : NULL;
}

/* -- the plugin */

static bool applies(const liar *l) {
  const fault *f = &chosen->f;
  const ambit_problem *p = &l->problem;
  if (f->backwards && !(p->time[p->ntime - 1] < p->time[0])) return false;
  return p->nx >= f->states && l->steps >= f->from_step && p->nu >= f->data;
}

static const double *keep(double *to, const double *from, size_t n) {
  if (!from || n > ROOM) return from;
  memcpy(to, from, n * sizeof *to);
  return to;
}

static void copy_set(liar *l) {
  if (!l->r.set) return;
  l->set = *l->r.set;
  ambit_set *s = &l->set;
  s->coefficient = keep(l->coefficient, s->coefficient, (size_t)l->r.nx * s->nterm);
  s->rest = keep(l->rest, s->rest, l->r.nx);
  s->about = keep(l->about, s->about, s->nu), s->scale = keep(l->scale, s->scale, s->nu);
  if (s->exponent) memcpy(l->exponent, s->exponent, (size_t)s->nterm * s->nu * sizeof *l->exponent);
  s->exponent = s->exponent ? l->exponent : NULL;
  l->r.set = s;
}

static void copy_record(liar *l, const ambit_record *r) {
  l->r = *r;
  l->r.lo = keep(l->lo, r->lo, r->nx), l->r.hi = keep(l->hi, r->hi, r->nx);
  l->r.tube_lo = keep(l->tube_lo, r->tube_lo, r->nx), l->r.tube_hi = keep(l->tube_hi, r->tube_hi, r->nx);
  l->r.dense_mid = keep(l->mid, r->dense_mid, (size_t)r->nx * r->ndense);
  l->r.dense_rad = keep(l->rad, r->dense_rad, (size_t)r->nx * r->ndense);
  l->r.dense_column = keep(l->column, r->dense_column, (size_t)r->nx * r->ncolumn * r->ncoef_column);
  copy_set(l);
}

static bool is_of_dense(void (*f)(liar *, ambit_record *)) {
  static void (*const list[])(liar *, ambit_record *) = { dense_moved, dense_sharp, dense_nan, dense_negative,
    dense_short, dense_between, dense_mirrored, dense_no_columns, dense_columns_cut, dense_late_columns, no_dense };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (list[i] == f) return true;
  return false;
}

static bool is_of_set(void (*f)(liar *, ambit_record *)) {
  static void (*const list[])(liar *, ambit_record *) = { set_turned, set_sharp, set_moved, set_wide, set_scaled,
    set_about, set_exchanged, set_shrunk, set_other, no_set };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (list[i] == f) return true;
  return false;
}

static bool has(const liar *l, void (*f)(liar *, ambit_record *)) {
  if (is_of_dense(f)) return l->r.dense_mid && l->r.ndense;
  return !is_of_set(f) || l->r.set;
}

static void spoil(liar *l) {
  const fault *f = &chosen->f;
  double lo[STATES], hi[STATES];
  memcpy(lo, l->lo, sizeof lo), memcpy(hi, l->hi, sizeof hi);
  if (applies(l) && f->record && has(l, f->record)) f->record(l, &l->r);
  if (applies(l) && f->act) f->act();
  memcpy(l->last_lo, lo, sizeof lo), memcpy(l->last_hi, hi, sizeof hi);
  if (chosen->f.problem == clock_wrong) l->r.t_from -= 0x1p-10, l->r.t_to -= 0x1p-10;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  liar *l = (liar *)(void *)s;
  l->steps++;
  copy_record(l, r);
  spoil(l);
  if (speaks("skips") && l->steps % 3 == 0) return 0;
  if (speaks("early") && l->steps > 1 && r->t_to == l->problem.time[1]) return l->stopped = 2;
  if (speaks("second") && chosen->answers % 2 == 0) l->hi[0] = nextafter(l->hi[0], INFINITY);
  int32_t stop = l->outer->emit(l->outer, &l->r);
  if (speaks("twice") && !stop) stop = l->outer->emit(l->outer, &l->r);
  if (stop) l->stopped = 1;
  return speaks("deaf") ? 0 : stop;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  liar *l = (liar *)(void *)s;
  if (speaks("silent")) return 0;
  if (speaks("more than 1")) done *= 1.0001;
  if (speaks("falls back") && l->steps % 4 == 3) done *= 0.5;
  int32_t stop = l->outer->progress(l->outer, done, message);
  if (stop) l->stopped = 1;
  return speaks("deaf to progress") ? 0 : stop;
}

static const void *service(const ambit_host *outer, const char *id) {
  return strcmp(id, AMBIT_JET_SERVICE) == 0 ? &chosen->lying : outer->service(outer, id);
}

static ambit_status open_liar(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  liar *l = h->alloc(h, sizeof *l);
  mutant_host *own = mutant_lend(h);
  if (!l || !own) return AMBIT_NOMEM;
  own->service = service, own->is_mute = speaks("no reason");
  if (!chosen->honest) chosen->honest = h->service(h, AMBIT_JET_SERVICE);
  chosen->lying = *chosen->honest;
  chosen->answers++;
  l->problem = *p;
  bool now = p->nx >= chosen->f.states && p->nu >= chosen->f.data;
  if (chosen->f.series && now) chosen->f.series(&chosen->lying);
  if (chosen->f.problem && now) chosen->f.problem(l, &l->problem);
  if (chosen->f.problem == clock_wrong) {
    for (uint32_t i = 0; i < p->ntime; i++) l->time[i] = p->time[i] + 0x1p-10;
    l->problem.time = l->time;
  }
  l->host = h;
  *self = l;
  if (speaks("unable")) return h->fail(h, AMBIT_UNABLE, "this problem is too hard for this method");
  return chosen->base.open(&own->host, &l->problem, option, &l->inner);
}

static ambit_status run(void *self, ambit_sink *sink) {
  liar *l = self;
  l->sink = (ambit_sink) { sizeof l->sink, emit, progress };
  l->outer = sink;
  ambit_status status = chosen->base.run(l->inner, &l->sink);
  if (chosen->conduct) chosen->conduct();
  if (speaks("complains") && status == AMBIT_OK) l->host->fail(l->host, AMBIT_UNABLE, "something went wrong");
  if (speaks("early") && l->stopped == 2) return AMBIT_OK;
  if (speaks("OK if stopped") && status == AMBIT_STOPPED) return AMBIT_OK;
  if (speaks("OK always") && status == AMBIT_UNABLE) return AMBIT_OK;
  return status;
}

static void close_liar(void *self) { chosen->base.close(((liar *)self)->inner); }

__attribute__((constructor)) static void choose(void);

static void choose(void) {
  const char *wanted = mutant_wanted();
  chosen = calloc(1, sizeof *chosen);
  for (size_t i = 0; i < FAULTS; i++)
    if (strcmp(faults[i].name, wanted) == 0) chosen->f = faults[i];
  chosen->conduct = conduct_of(wanted);
  ambit_solver *own =
      mutant_wrap(AMBIT_SOLVER, chosen->f.base ? chosen->f.base : "lohner", &chosen->base, sizeof chosen->base);
  own->open = open_liar, own->run = run, own->close = close_liar;
}

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.flow_mutant", "1.0",
  "A solver with one fault.", mutant_get };
