-- page/ranges.lua -- enclosures that do not change over time, as bars: one table for each result, with the hull of the
-- samples behind the bars.
local columns = require "ambit.page.columns"
local compare_table = require "ambit.compare.table"
local html = require "ambit.report.html"
local number = require "ambit.page.number"

local ranges = {}

local FAR = 1       -- widths of the tightest beyond it, after which a bar is cut off
local open_at_most = 4

local function finite(lo, hi) return lo == lo and hi == hi and lo > -math.huge and hi < math.huge and lo <= hi end

-- The proved enclosures of result k: { label, lo, hi }
local function enclosures(rows, k)
  local list = {}
  for _, row in ipairs(rows) do
    local x = row.rigorous ~= false and row.enclosures and row.enclosures[k]
    if x then list[#list + 1] = { label = row.label, lo = x.lo, hi = x.hi } end
  end
  return list
end

-- What the bars are drawn across: all of them, but not far beyond the tightest.
local function scale(list)
  local low, high, best = math.huge, -math.huge, nil
  for _, entry in ipairs(list) do
    if finite(entry.lo, entry.hi) then
      low, high = math.min(low, entry.lo), math.max(high, entry.hi)
      if not best or entry.hi - entry.lo < best.hi - best.lo then best = entry end
    end
  end
  if not best or high - low <= 0 or high - low == math.huge then return nil end
  local room = FAR * (best.hi - best.lo)
  if room > 0 then low, high = math.max(low, best.lo - room), math.min(high, best.hi + room) end
  return low, high - low
end

local function bar(kind, lo, hi, low, width)
  local function share(x) return math.max(0, math.min(100, 100 * ((x - low) / width))) end
  local left, right = share(lo), share(hi)
  return html.tag("i", { class = kind, style = ("left: %.2f%%; width: %.2f%%"):format(left, right - left) })
end

local function bar_column(list, sample)
  local low, width = scale(list)
  return { title = "enclosure", kind = "picture", value = function(entry) return low and entry or nil end,
    sort = function(entry) return number.sort(entry.hi - entry.lo) end,
    cell = function(entry)
      local shown = finite(sample.lo, sample.hi) and bar("sampled", sample.lo, sample.hi, low, width) or ""
      local own = finite(entry.lo, entry.hi) and bar("proved", entry.lo, entry.hi, low, width) or ""
      return html.tag("span", { class = "bars", ["aria-hidden"] = "true" }, own, shown)
    end }
end

local function bounds_text(x, way)
  return x == x and math.abs(x) < math.huge and number.outward(x, 7, way) or number.plain(x)
end

local function bound(title, name, way)
  return columns.number(title, function(entry) return entry[name] end, function(x) return bounds_text(x, way) end)
end

local function result(comparison, k)
  local list = enclosures(comparison.rows, k)
  if #list == 0 then return "" end
  local found = comparison.sample
  local sample = found and found.lo and { lo = (found.lo[k] or {})[1] or 0 / 0, hi = (found.hi[k] or {})[1] or 0 / 0 }
    or { lo = 0 / 0, hi = 0 / 0 }
  local unit = (comparison.units or {})[k] or ""
  local title = compare_table.name_of(comparison.names[k]) .. (unit ~= "" and ", " .. unit or "")
  local shown = { columns.text("combination", function(entry) return entry.label end), bar_column(list, sample),
    bound("from", "lo", -1), bound("to", "hi", 1),
    columns.number("width", function(entry) return entry.hi - entry.lo end, number.up) }
  return html.tag("details", { open = k <= open_at_most or nil }, html.tag("summary", {}, html.text(title)),
    columns.table("enclosures of " .. title, columns.used(shown, list), list))
end

-- A card, or nothing if no row has enclosures at one instant.
function ranges.of(comparison)
  local parts = {}
  for k = 1, #(comparison.names or {}) do parts[k] = result(comparison, k) end
  local text = table.concat(parts)
  if text == "" then return "" end
  local note = comparison.sample and "Bars: proved. Inside of them, darker: the hull of the samples." or "Bars: proved."
  return html.card("ranges", "Enclosures", html.say("p", "quiet", note), text)
end

return ranges
