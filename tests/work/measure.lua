-- measure.lua -- the counted work of the problems: { [name] = { [count] = number } }. Bytes are not among the counts:
-- they depend on how wide a processor's vectors are.
local core = require "ambit.core"
local session = require "ambit.session"

local measure = { counts = { "steps" } }

for _, entry in ipairs(core.work) do
  if entry[1] ~= "allocated" then measure.counts[#measure.counts + 1] = entry[1] end
end

-- The counts of all verbs that run() asks for.
function measure.one(run)
  local sums = {}
  session.verbs = {}
  run()
  for _, count in ipairs(measure.counts) do
    local sum = 0
    for _, verb in ipairs(session.verbs) do sum = sum + verb.report[count] end
    sums[count] = sum
  end
  return sums
end

return measure
