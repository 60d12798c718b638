/* jets_slopes.h -- one order of the slopes of every slot, in upward mode; included once per instruction set after
** jets_values.h.
**
** d u = u(x) - u(c) is linear in the slopes. For a bilinear form, a b over x minus a b over c is exactly A db + B da
** with the means A = (a(x) + a(c)) / 2, B likewise. So every recursion whose equation is bilinear (w r' = u' for a
** logarithm, r' = c u' for a sine) holds for slopes with means in place of values: c = a / b gives B dc = da - C db;
** r^2 = u gives 2 R dr = du; and so on [Krawczyk & Neumaier, SIAM J. Numer. Anal. 22 (1985), for slopes; the means
** make the rule symmetric and halve the radius]. Without a centre both are the same point: the means are the values,
** the slopes derivatives. Directions are the elements of vectors; values are scalars, spread over all elements.
*/
typedef struct lanes { /* sets [-(l + r), h + r], a direction in each element */
  vector h, l, r;
} lanes;

static inline lanes no_lanes(void) { return (lanes) { splat(0), splat(0), splat(0) }; }
static inline lanes lanes_plus(lanes a, lanes b) { return (lanes) { a.h + b.h, a.l + b.l, a.r + b.r }; }
static inline lanes lanes_minus(lanes a, lanes b) { return (lanes) { a.h + b.l, a.l + b.h, a.r + b.r }; }
static inline lanes lanes_times(lanes a, double positive) {
  return (lanes) { a.h * splat(positive), a.l * splat(positive), a.r * splat(positive) };
}
static inline lanes lanes_over(lanes a, double positive) {
  return (lanes) { a.h / splat(positive), a.l / splat(positive), a.r / splat(positive) };
}

/* one block of directions of one order */
typedef struct spot {
  uint32_t order, block, k;
} spot;

static inline size_t lane_at(spot at, uint32_t k) { return ((size_t)at.block * (at.order + 1u) + k) * WIDTH; }

static inline lanes slope_at(const slot *s, spot at) {
  if (!s->varies) return no_lanes();
  vector mid = load(s->slope.mid + lane_at(at, at.k));
  return (lanes) { mid, -mid, load(s->slope.rad + lane_at(at, at.k)) };
}

/* sum_{j=from}^{to} a_j d_(k-j), with a the scalar series of a slot of degree `degree`, d the slopes of s */
static inline lanes lane_product(row a, uint32_t degree, const slot *s, row d, spot at, uint32_t from, uint32_t to) {
  lanes t = no_lanes();
  if (!s->varies) return t;
  if (to > degree) to = degree;
  if (at.k > s->degree && at.k - s->degree > from) from = at.k - s->degree;
  vector q = splat(0);
  for (uint32_t i = from; i <= to; i++) { /* to < UINT32_MAX */
    size_t place = lane_at(at, at.k - i);
    vector m = splat(a.mid[i]), dm = load(d.mid + place), dr = load(d.rad + place);
    t.h = multiply_add(m, dm, t.h);
    t.l = multiply_add(-m, dm, t.l);
    t.r = multiply_add(magnitude(m), dr, t.r);
    q = multiply_add(splat(a.rad[i]), magnitude(dm) + dr, q);
  }
  t.r += q;
  return t;
}

static inline lanes mean_times_slope(const slot *a, const slot *d, spot at, uint32_t from, uint32_t to) {
  return lane_product(a->mean, a->degree, d, d->slope, at, from, to);
}

/* sum of i a_i d_(k-i); a_i i d_(k-i) with the index i of d */
static inline lanes moving_times_slope(const slot *a, const slot *d, spot at, uint32_t from, uint32_t to) {
  return lane_product(a->mean_moving, a->degree, d, d->slope, at, from, to);
}

static inline lanes mean_times_moving(const slot *a, const slot *d, spot at, uint32_t from, uint32_t to) {
  return lane_product(a->mean, a->degree, d, d->slope_moving, at, from, to);
}

