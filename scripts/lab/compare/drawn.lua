-- compare/drawn.lua -- what of comparisons goes into a picture: which quantity across, which rows in which style, what
-- is said of those that cannot be drawn (failures, widths that are zero, infinite or beyond the axis).
local compare_axis = require "ambit.report.axis"
local compare_table = require "ambit.compare.table"
local colours = require "ambit.report.svg".colours
local judge = require "ambit.compare.judge"

local drawn = {}

local notes_at_most = 12

local markers = { "circle", "square", "up", "diamond", "down", "pentagon", "open square", "open circle" }

local function of_simulation(comparison)
  local key, inner = judge.telling(comparison.rows, comparison.measure, { "width_max", "over_sample_max" }), 0
  if key == "error" then return key, "largest distance from the reference", nil end
  if key == "over_sample_max" then return key, "largest overestimation at any time: width / sampled width", 1 end
  if key == "width_max" then return key, "largest width of " .. drawn.list(comparison.names) .. " at any time", nil end
  local sample = comparison.sample
  for k in ipairs(sample and sample.lo or {}) do
    inner = math.max(inner, sample.hi[k][#sample.t] - sample.lo[k][#sample.t])
  end
  return "width", "largest width of " .. drawn.list(comparison.names) .. " at the end", inner > 0 and inner or nil
end

local function of_evaluation(comparison)
  local names, inner = comparison.names, comparison.sample and comparison.sample.width
  if #names == 1 then
    return "width", comparison.paths[1] == "" and "width of the enclosure" or "width of " .. names[1], inner
  end
  if comparison.measure == "over_sample" then
    return "over_sample", ("largest overestimation of %s: width / sampled width"):format(drawn.list(names)), 1
  end
  return "width", "largest width of " .. drawn.list(names), inner
end

-- "x, y", or how many there are
function drawn.list(names)
  local text = table.concat(names, ", ")
  return #text > 40 and ("%d results"):format(#names) or text
end

-- What goes across: the key of the row, the title, where the samples are (or nil).
function drawn.measure(comparison)
  return (comparison.verb == "simulate" and of_simulation or of_evaluation)(comparison)
end

local function drawable(row, key)
  return (row.rigorous or key == "error") and row.status == "complete" and row[key] and compare_axis.on_axis(row[key])
      and row.seconds_run and row.seconds_run > 0
end

-- One style for each family, in the order of first appearance; families of one arithmetic
-- or solver differ in their dashes.
function drawn.styles(comparisons)
  local styles, methods, count = {}, {}, 0
  for _, comparison in ipairs(comparisons) do
    local key = drawn.measure(comparison)
    for _, row in ipairs(comparison.rows) do
      if drawable(row, key) and not styles[row.family] then
        local method = row.solver or row.arithmetic
        local base = methods[method]
        if not base then
          base = { number = count % #colours + 1, families = 0 }
          methods[method], count = base, count + 1
        end
        base.families = base.families + 1
        styles[row.family] = { colour = colours[base.number], marker = markers[base.number],
          dash = (base.families - 1) % 5 + 1, axis = row.axis,
          name = row.axis and not row.solver and ("%s, by %s"):format(row.family, row.axis) or row.family }
        styles[#styles + 1] = styles[row.family]
      end
    end
  end
  return styles
end

local function note_of(row, key)
  if row.reason then return ("%s: %s: %s"):format(row.label, row.status, row.reason) end
  if not row.rigorous then return nil end
  if row.width == 0 then
    return ("%s: exact, width 0, in %s"):format(row.label, compare_table.seconds(row.seconds_run))
  end
  if row[key] and not compare_axis.on_axis(row[key]) then
    return ("%s: %.3g is beyond the axis"):format(row.label, row[key])
  end
end

function drawn.notes(comparisons)
  local notes = {}
  for i, comparison in ipairs(comparisons) do
    local key = drawn.measure(comparison)
    for _, row in ipairs(comparison.rows) do
      local note = not drawable(row, key) and note_of(row, key)
      if note then notes[#notes + 1] = (#comparisons > 1 and ("%d. "):format(i) or "") .. note end
    end
  end
  if #notes > notes_at_most then
    notes[notes_at_most] = ("... and %d more, see the table"):format(#notes - notes_at_most + 1)
    for i = #notes, notes_at_most + 1, -1 do notes[i] = nil end
  end
  return notes
end

-- The families of a comparison, each a list of rows by rising order.
function drawn.families(comparison, key)
  local families = {}
  for _, row in ipairs(comparison.rows) do
    if drawable(row, key) then
      if not families[row.family] then
        families[row.family] = {}
        families[#families + 1] = families[row.family]
      end
      table.insert(families[row.family], row)
    end
  end
  for _, family in ipairs(families) do
    table.sort(family, function(a, b) return (tonumber(a.value) or 0) < (tonumber(b.value) or 0) end)
  end
  return families
end

-- The time of what proves nothing: a line across, unless it has a place of its own.
function drawn.reference(comparison)
  if comparison.measure == "error" then return nil end
  for _, row in ipairs(comparison.rows) do
    if not row.rigorous and row.seconds_run and row.seconds_run > 0 then return row end
  end
end

return drawn
