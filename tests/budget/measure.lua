-- measure.lua -- the numbers of one scene that a budget pins, read from the lines of `ambit explain --json`.
--
-- Counts only: they are the same on every machine that computes the same results. Memory is a ceiling, in MB.
local cjson = require "cjson"

local measure = {}

-- What every process has, and what a sanitizer brings along: not the scene's.
local common = { "^ld%-linux", "^ld%-musl", "^libc%.", "^libm%.", "^libdl%.", "^libpthread%.", "^librt%.", "^libgcc_s",
  "^libstdc%+%+", "^libasan", "^libubsan", "^liblsan", "^libclang_rt" }

local function is_common(name)
  for _, pattern in ipairs(common) do
    if name:find(pattern) then return true end
  end
  return false
end

-- Sums over all verbs of what their reports count.
local summed = { "tape_slots", "tape_instructions", "unknowns", "coefficients", "operations", "steps",
  "allocations_run" }

local read = {}

function read.available(m, record)
  if record.loaded == 0 then return end
  m.plugins = m.plugins + 1
  m.here[#m.here + 1] = record.kind .. "." .. record.name
end

function read.library(m, record)
  if is_common(record.name) then return end
  m.libraries = m.libraries + 1
  m.here[#m.here + 1] = record.name
end

function read.modules(m, record)
  m.modules = record.read
  for name in record.names:gmatch "%S+" do m.here[#m.here + 1] = "lua." .. name end
end

function read.mechanism(m, record) m.quantities = m.quantities + record.pulled end

function read.datum(m, record) m.uncertain = m.uncertain + (record.kind == "uncertain" and 1 or 0) end

function read.graph(m, record) m.nodes, m.asked = record.nodes, record.asked end

function read.verb(m, record)
  for _, key in ipairs(summed) do m[key] = m[key] + (record.report[key] or 0) end
end

function read.memory(m, record) m.megabytes = record.peak / 1e6 end

function read.result(m, record) m.status, m.reason = record.status, record.reason end

-- Runs `ambit explain --json SCENE`, on one thread: each has contexts of its own -> { plugins =, libraries =, ...,
-- here = { what is loaded } }, or nil and why not.
function measure.scene(ambit, scene)
  local pipe = assert(io.popen(("AMBIT_THREADS=1 '%s' explain --json '%s' 2>/dev/null"):format(ambit, scene)))
  local m = { plugins = 0, libraries = 0, modules = 0, quantities = 0, uncertain = 0, here = {} }
  for _, key in ipairs(summed) do m[key] = 0 end
  for line in pipe:lines() do
    local good, record = pcall(cjson.decode, line)
    if not good then
      pipe:close()
      return nil, line
    end
    if read[record.record] then read[record.record](m, record) end
  end
  pipe:close()
  if m.status ~= "complete" then return nil, m.reason or "it ended without a result" end
  return m
end

-- The order in which counts are written; by rounding, the last ones may differ a little between processors.
measure.counts = { "plugins", "libraries", "modules", "quantities", "uncertain", "unknowns", "asked", "nodes",
  "tape_slots", "tape_instructions", "allocations_run", "steps", "coefficients", "operations" }
measure.slack = { steps = 1.02, coefficients = 1.02, operations = 1.02 }

return measure
