-- reduce/mechanism.lua -- reduction of a mechanism by its elements: models of the mechanism built anew without some of
-- its parts, what each omission alone changes in the equations, and the rows of the report.
--
-- The detailed model is x' = f(x) of the mechanism as it is; that of a choice of candidates is x' = g(x) of a mechanism
-- built without them (reduce/mechanism_copy.lua). A joint that is locked takes its states with it: outputs then have
-- its given motion in their place, and its initial values are ignored by the reduced model. How good a copy is does not
-- matter for a certificate to hold: it compares the two systems of equations as they come out.
-- Limit: mechanisms with closed loops (or gears) are refused. Their coordinates are tied to each other, so that a part
-- that goes would change which of them are states.
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.reduce.element"
local copy = require "ambit.reduce.mechanism_copy"
local model = require "ambit.reduce.mechanism_model"

local Reduction = { __name = "reduction of a mechanism" }
Reduction.__index = Reduction

local reduction = {}

-- The name of a part that ties others to each other by equations of its own; the norm of a quaternion is its joint's.
local function closure_of(m)
  for part = 1, core.part_count(m.handle) - 1 do
    local ties, moves = false, false
    for _, port in ipairs(m.declared[part].outs) do
      ties, moves = ties or port.kind == "constraint", moves or port.kind == "frame"
    end
    if ties and not moves then return core.part_name(m.handle, part) end
  end
end

-- new(detailed MODEL, { elements, keep, outputs }, what) -> the candidates of its mechanism, .candidates. elements:
-- true or names of parts, keep: names of parts that stay as they are, outputs: as the user gave them to that model.
function reduction.new(detailed, options, what)
  local m = detailed.system and detailed.system.mechanism
  if not m then
    check.fail("%s: elements: `%s` is no mechanism: its parts are terms of equations; leave `elements` out", what,
      detailed.name)
  end
  local closure = closure_of(m)
  if closure then
    check.fail("%s: elements: the mechanism `%s` has closed loops or gears (`%s`): elements can be left out of trees \z
      only", what, m.name, closure)
  end
  local self = setmetatable({ mechanism = m, form = rawget(m, "cached_form") or "auto", detailed = detailed,
    outputs = options.outputs, what = what, named = options.elements ~= true }, Reduction)
  self.candidates = element.list(m, options.elements, options.keep)
  return self
end

function Reduction:chosen(cut)
  local list = {}
  for i, k in ipairs(cut) do list[i] = self.candidates[k] end
  return list
end

-- Why the equations of motion of what is left cannot be written: the kernel names the joint that moves no mass.
local function refusal(chosen, message)
  local names, place = {}, core.where()
  if message:sub(1, #place) == place then message = message:sub(#place + 1) end
  for _, c in ipairs(chosen) do
    if element.is_mass(c) then names[#names + 1] = ("`%s`"):format(c.name) end
  end
  local joint = message:match "joint `(.*)` moves no mass"
  if #names == 0 or not joint then return message end
  return ("%s cannot be left out: the motion of `%s` would have no inertia"):format(table.concat(names, ", "), joint)
end

-- The copy without some candidates, as reduce/mechanism_model.lua has it; nil: nothing moves in it.
function Reduction:copy(chosen)
  local m, leaves, motions = copy.build(self.mechanism, element.change(chosen))
  if #core.speeds(m.handle) == 0 then return nil end
  return { mechanism = m, leaves = leaves, motions = motions, system = core.dynamics(m.handle, self.form) }
end

-- The MODEL of the mechanism without the candidates `cut` (numbers), and that mechanism; nil and why: there is none.
function Reduction:without(cut)
  local chosen = self:chosen(cut)
  local good, result, m = pcall(function()
    local reduced = self:copy(chosen)
    if not reduced then return nil end
    return model.of(reduced, self.detailed, self.outputs, self.what), reduced.mechanism
  end)
  if not good then return nil, refusal(chosen, tostring(result)) end
  if not result then return nil, "nothing would be left that moves" end
  return result, m
end

-- -- what ambit.reduce works on (reduce/pass.lua)

-- What a choice of one candidate changes: { { number of a state, change of its rate }, ... }; a state that goes stands
-- still.
local function effects_of(m, reduced)
  local rate, zero, list = {}, core.expression(0), {}
  for i, name in ipairs(reduced.states) do rate[name] = reduced.rates[i] end
  for i, name in ipairs(m.states) do
    local change = (rate[name] or zero) - m.rates[i]
    if change ~= zero then list[#list + 1] = { i, change } end
  end
  return list
end

local techniques = { left = "left out", rigid = "rigid", locked = "locked", inertia = "without inertia",
  weight = "without weight" }

-- Has nothing been left of a candidate by another one: its part gone, its spring made rigid, or the joint that it locks
-- locked already? Of two that are cut and lock one joint the first counts (element.change).
local function leaves_nothing(other, c, counts)
  if other.part == c.part and other ~= c then
    return (other.kind == "left" and c.kind ~= "rigid") or (other.kind == "rigid" and c.kind == "left")
  end
  return c.joint ~= nil and other.joint == c.joint and counts
end

-- list(m, form) -> candidates of the model m, the detailed one, as reduce/candidate.lua has them; build(cut) -> the
-- model and the mechanism without those, or nil and why there is none; moot(k): has nothing been left of candidate k by
-- those that are cut? form(MODEL) -> the model as m is written. Of a list of names each must be able to go by itself.
function Reduction:list(m, form)
  local found, numbers = {}, {}
  for k, c in ipairs(self.candidates) do
    local reduced, reason = self:without { k }
    if not reduced and self.named then check.fail("%s: elements: %s", self.what, reason) end
    if reduced then
      local n = #found + 1
      numbers[n] = k
      found[n] = { equation = c.element, level = "element", text = ("%s %s"):format(c.type, techniques[c.kind]),
        technique = techniques[c.kind], replacement = c.replacement, effects = effects_of(m, reduced) }
    end
  end
  function found.build(cut)
    local chosen = {}
    for i, n in ipairs(cut) do chosen[i] = numbers[n] end
    if #chosen == 0 then return m, self.mechanism end
    local reduced, result = self:without(chosen)
    return reduced and form(reduced), result
  end
  function found.moot(k)
    for n, c in ipairs(found) do
      local counts = n < k or (n ~= k and found[k].status ~= "cut")
      if c.status == "cut" and leaves_nothing(self.candidates[numbers[n]], self.candidates[numbers[k]], counts) then
        return true
      end
    end
    return false
  end
  return found
end

return reduction
