-- explain/json.lua -- the same as records, one object a line.
local core = require "ambit.core"

local explain = {}

local keys = { "arithmetic", "solver", "expressions", "states", "parameters", "unknowns", "steps", "graph_nodes",
  "tape_slots", "tape_constants", "tape_instructions", "tape_runs", "constant_slots" }
for _, work in ipairs(core.work) do keys[#keys + 1] = work[1] end
for _, key in ipairs { "build", "graph", "tape", "context", "open", "run", "close" } do
  keys[#keys + 1] = "seconds_" .. key
end

-- { key, t[key], ... } of those that are there
local function fields_of(t, order)
  local list = {}
  for _, key in ipairs(order) do
    if t[key] ~= nil then list[#list + 1], list[#list + 2] = key, t[key] end
  end
  return list
end

local function append(list, ...)
  return table.move({ ... }, 1, select("#", ...), #list + 1, list)
end

local function write_process(facts)
  local loaded, left, libraries = {}, {}, {}
  for _, plugin in ipairs(facts.plugins) do
    table.insert(plugin.loaded and loaded or left, plugin.kind .. "." .. plugin.name)
  end
  for i, library in ipairs(facts.libraries) do libraries[i] = library.name end
  core.record("plugins", { "loaded", table.concat(loaded, " "), "left", table.concat(left, " "), "libraries",
    table.concat(libraries, " ") })
  for _, plugin in ipairs(facts.plugins) do
    core.record("available", { "kind", plugin.kind, "name", plugin.name, "loaded", plugin.loaded and 1 or 0, "bytes",
      plugin.bytes })
  end
  core.record("modules", { "read", #facts.modules, "available", facts.module_count, "names",
    table.concat(facts.modules, " ") })
  for _, library in ipairs(facts.libraries) do
    core.record("library", fields_of(library, { "name", "mapped", "resident" }))
  end
end

local function part_fields(tree, part)
  local on, built = {}, {}
  for i, link in ipairs(part.on) do on[i] = tree[link.part].name end
  for _, quantity in ipairs(part.quantities) do
    if quantity.pulled then built[#built + 1] = (quantity.port and quantity.port .. "." or "") .. quantity.name end
  end
  local list = { "mechanism", tree.name, "name", part.name, "type", part.type, "on", table.concat(on, " "), "pulled",
    part.built, "available", part.available, "built", table.concat(built, ", ") }
  if #part.coordinates > 0 then append(list, "coordinates", table.concat(part.coordinates, " ")) end
  if part.mass then append(list, "mass", part.mass) end
  if part.closes then append(list, "closes_loop", 1) end
  return list
end

local function write_mechanism(tree)
  core.record("mechanism", { "name", tree.name, "parts", tree.count, "pulled", tree.built, "available",
    tree.available, "coordinates", tree.coordinates, "loops", #tree.loops })
  for _, q in ipairs(tree.quantities) do
    core.record("quantity", { "mechanism", tree.name, "name", q.name, "pulled", q.built, "available", q.available })
  end
  for number = 1, tree.count - 1 do core.record("part", part_fields(tree, tree[number])) end
end

local function write_verb(number, verb)
  local list = { "number", number, "verb", verb.verb, "status", verb.status, "code", verb.code,
    "report", fields_of(verb.report, keys),
    "graph", fields_of(verb.own, { "asked", "shared", "folded", "nodes" }), "memory", verb.resident, "peak_memory",
    verb.peak }
  if verb.settings then append(list, "settings", verb.settings) end
  if verb.suggestion then
    append(list, "suggested", verb.suggestion.solver, "because", verb.suggestion.reason)
  end
  core.record("verb", list)
  for _, try in ipairs(verb.tried or {}) do
    local fields = { "verb", number, "solver", try.solver, "outcome", try.outcome }
    if try.pieces then append(fields, "pieces", try.pieces) end
    core.record("tried", fields)
  end
end

local function write_datum(datum)
  local list = { "name", datum.label, "kind", datum.kind, "verbs", table.concat(datum.verbs, " ") }
  if datum.range then append(list, "range", datum.range) end
  core.record("datum", list)
end

function explain.write(facts)
  require "ambit.provenance".records "-"
  write_process(facts)
  for _, tree in ipairs(facts.mechanisms) do write_mechanism(tree) end
  for _, datum in ipairs(facts.data) do write_datum(datum) end
  for number, verb in ipairs(facts.verbs) do write_verb(number, verb) end
  core.record("graph", fields_of(facts.answers, { "asked", "shared", "folded", "nodes" }))
  for _, entry in ipairs(facts.times) do core.record("stage", { "name", entry[1], "seconds", entry[2] }) end
  core.record("memory", { "start", facts.resident_start, "end", facts.resident, "peak", facts.peak })
  core.record("result", { "verb", "explain", "status", facts.problem and "failed" or "complete", "reason",
    facts.problem or "", "cpu_seconds", facts.cpu_end - facts.cpu_start })
  core.records_close()
end

return explain
