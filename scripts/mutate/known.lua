-- known.lua -- mutations that the tests once did not notice; they are tried in every run.
return {
  { area = "taylor_model", file = "plugins/solver/taylor_model/proof.c", old = "w->dexcess[k] = H *", new = "w->dexcess[k] = 0 * H *" },
  { area = "valencia", file = "plugins/solver/valencia/verify.c", old = "s->start[i] = error + lost", new = "s->start[i] = error" },
  { area = "certify", file = "framework/verbs/reduce/certify/bounds.lua", old = "math.max(least[j][k] or -math.huge, x.lo)",
    new = "math.max(least[j][k] or -math.huge, x.hi)" },
  { area = "certify", file = "framework/verbs/reduce/certify/bound.lua", old = "core.interval(e).lo", new = "core.interval(e).hi" },
  { area = "robots", file = "framework/models/robot/urdf.lua", old = "{ 1, 0, 0 }", new = "{ 0, 0, 1 }" },
  { area = "graph", file = "framework/algebra/simplify.c", old = "if (e >= g->count || limit == 0)", new = "if (e >= g->count && limit == 0)" },
  { area = "zonotope, lumps and discs", file = "plugins/solver/zonotope/residual.c", old = "to->moment += by * size.moment",
    new = "to->moment = 0" },
}
