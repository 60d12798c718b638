-- areas.lua -- what is mutated, and which tests must notice.
--
-- files: patterns of `git ls-files`. tests: stages of ctest, quick ones first. specs: suites under tests/lua. share: of the mutations that are tried.
local function solver(name, share, rooms, specs)
  return { name = name, share = share, files = { "^plugins/solver/" .. name .. "/(" .. rooms .. ")%.c$" },
    specs = specs,
    tests = { "^plugins\\.solver_" .. name .. "$", "^plugins\\.solver_" .. name .. "_", "^plugins\\.solver_kit$" } }
end

return {
  { name = "num", share = 50, files = { "^framework/num/(%w+_?%w*)%.c$" },
    tests = { "^num\\.(interval|decimal|power|product|regular|elementary$|elementary_tight|spectrum)",
      "^(num\\.[^e]|num\\.elementary_[^p]|plugins\\.arithmetic_interval)", "^plugins\\.(arithmetic|solver_(lohner|valencia)$)" } },
  { name = "num headers", share = 15, files = { "^framework/num/(interval|rounding|elementary_kernel|power_kernel|product_kernel)%.h$" },
    tests = { "^num\\.(interval|decimal|power|product|regular|elementary$|elementary_tight|spectrum)",
      "^(num\\.[^e]|num\\.elementary_[^p]|plugins\\.arithmetic_interval)", "^plugins\\.(arithmetic|solver_(lohner|valencia)$)" } },
  { name = "graph", share = 65,
    files = { "^framework/graph/(contract|derivative|difference|difference_rule|expand|fold%w*|fold_%w+|hull|interpreter|inverse|inverse_angle|jet_%w+|kink|polynomial|simplify|summands|tail_%w+|tape)%.c$" },
    tests = { "^graph\\.", "^plugins\\.(arithmetics_agree|arithmetic_interval_jets|solver_lohner$|solver_valencia)",
      "^(plugins\\.solver_taylor_model$|mechanism|plugins\\.solver_reduction)" },
    specs = { "expression", "source", "certify" } },
  { name = "model", share = 30,
    files = { "^framework/model/(event%w*|event_%w+|watch|watch_most|guard|monotone|bound|merge|dense|split)%.c$" },
    tests = { "^model\\.(event|watch|monotone|split|pieces|simulate|evaluate)" },
    specs = { "event", "verify", "poincare", "hybrid", "split", "gradient" } },
  solver("lohner", 35, "contract|dense|frame|hermite|history|invariant|kink|series|set|start|step", { "solver" }),
  solver("taylor_model", 35, "cell|dense|functions|kink|pieces|polynomial|proof|range|restrict|rules|series|set|step|tube|zonotope", { "solver" }),
  solver("stiff", 40, "bound|collocation|dd|dense|evaluate|frame|improve|invariant|linear|metzler|metzler_stiff|nodes|poly|prove|refine|series|splitting|spread|step|terms", { "solver" }),
  solver("valencia", 30, "faces|frame|point|series|slope|terms|verify", { "solver" }),
  solver("krawczyk", 25, "bound|box|branch|cover|evaluate|hull|inverse|newton|prove|solution",
    { "roots", "roots_parameters", "stability", "inverse_kinematics" }),
  { name = "certify", share = 20, files = { "^scripts/prelude/certify/(bound|bounds|couple|curve|proof|values)%.lua$" }, tests = {}, specs = { "certify", "certify_points", "reduce" } },
  { name = "verify", share = 15, files = { "^scripts/prelude/verify/(box|carry|search)%.lua$" },
    tests = {}, specs = { "verify", "certify" } },
  { name = "robots", share = 0, files = { "^scripts/prelude/urdf()%.lua$" }, tests = {},
    specs = { "urdf", "load" } },
}
