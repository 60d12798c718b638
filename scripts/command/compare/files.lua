-- compare/files.lua -- what `ambit compare` writes besides its tables: CSV, JSON lines, a picture, a page.
local compare_csv = require "ambit.command.compare.csv"
local compare_records = require "ambit.compare.records"
local core = require "ambit.core"
local outputs = require "ambit.command.outputs"
local picture = require "ambit.compare.picture"
local provenance = require "ambit.provenance"

local files = {}

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

-- Said before anything is computed: the file that cannot be written.
function files.problem(options) return outputs.problem(options, { "csv", "svg", "html", "json" }, { json = true }) end

local function write_csv(list, name) 
  outputs.write(name, provenance.lines("# ", "\r\n") .. compare_csv.text(list))
end

-- -- JSON lines

local function status_of(list)
  local status, seconds = "complete", 0
  for _, comparison in ipairs(list) do
    if comparison.status ~= "complete" then status = comparison.status end
    if comparison.interrupted then status = "stopped" end
    seconds = seconds + comparison.cpu_seconds
  end
  return status, seconds
end

local function write_json(list, name, file, settings)
  provenance.records(name)
  for number, comparison in ipairs(list) do compare_records.write(comparison, number) end
  local status, seconds = status_of(list)
  core.record("result", { "verb", "compare", "scene", file, "status", status, "comparisons", #list, "cpu_seconds",
    seconds, "settings", { "repeats", settings.repeats, "limit", settings.limit, "seed", settings.seed } })
  core.records_close()
end

-- -- picture and page

local function write_svg(list, name, file)
  local title = ("%s: %s against run time"):format(file:match "[^/]*$", picture.subject(list))
  local text, left_out = picture.text(list, title)
  if left_out > 0 then
    io.stderr:write(("note: the picture shows the first %d comparisons of %d\n"):format(#list - left_out, #list))
  end
  outputs.write(name, provenance.svg(text))
end

local function write_html(list, name, file) outputs.write(name, require "ambit.page.compare".of(list, file)) end

-- Writes what the options ask for, as much as it can; true: something could not be written, and was complained about.
-- engine:calm: Ctrl-C does not keep a file from being written.
function files.write(list, file, options, settings, engine)
  local failed = false
  local function try(write_one, name)
    if not name then return end
    local good, problem = pcall(engine.calm, engine, write_one, list, name, file, settings)
    if not good then
      failed = true
      complain(problem)
    end
  end
  try(write_csv, options.csv)
  try(write_json, options.json)
  try(write_html, options.html)
  try(write_svg, options.svg)
  return failed
end

return files