/* [h, l] / (scale * mean_0) */
static inline lanes lanes_divide(lanes t, row b, double scale) {
  double size = fabs(b.mid[0]), low = -(scale * (b.rad[0] - size)), high = scale * (size + b.rad[0]);
  if (!(low > 0)) return (lanes) { splat(INFINITY), splat(INFINITY), splat(0) };
  vector h = t.h + t.r, l = t.l + t.r, near = splat(low), far = splat(high);
  if (b.mid[0] < 0) {
    vector keep_h = h;
    h = l, l = keep_h;
  }
  h = h / choose(above(h, splat(0)), near, far);
  l = l / choose(above(l, splat(0)), near, far);
  return (lanes) { h, l, splat(0) };
}

static inline void settle_lanes(jets *j, const slot *s, spot at, lanes t) {
  vector mid = splat(0.5) * (t.h - t.l), rad = t.r + larger_each(t.h - mid, mid + t.l);
  mask good = above(splat(DBL_MAX), rad); /* see settle */
  if (any(~good)) {
    mid = keep(good, mid), rad = choose(good, rad, splat(DBL_MAX));
    j->flags |= AMBIT_F_UNBOUNDED;
  }
  size_t place = lane_at(at, at.k);
  store(s->slope.mid + place, mid);
  store(s->slope.rad + place, rad);
  if (!s->slope_moving.mid) return;
  vector order = splat(at.k), up = order * mid, down = order * -mid;
  store(s->slope_moving.mid + place, up);
  store(s->slope_moving.rad + place, order * rad + (up + down));
}

/* The mean of box and centre, and k times it. */
static inline void average(const slot *box, const slot *centre, uint32_t k) {
  if (box->mean.mid == box->u.mid) return;
  double up = 0.5 * (box->u.mid[k] + centre->u.mid[k]), down = 0.5 * (-box->u.mid[k] - centre->u.mid[k]);
  double rad = 0.5 * (box->u.rad[k] + centre->u.rad[k]) + (up + down);
  box->mean.mid[k] = up, box->mean.rad[k] = rad;
  if (!box->mean_moving.mid) return;
  double order = k, more = order * up, less = order * -up;
  box->mean_moving.mid[k] = more, box->mean_moving.rad[k] = order * rad + (more + less);
}

/* d of an operand, times the interval that contains the slope of a function */
static inline lanes scaled_slope(bounds factor, const slot *a, spot at) {
  double mid = 0.5 * (factor.lo + factor.hi), above = factor.hi - mid, below = mid - factor.lo;
  double rad = above > below ? above : below;
  return lane_product((row) { &mid, &rad }, 0, a, a->slope, at, 0, 0);
}

static inline lanes product_slope(const slot *a, const slot *b, spot at) {
  return lanes_plus(mean_times_slope(a, b, at, 0, at.k), mean_times_slope(b, a, at, 0, at.k));
}

static inline lanes quotient_slope(const step *s, spot at) {
  lanes known = mean_times_slope(s->r, s->b, at, 0, at.k);
  known = lanes_plus(known, mean_times_slope(s->b, s->r, at, 1, at.k));
  return lanes_divide(lanes_minus(slope_at(s->a, at), known), s->b->mean, 1);
}

static inline lanes root_slope(const step *s, spot at) {
  lanes known = lanes_times(mean_times_slope(s->r, s->r, at, 1, at.k), 2);
  return lanes_divide(lanes_minus(slope_at(s->a, at), known), s->r->mean, 2);
}

/* w r' = u' */
static inline lanes logarithmic_slope(const step *s, const slot *w, spot at) {
  lanes known = moving_times_slope(s->r, w, at, 1, at.k);
  known = lanes_plus(known, mean_times_moving(w, s->r, at, 1, at.k));
  lanes u = lanes_times(slope_at(s->a, at), at.k);
  return lanes_divide(lanes_minus(u, known), w->mean, at.k);
}

/* sum of the slopes of a b' */
static inline lanes turn_slope(const slot *a, const slot *b, spot at) {
  return lanes_plus(moving_times_slope(b, a, at, 1, at.k), mean_times_moving(a, b, at, 0, at.k - 1));
}

static inline lanes angle_slope(const step *s, spot at) {
  lanes known = moving_times_slope(s->r, s->aux, at, 1, at.k);
  known = lanes_plus(known, mean_times_moving(s->aux, s->r, at, 1, at.k));
  lanes turn = lanes_minus(turn_slope(s->b, s->a, at), turn_slope(s->a, s->b, at));
  return lanes_divide(lanes_minus(turn, known), s->aux->mean, at.k);
}

