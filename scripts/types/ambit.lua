---@meta ambit
-- Annotations of the Lua API (LuaCATS) for editors: add the folder of this file to the workspace library of
-- lua-language-server. Elements are plugins; those that come with Ambit are listed, others are m:<name> { ... } all the
-- same.

---@class ambit
---@field version string
---@field pi ambit.expression the constant itself, enclosed by each arithmetic
---@field time ambit.expression the time of a simulation, s
local ambit = {}

---A formula over unknowns and variables; exact, correlated, differentiable.
---@class ambit.expression
---@operator add(ambit.datum): ambit.expression
---@operator sub(ambit.datum): ambit.expression
---@operator mul(ambit.datum): ambit.expression
---@operator div(ambit.datum): ambit.expression
---@operator pow(ambit.datum): ambit.expression
---@operator unm: ambit.expression

---A set [lo, hi] of reals. `a < b` and `a <= b` hold only if certain for every pair of values.
---@class ambit.enclosure
---@field lo number exact double
---@field hi number exact double
---@field partial boolean some operation on the way left its domain; the set holds for the part inside
---@field error? number of what was sampled: by how much its hull was made smaller, or how far off its middle is
---@operator add(ambit.datum): ambit.enclosure
---@operator sub(ambit.datum): ambit.enclosure
---@operator mul(ambit.datum): ambit.enclosure
---@operator div(ambit.datum): ambit.enclosure
---@operator pow(ambit.datum): ambit.enclosure
---@operator unm: ambit.enclosure
local enclosure = {}
---@return number # rounded up
function enclosure:width() end
---@return number # a finite double inside
function enclosure:mid() end
---@return number # rounded up
function enclosure:rad() end
---@return number # largest absolute value
function enclosure:mag() end
---@return number # smallest absolute value
function enclosure:mig() end
---@param x ambit.datum
---@return boolean # is every value of x inside?
function enclosure:contains(x) end
---@param ... ambit.datum
---@return ambit.enclosure
function enclosure:hull(...) end
---@param x ambit.datum
---@return ambit.enclosure
function enclosure:intersect(x) end
---@param digits? integer significant digits of the width
---@return string # rounded outward
function enclosure:text(digits) end
---@return boolean
function enclosure:is_empty() end
---@return boolean
function enclosure:is_bounded() end

---A number is the exact double; text is the decimal it says, perhaps with a unit: "0.1", "35 mm", "[0.1, 0.2]".
---@alias ambit.datum number|string|ambit.expression|ambit.enclosure
---@alias ambit.vector { x: ambit.datum, y: ambit.datum, z: ambit.datum }|ambit.datum[]
---@alias ambit.axis "x"|"y"|"z"|"-x"|"-y"|"-z"|ambit.datum[]

---A datum within a tolerance: one fresh unknown at each call.
---@param c ambit.datum
---@param tolerance number|string 0.1, "0.1", "1%", "0.1 mm"
---@param name? string what reports call it; otherwise as the place where it is used first
---@return ambit.expression
function ambit.around(c, tolerance, name) end

---A datum somewhere in [lo, hi]: one fresh unknown at each call.
---@param lo number|string|ambit.expression
---@param hi number|string|ambit.expression
---@param name? string what reports call it; otherwise as the place where it is used first
---@return ambit.expression
function ambit.between(lo, hi, name) end

---A function of time, never known but for its bounds.
---@param lo ambit.value
---@param hi ambit.value
---@param name? string
---@return ambit.expression
function ambit.varying(lo, hi, name) end

---A controller that looks at its plant at the instants of a clock and holds what it finds.
---@class ambit.sampled
---@class ambit.sampled.definition
---@field [1]? string name
---@field name? string
---@field period ambit.datum "1 ms"
---@field start? ambit.datum of the first sample after the start of a run
---@field outputs table names, or names and units
---@field memory? table<string, ambit.value> initial values
---@field delay? integer samples until an output acts
---@field quantum? ambit.value|table<string, ambit.value> steps of the sensors' readings
---@field law fun(s: table, m: table, t: ambit.expression): any, table?

---@param t ambit.sampled.definition
---@return ambit.sampled
function ambit.sampled(t) end

---A system that steps: x+ = next(x, p, k).
---@param t { [1]: string?, name: string?, states: string[]|table<string, string>, parameters: table<string, ambit.datum>?, next: (fun(s: table<string, ambit.expression>, p: table<string, ambit.expression>, k: ambit.expression): table<string, ambit.datum>), check_units: boolean? }
---@return ambit.ode
function ambit.map(t) end

---A neural network of dense layers, from a file or from a list of layers.
---@param layers string|{ weights: number[][], bias: number[]?, activation: "linear"|"relu"|"tanh"|"sigmoid"|nil }[]
---@return fun(inputs: ambit.datum[]): ambit.expression[]
function ambit.network(layers) end

---Lines between points, constant beyond them.
---@param t { x: ambit.datum[], y: ambit.datum[] }
---@return fun(x: ambit.datum): ambit.expression
function ambit.lookup(t) end

---@param is_exact boolean true: arithmetic on texts is Ambit's, as in the command; false: Lua's, which rounds
---@return "ambit"|"lua"|"watched" # whose it was
function ambit.text_arithmetic(is_exact) end

---@param x ambit.datum
---@param unit? string unit that it must agree with, and that of x if it has none
---@return ambit.expression
function ambit.number(x, unit) end

---An enclosure to calculate with.
---@param lo ambit.datum
---@param hi? ambit.datum
---@return ambit.enclosure
function ambit.interval(lo, hi) end

