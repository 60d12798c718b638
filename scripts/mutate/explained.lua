-- explained.lua -- mutations that no test can notice, or need not: key -> why. They change no answer, make a set wider,
-- or a run slower.
return {
  ["plugins/solver/valencia/slope.c | logic 2 | if (!(b.lo > 0 || a.lo > 0 || a.hi < 0)) return (slopes) { unbounded, unbounded };"] =
    "no interval is on both sides of 0: slopes are unbounded more often, and the enclosure wider",
  ["plugins/solver/zonotope/reduce.c | relation 1 | while (x[j] < pivot) j--;"] =
    "which generators are kept is free: all others go to the box",
  ["plugins/solver/zonotope/reduce.c | extremum 1 | sum += u, most = fmax(most, u);"] =
    "which generators are kept is free: all others go to the box",
  ["plugins/solver/zonotope/reduce.c | relation 1 | if (!(p->spread[i] > 0)) p->spread[i] = 1;"] =
    "which generators are kept is free: all others go to the box",
  ["plugins/solver/zonotope/discs.c | guard 1 | if (d->b[k] == 0) continue;"] = "adds 0: a run slower",
  ["plugins/solver/zonotope/discs.c | guard 1 | if (sum == 0) continue;"] = "adds 0: a run slower",
  ["plugins/solver/zonotope/map.c | guard 1 | if (rest)"] = "what is left goes into the box: wider",
  ["plugins/solver/zonotope/map.c | term 1 | for (size_t e = 0; e < square; e++) m->growth[e] += beyond[e];"] =
    "when discs are used is free",
  ["plugins/solver/zonotope/mixed.c | guard 1 | if (y[k] == 0) continue;"] = "adds 0: a run slower",
  ["plugins/solver/zonotope/mixed.c | guard 1 | if (size > most) most = size, *row = i, *column = k;"] =
    "any entry that is not 0 is a pivot",
  ["plugins/solver/zonotope/mixed.c | relation 1 | if (size > most) most = size, *row = i, *column = k;"] =
    "any entry that is not 0 is a pivot",
  ["plugins/solver/zonotope/discs.c | guard 1 | if (!worth_enclosing(z)) return 0;"] = "when discs are used is free",
  ["plugins/solver/zonotope/discs.c | relation 1 | } else if (m->wait > 0)"] = "when discs are used is free",
  ["plugins/solver/zonotope/error.c | extremum 1 | case AMBIT_OP_COS: return (move) { fmin(1, high[t->aux[i]] + r) * da, 0.5 * da * da };"] =
    "the larger of two bounds",
  ["plugins/solver/zonotope/implicit.c | guard 1 | if (!m->has_partial || !m->changed || !m->stage_at) return 0;"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/zonotope/implicit.c | logic 1 | return m->partial && m->change && m->factor && m->inverse && m->y;"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/zonotope/range.c | term 1 | if (z->h_error > 0) more += z->h_error * (p->high[slot_out(z)[i]] + p->delta[slot_out(z)[i]]);"] =
    "half a unit in the last place of the step: less than what is charged beside it for rounding of the form",
  ["plugins/solver/zonotope/run.c | unit 1 | int at_goal = !(fabs(h) < fabs(goal - z->t) * (1 - 0x1p-40));"] =
    "a further step of less than 2^-40 of the last one: the same proof",
  ["plugins/solver/zonotope/run.c | unit 1 | z->h_error = 0x1p-52 * fabs(z->h);"] =
    "half a unit in the last place of the step: less than what is charged beside it for rounding of the rows' sums",
  ["plugins/solver/valencia/faces.c | bound 1 | int largest = upper == (s->half.hi > 0);"] =
    "both ends of half a step have the same sign",
  ["plugins/solver/valencia/terms.c | logic 3 | if (!t->exponent || !t->parent || !t->sample || !t->q || !t->r) return 0;"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/valencia/verify.c | extremum 1 | end[b] = smaller(end[b], end_of_block(s, b, growth, integral));"] =
    "both are bounds: the larger one makes the enclosure wider",
  ["plugins/solver/valencia/verify.c | unit 1 | s->omega[b] = larger(s->omega[b], 1.1 * larger(end[b], s->last[b]) + 0x1p-1000);"] =
    "a guess, which is then checked by a strict comparison",
  ["plugins/solver/taylor_model/range.c | unit 1 | if (own) size += fabs(c[j]) * (degree == 1 ? 0x1p-20 : own);"] =
    "decides which datum is cut first, for speed",
  ["plugins/solver/taylor_model/proof.c | extremum 1 | double rad = larger(larger(mid - p->t, mid - w->t_next), larger(p->t - mid, w->t_next - mid));"] =
    "both are half the step, whichever way the time runs",
  ["framework/verbs/verify/box.lua | extremum 1 | lo = math.max(a.lo, b.lo), hi = math.min(a.hi, b.hi), when = seen.when, value = seen.value,"] =
    "both findings are true: the looser bound decides less",
  ["framework/verbs/verify/box.lua | extremum 2 | lo = math.max(a.lo, b.lo), hi = math.min(a.hi, b.hi), when = seen.when, value = seen.value,"] =
    "both findings are true: the looser bound decides less",
  ["framework/verbs/verify/search.lua | guard 1 | if #job.lo > 0 and job.sound_points and box.is_open(job, root) and not box.is_spent(job) then"] =
    "single values are not tried: less is refuted",
  ["framework/verbs/verify/search.lua | sign 2 | local t = k == 0 and first or k == n and last or first + (last - first) * (k / n)"] =
    "instants within the horizon at which steps end besides those asked for: any will do",
  ["framework/kernel/num/decimal_digits.c | radius 1 | if (rest->d[i]) return 0;"] =
    "p and q have at most 998 digits, so that an inexact p/q is over 1e-990 from any double, which 1075 places show",
  ["framework/kernel/num/decimal_print.c | extremum 2 | double width = ambit_interval_width(x), mag = ambit_interval_mag(x);"] =
    "how many digits are shown: the bounds are rounded outward to any number of them",
  ["framework/kernel/num/elementary.c | guard 1 | if (op != AMBIT_OP_ATAN2) blo = alo, bhi = ahi;"] =
    "only atan2 reads a second operand",
  ["plugins/solver/valencia/faces.c | guard 1 | if (slope.hi <= 0) return point(largest ? x.lo : x.hi);"] =
    "the whole interval is taken where one end would do: wider",
  ["plugins/solver/valencia/frame.c | unit 1 | double size = larger(smaller(larger(fabs(s->tube_lo[i]), fabs(s->tube_hi[i])), 0x1p900), 0x1p-900);"] =
    "scales start above 0, and a size that is not above the scale leaves it as it is",
  ["plugins/solver/valencia/series.c | radius 1 | for (uint32_t i = 0; i < s->nx; i++) tail[i] = larger_or_nan(tail[i], other[i]);"] =
    "the kernel bounds the tails of both halves by the same number: it looks at |h| only",
  ["plugins/solver/valencia/terms.c | logic 4 | if (!t->exponent || !t->parent || !t->sample || !t->q || !t->r) return 0;"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/valencia/verify.c | guard 1 | if (why != WHY_NOTHING) return why;"] =
    "what fails there is an evaluation over a part of the tube, over the whole of which the same has just succeeded",
  ["framework/verbs/reduce/certify/couple.lua | sign 1 | if source ~= ZERO or shared[j].error_start ~= ZERO then active[j], count = true, count + 1 end"] =
    "the count is compared with itself a round before, and each round adds to it",
  ["framework/verbs/reduce/certify/curve.lua | extremum 1 | list[j] = list[j] and math.min(list[j], e) or e"] =
    "both are bounds of the error: the larger one is above it too",
  ["framework/verbs/reduce/certify/values.lua | guard 1 | if not i then return nil end"] =
    "without an instant the next line raises an error: nothing is claimed",
  ["framework/verbs/verify/box.lua | bound 3 | local whole, inside = lo <= job.lo[j] and hi >= job.hi[j], least <= most and lo <= most and hi >= least"] =
    "fewer boxes are taken for allowed: less is refuted",
  ["framework/verbs/verify/box.lua | relation 1 | moved[j] = least <= most and math.min(math.max(x, least), most) or x"] =
    "a value that was not moved where it should be is not taken for allowed (is_allowed): less is refuted",
  ["framework/kernel/num/power_kernel.h | logic 1 | if (n.size > PLAIN_MOST && bit % 4 == 0)"] =
    "the pair is normalised more often, which is exact",
  ["framework/verbs/roots/solve.c | guard 1 | if (ambit_interval_is_empty(a[i]) || !ambit_interval_is_bounded(a[i])) return false;"] =
    "such an entry makes the distance from one infinite, which the next check refuses",
  ["framework/verbs/stability/spectrum.c | term 1 | *spread += ambit_interval_width(value[i].re) + ambit_interval_width(value[i].im);"] =
    "decides which of two enclosures, both true, is given",
  ["plugins/solver/taylor_model/functions.c | extremum 3 | double floor = range(s, q).lo, ga = larger(larger(ra.lo, -ra.hi), 0), gb = larger(larger(rb.lo, -rb.hi), 0);"] =
    "a smaller lower bound of the distance from 0: the radius is wider",
  ["plugins/solver/taylor_model/range.c | guard 1 | if (part == reach[v]) continue;"] =
    "nothing is left out of the box, and only the count of cuts grows",
  ["framework/verbs/verify/search.lua | guard 1 | if box.is_spent(job) or not box.is_open(job, b) then return end"] =
    "ends are tried although nothing is open: slower",
  ["framework/verbs/verify/search.lua | extremum 1 | for j, moved in ipairs(job.moved[k]) do effect[j] = math.max(effect[j] or 0, moved) end"] =
    "decides which datum is cut first",
  ["framework/verbs/verify/search.lua | relation 1 | local weight = most > 0 and math.max((effect[j] or 0) / most, 0.02) or 1"] =
    "decides which datum is cut first",
  ["framework/kernel/graph/jet_general.c | logic 2 | if (!s->first || !s->length || !s->weighted || !s->branch || !s->target || !s->left || !s->right)"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/krawczyk/newton.c | guard 1 | if (k->options.operation == OPERATOR_NEWTON) return VERDICT_UNKNOWN;"] =
    "rows narrow the box then, as they do for the other operators",
  ["plugins/solver/krawczyk/newton.c | logic 1 | return k->options.operation == OPERATOR_AUTO || k->options.operation == OPERATOR_HANSEN_SENGUPTA;"] =
    "rows are left out: the enclosure is wider",
  ["plugins/solver/krawczyk/solution.c | relation 1 | if (part[below].hi < part[1 - below].lo) note_gap(k, i, part[below], part[1 - below]);"] =
    "fewer gaps are noted, and one of negative width is wider than none",
  ["plugins/solver/taylor_model/functions.c | extremum 1 | *low = larger(*low, -bound);"] =
    "the looser of two lower bounds",
  ["plugins/solver/krawczyk/solution.c | bound 3 | span ends[2] = { { lower.hi, lower.hi }, { upper.lo, upper.lo } };"] =
    "only the upper end of this sum is used",
  ["plugins/solver/lohner/frame.c | logic 1 | if (!(off > NEGLIGIBLE * diagonal) || !(off < DBL_MAX)) return;"] =
    "more sweeps: any frame serves, for how far it is from orthogonal is bounded afterwards",
  ["plugins/solver/lohner/history.c | logic 6 | return g->level && g->direction && g->weight && g->block && g->frame && g->shape && g->size && g->sum && g->unit &&"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/lohner/start.c | relation 2 | return i < nx ? value.rad[i] > THIN * fabs(value.mid[i]) + 0x1p-1000 : value.rad[i] > 0;"] =
    "the radius of a state without a column of its own goes to the rest of the set: both hold it",
  ["plugins/solver/lohner/inclusion.c | sign 1 | for (uint32_t i = 0; i < f->nx; i++) phi->box_excess[i] = H * phi->tail_out[i] / (q + 1.0);"] =
    "a larger bound of the excess",
  ["plugins/solver/lohner/step.c | guard 1 | if (by_slopes < SLOPES_LIMIT * by_centre && q < o->slope_order_max) c->slope_order++;"] =
    "the order of slopes stays lower: wider slopes, the same proof",
  ["plugins/solver/stiff/collocation.c | logic 9 | return q->x && q->Z && q->c && q->size && q->least && q->unit && q->scale && q->A && q->residual && q->J && q->f &&"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/stiff/collocation.c | guard 1 | if (!(now < 1e6)) return 0;"] =
    "Newton's method goes on; its result is a guess, which is proved afterwards",
  ["plugins/solver/stiff/collocation.c | logic 11 | return q->x && q->Z && q->c && q->size && q->least && q->unit && q->scale && q->A && q->residual && q->J && q->f &&"] =
    "memory that ran out for one array ran out for the next",
  ["plugins/solver/stiff/evaluate.c | sign 1 | for (uint32_t k = room; k < a->n; k++) rest += fabs(a->hi[k]) * (1 + 2 * DD_U);"] =
    "SLACK, by which the sum is multiplied, is more than the low parts",
  ["plugins/solver/stiff/evaluate.c | guard 1 | if (!(f->tail < INFINITY)) return 0;"] =
    "a bound that is infinite or NaN is not below that of the tube: the proof fails there, with another reason",
  ["plugins/solver/stiff/spread.c | term 1 | for (uint32_t k = 1; k < g->n[t]; k++) rest += fabs(row[k]);"] =
    "initial values do not depend on time: their rows have one coefficient",
  ["plugins/solver/stiff/spread.c | radius 1 | double rest = P->tail + (a >= s->nx ? s->start_rest[a] : box ? box[a] : 0);"] =
    "parameters are unknowns themselves, of which nothing is left over",
  ["plugins/solver/stiff/step.c | relation 1 | s->box[i] = i < s->nx ? 3 * sum : sum * (1 + 0x1p-20);"] =
    "a guess: slopes are computed anew over what leaves it",
  ["plugins/solver/stiff/step.c | extremum 1 | for (size_t i = 0; i < (size_t)(m + 1) * s->n * s->n; i++) most = fmax(most, fabs(s->rate[i]));"] =
    "steps that are too long for their rates fail in the proof, which takes longer",
  ["plugins/solver/stiff/step.c | guard 1 | if (too_fast(s, m)) return WHY_FAST;"] =
    "steps that are too long for their rates fail in the proof, which takes longer",
  ["framework/algebra/polynomial.c | radius 1 | for (size_t k = 0; k < ring->nlost && !known; k++) known = ring->lost[k] == atom;"] =
    "what vanished is noted twice, and sooner there is too much of it: then nothing is rewritten",
  ["framework/algebra/polynomial.c | guard 1 | if (p.n > 64 * ring->limit / q.n) return fail(ring);"] =
    "a limit of time and memory: what is multiplied out is right whatever its length",
  ["framework/kernel/graph/tail_value.c | guard 1 | if (!(floor > 0)) return INFINITY;"] =
    "a floor of 0 then gives 0/0, which claims nothing either",
  ["plugins/solver/lohner/start.c | unit 1 | return i < nx ? value.rad[i] > THIN * fabs(value.mid[i]) + 0x1p-1000 : value.rad[i] > 0;"] =
    "which boxes get a column of their own: either way all of the box is in the set",
  ["plugins/solver/zonotope/distance.c | guard 1 | if (size.most == 0) continue;"] =
    "adds 0: a run slower",
  ["plugins/solver/zonotope/kink.c | logic 1 | if (!is_line(z, i) || has_twin(z, i)) continue;"] =
    "more is noted, which is asked only where lines are",
  ["plugins/solver/zonotope/jump.c | guard 1 | if (row_parts(s, 0) & TRIPLES) continue;"] =
    "what is of degree three goes to the box as well: the set is wider",
  ["framework/verbs/run/bracket.lua | unit 1 | local r = 2 * guess[k]:mag() + 0x1p-51 * x:mag() + 0x1p-1000"] =
    "a guess, which is then checked by a strict comparison: if it fails, the hull of the steps is taken",
  ["framework/verbs/run/instant.lua | bound 1 | value = x.lo"] = "both ends are one double there",
  ["framework/verbs/run/instant.lua | unit 1 | if t.set or t.hi - t.lo <= 0x1p-51 * math.abs(t.near - start) then return nil end"] =
    "the difference is enclosed with more digits although the bracket would do: a run slower",
  ["plugins/solver/zonotope/far.c | relation 2 | uint32_t first = g < u ? g : u, last = g > v ? g : v, middle = g + u + v - first - last;"] =
    "which far triples are held is free",
  ["plugins/solver/zonotope/jump.c | named 1 | if (row_parts(s, 0) & TRIPLES) continue; -> continue;"] =
    "the row keeps its terms of degree three, and a step that holds none charges their size: no set is smaller",
  ["plugins/solver/zonotope/jump.c | guard 1 | if (!p->njump) return 1;"] =
    "no programs are opened then: an array of none",
  ["plugins/solver/zonotope/tanh.c | unit 1 | k->slope = hi - lo > 0x1p-10 ? (last - first) / (hi - lo) : slope_at(middle);"] =
    "which line is taken is free: what it misses is computed from the line",
  ["plugins/solver/zonotope/tanh.c | bound 4 | double first = value(z, lo), last = value(z, hi), middle = value(z, 0.5 * (lo + hi));"] =
    "which line is taken is free: what it misses is computed from the line",
  ["framework/functions/cbrt.c | sign 4 | double rest = (((u - cube.h) - cube.l) - more.h) - more.l;"] =
    "2^-106 of the cube, of which the error bound 2^-90 has room",
  ["framework/functions/hypot.c | guard 1 | if (ambit_interval_is_empty(s)) return false;"] =
    "cuts with the empty set are empty, which the end of the function says",
  ["framework/functions/pow.c | bound 1 | return (ambit_interval) { r.lo > 0 ? function_op(AMBIT_OP_LOG, r).lo : -INFINITY, hi };"] =
    "the logarithm over a set that reaches 0 begins at minus infinity, too",
  ["framework/functions/pow.c | guard 1 | if (ambit_interval_is_empty(quotient)) return false;"] =
    "a cut with the empty set is empty, which the end of the function says",
  ["framework/functions/pow.c | logic 1 | if (!free || !ambit_interval_contains(*b, 0)) {"] =
    "less is cut away",
  ["framework/functions/pow.c | logic 1 | if (ambit_interval_is_empty(r) || ambit_interval_is_empty(*a)) return false;"] =
    "less is found to be impossible",
  ["framework/verbs/simulate/problem.c | logic 1 | if (status == AMBIT_OK && b->ninvariant)"] =
    "a tape over what is no input is refused when it is sealed, and the sentence is that of the first check",
  ["framework/verbs/simulate/problem.c | guard 1 | if (!range || !slot || !x) return no_memory(b);"] =
    "memory that ran out for one array ran out for the next: an allocation that fails is tried where it is made",
  ["plugins/solver/zonotope/quartic.c | extremum 1 | all.most = fmin(bound, all.rest + add_known(z, j, whole)) * ABOVE;"] =
    "the larger of two bounds of the same: a set wider",
  ["plugins/solver/zonotope/quartic.c | extremum 1 | sum += fmin(single, together + mixed_size(z, row)) + rounding;"] =
    "the larger of two bounds of the same: a set wider",
  ["plugins/solver/zonotope/quartic.c | guard 1 | if (q->chosen[k] != 1) continue;"] =
    "products that were not chosen are multiplied out, too: a run slower",
}
