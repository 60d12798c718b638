-- plot/csv.lua -- a course as comma-separated values: each row an instant, or the time between two of them.
local csv = {}

-- Names are the scene's: quoted, and no spreadsheet takes them for a formula.
local function cell(text)
  text = tostring(text):gsub("%c", " ")
  if text:find "^[=+%-@]" then text = "'" .. text end
  return text:find '[",]' and ('"%s"'):format(text:gsub('"', '""')) or text
end

local function number(x) return x == x and ("%.17g"):format(x) or "" end

local function row(from, to, course, i, of)
  local cells = { number(from), number(to) }
  for k in ipairs(course) do
    local bounds = of(course[k])
    local known = bounds.lo[i] and bounds.lo[i] <= bounds.hi[i] and not bounds.partial[i]
    cells[#cells + 1], cells[#cells + 2] = known and number(bounds.lo[i]) or "", known and number(bounds.hi[i]) or ""
  end
  return table.concat(cells, ",")
end

function csv.text(course, quantities)
  local head = { "t_from", "t_to" }
  for _, q in ipairs(quantities) do
    local name = q.unit ~= "" and ("%s [%s]"):format(q.name, q.unit) or q.name
    head[#head + 1], head[#head + 2] = cell(name .. " lo"), cell(name .. " hi")
  end
  local lines = { table.concat(head, ",") }
  local lo, hi = course.t_lo, course.t_hi
  if #lo > 1 and lo[#lo] < lo[1] then lo, hi = hi, lo end
  for i in ipairs(course.t) do
    lines[#lines + 1] = row(lo[i], hi[i], course, i, function(c) return c end)
    if lo[i + 1] then lines[#lines + 1] = row(hi[i], lo[i + 1], course, i, function(c) return c.tube end) end
  end
  return table.concat(lines, "\n") .. "\n"
end

return csv