---@generic T: ambit.expression|ambit.enclosure
---@param x ambit.datum degrees, without a unit
---@return ambit.expression|ambit.enclosure # rad
function ambit.degrees(x) end

---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.sin(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.cos(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.tan(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.asin(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.acos(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.atan(x) end
---@param y ambit.datum
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure # the angle of the point (x, y)
function ambit.atan2(y, x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.sinh(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.cosh(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.tanh(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.exp(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.log(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.sqrt(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.sqr(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.abs(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.log1p(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.expm1(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.asinh(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.acosh(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.atanh(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.log2(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.log10(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.exp2(x) end
---@param x ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.cbrt(x) end
---@param x ambit.datum
---@param y ambit.datum
---@return ambit.expression|ambit.enclosure # sqrt(x^2 + y^2)
function ambit.hypot(x, y) end
---Integer exponents for every base, half integers as powers of the square root, others for a > 0.
---@param a ambit.datum
---@param b ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.pow(a, b) end
---@param ... ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.min(...) end
---@param ... ambit.datum
---@return ambit.expression|ambit.enclosure
function ambit.max(...) end

---@param e ambit.datum
---@param x ambit.expression a variable, an unknown or ambit.time
---@return ambit.expression
function ambit.derivative(e, x) end
---@param e ambit.datum
---@param limit? integer most terms of the expanded form
---@return ambit.expression
function ambit.simplify(e, limit) end

---@class ambit.frame
---@class ambit.joint

---@class ambit.mechanism
---@field name string
---@field world ambit.frame
local mechanism = {}

---@param t string|{ [1]: string?, name: string?, gravity: ambit.vector? }
---@return ambit.mechanism
function ambit.mechanism(t) end

---@alias ambit.triple { x: ambit.expression, y: ambit.expression, z: ambit.expression }

-- what can be measured: expressions, for ambit.evaluate

---@param frame ambit.frame
---@return ambit.triple # m, in the world
function mechanism:position(frame) end
---@param frame ambit.frame
---@return ambit.expression[][] # rotation by rows, own axes -> world
function mechanism:orientation(frame) end
---@param frame ambit.frame
---@return ambit.triple # m/s, world axes
function mechanism:velocity(frame) end
---@param frame ambit.frame
---@return ambit.triple # rad/s, world axes
function mechanism:angular_velocity(frame) end
---@param frame ambit.frame
---@return ambit.triple # m/s^2, world axes
function mechanism:acceleration(frame) end
---@param a ambit.frame
---@param b ambit.frame
---@return ambit.expression # of the origins, m
function mechanism:distance(a, b) end
---@param a ambit.frame
---@param b ambit.frame
---@param axis? ambit.axis in the axes of a; without it the angle of the whole rotation, 0 to pi
---@param near? ambit.datum the signed angle is within pi of it, rad
---@return ambit.expression # rad
function mechanism:angle(a, b, axis, near) end
---@param a ambit.frame
---@param b ambit.frame
---@return { position: ambit.triple, rotation: ambit.expression[][] } # of b, in the axes of a
function mechanism:relative_pose(a, b) end
---@param a ambit.frame
---@param b ambit.frame
---@return { linear: ambit.triple, angular: ambit.triple } # of b as seen from a, in the axes of a
function mechanism:relative_velocity(a, b) end
---@return ambit.expression # kg
function mechanism:total_mass() end
---@return ambit.triple # m, in the world
function mechanism:centre_of_mass() end
---@param about? ambit.frame angular momentum about its origin; else about the world's
---@return { linear: ambit.triple, angular: ambit.triple } # N s, N m s, world axes
function mechanism:momentum(about) end
---@param joint ambit.frame|ambit.joint
---@param which? "motion" put in what the equations of motion make of accelerations and multipliers
---@return { torque: ambit.triple, force: ambit.triple } # what the joint exerts on what it carries, in the axes of its frame
function mechanism:reaction(joint, which) end
---@return { kinetic: ambit.expression, potential: ambit.expression, total: ambit.expression } # J
function mechanism:energy() end
---@return ambit.expression # W put in beyond what the potential energy gives up
function mechanism:power() end

-- equations of motion; lists are in the order of speed_names()

---@return string[]
function mechanism:coordinate_names() end
---@return string[] # "beta1'", ...
function mechanism:speed_names() end
---@return table<string, ambit.expression> # beta1, beta1', beta1'' ..., and the states
function mechanism:coordinates() end
---A quantity with an equation of its own, a state of m:dynamics(); q: coordinates, speeds and states by name.
---@param t { [1]: string, unit: string?, rate: ambit.datum|fun(q: table<string, ambit.expression>, x: ambit.expression, t: ambit.expression): ambit.datum }
---@return ambit.expression # the state
function mechanism:state(t) end
---@param controller ambit.sampled
---@return table<string, ambit.expression> # its outputs, for laws of torques and forces
function mechanism:sampled(controller) end
---@return table<string, ambit.expression> # above 0 where a limit of the robot's file is exceeded; for `safe` of verify
function mechanism:limit_excess() end
---@return table[] # events of simulate: each limit of the robot's file, where it is passed
function mechanism:limit_events() end
---@param t { stiffness: ambit.datum?, slide_stiffness: ambit.datum?, damping: ambit.datum? }
---@return string[] # joints that are pushed back from now on where they exceed a limit
function mechanism:limit_stops(t) end
---@param joint ambit.frame|ambit.joint
---@return ambit.expression
function mechanism:coordinate(joint) end
---@return ambit.expression[][] # M(q) by rows
function mechanism:mass_matrix() end
---@return ambit.expression[] # C(q, q') q' + g(q), with all forces of the elements: M q'' + bias = tau
function mechanism:bias() end
---@return ambit.expression[] # what gravity alone adds to the bias
function mechanism:gravity_torque() end
---@return ambit.expression[] # h(q, q') of M q'' = h
function mechanism:generalised_forces() end
---@param motion? table<string, ambit.datum> what is put in for coordinates, speeds or accelerations, by name
---@return ambit.expression[] # tau for given q, q', q''
function mechanism:inverse_dynamics(motion) end
---@param t? { form: "mass_matrix"|"articulated" }
---@return ambit.expression[] # q'' for given q, q' and tau_beta1, ...
function mechanism:forward_dynamics(t) end
---@param at ambit.frame|{ [1]: ambit.frame, [2]: ambit.datum[] } a frame, or a point with its offset in the frame's axes
---@return ambit.expression[][] # 6 rows: angular above linear velocity in world axes, for each speed
function mechanism:jacobian(at) end
---@param t? { form: "mass_matrix"|"articulated" }
---@return ambit.ode
function mechanism:dynamics(t) end

-- closed loops

---@return table<string, ambit.expression[]> # residuals by closing element
function mechanism:constraints() end
---@param names string[] coordinates or speeds that shall be independent
function mechanism:independent(names) end
---@param t table<string, number|string> a configuration at which the loops are closed: where pivots are chosen
function mechanism:reference(t) end
---@return string[] # rows that follow from the others at the reference
function mechanism:redundant() end
---@return table<string, ambit.expression> # as functions of the states
function mechanism:multipliers() end
---@param e any expressions in any shape
---@return any # dependent speeds, accelerations and multipliers put in
function mechanism:of_states(e) end
---@param t { box: table<string, any>, t: any?, boxes: integer? }
---@return { status: "proved"|"undecided"|"singular"|"empty", code: string, reason: string, independent: string[], dependent: string[], redundant: string[] }
function mechanism:rank(t) end

---@class ambit.assembly
---@field status "unique"|"none"|"several"|"undecided"|"partial"|"stopped"|"broken"
---@field code string "ok", "ok.none", "unable.partial", ...: see docs/errors.md
---@field partial boolean is there a configuration for a part of the data only?
---@field partly table<string, ambit.enclosure>[] those configurations
---@field reason string?
---@field configuration table<string, ambit.enclosure>? for `initial` and `at`
local assembly = {}
---The configuration as functions of the uncertain data; nil where they are exact or too wide for it.
---@return table<string, ambit.expression>?
function assembly:of_data() end

---Coordinates by name are given; the others are sought in `box`, or `within` a radius of `guess`.
---@param t { guess: table<string, ambit.datum>?, box: table<string, any>?, within: any, partial: boolean?, [string]: ambit.datum }
---@return ambit.assembly
function mechanism:assemble(t) end

-- files

---@param t string|{ [1]: string, from: ambit.frame?, tolerances: table<string, string>?, name: string?, damping: boolean?, friction: boolean?, physical: boolean? }
---@return table<string, ambit.frame> # by name of link
function mechanism:load(t) end
---@param name string
---@return ambit.frame
function mechanism:link(name) end
---@return table<string, { lower: any, upper: any, velocity: any, effort: any }> # by joint, as the file says
function mechanism:limits() end
---@param t? table<string, string> pattern = tolerance, for what is loaded from now on; nothing: what was laid
---@return table?
function mechanism:tolerances(t) end
---A robot from URDF or from an RBDL model table.
---@param t string|{ [1]: string, gravity: ambit.vector?, tolerances: table<string, string>?, name: string?, damping: boolean?, friction: boolean?, physical: boolean? }
---@return ambit.mechanism
function ambit.load(t) end

---@return table # { name, path, type, where, parts }
function mechanism:tree() end

---A Lua function that assembles elements, as an element.
---@param t { [1]: string, doc: string?, ports: table<string, any>?, parameters: table<string, any>?, build: fun(m: ambit.mechanism, p: table): ... }
---@return fun(m: ambit.mechanism, t: table): any
function ambit.chain(t) end

---@param t { from: ambit.frame, axis: ambit.axis, angle: ambit.datum?, mimic: { joint: any, multiplier: ambit.datum?, offset: ambit.datum? }?, name: string? }
---@return ambit.frame, ambit.joint
function mechanism:revolute(t) end
---@param t { from: ambit.frame, axis: ambit.axis, displacement: ambit.datum?, mimic: { joint: any, multiplier: ambit.datum?, offset: ambit.datum? }?, name: string? }
---@return ambit.frame, ambit.joint
function mechanism:prismatic(t) end
---@param t { from: ambit.frame, offset: ambit.vector?, axis: ambit.axis?, angle: ambit.datum?, name: string? }
---@return ambit.frame
function mechanism:rigid_link(t) end
---@param t { from: ambit.frame, axis: ambit.axis, angle: ambit.datum?, play: ambit.datum?, name: string? }
---@return ambit.frame
function mechanism:sloppy_joint(t) end
---@param t { at: ambit.frame, mass: ambit.datum, name: string? }
function mechanism:point_mass(t) end
---@param t { at: ambit.frame, mass: ambit.datum, centre: ambit.vector?, inertia: ambit.datum[][]?, name: string? }
function mechanism:rigid_body(t) end
---@param t { from: ambit.frame, to: ambit.frame, stiffness: ambit.datum?, damping: ambit.datum?, name: string? }
function mechanism:spring_damper(t) end
---@param t ambit.vector
function mechanism:gravity(t) end

---@class ambit.ode
---@field name string
---@field states string[]
local ode = {}
---@param name string
---@return ambit.expression # the right-hand side of that state
function ode:rate(name) end
---@return string # the equations, a line each
function ode:text() end
---@return string # a program that declares the same system
function ode:lua() end
---@return string # an aligned environment
function ode:latex() end
---@return string # a model ... end
function ode:modelica() end

---@param t { states: string[]|table<string, string>, parameters: table<string, ambit.datum>?, equations: (fun(s: table<string, ambit.expression>, p: table<string, ambit.expression>, t: ambit.expression): table<string, ambit.datum>)|table<string, ambit.datum|function>, name: string?, check_units: boolean?, sampled: ambit.sampled|ambit.sampled[]|nil }
---@return ambit.ode
function ambit.ode(t) end
---Several mechanisms and systems as one; a name may come first.
---@param t table
---@return ambit.ode
function ambit.join(t) end

---"real" proves nothing; the others enclose. With options as a table: { "affine", symbols = 20 }. Others may be
---installed; `ambit plugins NAME` prints the options of one.
---@alias ambit.arithmetic
---|"real"
---|"interval"
---|"gradient"
---|"affine"
---|"taylor_model"
---|"mpfr"
---|string
---|ambit.arithmetic.affine
---|ambit.arithmetic.taylor_model
---|ambit.arithmetic.mpfr
---|{ [1]: string, [string]: any }
---@class ambit.arithmetic.affine
---@field [1] "affine"
---@field symbols integer? noise symbols for the errors of operations, besides one for each uncertain datum
---@field product? "fast"|"tight"
---@field linearisation? "chebyshev"|"min_range"
---@class ambit.arithmetic.taylor_model
---@field [1] "taylor_model"
---@field order integer? total degree of the polynomial
---@field boxes integer? into how many boxes the domain may be split to bound a result
---@class ambit.arithmetic.mpfr
---@field [1] "mpfr"
---@field precision integer? bits

---The same shape with enclosures; a table also has .status ("complete", "partial", "impossible"), .code, .reason,
---.partial, .arithmetic, .cpu_seconds. partial = true: a part of the data may have no answer.
---@param t { [1]: any, at: table<string, ambit.datum>?, arithmetic: ambit.arithmetic?, partial: boolean? }
---@return any
function ambit.evaluate(t) end

---@class ambit.step
---@field t_from number|ambit.enclosure an enclosure if the run starts at a text that is no double
---@field t number|ambit.enclosure
---@field order integer
---@field x table<string, ambit.enclosure> at t
---@field tube table<string, ambit.enclosure>? for all times of the step

---A formula g of states, parameters and time, or a function that returns one; `g = 0` is the event.
---@alias ambit.condition ambit.datum|fun(s: table<string, ambit.expression>, p: table<string, ambit.expression>, t: ambit.expression): ambit.datum

---@class ambit.event
---@field g ambit.condition
---@field direction? "rising"|"falling"|"both" of g as time grows
---@field name? string its number unless given
---@field stop? boolean ends the run behind it

---@class ambit.event.found
---@field name string
---@field index integer of the entry in `events`
---@field t ambit.enclosure
---@field x table<string, ambit.enclosure>
---@field direction "rising"|"falling"|"both"
---@field certain boolean every solution of the set crosses, exactly once
---@field reason string? why it is not certain

---@class ambit.width_from
---@field state string the state that is widest beside sampled motions
---@field t number when: shortly before the run's end
---@field factor number its width by that of sampled motions
---@field shares { datum: string, share: number }[] what of the width goes with the datum at its middle, largest first
---@field datum string? the datum with the largest share, if the run completes with it narrower,
---@field tolerance string? and how narrow

---@class ambit.run
---@field status "complete"|"partial"|"impossible"|"unable"|"stopped"|"broken" partial: an event is not certain
---@field partial boolean may an event happen for a part of the data only?
---@field code string "ok", "unable.width", ...: see docs/errors.md
---@field reason string "" if complete, else why, and which knob to turn
---@field t_start number
---@field t_reached number
---@field cpu_seconds number of all threads
---@field wall_seconds number
---@field threads integer how many worked
---@field pieces integer that the uncertain data were cut into by `split`
---@field step_count integer
---@field solver string
---@field solver_reason string why this one was taken
---@field width_from ambit.width_from? where the width of a run that ended early came from, by experiment
---@field overestimate number? estimate, not proved: widest enclosure by the hull of samples; nil: no uncertain data
---@field parts { solver: string, t_from: number, t: number }[] which solver made which part
---@field tried { solver: string, pieces: integer?, outcome: string }[]? who was asked, if the first choice was not good enough
---@field arithmetic string
---@field rigorous boolean are these proved enclosures?
---@field states string[]
---@field events ambit.event.found[] in the order of time
---@field ended_by string? name of the event that ended the run
---@field x table<string, ambit.enclosure> the last enclosure, by state name
local run = {}
---@param t number|string|ambit.enclosure an enclosure, such as step.t: of the states at all its times within the run
---@return table<string, ambit.enclosure> # tight at ends of steps and with dense = true, else that of the whole step
function run:at(t) end
---@return fun(): ambit.step?
function run:steps() end
---@return table<string, ambit.expression> # initial values to go on from, of the same uncertain data
function run:set() end
---@param sample ambit.sample of the same system
---@return ambit.overestimation
function run:overestimation(sample) end

---@alias ambit.solver
---|"lohner"
---|"taylor_model"
---|"valencia"
---|"stiff"
---|"gsl"
---|string

---Options of the solvers; each knows some of them, `ambit plugins NAME` tells which.
---@class ambit.solver.options
---@field solver? ambit.solver
---@field arithmetic? ambit.arithmetic
---@field tolerance? number what one step may add
---@field order? integer
---@field jacobian_order? integer lohner, taylor_model
---@field time_order? integer taylor_model
---@field nodes? integer stiff
---@field degree? integer valencia
---@field exponential? "auto"|"off"|"on" valencia
---@field set? "auto"|"qr"|"history" lohner
---@field history? integer lohner
---@field pieces? integer lohner
---@field step? "auto"|"taylor"|"hermite_obreschkoff" lohner
---@field split_tolerance? number taylor_model
---@field pieces_max? integer taylor_model
---@field outputs? integer taylor_model
---@field method? string gsl
---@field relative? number gsl
---@field absolute? number gsl
---@field step_max? number s
---@field step_min? number s
---@field width_max? number
---@field [string] any of other plugins

---@class ambit.problem: ambit.solver.options
---@field [1] ambit.ode|ambit.mechanism
---@field initial table<string|integer, ambit.datum>
---@field t number|string|(number|string)[] start, ..., end; or the end

---@class ambit.simulate.request: ambit.problem
---@field events? ambit.event[]
---@field partial? boolean true: an event may happen for a part of the data only
---@field split? integer|table<string|ambit.expression, integer> pieces, or parts by state, parameter or datum
---@field threads? integer
---@field keep? "all"|"last"
---@field dense? boolean an enclosure of each whole step, for run:at(t)

---Keys besides these are options of the solver; without `solver` the one that suits.
---@param t ambit.simulate.request
---@return ambit.run
function ambit.simulate(t) end

---@class ambit.poincare.return
---@field t ambit.enclosure
---@field x table<string, ambit.enclosure>
---@field set table<string, ambit.expression> initial values to go on from
---@field direction "rising"|"falling"
---@field certain boolean

---@class ambit.poincare
---@field status "complete"|"impossible"|"unable"|"stopped"|"broken"
---@field code string "ok", "unable.width", ...: see docs/errors.md
---@field reason string
---@field returns ambit.poincare.return[]
---@field step_count integer
---@field cpu_seconds number
---@field rigorous boolean
local poincare = {}
---@param i? integer the last return unless given
---@return table<string, ambit.expression>
function poincare:set(i) end
---@return { proved: boolean, period: ambit.enclosure?, x: table<string, ambit.enclosure>?, reason: string? }
function poincare:orbit() end

---@class ambit.poincare.request: ambit.solver.options
---@field [1] ambit.ode|ambit.mechanism
---@field section ambit.condition
---@field direction? "rising"|"falling"|"both"
---@field initial table<string|integer, ambit.datum>
---@field t_max number|string by when the returns have happened, s
---@field t_start? number|string
---@field returns? integer

---@param t ambit.poincare.request
---@return ambit.poincare
function ambit.poincare(t) end

---@class ambit.guard
---@field g ambit.condition
---@field direction? "rising"|"falling"|"both"
---@field name? string
---@field to string mode in which the solution goes on
---@field reset? table<string, ambit.datum>|fun(s: table, p: table, t: ambit.expression): table<string, ambit.datum> states not mentioned keep their values

---@class ambit.hybrid: ambit.run
---@field modes string[] that it went through; events have `from` and `to`

---@class ambit.hybrid.request: ambit.solver.options
---@field modes table<string, { [1]: ambit.ode|ambit.mechanism, guards: ambit.guard[]? }>
---@field mode? string to start in, needed if there are several
---@field initial table<string|integer, ambit.datum>
---@field t number|string|(number|string)[]
---@field switches_max? integer

---A model that switches where a guard crosses 0.
---@param t ambit.hybrid.request
---@return ambit.hybrid
function ambit.hybrid(t) end

---@class ambit.counterexample
---@field initial table<string, ambit.enclosure>
---@field parameters table<string, ambit.enclosure>
---@field data table<string, ambit.enclosure> by the names of the data
---@field t ambit.enclosure
---@field g ambit.enclosure
local counterexample = {}
---@param e ambit.datum of the data
---@return ambit.enclosure # for this choice of them
function counterexample:value(e) end

---@class ambit.verdict
---@field name string
---@field status "proved"|"refuted"|"undecided"|"impossible"|"broken"
---@field code string
---@field reason string
---@field bound ambit.enclosure? of the largest (reach: the least) g over all data
---@field counterexample ambit.counterexample?

---@class ambit.verification
---@field status "proved"|"refuted"|"undecided"|"impossible"|"broken"
---@field code string
---@field reason string
---@field bound ambit.enclosure?
---@field counterexample ambit.counterexample?
---@field conditions table<string, ambit.verdict> by name
---@field refinements integer runs after the first
---@field cpu_seconds number

---@class ambit.verify.request: ambit.problem
---@field safe? ambit.condition|table<string|integer, ambit.condition> never positive
---@field at_end? ambit.condition|table<string|integer, ambit.condition> not positive at the end
---@field reach? ambit.condition|table<string|integer, ambit.condition> not positive at some time
---@field budget? integer|string runs after the first, 200 unless given; "10 s" of CPU time
---@field expect? "proved"|"refuted"|"undecided" the verdict with which the scene is to end with 0
---@field about? table<string, ambit.datum> with t = math.huge: roughly where it rests, if that is far from the start

---@class ambit.invariant
---@field status "proved"|"undecided"
---@field reason string
---@field box? table<string, ambit.enclosure> by state: the range of the set
---@field settles? table<string, ambit.enclosure> by state: where all its solutions are in the end
---@field centre? table<string, ambit.enclosure> by state: the states of rest, for all data
---@field rate? number of the decay, 1/s
---@field contains fun(self: ambit.invariant, state: table<string, ambit.datum>): boolean

---@class ambit.invariant.request
---@field [1] ambit.ode|ambit.mechanism
---@field about table<string, ambit.datum> roughly where it rests; speeds are 0
---@field within? table<string, any> { lo, hi } of states: where the set must lie
---@field budget? integer boxes that are looked at for one set, 400 unless given

---A set about a state of rest that no solution leaves, whatever the data are and whatever varies in time.
---@param t ambit.invariant.request
---@return ambit.invariant
function ambit.invariant(t) end

---Proves or refutes conditions for every behaviour that the tolerances allow.
---@param t ambit.verify.request
---@return ambit.verification
function ambit.verify(t) end

---A run with derivatives; see ambit.run for what else it knows.
---@class ambit.sensitivity: ambit.run
local sensitivity = {}
---@param state string
---@param by string|ambit.expression
---@return ambit.enclosure # at the end
function sensitivity:d(state, by) end
---@param t number|string
---@param state string
---@param by string|ambit.expression
---@return ambit.enclosure
function sensitivity:d_at(t, state, by) end
---@param state string
---@param by string|ambit.expression
---@return string
function sensitivity:unit(state, by) end

---@class ambit.sensitivity.request: ambit.problem
---@field wrt? table<string|integer, string|ambit.expression> states, parameters, or data by a name of your own; everything unless given

---Enclosures of the derivatives by initial values and data.
---@param t ambit.sensitivity.request
---@return ambit.sensitivity
function ambit.sensitivity(t) end

---@class ambit.scenario
---@field name? string
---@field t? number|string|(number|string)[]
---@field initial? table<string|integer, ambit.datum>|fun(p: table<string, ambit.expression>): table<string, ambit.datum>
---@field parameters? table<string|ambit.expression, ambit.datum>
---@field inputs? table<string|ambit.expression, ambit.datum|fun(t: ambit.expression): ambit.datum>

---What ambit.reduce and ambit.certify share; keys of `scenarios` fall back to those given here.
---@class ambit.certify.problem: ambit.solver.options, ambit.scenario
---@field scenarios? ambit.scenario[]
---@field outputs table<string|integer, string|ambit.datum|function> names of states; name = function(s, p, t)
---@field criterion? "difference"|"bounds" of both models on the same data; of the ranges of the outputs
---@field threads? integer
---@field split? integer|table<string|ambit.expression, integer>
---@field nodes? integer instants that "bounds" looks at, 100 unless given
---@field refine? integer further runs over parts of the data (certify: 8 where it helps, reduce: none, unless given)

---@class ambit.certificate
---@field status "proved"|"exceeded"|"unable"|"stopped"
---@field reason string
---@field error table<string, number> a proved bound for each output
---@field when table<string, number> where it is worst, s
---@field scenarios table[] the same for each
---@field cpu_seconds number
local certificate = {}
---@return { t: number[], error: table<string, number[]> }
function certificate:curve() end
---@param t? { draws: integer?, seed: integer? }
---@return table # the error seen in samples, from inside
function certificate:sample(t) end

---@class ambit.certify.request: ambit.certify.problem
---@field [1] ambit.ode|ambit.mechanism the detailed model
---@field [2] ambit.ode|ambit.mechanism the reduced one
---@field reduced_outputs? table<string, string|ambit.datum|function> where the reduced model's differ
---@field error? table<string, number|string>

---Proves how far a given reduced model is off, for all data of all scenarios, at all times.
---@param t ambit.certify.request
---@return ambit.certificate
function ambit.certify(t) end

---@class ambit.reduction
---@field status "complete"|"stopped"|"unable"
---@field reason string
---@field ode ambit.ode the reduced model
---@field mechanism ambit.mechanism? the reduced mechanism
---@field error table<string, number> a proved bound for each output
---@field terms table[]
---@field log table[]
---@field terms_before integer
---@field terms_after integer
---@field equations_before integer
---@field equations_after integer
---@field proofs integer
---@field cpu_seconds number
local reduction = {}
---@return table[] # a row for each term that was tried
function reduction:report() end
---@param width integer?
---@return string
function reduction:table(width) end
---@return string[] # the undo log
function reduction:decisions() end
---@return table[] # how well each ranking foretold the exact effect
function reduction:judge() end
---@param file string?
---@return string
function reduction:json(file) end
---@param file string an SVG file
---@param options table?
function reduction:picture(file, options) end
---@param t? { draws: integer?, seed: integer? }
---@return table # the error seen in samples, from inside
function reduction:sample(t) end

---@class ambit.reduce.request: ambit.certify.problem
---@field [1] ambit.ode|ambit.mechanism
---@field error table<string, number|string> what each output may be off by
---@field reductions? ("branch"|"neglect"|"constant"|"enclosure"|"linearise"|"merge")[]|string in this order
---@field ranking? string|string[] "adjoint" unless given; the first decides, the others are judged
---@field strategy? "predicted"|"clusters"
---@field cluster? number factor, 10 unless given; 1: one by one
---@field give_up? number a cluster of which each alone is so many bounds off is not halved, 10 unless given
---@field levels? integer 0: whole right-hand sides, 1: their summands, 2: sums inside those (unless given), ...
---@field budget? number|string s
---@field keep? string|string[] states and terms never to be cut
---@field elements? boolean|(string|table)[] of a mechanism: parts that may be left out

---The smallest set of equations whose outputs provably stay within their bounds of the detailed ones.
---@param t ambit.reduce.request
---@return ambit.reduction
function ambit.reduce(t) end

---What ambit.sample gives back for a system; for expressions, their shape has the same fields but x, t and states.
---@class ambit.sample
---@field status "complete"|"partial"|"unable"|"stopped" stopped: what was drawn until then counts
---@field partial boolean have some draws no value?
---@field draws integer
---@field failed integer of these did not reach the end
---@field off integer of these start off a constraint
---@field reason string? of the first that failed
---@field polished integer evaluations that followed the extremes besides
---@field one_by_one integer draws that were not integrated side by side
---@field points "sobol"|"niederreiter"|"halton"|"reverse_halton"|"random"
---@field points_reason string? why the points are random ones
---@field method string how the draws of a system were integrated
---@field threads integer
---@field cpu_seconds number
---@field wall_seconds number
---@field t number[]
---@field states string[]
---@field x table<string, ambit.enclosure> hull of the draws at the last time, made smaller by its error
---@field error table<string, number> how far the ends of what was drawn may be off: an estimate; of expressions a proved bound
local sample = {}
---@param t number|string one of the listed times
---@return table<string, ambit.enclosure>
function sample:at(t) end
---@param t number|string one of the listed times
---@return table<string, number> # how far the ends of the hull may be off; NaN: not known
function sample:error_at(t) end

---Draws from the tolerances in ordinary floating point; proves nothing.
---@param t { [1]: any, n: integer?, seed: integer?, points: string?, corners: boolean?, polish: boolean?, threads: integer?, at: table<string, ambit.datum>?, initial: table<string|integer, ambit.datum>?, t: any?, relative: number?, absolute: number?, solver: string?, arithmetic: ambit.arithmetic? }
---@return any
function ambit.sample(t) end

---Factors by state name, at the last time that a run and a sample have in common.
---@class ambit.overestimation
---@field max table<string, number> the largest over the common times
---@field t number the last common time
---@field contradiction string? what was seen that the enclosures miss
local overestimation = {}
---@param t number|string
---@return table<string, number>
function overestimation:at(t) end

---How many times as wide as the hull of a sample enclosures are: of a run (as run:overestimation), or of what evaluate
---gave, in its shape.
---@param result any
---@param sample any
---@return any
function ambit.overestimation(result, sample) end

---One combination: an arithmetic, or a solver over an arithmetic, with one choice of options. Of what it proves, only
---what there is has a value.
---@class ambit.comparison.row
---@field label string "affine symbols=20", "taylor_model order=8"
---@field family string the curve that it is a point of: "taylor_model, by order"
---@field solver string?
---@field arithmetic string?
---@field options string[] name, value, name, value ...
---@field axis string? the option that varies along the curve
---@field value string? and its value
---@field rigorous boolean
---@field status "complete"|"unable"|"stopped"|"empty"|"unbounded"|"failed"|"refused"|"crashed"|"late"|"out of memory"|"skipped"
---@field reason string? why it is not complete
---@field partial boolean? some operation left its domain
---@field t_reached number?
---@field x any? of expressions: enclosures, in the shape that was asked for
---@field values table<string, ambit.enclosure>? of a simulation: at the end, by state
---@field widths table<string, number>? of each result or state, by name
---@field width number? the largest of them
---@field width_max number? the largest of any state at any time
---@field over_tightest number? largest ratio to the tightest proved width
---@field over_sample number? largest ratio to the width of the sampled hull, at the end
---@field over_sample_max number? and at any time
---@field error number? largest distance from the reference that the enclosure allows
---@field pareto boolean? no other proof is both as fast and as tight
---@field seconds_run number? CPU time, the least of the repeats
---@field seconds_build number?
---@field repeats integer?
---@field steps integer?
---@field memory number? bytes by which its process grew
---@field work table? the report of a run
---@field track ambit.track?

---At most 200 instants, bounds by place of the state.
---@class ambit.track
---@field t number[]
---@field lo number[][]
---@field hi number[][]
---@field tube { lo: number[][], hi: number[][] } all the time from an instant to the next one

---Printed, it is a table.
---@class ambit.comparison
---@field verb "evaluate"|"simulate"
---@field status "complete"|"unable" unable: nothing was proved, or proofs contradict each other or the reference
---@field reason string?
---@field advice string? which combination to use for which accuracy
---@field interrupted boolean
---@field place string where in the scene
---@field title string
---@field names string[] of the results or states
---@field units string[]? of the states
---@field t number[]? { start, end }
---@field measure "width"|"error"|"over_sample" what the Pareto front and the advice go by
---@field rows ambit.comparison.row[]
---@field sample { t: number[], lo: number[][], hi: number[][], draws: integer, failed: integer }? hull of the samples
---@field sample_problem string? why there is none
---@field reference { t: number, x: table<string, number>, source: string }?
---@field reference_problem string? why the scene's reference is not used here
---@field settings table
---@field cpu_seconds number

---@class ambit.comparison.settings
---@field arithmetics? (string|table)[]
---@field solvers? (string|table)[]
---@field reference? { t: number|string, x: table<string, ambit.datum>, source: string? }
---@field repeats? integer 5
---@field limit? number seconds of CPU time for each combination, 10
---@field memory? number bytes for each combination, 1e9
---@field n? integer draws of the sampled hull
---@field seed? integer

---@class ambit.comparison.request: ambit.comparison.settings
---@field [1] any an expression, a table of them, or a system
---@field at? table<string, ambit.datum> of expressions
---@field initial? table<string|integer, ambit.datum> of a system, and what simulate knows besides:
---@field t? any
---@field events? table[]
---@field split? any
---@field threads? integer 1
---@field dense? boolean

---Width or error against run time, over arithmetics or solvers. A list of values of an option is run through:
---{ "affine", symbols = { 10, 20 } }. Without a subject: how `ambit compare` shall compare this scene.
---@param t ambit.comparison.request
---@return ambit.comparison
function ambit.compare(t) end

---Enclosures by name; further:
---@class ambit.root
---@field inside boolean is the enclosure inside the box that was searched?
---@field slope fun(datum: ambit.expression): table<string, ambit.enclosure> how it moves with a datum
---@field [string] any

---@class ambit.roots
---@field status "complete"|"partial"|"unable"|"stopped"|"broken"
---@field code string
---@field partial boolean are there roots for a part of the data only?
---@field reason string "" if complete
---@field proved ambit.root[] each holds exactly one root, for each value of the uncertain data
---@field partly ambit.root[] roots for a part of the data's values
---@field undecided table[] boxes that may hold roots
---@field unknowns string[]
---@field solver string
---@field arithmetic string
---@field boxes integer how many were looked at
---@field cpu_seconds number

---@class ambit.roots.options
---@field partial? boolean true: there may be roots for a part of the data only
---@field solver? string
---@field arithmetic? ambit.arithmetic
---@field tolerance? number size of the smallest boxes
---@field boxes_max? integer
---@field undecided_max? integer
---@field roots_max? integer
---@field operator? "auto"|"newton"|"krawczyk"|"hansen_sengupta"
---@field parameter_pieces? integer

---@class ambit.roots.request: ambit.roots.options
---@field [1] any an expression, a table of them, or a function(s) that returns one
---@field box table<string, any> { lo, hi }, an enclosure or a text for every unknown; ends may be infinite
---@field at? table<string, ambit.datum>

---Every root of f = 0 in a box, with proof.
---@param t ambit.roots.request
---@return ambit.roots
function ambit.roots(t) end

---@class ambit.eigenvalue
---@field re ambit.enclosure
---@field im ambit.enclosure
---@field count integer eigenvalues that share this box

---@class ambit.equilibrium: ambit.root
---@field stability "stable"|"unstable"|"undecided" for every value of the data
---@field stability_by? "eigenvalues"|"Lyapunov's equation"|"energy"
---@field stability_reason? string why it is undecided
---@field eigenvalues ambit.eigenvalue[]

---@class ambit.equilibria: ambit.roots
---@field proved ambit.equilibrium[]
---@field partly ambit.equilibrium[]

---@class ambit.equilibria.request: ambit.roots.options
---@field [1] ambit.ode|ambit.mechanism
---@field box table<string, any> of coordinates; speeds are 0
---@field at? table<string, ambit.datum>
---@field stability? boolean for all points at once, else when asked for

---Where a system rests: the speeds are zero, and so are their derivatives.
---@param t ambit.equilibria.request
---@return ambit.equilibria
function ambit.equilibria(t) end

---@param matrix { [integer]: ambit.datum[], partial: boolean? } by rows
---@return ambit.eigenvalue[] # also with .stability, .stability_by, .stability_reason
function ambit.eigenvalues(matrix) end

---@class ambit.inverse_kinematics.request: ambit.roots.options
---@field [1] ambit.mechanism
---@field at ambit.frame
---@field position? ambit.vector|{ x: ambit.datum?, y: ambit.datum?, z: ambit.datum? } m; components left out are free
---@field orientation? ambit.datum[][]|{ axis: ambit.axis, angle: ambit.datum }|{ rpy: ambit.datum[] }
---@field box? table<string, any> ranges of joints; else their limits, or half a turn around 0
---@field given? table<string, ambit.datum> values for joints

---Every posture in which a frame is at a place.
---@param t ambit.inverse_kinematics.request
---@return ambit.roots
function ambit.inverse_kinematics(t) end

---What `ambit view` shows of a mechanism; otherwise it only checks what it is given.
---@param t ambit.mechanism | { [1]: ambit.mechanism, run: ambit.run?, points: table<string|integer, ambit.frame>?, at: table<string, ambit.datum>?, t: ambit.datum[]?, arithmetic: string|table|nil, title: string? }
function ambit.view(t) end

---@param kind? "arithmetic"|"element"|"solver"|"service"
---@return { kind: string, name: string, file: string, loaded: boolean }[]
function ambit.plugins(kind) end
---@param kind "arithmetic"|"element"|"solver"|"service"
---@param name string
---@return { kind: string, name: string, version: string, doc: string, fn: table<string, function> }
function ambit.plugin(kind, name) end

---What results rest on so far. The files are hashed when this is called; a plugin whose file was changed since it was
---loaded is an error.
---@return { ambit: string, command: string?, scene: { file: string, sha256: string }?, kernel: { file: string, sha256: string }, plugins: { kind: string, name: string, version: string, file: string, sha256: string, shadows: string? }[], trusted: string[]? }
function ambit.provenance() end

---Loads plugins from these folders although others may write there. It holds for the whole process and for plugins
---that are loaded from then on: what `ambit --trust FOLDER --allow-shadow` says on the command line.
---@param t { [integer]: string, shadow?: boolean } shadow: a plugin may replace one of Ambit's own by its kind and name
function ambit.trust(t) end
---@param name? string
---@return string
function ambit.help(name) end

return ambit
