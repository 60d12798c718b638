-- help.lua -- ambit.help(name): a function of the API in a few lines, or the manual of a plugin.
local check = require "ambit.check"
local core = require "ambit.core"
local manual = require "ambit.manual"

local topics = {
  around = [[
around(c, tolerance [, name]): a datum within a tolerance, one fresh unknown: around(2, 0.1), around("35 mm", "1%").]],
  between = "between(lo, hi [, name]): a datum somewhere in [lo, hi], one fresh unknown.",
  varying = [[
varying(lo, hi [, name]): a function of time, never known but for its bounds: a disturbance, noise, a load. In
equations, forces and laws; each use of the same one is the same function.]],
  sampled = [[
sampled { period = "1 ms", outputs = { "u" }, memory = { sum = 0 }, delay = 0, quantum = { x = "0.1" }, law =
function(s, m, t) return { u = ... }, { sum = ... } end }: a controller with a clock. ambit.ode { ..., sampled =
controller }, or m:sampled(controller).u.]],
  map = [[
map { states = { "x" }, parameters = { a = 2 }, next = function(s, p, k) return { x = p.a * s.x } end }: a system that
steps; simulate, verify and sample take it, t counts steps.]],
  network = [[
network "file" or network { { weights = { { 1, 2 } }, bias = { 0 }, activation = "relu" }, ... }: dense layers, a
function of a list of inputs that returns the list of outputs.]],
  lookup = 'lookup { x = { 0, 1 }, y = { 2, 3 } }: f(x), lines between the points, constant beyond them.',
  number = 'number(x [, unit]): an expression: number "8/3", number("35 mm", "m").',
  interval = [[
interval(lo, hi), interval "[0.1, 0.2]": an enclosure to calculate with. It has lo, hi, partial, width(), mid(), rad(),
mag(), mig(), contains(x), hull(x), intersect(x), text(digits), is_empty(), is_bounded().]],
  text_arithmetic = [[
text_arithmetic(true): "1" / "3" means a third, as it always does in the command; text_arithmetic(false): it is Lua's,
which rounds. For scripts that a stock lua5.4 runs; returns what it was: "ambit", "lua" or "watched".]],
  degrees = 'degrees(x): x pi/180, exact, of a number without a unit; "60 deg" is converted already.',
  pi = "pi: the constant itself, enclosed by each arithmetic.",
  time = "time: the time t of a simulation, for given motions and forces.",
  mechanism = [[
mechanism { "name", gravity = { 0, 0, "-9.81" } }: parts are added with m:<element> { ... } to m.world and to the frames
that elements return; m:position(frame), m:orientation(frame), m:velocity(frame), m:angular_velocity(frame),
m:acceleration(frame), m:distance(a, b), m:angle(a, b, axis), m:relative_pose(a, b), m:relative_velocity(a, b),
m:total_mass(), m:centre_of_mass(), m:momentum(), m:reaction(joint), m:energy(), m:power(), m:coordinates(),
m:mass_matrix(), m:generalised_forces(), m:dynamics().]],
  load = [[
load { "robot.urdf", tolerances = { mass = "2%", ["*_joint.offset"] = "0.1 mm" }, gravity = { 0, 0, "-9.81" } }: a
mechanism from a URDF file or a Lua table of RBDL, with m.links.NAME, m.joints.NAME, m:limits(), m:tolerances(). Also
name = "arm", base = frame of another mechanism, damping = true, friction = true. Into a mechanism that there is:
m:load { "arm.urdf", from = frame, name = "left" }.]],
  chain = [[
chain { "leg", doc = "...", ports = { from = "frame" }, parameters = { thigh = { "m", "0.4", "its length" } },
build = function(m, p) ... return { foot = frame } end }: from then on m:leg { name = "left", from = f } is an element;
its parts are left.knee, ..., what build returns is left.foot.]],
  ode = [[
ode { states = { "x" }, parameters = { a = 1 }, equations = function(s, p, t) return { x = -p.a * s.x } end }; with
units, states = { x = "m" }, derivatives must be in them by s, unless check_units = false.]],
  join = [[
join { "name", m1, m2, ode }: mechanisms and odes as one system; force laws and equations of each may read states
of the others by their names.]],
  evaluate = [[
evaluate { expression or table of them, at = { name = value }, arithmetic = "interval", partial = false }:
enclosures, in the same shape.]],
  simulate = [[
simulate { ode, initial = { x = 1 }, t = { 0, 1 }, solver = "lohner", <options of the solver>, split = { x = 8 } or 8,
threads = 2, keep = "last", dense = true, events = { { g = function(s, p, t) ... end, name = "impact", direction =
"falling", stop = true } } }: a run with status, reason, t_reached, cpu_seconds, wall_seconds, step_count, threads,
pieces, rigorous, events, ended_by, x, :at(t), :steps(), :set() to go on from. Without solver, the one that suits:
run.solver, run.solver_reason. Solvers: lohner, taylor_model, valencia, stiff, gsl; help "stiff" lists options.]],
  poincare = [[
poincare { ode, section = function(s, p, t) ... end, direction = "rising", initial = { x = 1 }, t_max = 10, returns = 1,
t_start = 0, solver = "lohner" }: the returns to a section, returns[i].t, .x, .set; :set(i), :orbit(): is there a
periodic orbit?]],
  hybrid = [[
hybrid { modes = { fly = { ode, guards = { { g = function(s, p, t) ... end, direction = "falling", to = "fly", reset =
function(s, p, t) return { v = -s.v } end } } } }, mode = "fly", initial = { y = 1, v = 0 }, t = { 0, 3 } }: a model
that switches where a guard crosses 0: status, reason, t_reached, x, events, modes, :at(t), :steps().]],
  reduce = [[
reduce { ode or m:dynamics(), t = { 0, 10 }, initial = ..., outputs = { "x", y = function(s, p, t) ... end },
  error = { x = "0.1", y = 1 }, scenarios = { { parameters = { v = ... }, inputs = { u = function(t) ... end } }, ... },
  reductions = { "branch", "neglect", "constant", "enclosure", "linearise", "merge" }, elements = true }
  The smallest equations whose outputs provably stay within `error` of the detailed ones, for all data of all
  scenarios, at all times: .ode, .error, .terms; :report(), :decisions(), :sample { draws = 100 }, :json(FILE),
:picture(FILE).]],
  certify = [[
certify { detailed, reduced, t = { 0, 10 }, initial = ..., outputs = { "x", y = function(s, p, t) ... end },
  error = { x = 0.1 }, criterion = "difference" | "bounds", parameters, inputs, scenarios = { { ... }, ... },
  reduced_outputs, split, refine = 16 (further runs over parts of the data), solver and its options }
  proves how far the outputs of a reduced model are off, for all data of all scenarios, at all times
  -> .status "proved" | "exceeded" | "unable" | "stopped", .error.x, .when.x, .scenarios, :curve()]],
  verify = [[
verify { ode, initial = { x = 1 }, t = { 0, 1 } or math.huge, safe = expression or function(s, p, t), at_end = ...,
reach = ..., budget = 200 }: proves or refutes that conditions are never positive: status, reason, bound,
counterexample, conditions.]],
  sensitivity = [[
sensitivity { ode, initial = { x = 1 }, t = { 0, 1 }, wrt = { "x", k = datum } }: a run with derivatives by initial
values and data: :d(state, by), :d_at(t, state, by), step.d(state, by), :unit(state, by).]],
  roots = [[
roots { function(s) return { s.x ^ 2 - 2 } end, box = { x = { 0, 3 } }, at = { name = value }, tolerance = 1e-8 }: every
root in the box, proved: status, proved, partly, undecided, boxes; proved[1].x, .slope(datum). Options: help
"krawczyk".]],
  invariant = [[
invariant { ode or mechanism, about = { angle = 0 }, within = { angle = { -0.5, 0.5 } }, budget = 400 }: a set about a
state of rest that no solution leaves, for all data: status, box, settles, rate, contains { state = value }.]],
  equilibria = [[
equilibria { ode or mechanism, box = { angle = { -3, 3 } }, at = { name = value }, stability = true }: where it rests,
as roots does; proved[1].stability, .stability_by, .stability_reason, .eigenvalues[1].re, .im, .count.]],
  inverse_kinematics = [[
inverse_kinematics { m, at = frame, position = { x, y, z }, orientation = rows or { axis = "z", angle = a } or { rpy =
{ r, p, y } }, box = { joint = { lo, hi } }, given = { joint = value } }: every posture, as roots does.]],
  eigenvalues = [[
eigenvalues { { a, b }, { c, d } }: of a matrix: a list of { re, im, count } with stability.]],
  sample = [[
sample { expression or ode, n = 1000, seed = 1, threads = 2, points = "sobol" | "niederreiter" | "halton" |
"reverse_halton" | "random", corners = true, polish = true, relative = 1e-10, absolute = 1e-12, at | initial, t ... }:
draws from the tolerances; proves nothing: status, draws, failed, points, x, error, :at(t), :error_at(t).]],
  overestimation = [[
overestimation(result, sample): how many times as wide as the sampled hull: of what evaluate gave, in its shape; of a
run (as run:overestimation(sample)) by state name, with .max, .t, .contradiction, :at(t).]],
  compare = [[
compare { expression or table of them, at = { name = value }, arithmetics = { "interval", { "affine", symbols =
{ 10, 20 } } }, repeats = 5, limit = 4 } or compare { m:dynamics() or ode, initial, t, solvers = { "lohner",
{ "taylor_model", order = { 8, 12 } } }, arithmetics, reference = { t, x = { state = value } } }: width or error against
run time, a result with status, rows, advice, and a table when printed. Without a subject: how `ambit compare` shall
compare this scene.]],
  view = [[
view { m, run = run, points = { tip = frame }, at = { joint = value }, t = { 0, 5 }, title = "" }: what `ambit view`
shows of a mechanism; otherwise nothing happens.]],
  derivative = "derivative(e, x): de/dx for a variable, an unknown or ambit.time.",
  simplify = "simplify(e): an equal expression with fewer operations, if one is found.",
  plugins = "plugins([kind]): what there is, without loading it.",
  plugin = "plugin(kind, name): one plugin, loaded; its exported functions are in .fn.",
  trust = "trust { folder, ..., shadow = true }: load plugins from these folders although others may write there;\n"
    .. "shadow: a plugin may have the kind and name of one of Ambit's own, which it replaces.",
  provenance = "provenance(): what results rest on so far: version, scene, kernel and every loaded plugin, with files\n"
    .. "and their SHA-256.",
  help = "help([name]): this text; name of a function or a plugin.",
  version = "version: of Ambit.",
}
for _, name in ipairs { "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "sqrt",
  "sqr", "abs" } do
  topics[name] = name .. "(x): of numbers, texts, expressions and enclosures."
end
for _, name in ipairs(core.described_functions) do
  topics[name] = topics[name] or name .. "(x): of numbers, texts, expressions and enclosures."
end
topics.atan2 = "atan2(y, x): the angle of the point (x, y)."
topics.pow = "pow(a, b), a ^ b: integer b for every a, half integers as powers of sqrt(a), others for a > 0."
topics.hypot = "hypot(x, y): sqrt(x^2 + y^2), without overflow in between."
topics.min = "min(a, b, ...): the smaller one."
topics.max = "max(a, b, ...): the larger one."

-- help() lists the topics, help(name) returns a text.
return function(name)
  if name == nil then
    return "topics: " .. table.concat(check.sorted(topics), ", ") .. "\nand every plugin: see ambit.plugins()"
  end
  check.text(name, "help: name")
  local topic = topics[name]
  if topic then return "ambit." .. topic end
  local text, problem = manual.named(name)
  if not text then check.fail("help: there is no topic and no plugin of that name: %s", problem) end
  return text
end