/* r' = f a' */
static inline lanes integral_slope(const slot *f, const slot *a, spot at) {
  return lanes_over(turn_slope(f, a, at), at.k);
}

static inline lanes lanes_hull(lanes a, lanes b) {
  return (lanes) { larger_each(a.h + a.r, b.h + b.r), larger_each(a.l + a.r, b.l + b.r), splat(0) };
}

/* An open choice (of constants; otherwise order 0 is lost): |u| - |u0| = phi (u - u0) with phi in [-1, 1], and a
** minimum or maximum changes by a mean of what its operands change by. */
static inline lanes chosen_slope(const jets *j, const step *s, spot at) {
  lanes a = slope_at(s->a, at), b = s->op == AMBIT_OP_ABS ? lanes_minus(no_lanes(), a) : slope_at(s->b, at);
  int choice = jets_choice(j, s);
  return choice > 0 ? a : choice < 0 ? b : lanes_hull(a, b);
}

static inline void pair_slope(jets *j, const step *s, spot at) {
  lanes sine = integral_slope(s->other, s->a, at), cosine = integral_slope(s->r, s->a, at);
  settle_lanes(j, s->r, at, sine);
  settle_lanes(j, s->other, at, s->op == AMBIT_OP_SIN ? lanes_minus(no_lanes(), cosine) : cosine);
}

/* rules that hold for every order */
static inline int plain_slope(const jets *j, const step *s, spot at, lanes *t) {
  switch (s->op) {
  case AMBIT_OP_ADD: *t = lanes_plus(slope_at(s->a, at), slope_at(s->b, at)); return 1;
  case AMBIT_OP_SUB: *t = lanes_minus(slope_at(s->a, at), slope_at(s->b, at)); return 1;
  case AMBIT_OP_NEG: *t = lanes_minus(no_lanes(), slope_at(s->a, at)); return 1;
  case STEP_COPY: *t = slope_at(s->a, at); return 1;
  case AMBIT_OP_MUL: *t = product_slope(s->a, s->b, at); return 1;
  case AMBIT_OP_SQR: *t = lanes_times(mean_times_slope(s->a, s->a, at, 0, at.k), 2); return 1;
  case AMBIT_OP_DIV: *t = quotient_slope(s, at); return 1;
  case AMBIT_OP_SQRT: *t = root_slope(s, at); return 1;
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: *t = chosen_slope(j, s, at); return 1;
  default: return 0;
  }
}

static inline void first_slope(jets *j, const step *s, spot at, bounds by_a, bounds by_b) {
  lanes t = scaled_slope(by_a, s->a, at);
  if (s->op == AMBIT_OP_ATAN2) t = lanes_plus(t, scaled_slope(by_b, s->b, at));
  settle_lanes(j, s->r, at, t);
  if (s->other != s->r) settle_lanes(j, s->other, at, scaled_slope(by_b, s->a, at));
}

static inline lanes later_slope(const step *s, spot at) {
  switch (s->op) {
  case AMBIT_OP_EXP: return integral_slope(s->r, s->a, at);
  case AMBIT_OP_TANH: return integral_slope(s->aux, s->a, at);
  case AMBIT_OP_LOG: return logarithmic_slope(s, s->a, at);
  case AMBIT_OP_ATAN: return logarithmic_slope(s, s->aux, at);
  default: return angle_slope(s, at);
  }
}

/* elementary functions: their slopes start from a derivative */
static inline int needs_start(uint32_t op) { return op >= AMBIT_OP_EXP && op < AMBIT_OP_ABS; }

static inline void slope(jets *j, const step *s, uint32_t k) {
  if (!s->r->varies) return;
  bounds by_a, by_b;
  if (k == 0 && needs_start(s->op)) j->flags |= jets_start_slope(j, s, &by_a, &by_b);
  for (uint32_t block = 0; block < j->blocks; block++) {
    spot at = { j->order, block, k };
    lanes t;
    if (plain_slope(j, s, at, &t))
      settle_lanes(j, s->r, at, t);
    else if (k == 0)
      first_slope(j, s, at, by_a, by_b);
    else if (s->other != s->r)
      pair_slope(j, s, at);
    else
      settle_lanes(j, s->r, at, later_slope(s, at));
  }
}

