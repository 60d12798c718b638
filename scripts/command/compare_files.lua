-- compare_files.lua -- what `ambit compare` writes besides its tables: CSV, JSON lines, a picture.
local compare = require "ambit.compare"
local core = require "ambit.core"
local picture = require "ambit.compare.picture"

local files = {}

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

local function write(name, text)
  local file = assert(io.open(name, "w"))
  local written, problem = file:write(text)
  local closed, late = file:close()
  if not (written and closed) then error(("cannot write %s: %s"):format(name, problem or late), 0) end
end

-- Said before anything is computed: the file that cannot be written.
function files.problem(options)
  local used = {}
  for _, key in ipairs { "csv", "svg", "json" } do
    local name = options[key]
    if name and used[name] then return ("--%s and --%s name the same file, %s"):format(used[name], key, name) end
    if name then used[name] = key end
    if name and not (key == "json" and name == "-") then
      local there = io.open(name)
      if there then there:close() end
      local file, problem = io.open(name, "a")
      if not file then return ("cannot write the file of --%s: %s"):format(key, problem) end
      file:close()
      if not there then os.remove(name) end
    end
  end
end

-- -- CSV (RFC 4180), one line for each combination and result

local columns = { "comparison", "place", "arithmetic", "options", "rigorous", "status", "reason", "result", "lo", "hi",
  "width", "over_tightest", "over_sample", "partial", "seconds_run", "seconds_build", "repeats" }

local function cell(value)
  if value == nil then return "" end
  local text = math.type(value) == "float" and core.literal(value) or tostring(value)
  if text:find '[",\r\n]' then text = '"' .. text:gsub('"', '""') .. '"' end
  return text
end

local function line_of(fields)
  local cells = {}
  for i, name in ipairs(columns) do cells[i] = cell(fields[name]) end
  return table.concat(cells, ",") .. "\r\n"
end

local function options_text(options)
  local list = {}
  for i = 1, #options, 2 do list[#list + 1] = options[i] .. "=" .. options[i + 1] end
  return table.concat(list, " ")
end

local function fields_of(comparison, number, row)
  local fields = { comparison = number, place = comparison.place, options = options_text(row.options),
    rigorous = row.rigorous and "yes" or "no", partial = row.enclosures and (row.partial and "yes" or "no") }
  for _, key in ipairs { "arithmetic", "status", "reason", "over_tightest", "over_sample", "seconds_run",
    "seconds_build", "repeats" } do fields[key] = row[key] end
  return fields
end

local function csv_lines(list)
  local lines = { table.concat(columns, ",") .. "\r\n" }
  for number, comparison in ipairs(list) do
    for _, row in ipairs(comparison.rows) do
      local fields = fields_of(comparison, number, row)
      if not row.enclosures then lines[#lines + 1] = line_of(fields) end
      for i, set in ipairs(row.enclosures or {}) do
        fields.result, fields.width = comparison.paths[i], row.widths[i]
        fields.status, fields.reason = compare.status_of(set), nil
        fields.lo, fields.hi = nil, nil -- the empty set has no bounds
        if not set:is_empty() then fields.lo, fields.hi = set.lo, set.hi end
        lines[#lines + 1] = line_of(fields)
      end
    end
  end
  return lines
end

local function write_csv(list, name) write(name, table.concat(csv_lines(list))) end

-- -- JSON lines

local function write_json(list, name, file, settings)
  core.records_open(name)
  local status, seconds = "complete", 0
  for number, comparison in ipairs(list) do
    compare.write_records(comparison, number)
    if comparison.status ~= "complete" then status = comparison.status end
    seconds = seconds + comparison.cpu_seconds
  end
  core.record("result", { "verb", "compare", "scene", file, "status", status, "comparisons", #list, "cpu_seconds",
    seconds, "settings", { "repeats", settings.repeats, "limit", settings.limit, "n", settings.n, "seed",
      settings.seed } })
  core.records_close()
end

-- -- picture

local no_gnuplot = [[
the picture needs gnuplot, which is not on the PATH (Debian, Ubuntu: apt install gnuplot-nox); all else is written]]

local function draw(script)
  local source = os.tmpname()
  write(source, script)
  local pipe = assert(io.popen(("gnuplot '%s'"):format(source)))
  local text = pipe:read "a"
  local drawn = pipe:close()
  os.remove(source)
  if not drawn or text == "" then error("gnuplot could not draw the picture", 0) end
  return text
end

local function write_svg(list, name, file)
  if not os.execute "command -v gnuplot >/dev/null 2>&1" then error(no_gnuplot, 0) end
  local title = ("%s: width against run time"):format(file:match "[^/]*$")
  local script, left_out = picture.script(list, title)
  if left_out > 0 then
    io.stderr:write(("note: the picture shows the first %d comparisons of %d\n"):format(#list - left_out, #list))
  end
  write(name, draw(script))
end

-- Writes what the options ask for, as much as it can; true: something could not be written, and was complained about.
function files.write(list, file, options, settings)
  local failed = false
  local function try(write, name)
    if not name then return end
    local good, problem = pcall(write, list, name, file, settings)
    if not good then
      failed = true
      complain(problem)
    end
  end
  try(write_csv, options.csv)
  try(write_json, options.json)
  try(write_svg, options.svg)
  return failed
end

return files
