-- explained.lua -- mutations that no test can notice, or need not: key -> why. They change no answer, make a set wider,
-- or a run slower.
return {
  ["plugins/solver/valencia/slope.c | logic 2 | if (!(b.lo > 0 || a.lo > 0 || a.hi < 0)) return (slopes) { unbounded, unbounded };"] =
    "no interval is on both sides of 0: slopes are unbounded more often, and the enclosure wider",
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
  ["scripts/prelude/verify/box.lua | extremum 1 | lo = math.max(a.lo, b.lo), hi = math.min(a.hi, b.hi), when = seen.when, value = seen.value,"] =
    "both findings are true: the looser bound decides less",
  ["scripts/prelude/verify/box.lua | extremum 2 | lo = math.max(a.lo, b.lo), hi = math.min(a.hi, b.hi), when = seen.when, value = seen.value,"] =
    "both findings are true: the looser bound decides less",
  ["scripts/prelude/verify/search.lua | guard 1 | if #job.lo > 0 and job.sound_points and box.is_open(job, root) and not box.is_spent(job) then"] =
    "single values are not tried: less is refuted",
  ["scripts/prelude/verify/search.lua | sign 2 | local t = k == 0 and first or k == n and last or first + (last - first) * (k / n)"] =
    "instants within the horizon at which steps end besides those asked for: any will do",
}
