-- reduce/report_text.lua -- a reduction as text: the reduced equations, what was cut and kept, the proved errors, the
-- certificate. Errors are rounded up where digits are cut, so that what is printed is proved too.
local judge = require "ambit.reduce.report_judge"
local number = require "ambit.report.number"
local provenance = require "ambit.provenance"
local scenarios = require "ambit.reduce.report_scenario"
local compare_table = require "ambit.compare.table"

local text = { width = 100 }

local EQUATION_LINES = 4 -- of one equation at most
local ROWS = 24          -- of cut and of kept terms in the whole report; `table` has them all

local up, short = number.up, compare_table.short

-- -- what a cluster cost: the output that comes closest to its bound

function text.worst(self, effect)
  if type(effect) == "number" then effect = #self.outputs == 1 and { [self.outputs[1]] = effect } or nil end
  local worst, value, share
  for k, name in ipairs(self.outputs) do
    local error = effect and effect[name]
    if error and error == error and self.bounds[k] and (not share or error / self.bounds[k] > share) then
      worst, value, share = name, error, error / self.bounds[k]
    end
  end
  return worst, value, share
end

local function error_text(self, effect)
  local output, value, share = text.worst(self, effect)
  if not output then return "" end
  if value == math.huge then return "not proved" end
  local whole = #self.outputs > 1 and output .. ": " .. up(value) or up(value)
  return ("%s (%s of bound)"):format(whole, number.percent(share))
end

-- -- tables

