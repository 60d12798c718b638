-- areas.lua -- what is mutated, and which tests must notice.
--
-- files: patterns of `git ls-files`, (a|b) for either. target: what is built. tests: patterns of the names of test
-- programs. specs: suites under tests/lua. share: of the mutations that are tried.
local function solver(name, share, rooms, specs, title)
  return { name = title or name, share = share, files = { "^plugins/solver/" .. name .. "/(" .. rooms .. ")%.[ch]$" },
    target = "solver_" .. name, specs = specs,
    tests = { "^plugins%.solver_" .. name .. "$", "^plugins%.solver_" .. name .. "_", "^plugins%.solver_kit$" } }
end

local num = { "^num%.", "^plugins%.arithmetic_interval" }

return {
  { name = "num", share = 50, files = { "^framework/kernel/num/(%w+_?%w*)%.c$" }, target = "ambit_inside", tests = num },
  { name = "num headers", share = 15, target = "ambit_inside", tests = num,
    files = { "^framework/kernel/num/(interval|rounding|elementary_kernel|power_kernel|product_kernel)%.h$" } },
  { name = "graph", share = 65, target = "ambit_inside",
    files = {
      "^framework/kernel/graph/(contract|derivative|fold%w*|fold_%w+|hull|interpreter|inverse|inverse_angle|jet_%w+|kink|tail_%w+|tape)%.c$",
      "^framework/algebra/(difference|difference_rule|expand|polynomial|simplify|summands)%.c$" },
    tests = { "^graph%.", "^algebra%.", "^plugins%.arithmetic_interval_jets", "^plugins%.solver_valencia", "^mechanics%.",
      "^plugins%.solver_reduction" },
    specs = { "expression", "source" } },
  { name = "verbs", share = 30, target = "ambit_inside",
    files = { "^framework/verbs/%w+/(event%w*|event_%w+|watch|watch_most|guard|monotone|bound|merge|dense|split|solve|spectrum|definite)%.c$" },
    tests = { "^verbs%." },
    specs = { "event", "verify", "poincare", "hybrid", "split", "gradient" } },
  solver("lohner", 35, "contract|dense|flow|frame|hermite|history|inclusion|invariant|kink|set|slopes|start|step",
    { "solver" }),
  solver("taylor_model", 35, "cell|dense|functions|kink|pieces|polynomial|proof|range|restrict|rules|series|set|step|tube|zonotope", { "solver" }),
  solver("stiff", 40, "bound|collocation|dd|dense|evaluate|frame|improve|invariant|linear|metzler|metzler_stiff|nodes|poly|prove|refine|series|splitting|spread|step|terms", { "solver" }),
  solver("valencia", 30, "faces|frame|point|series|slope|terms|verify", { "solver" }),
  solver("zonotope", 50, "basis|close|defect|dense|error|form|functions|implicit|inverse|kernel|range|multiply|row|run|series|set|slope|start|sum|sweep", { "zonotope" }),
  solver("zonotope", 45, "change|depend|discs|distance|far|kink|map|mixed|modes|products|quartic|residual|strip|vary", { "zonotope", "varying", "rate", "kink" },
    "zonotope, lumps and discs"),
  solver("zonotope", 35, "cycle|jump|tanh|turn", { "sampled", "map", "saturation", "zonotope" }, "zonotope, jumps"),
  { name = "functions", share = 45, files = { "^framework/functions/(%w+)%.c$" }, target = "ambit_inside",
    tests = { "^functions%.", "^graph%.contract", "^graph%.jet" }, specs = { "functions" } },
  { name = "sampled", share = 20, files = { "^framework/models/(sampled|map|network)%.lua$",
      "^framework/verbs/simulate/(problem)%.c$" }, target = "ambit", tests = { "^verbs%.simulate", "^verbs%.problem" },
    specs = { "sampled", "map", "varying", "simulate", "verify", "split" } },
  solver("krawczyk", 25, "bound|box|branch|cover|evaluate|hull|inverse|newton|prove|solution",
    { "roots", "roots_parameters", "stability", "inverse_kinematics" }),
  { name = "certify", share = 20, files = { "^framework/verbs/reduce/certify/(bound|bounds|couple|curve|proof|values)%.lua$" },
    target = "ambit", tests = {}, specs = { "certify", "certify_points", "reduce" } },
  { name = "verify", share = 15, files = { "^framework/verbs/verify/(box|carry|search)%.lua$" },
    target = "ambit", tests = {}, specs = { "verify", "inner_range", "certify" } },
  { name = "instants", share = 20, target = "ambit", tests = {}, specs = { "exact_clock", "sampled", "map", "instant" },
    files = { "^framework/verbs/run/(schedule|rational)%.c$", "^framework/verbs/run/(bracket|samples|instant)%.lua$" } },
  { name = "rational", share = 15, target = "service_rational", tests = { "^plugins%.service_rational$" },
    specs = { "exact_clock" }, files = { "^plugins/service/(rational)%.c$" } },
  { name = "robots", share = 0, files = { "^framework/models/robot/urdf()%.lua$" }, target = "ambit", tests = {},
    specs = { "urdf", "load" } },
}
