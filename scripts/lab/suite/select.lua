-- suite/select.lua -- which cases, and which of their combinations, are run.
local case = require "ambit.suite.case"
local check = require "ambit.check"
local over = require "ambit.suite.over"
local provenance = require "ambit.provenance"

local select_cases = {}

local modules = { "ambit.suite.stiff", "ambit.suite.chaotic", "ambit.suite.extreme" }

-- All cases that come with Ambit.
function select_cases.own()
  local list = {}
  for _, name in ipairs(modules) do
    for _, entry in ipairs(require(name)) do list[#list + 1] = entry end
  end
  return list
end

-- A user's file of cases: it returns a list of them.
function select_cases.file(name)
  local chunk, problem = provenance.load(name)
  if not chunk then error(problem, 0) end
  local list = chunk()
  if type(list) ~= "table" or #list == 0 then
    check.fail("stability: %s: expected it to return a list of cases, got %s", name,
      type(list) == "table" and "an empty one" or check.kind(list))
  end
  return list
end

local function check_name(wanted, known, option)
  if wanted and not known[wanted] then
    check.fail("stability: --%s: nothing is called `%s`%s", option, wanted, check.suggest(wanted, check.sorted(known)))
  end
end

-- The combinations of a case that are asked for.
local function chosen(entry, wanted)
  local one, list = entry.case, {}
  if wanted.group and one.group ~= wanted.group or wanted.case and one.name ~= wanted.case then return list end
  for _, c in ipairs(entry.combinations) do
    local plugin = c.solver or c.arithmetic
    local short = one.quick == true or one.quick and one.quick[plugin]
    if (not wanted.solver or plugin == wanted.solver) and (not wanted.quick or short) then list[#list + 1] = c end
  end
  return list
end

-- Cases as their authors wrote them -> { { case, combinations }, ... }; wanted: { quick, group, case, solver }
function select_cases.of(list, wanted)
  local read, groups, names, solvers = {}, {}, {}, {}
  for i, entry in ipairs(list) do
    local one = case.read(entry)
    if names[one.name] then check.fail("stability: two cases are called `%s`", one.name) end
    read[i] = { case = one, combinations = over.of(one) }
    case.check_names(one, read[i].combinations)
    groups[one.group], names[one.name] = true, true
    for _, c in ipairs(read[i].combinations) do solvers[c.solver or c.arithmetic or ""] = true end
  end
  solvers[""] = nil
  check_name(wanted.group, groups, "group")
  check_name(wanted.case, names, "case")
  check_name(wanted.solver, solvers, "solver")
  local selected = {}
  for _, entry in ipairs(read) do
    local combinations = chosen(entry, wanted)
    if #combinations > 0 then selected[#selected + 1] = { case = entry.case, combinations = combinations } end
  end
  return selected
end

return select_cases