-- Rows -> lines no wider than `width`: the columns that may shrink share what is missing, the widest first.
local function fitted(rows, columns, width)
  local cells, room = { {} }, {}
  for k, column in ipairs(columns) do cells[1][k] = column[1] end
  for i, row in ipairs(rows) do
    cells[i + 1] = {}
    for k, column in ipairs(columns) do cells[i + 1][k] = tostring(column[2](row) or "") end
  end
  local total = 2 * (#columns - 1)
  for k in ipairs(columns) do
    room[k] = 0
    for _, line in ipairs(cells) do room[k] = math.max(room[k], compare_table.length(line[k])) end
    total = total + room[k]
  end
  while total > width do
    local widest
    for k, column in ipairs(columns) do
      if column.shrinks and room[k] > 8 and (not widest or room[k] > room[widest]) then widest = k end
    end
    if not widest then break end
    room[widest], total = room[widest] - 1, total - 1
  end
  for _, line in ipairs(cells) do
    for k, cell in ipairs(line) do line[k] = short(cell, room[k]) end
  end
  return compare_table.aligned(cells, columns)
end

-- A column that is empty for every row is left out.
local function filled(rows, columns)
  local list = {}
  for _, column in ipairs(columns) do
    local needed = false
    for _, row in ipairs(rows) do
      local cell = column[2](row)
      needed = needed or cell ~= nil and cell ~= ""
    end
    if needed then list[#list + 1] = column end
  end
  return list
end

local function term_columns(self, last, of_last)
  return {
    { "equation", function(row) return row.equation end, left = true, shrinks = true },
    { "level", function(row) return row.level ~= 1 and row.level or nil end },
    { "term", function(row) return row.text end, left = true, shrinks = true },
    { "technique", function(row) return row.technique end, left = true },
    { "replaced by", function(row) return row.replacement end, left = true, shrinks = true },
    { "rank", function(row) return row.rank and number.rank(row.rank) end },
    { last, of_last or function(row) return error_text(self, row.effect) end, left = true, shrinks = true },
  }
end

local function with_status(self, wanted)
  local list = {}
  for _, term in ipairs(self.terms) do
    if term.status == wanted then list[#list + 1] = term end
  end
  return list
end

local function why_kept(self)
  return function(row)
    local _, _, share = text.worst(self, row.effect)
    if row.technique == "branch" then return "its switch may be crossed" end
    if not row.effect then return "not tried" end
    if not share then return "no proof within bound" end
    return (share > 1 and "would be " or "was ") .. error_text(self, row.effect)
  end
end

local function append(lines, more, indent)
  for _, line in ipairs(more) do lines[#lines + 1] = (indent or "") .. line end
end

local function terms_lines(self, width, most)
  local lines = {}
  local function section(title, status, columns)
    local rows = with_status(self, status)
    if #rows == 0 then return end
    lines[#lines + 1] = title:format(#rows)
    local shown = table.move(rows, 1, math.min(#rows, most), 1, {})
    append(lines, fitted(shown, filled(shown, columns), width - 2), "  ")
    if #rows > most then lines[#lines + 1] = ("  ... and %d more: result:table()"):format(#rows - most) end
  end
  section("cut: %d, by rank and proved error with it", "cut", term_columns(self, "error with it"))
  section("gone with equations that no output needs: %d", "removed", term_columns(self, "", function() end))
  section("kept: %d, by rank and error without it", "kept", term_columns(self, "why kept", why_kept(self)))
  return lines
end

function text.terms(self, width) return table.concat(terms_lines(self, width, math.huge), "\n") end

-- -- equations

-- "d x/dt = ..." on several lines, cut at spaces where there are some.
local function wrapped(line, width)
  local lines, indent = {}, "      "
  while compare_table.length(line) > width and #lines < EQUATION_LINES - 1 do
    local head = line:sub(1, width)
    local space = head:match "^.*() " or width
    if space < width // 2 then space = width end
    lines[#lines + 1] = line:sub(1, space):gsub("%s+$", "")
    line = indent .. line:sub(space + 1)
  end
  lines[#lines + 1] = short(line, width)
  return lines
end

local function equation_lines(self, width)
  local lines, data, model = {}, scenarios.data(self), self.model
  for i, rate in ipairs(scenarios.named(data, model.rates)) do
    append(lines, wrapped(("d %s/dt = %s"):format(model.states[i], tostring(rate)), width - 2), "  ")
  end
  for _, output in ipairs(model.outputs) do
    local known = tostring(scenarios.named(data, { output.expression })[1])
    if known ~= output.name then append(lines, wrapped(("%s = %s"):format(output.name, known), width - 2), "  ") end
  end
  return lines
end

-- -- the head, the errors, the decisions

local function left(after, before, what) return before and ("%d of %d %s"):format(after, before, what) end

local function head(self)
  local sizes = {}
  for _, what in ipairs { "terms", "equations", "operations" } do
    sizes[#sizes + 1] = left(self[what .. "_after"], self[what .. "_before"], what)
  end
  local line = ("%s: %s are left"):format(self.status, table.concat(sizes, ", "))
  return self.status ~= "complete" and (self.reason or "") ~= "" and line .. ": " .. self.reason or line
end

-- The scenario that has the greatest error of an output, and when.
local function where_worst(self, name)
  local found
  for _, s in ipairs(self.scenarios) do
    local error = s.error[name]
    if error and (not found or error > found.error[name]) then found = s end
  end
  if not found then return "" end
  local when = found.when and found.when[name]
  local place = #self.scenarios > 1 and found.name or ""
  if not when then return place end
  return ("t = %s s%s"):format(number.time(when), place ~= "" and ", " .. place or "")
end

local function errors(self, width)
  local rows = {}
  for k, name in ipairs(self.outputs) do rows[k] = { name = name, error = self.error[name], bound = self.bounds[k] } end
  return fitted(rows, filled(rows, {
    { "output", function(row) return row.name end, left = true, shrinks = true },
    { "error", function(row) return row.error and up(row.error) or "not proved" end },
    { "bound", function(row) return row.bound and number.short(row.bound) end },
    { "used", function(row) return row.error and row.bound and number.percent(row.error / row.bound) end },
    { "worst near", function(row) return where_worst(self, row.name) end, left = true, shrinks = true },
  }), width - 2)
end

local function errors_of(self, error)
  local list = {}
  for _, name in ipairs(self.outputs) do
    if error and error[name] then list[#list + 1] = ("%s %s"):format(name, up(error[name])) end
  end
  return #list > 0 and ": " .. table.concat(list, ", ") or ""
end

function text.decisions(self)
  local lines = {}
  for i, entry in ipairs(self.log or {}) do
    lines[i] = ("%d. pass %s: %s %s%s"):format(i, tostring(entry.pass), entry.outcome,
      table.concat(entry.candidates, "; "), errors_of(self, entry.error))
  end
  return table.concat(lines, "\n")
end

-- -- the certificate

local definition = {
  difference = "max over all times and all data of |y - y of the reduced model|, both on the same data",
  bounds = "max over the nodes of what infimum and supremum of y are off by (Mikelsons and Brandt 2009, eq. 19)",
}

-- { "order", "12", ... } -> "order = 12"
local function options_text(list)
  local parts = {}
  for i = 1, #list, 2 do parts[#parts + 1] = ("%s = %s"):format(list[i], tostring(list[i + 1])) end
  return table.concat(parts, ", ")
end

local function proof_of(s)
  local with = { s.solver or nil, s.arithmetic or nil }
  local line = ("%s with %s"):format(s.status or "proved", #with > 0 and table.concat(with, " over ") or "no solver")
  if s.steps then line = ("%s, %d steps"):format(line, s.steps) end
  if s.cpu_seconds then line = ("%s, %s"):format(line, compare_table.seconds(s.cpu_seconds)) end
  return s.reason and s.reason ~= "" and line .. ": " .. s.reason or line
end

local function search_lines(self, add)
  add("search", ("ranking %s, %s, %s"):format(self.ranking, self.strategy == "predicted" and "clusters by prediction"
    or ("clusters within a factor of %s"):format(tostring(self.cluster)), number.count(self.proofs or 0, "proof")))
end

local function time_text(self)
  local spent = ("%s in all"):format(compare_table.seconds(self.cpu_seconds or 0))
  if not self.cpu_seconds_rank then return spent end
  return ("%s, %s for ranking"):format(spent, compare_table.seconds(self.cpu_seconds_rank))
end

local function certificate(self, width)
  local lines = {}
  local function add(name, value) append(lines, wrapped(("%-12s%s"):format(name, value), width - 2), "  ") end
  add("criterion", ("%s: %s"):format(self.criterion, definition[self.criterion]))
  for k, s in ipairs(self.scenarios) do
    add("scenario", s.name)
    append(lines, scenarios.lines(self, self.given[k], width - 6), "    ")
    append(lines, wrapped(proof_of(s), width - 6), "    ")
  end
  if #self.settings.options > 0 then add("options", options_text(self.settings.options)) end
  if self.criterion == "bounds" then add("nodes", tostring(self.settings.nodes)) end
  if self.ranking then search_lines(self, add) end
  add("time", time_text(self))
  append(lines, provenance.tail(), "  ")
  return lines
end

-- The errors and the certificate: what there is of a proof without a search.
function text.proof(self)
  local lines = {}
  append(lines, errors(self, text.width), "  ")
  append(lines, certificate(self, text.width))
  return lines
end

-- How well the rankings did, if there is something to judge them by.
local function judged(self)
  local lines, line, pass = {}, nil, nil
  if not judge.is_possible(self) then return lines end
  lines[1] = "rank against exact effect (Spearman's correlation)"
  for _, row in ipairs(judge.of(self)) do
    local said = ("%s %s"):format(row.ranking, row.correlation and ("%.2f"):format(row.correlation) or "undecided")
    if row.pass == pass then
      lines[line] = ("%s, %s"):format(lines[line], said)
    else
      line, pass = #lines + 1, row.pass
      lines[line] = ("  %s, %s: %s"):format(pass, number.count(row.candidates, "candidate"), said)
    end
  end
  return lines
end

function text.whole(self)
  local lines = { head(self) }
  append(lines, equation_lines(self, text.width))
  lines[#lines + 1] = "proved errors"
  append(lines, errors(self, text.width), "  ")
  append(lines, terms_lines(self, text.width, ROWS))
  append(lines, judged(self))
  lines[#lines + 1] = "certificate"
  append(lines, certificate(self, text.width))
  return table.concat(lines, "\n")
end

return text
