---@meta ambit
-- Annotations of the Lua API (LuaCATS) for editors: add the folder of this file to the workspace library of lua-language-server.
-- Elements are plugins; those that come with Ambit are listed, others are m:<name> { ... } all the same.

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

---A number is the exact double; text is the decimal it says, with an optional unit: "0.1", "35 mm", "[0.1, 0.2]", "3.56?2".
---@alias ambit.datum number|string|ambit.expression|ambit.enclosure
---@alias ambit.vector { x: ambit.datum, y: ambit.datum, z: ambit.datum }|ambit.datum[]
---@alias ambit.axis "x"|"y"|"z"|"-x"|"-y"|"-z"|ambit.datum[]

---A datum within a tolerance: one fresh unknown at each call.
---@param c ambit.datum
---@param tolerance number|string 0.1, "0.1", "1%", "0.1 mm"
---@return ambit.expression
function ambit.around(c, tolerance) end

---A datum somewhere in [lo, hi]: one fresh unknown at each call.
---@param lo number|string|ambit.expression
---@param hi number|string|ambit.expression
---@return ambit.expression
function ambit.between(lo, hi) end

---@param x ambit.datum
---@param unit? string SI unit that it must agree with
---@return ambit.expression
function ambit.number(x, unit) end

---An enclosure to calculate with.
---@param lo ambit.datum
---@param hi? ambit.datum
---@return ambit.enclosure
function ambit.interval(lo, hi) end

---@generic T: ambit.expression|ambit.enclosure
---@param x ambit.datum degrees
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
---Integer exponents for every base, others as exp(b log a).
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

---@param frame ambit.frame
---@return { x: ambit.expression, y: ambit.expression, z: ambit.expression } # m, in the world
function mechanism:position(frame) end
---@param frame ambit.frame
---@return ambit.expression[][] # rotation by rows, own axes -> world
function mechanism:orientation(frame) end
---@param frame ambit.frame
---@return { x: ambit.expression, y: ambit.expression, z: ambit.expression } # m/s, world axes
function mechanism:velocity(frame) end
---@param frame ambit.frame
---@return { x: ambit.expression, y: ambit.expression, z: ambit.expression } # rad/s, world axes
function mechanism:angular_velocity(frame) end
---@param frame ambit.frame
---@return { x: ambit.expression, y: ambit.expression, z: ambit.expression } # m/s^2, world axes
function mechanism:acceleration(frame) end
---@return { kinetic: ambit.expression, potential: ambit.expression, total: ambit.expression } # J
function mechanism:energy() end
---@return table<string, ambit.expression> # beta1, beta1', beta1'' ...
function mechanism:coordinates() end
---@return ambit.expression[][] # M(q) by rows
function mechanism:mass_matrix() end
---@return ambit.expression[] # h(q, q') of M q'' = h
function mechanism:generalised_forces() end
---@return ambit.ode
function mechanism:dynamics() end

---@param t { from: ambit.frame, axis: ambit.axis, name: string? }
---@return ambit.frame, ambit.joint
function mechanism:revolute(t) end
---@param t { from: ambit.frame, axis: ambit.axis, name: string? }
---@return ambit.frame, ambit.joint
function mechanism:prismatic(t) end
---@param t { from: ambit.frame, offset: ambit.vector?, name: string? }
---@return ambit.frame
function mechanism:rigid_link(t) end
---@param t { from: ambit.frame, axis: ambit.axis, angle: ambit.datum?, play: ambit.datum?, name: string? }
---@return ambit.frame
function mechanism:sloppy_joint(t) end
---@param t { at: ambit.frame, mass: ambit.datum, name: string? }
function mechanism:point_mass(t) end
---@param t ambit.vector
function mechanism:gravity(t) end

---@class ambit.ode
---@field name string
---@field states string[]
local ode = {}
---@param name string
---@return ambit.expression # the right-hand side of that state
function ode:rate(name) end

