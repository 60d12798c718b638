-- view/data.lua -- a mechanism and its motion -> what the page draws and tells.
--
-- Two kinds of numbers. The drawing (positions of frames, axes, centres) is the motion of the midpoints in plain
-- doubles, a few digits of it, and proves nothing. The boxes of the chosen points are guaranteed: the enclosure of the
-- position over the enclosures of the coordinates, whatever the uncertain data are; their texts are rounded outward and
-- are shown as they are.
local check = require "ambit.check"
local core = require "ambit.core"
local json = require "ambit.report.json"
local model = require "ambit.view.model"
local motion = require "ambit.view.motion"

local data = {}

local limits = {
  instants = 200,    -- at most
  positions = 60000, -- of frames, over all instants
  turned = 80,       -- frames; with more, their axes are left out
  coordinates = 24,  -- whose enclosures are listed
  points = 8,        -- tips that are chosen when the scene chooses none
  unknowns = 1000,   -- coordinates and data; with more, plain intervals
  seconds = 8,       -- to evaluate all instants
}

-- -- evaluating

local function leaves_of(expressions)
  local list = {}
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "symbol" or leaf.kind == "time" then list[#list + 1] = leaf end
  end
  return list
end

local function bindings(leaves, t, values)
  local list, set = {}, {}
  for i, leaf in ipairs(leaves) do
    local value
    if leaf.kind == "time" then value = t else value = rawget(values, leaf.name) end
    if value == nil then
      check.fail("view: the run does not say where `%s` is; give it by at = { %s = ... }", leaf.name, leaf.name)
    end
    list[i], set[i] = leaf.expression, core.expression(value)
  end
  return list, set
end

-- A list of expressions, evaluated again and again.
local Batch = {}
Batch.__index = Batch

local function batch(arithmetic, options, expressions)
  return setmetatable({ arithmetic = arithmetic, options = options, expressions = expressions,
    leaves = leaves_of(expressions) }, Batch)
end

function Batch:run(t, values)
  local leaves, set = bindings(self.leaves, t, values)
  return core.evaluate { arithmetic = self.arithmetic, options = self.options, expressions = self.expressions,
    leaves = leaves, values = set }
end

-- -- the drawing

local function append(list, values, first, last)
  for i = first, last do list[#list + 1] = values[i] end
end

-- What is drawn at each instant, by name: expressions, so many for each instant.
local function drawn_groups(shown)
  local groups = { { name = "position" }, { name = "turn" }, { name = "axis" }, { name = "centre" } }
  for _, group in ipairs(groups) do group.list = {} end
  for _, frame in ipairs(shown.frames) do
    append(groups[1].list, frame.pose, 10, 12)
    if #shown.frames <= limits.turned then -- own x and y axes; z follows
      for _, i in ipairs { 1, 4, 7, 2, 5, 8 } do table.insert(groups[2].list, frame.pose[i]) end
    end
  end
  for _, axis in ipairs(shown.axes) do append(groups[3].list, axis.direction, 1, 3) end
  for _, body in ipairs(shown.bodies) do append(groups[4].list, body.position, 1, 3) end
  return groups
end

local function mid(x)
  return x:is_empty() and 0.0 or x:is_bounded() and x:mid() or 0.0
end

local function midpoints(values)
  local list = {}
  for name, x in pairs(values) do list[name] = check.kind(x) == "enclosure" and mid(x) or x end
  return list
end

local function numbers(results, first, count)
  local list = {}
  for i = 1, count do list[i] = json.drawn(results[first + i].lo) end
  return json.raw("[" .. table.concat(list, ",") .. "]")
end

local function draw(view, shown, moving)
  local groups, all = drawn_groups(shown), {}
  for _, group in ipairs(groups) do
    append(all, group.list, 1, #group.list)
    view[group.name] = {}
  end
  local nominal = batch("real", {}, all)
  for i, t in ipairs(moving.t) do
    local results, first = nominal:run(t, midpoints(moving.at[i])), 0
    for _, group in ipairs(groups) do
      view[group.name][i] = numbers(results, first, #group.list)
      first = first + #group.list
    end
  end
end

local function draw_gravity(view, m, moving)
  view.gravity = numbers(batch("real", {}, model.field(m)):run(moving.t[1], midpoints(moving.at[1])), 0, 3)
end

-- -- the boxes

local function text_of(x)
  if x:is_empty() then return "[empty]" end
  return x:text(3)
end

local function texts(boxes, count)
  local list = {}
  for k = 1, count do
    list[k] = { text_of(boxes[3 * k - 2]), text_of(boxes[3 * k - 1]), text_of(boxes[3 * k]) }
  end
  return list
end

local function swept(enclosing, tubes)
  local hull
  for _, tube in ipairs(tubes) do
    local boxes = enclosing:run(tube.t, tube.values)
    for i, x in ipairs(hull and boxes or {}) do hull[i] = hull[i]:hull(x) end
    hull = hull or boxes
  end
  return hull
end

local function enclose(view, points, enclosing, moving)
  view.boxes, view.swept = {}, {}
  for i, t in ipairs(moving.t) do view.boxes[i] = texts(enclosing:run(t, moving.at[i]), #points) end
  for i, tubes in ipairs(moving.over) do
    view.swept[i] = tubes and texts(swept(enclosing, tubes), #points) or false
  end
end

-- -- the coordinates

-- Enclosures of the coordinates of a run; of a few, which a page has room for.
local function tell_coordinates(view, request, moving)
  local known = core.coordinates(request.mechanism.handle)
  view.coordinates, view.values = {}, {}
  if not request.run or #known > limits.coordinates then return end
  local names = {}
  for _, c in ipairs(known) do
    if check.kind(rawget(moving.at[1], c.name)) == "enclosure" then
      names[#names + 1] = c.name
      view.coordinates[#names] = { name = c.name, unit = c.unit }
    end
  end
  for i, values in ipairs(moving.at) do
    view.values[i] = {}
    for k, name in ipairs(names) do view.values[i][k] = text_of(values[name]) end
  end
end

-- -- putting it together

-- The points of the request, or the tips.
local function points_of(shown, request, notes)
  local list = {}
  for i, point in ipairs(request.points or {}) do
    local place = shown:place(point)
    list[i] = { name = point.name or shown.frames[place].name, frame = place }
  end
  if request.points then return list end
  for i = 1, math.min(#shown.tips, limits.points) do
    list[i] = { name = shown.frames[shown.tips[i]].name, frame = shown.tips[i] }
  end
  if #shown.tips > limits.points then
    notes[#notes + 1] = ("boxes of %d of %d tips; ambit.view { m, points = { ... } } chooses others"):format(
      limits.points, #shown.tips)
  end
  return list
end

-- How often something can be evaluated, at the price of the first time.
local function affordable(enclosing, start)
  local began = core.cpu()
  enclosing:run(start.t[1], start.at[1])
  return limits.seconds // (6 * math.max(core.cpu() - began, 1e-5))
end

-- What encloses the points, and at how many instants: in gradient arithmetic, which is tight where a position is
-- monotone, unless that takes too long.
local function enclosing_batch(shown, points, request, start, notes)
  local list = {}
  for _, point in ipairs(points) do append(list, shown.frames[point.frame].pose, 10, 12) end
  local wanted = math.max(2, math.min(limits.instants, limits.positions // #shown.frames))
  local choice = request.arithmetic or #core.leaves(list) <= limits.unknowns and "gradient" or "interval"
  local enclosing = batch(choice, request.options or {}, list)
  local count = affordable(enclosing, start)
  if count < wanted and not request.arithmetic and choice ~= "interval" then
    enclosing = batch("interval", {}, list)
    count = affordable(enclosing, start)
  end
  count = math.tointeger(math.max(2, math.min(count, wanted)))
  if count < limits.instants then
    notes[#notes + 1] = ("%d instants instead of %d, because there are %d frames"):format(count + 1,
      limits.instants + 1, #shown.frames)
  end
  return enclosing, count
end

-- The run of a mechanism cannot be shown with another one; that of an ambit.ode can, if it has such states.
local function check_run(m, run, question)
  local other = question.system.mechanism
  if other and other ~= m then check.fail("view: the run is one of mechanism `%s`, not of `%s`", other.name, m.name) end
  local known = {}
  for _, name in ipairs(run.states) do known[name] = true end
  for _, c in ipairs(core.coordinates(m.handle)) do
    if known[c.name] then return end
  end
  check.fail("view: the run says nothing about mechanism `%s`: its states are %s", m.name, table.concat(run.states,
    ", "))
end

local function moving_of(request, count)
  if request.run then return motion.of_run(request.run, request.question, request.at, count) end
  return motion.given(request.mechanism, request.at, request.times, count)
end

local function plain(list, ...)
  local copies = {}
  for i, entry in ipairs(list) do
    copies[i] = {}
    for _, key in ipairs { ... } do
      local value = entry[key]
      copies[i][key] = type(value) == "number" and value - 1 or value -- the page counts frames from 0
    end
  end
  return copies
end

local function describe_shape(view, shown, points)
  view.frames, view.lines = plain(shown.frames, "name", "kind"), plain(shown.lines, "a", "b", "kind", "name")
  view.axes, view.bodies = plain(shown.axes, "frame", "kind", "name"), plain(shown.bodies, "frame", "kind", "name")
  view.points = plain(points, "name", "frame")
end

local function facts_of(view, request, enclosing, moving)
  local facts, run = {}, request.run
  if run then
    facts[1] = { "solver", ("%s over %s"):format(run.solver, run.arithmetic) }
    facts[2] = { "time", ("%.9g s to %.9g s"):format(run.t_start, run.t_reached) }
    facts[3] = { "steps", moving.again and ("%d, then %d in a second run, for this page"):format(run.step_count,
      moving.again) or tostring(run.step_count) }
  end
  facts[#facts + 1] = { "boxes", ("position in %s arithmetic"):format(enclosing.arithmetic) }
  facts[#facts + 1] = { "instants", tostring(#moving.t) }
  view.facts = facts
end

local function status_of(view, request, notes)
  local run = request.run
  if run then
    view.code = run.code
    view.status, view.reason, view.proved = run.status, run.status ~= "complete" and run.reason or "", run.rigorous
    return
  end
  view.status, view.reason, view.proved = request.times and "given motion" or "one configuration", "", true
  local free = {}
  for _, c in ipairs(core.coordinates(request.mechanism.handle)) do
    if not request.at[c.name] then free[#free + 1] = c.name end
  end
  if #free > 0 then
    local more = #free > 6 and (" and %d more"):format(#free - 6) or ""
    notes[#notes + 1] = ("no simulation of it in the scene: drawn with %s at rest%s"):format(table.concat(free, ", ",
      1, math.min(6, #free)), more)
  end
  for _, line in ipairs(view.lines) do
    if line.kind == "closure" then
      notes[#notes + 1] = "loops are drawn as the coordinates leave them, which need not close them"
      break
    end
  end
end

-- request: { mechanism, run, question (what simulate was asked), points, at, times, arithmetic, options, title } -> a
-- table for view_json
function data.of(request)
  local m, notes, view = request.mechanism, {}, {}
  if request.run then check_run(m, request.run, request.question) end
  local shown = model.of(m)
  local points = points_of(shown, request, notes)
  local enclosing, count = enclosing_batch(shown, points, request, moving_of(request, 0), notes)
  local moving = moving_of(request, count)
  view.title, view.mechanism, view.notes = request.title or m.name, m.name, notes
  describe_shape(view, shown, points)
  status_of(view, request, notes)
  facts_of(view, request, enclosing, moving)
  view.t = {}
  for i, t in ipairs(moving.t) do view.t[i] = core.literal(t) end
  draw(view, shown, moving)
  draw_gravity(view, m, moving)
  tell_coordinates(view, request, moving)
  enclose(view, points, enclosing, moving)
  return view
end

return data
