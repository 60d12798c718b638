-- reduce/certify/curve.lua -- the proved error of each output over time, for pictures.
local couple = require "ambit.reduce.certify.couple"
local values = require "ambit.reduce.certify.values"

local curve = {}

-- About the reduced model and about the detailed one: both hold.
local function one(detailed, reduced, s, settings)
  local instants = values.instants(s.times, settings.nodes or 100)
  local c = { name = s.name, status = "unable", reason = "", t = {}, error = {} }
  for _, output in ipairs(detailed.outputs) do c.error[output.name] = {} end
  for _, about in ipairs { "reduced", "detailed" } do
    local result = values.all(couple.of(detailed, reduced, s, about), settings, instants)
    if result.status == "complete" then c.status = "complete" else c.reason = result.reason end
    for j, row in ipairs(result.value) do
      c.t[j] = instants[j]
      for k, output in ipairs(detailed.outputs) do
        local list, e = c.error[output.name], row[k]:mag()
        list[j] = list[j] and math.min(list[j], e) or e
      end
    end
  end
  return c
end

local function same_times(a, b)
  for j, t in ipairs(a) do
    if b[j] ~= t then return false end
  end
  return #a == #b
end

-- -> { t = {}, error = { [output] = {} } }: the greatest over all scenarios with the times of the first; scenarios = {
-- { name, status, reason, t, error } }, empty where a run was not complete
function curve.of(detailed, reduced, scenarios, settings)
  local total = { t = {}, error = {}, scenarios = {} }
  for i, s in ipairs(scenarios) do
    local c = one(detailed, reduced, s, settings)
    total.scenarios[i] = c
    if i == 1 then
      total.t = table.move(c.t, 1, #c.t, 1, {})
      for name, list in pairs(c.error) do total.error[name] = table.move(list, 1, #list, 1, {}) end
    elseif same_times(total.t, c.t) then
      for name, list in pairs(c.error) do
        for j, x in ipairs(list) do total.error[name][j] = math.max(total.error[name][j], x) end
      end
    end
  end
  return total
end

return curve