---@param t { states: string[]|table<string, string>, parameters: table<string, ambit.datum>?, equations: (fun(s: table<string, ambit.expression>, p: table<string, ambit.expression>, t: ambit.expression): table<string, ambit.datum>)|table<string, ambit.datum|function>, name: string? }
---@return ambit.ode
function ambit.ode(t) end

---"real" proves nothing; the others enclose. With options as a table: { "affine", symbols = 20 }. Plugins: others may be
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

---The same shape with enclosures; a table also has .status, .arithmetic, .cpu_seconds.
---@param t { [1]: any, at: table<string, ambit.datum>?, arithmetic: ambit.arithmetic? }
---@return any
function ambit.evaluate(t) end

---@class ambit.step
---@field t_from number
---@field t number
---@field order integer
---@field x table<string, ambit.enclosure> at t
---@field tube table<string, ambit.enclosure>? for all times of the step

---@class ambit.run
---@field status "complete"|"unable"|"stopped"
---@field reason string "" if complete, else why, and which knob to turn
---@field t_reached number
---@field cpu_seconds number
---@field step_count integer
---@field rigorous boolean are these proved enclosures?
---@field x table<string, ambit.enclosure> the last enclosure, by state name
local run = {}
---@param t number|string
---@return table<string, ambit.enclosure> # a step's end exactly, else the tube of the step around t
function run:at(t) end
---@return fun(): ambit.step?
function run:steps() end

---Keys besides these are options of the solver.
---@param t { [1]: ambit.ode|ambit.mechanism, initial: table<string, ambit.datum>, t: number|(number|string)[], solver: string?, arithmetic: ambit.arithmetic?, order: integer? }
---@return ambit.run
function ambit.simulate(t) end

---@class ambit.sample
---@field status "complete"|"stopped"
---@field draws integer
---@field failed integer
---@field x table<string, ambit.enclosure> hull of the draws at the last time
local sample = {}
---@param t number|string one of the listed times
---@return table<string, ambit.enclosure>
function sample:at(t) end

---Monte Carlo in ordinary floating point; proves nothing.
---@param t { [1]: any, n: integer?, seed: integer?, at: table<string, ambit.datum>?, initial: table<string, ambit.datum>?, t: any?, solver: string?, arithmetic: ambit.arithmetic? }
---@return any
function ambit.sample(t) end

---One arithmetic with one choice of its options.
---@class ambit.comparison.row
---@field arithmetic string
---@field label string "affine symbols=20"
---@field options string[] name, value, name, value ...
---@field rigorous boolean
---@field status "complete"|"empty"|"unbounded"|"failed"|"skipped"
---@field reason string? why it is not complete
---@field partial boolean? some operation left its domain
---@field x any? enclosures, in the shape that was asked for
---@field widths number[]? of each result
---@field width number? the largest
---@field over_tightest number? largest ratio to the tightest proved width
---@field over_sample number? largest ratio to the width of the sampled hull
---@field seconds_run number? CPU time, the least of the repeats
---@field seconds_build number?

---Printed, it is a table.
---@class ambit.comparison
---@field status "complete"|"unable" unable: nothing was proved, or proofs contradict each other
---@field reason string?
---@field rows ambit.comparison.row[]
---@field sample { x: ambit.enclosure[], width: number }? hull of the samples
---@field cpu_seconds number

---Width against run time over arithmetics. A list of values of an option is run through: { "affine", symbols = { 10, 20 } }.
---Without expressions: how `ambit compare` shall compare this scene.
---@param t { [1]: any, at: table<string, ambit.datum>?, arithmetics: (string|table)[]?, repeats: integer?, limit: number?, n: integer?, seed: integer? }
---@return ambit.comparison
function ambit.compare(t) end

---@param kind? "arithmetic"|"element"|"solver"|"service"
---@return { kind: string, name: string, file: string, loaded: boolean }[]
function ambit.plugins(kind) end
---@param kind "arithmetic"|"element"|"solver"|"service"
---@param name string
---@return { kind: string, name: string, version: string, doc: string, fn: table<string, function> }
function ambit.plugin(kind, name) end
---@param name? string
---@return string
function ambit.help(name) end

return ambit