/* inputs and constants were written by put(): their copies, and whether they are bounded */
static inline void source(jets *j, uint32_t index, uint32_t k) {
  slot *s = &j->slot[index];
  if (s->u.rad[k] >= DBL_MAX) j->flags |= AMBIT_F_UNBOUNDED;
  spread(s, j->order, k);
  if (j->ndir && j->centre) average(s, &j->centre->slot[index], k);
  for (uint32_t block = 0; s->varies && block < j->blocks; block++) {
    spot at = { j->order, block, k };
    settle_lanes(j, s, at, slope_at(s, at));
  }
}

static inline void advance_step(jets *j, const step *s, uint32_t k) {
  value(j, s, k);
  if (!j->ndir) return;
  if (j->centre) {
    average(s->r, &j->centre->slot[s->r_index], k);
    if (s->other != s->r) average(s->other, &j->centre->slot[s->other_index], k);
  }
  slope(j, s, k);
}

/* upward mode */
static AMBIT_WORKER void advance_sources(jets *j, uint32_t k) {
  if (j->ndir && j->centre && k >= j->centre->failed) j->flags |= AMBIT_F_UNBOUNDED;
  for (uint32_t i = 0; i < j->nsource; i++)
    if (k <= j->slot[i].degree)
      source(j, i, k);
    else if (j->slot[i].u.rad[k] != 0)
      j->flags |= AMBIT_F_UNBOUNDED; /* put() was given what the tape excludes */
}

/* upward mode; steps [from, to), of those that move if k > 0 */
static AMBIT_WORKER void advance_steps(jets *j, uint32_t k, uint32_t from, uint32_t to) {
  if (k == 0)
    for (uint32_t i = from; i < to; i++) advance_step(j, &j->step[i], 0);
  else
    for (uint32_t i = from; i < to; i++)
      if (k <= j->moving[i]->degree) advance_step(j, j->moving[i], k);
}

/* one after the other, each told before it is done */
static void advance_metered(jets *j, uint32_t k, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) {
    j->meter->operation(k ? j->moving[i]->op : j->step[i].op);
    advance_steps(j, k, i, i + 1);
  }
}

static uint32_t advance(void *self, uint32_t k) {
  jets *j = self;
  if (k == 0) j->failed = j->order + 1, j->flags = 0;
  if (k > j->failed) return j->flags; /* nothing can be said any more */
  ambit_rounding old = ambit_round_up();
  advance_sources(j, k);
  uint32_t count = k ? j->nmoving : j->nstep;
  if (j->meter)
    advance_metered(j, k, count);
  else
    advance_steps(j, k, 0, count);
  ambit_rounding_restore(old);
  if (j->flags) j->failed = k;
  return j->flags;
}

/* upward mode */
static AMBIT_WORKER void integrate_order(jets *j, slot *in, const slot *s, uint32_t k) {
  double next = k + 1.0;
  int known = k < j->failed && k < in->degree;
  triple unknown = { INFINITY, INFINITY, 0 };
  settle(j, in, k + 1, known ? over(coefficient(s->u, k), next) : unknown);
  for (uint32_t block = 0; block < j->blocks; block++) {
    spot from = { j->order, block, k }, to = { j->order, block, k + 1 };
    settle_lanes(j, in, to, lanes_over(slope_at(s, from), next));
  }
}

static void integrate(void *self, uint32_t in, uint32_t slot_index, uint32_t k) {
  jets *j = self;
  if (k >= j->order) return;
  ambit_rounding old = ambit_round_up();
  integrate_order(j, &j->slot[j->nsource - j->nin + in], &j->slot[slot_index], k);
  ambit_rounding_restore(old);
}

static ambit_status open_jets(const ambit_host *h, void *ctx, const ambit_tape *t, uint32_t order, uint32_t ndir,
    const void *centre, void **self) {
  return jets_open(h, ctx, t, order, ndir, centre, WIDTH, self);
}

const ambit_jets JETS = { sizeof JETS, open_jets, jets_close, jets_put, advance, jets_get, jets_magnitude, integrate };
