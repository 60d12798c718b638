-- explain/text.lua -- what `ambit explain` prints: the five levels of leaving out, memory and time, in columns.
local explain_parts = require "ambit.explain.parts"
local explain_tree = require "ambit.explain.tree"

local explain = {}

local WIDTH = 110
local MOST = 12 -- verbs, libraries or data of a kind that are listed one by one

local function percent(part, whole) return whole > 0 and ("%.0f %%"):format(100 * part / whole) or "-" end

local function bytes(n)
  if n >= 1e6 then return ("%.1f MB"):format(n / 1e6) end
  return ("%.0f kB"):format(n / 1e3)
end

local function seconds(s)
  if s >= 1 then return ("%.2f s"):format(s) end
  return s >= 1e-3 and ("%.1f ms"):format(1e3 * s) or ("%.0f us"):format(1e6 * s)
end

-- Words behind a label, in lines of a readable length.
local function write_words(write, label, words)
  local row, lines = "", {}
  for _, word in ipairs(words) do
    if #row + #word > WIDTH - 20 then lines[#lines + 1], row = row, "" end
    row = row .. (row == "" and "" or " ") .. word
  end
  lines[#lines + 1] = row
  for i, text in ipairs(lines) do write("  %-16s %s\n", i == 1 and label or "", text) end
end

-- -- 1: the process

-- Names by kind, a line for each.
local function write_kinds(write, label, plugins, is_loaded)
  local first = label
  for _, kind in ipairs { "arithmetic", "solver", "element", "service" } do
    local words = {}
    for _, plugin in ipairs(plugins) do
      if plugin.kind == kind and plugin.loaded == is_loaded then words[#words + 1] = plugin.name end
    end
    if #words > 0 then
      table.insert(words, 1, ("%d %s%s:"):format(#words, kind, #words == 1 and "" or "s"))
      write_words(write, first, words)
      first = ""
    end
  end
  if first ~= "" then write_words(write, label, { "none" }) end
end

local function write_plugins(write, facts)
  local loaded, spared = 0, 0
  for _, plugin in ipairs(facts.plugins) do
    loaded = loaded + (plugin.loaded and 1 or 0)
    if not plugin.loaded then spared = spared + plugin.bytes end
  end
  write("  %d of %d plugins loaded, %d left out (%s of files)\n", loaded, #facts.plugins, #facts.plugins - loaded,
    bytes(spared))
  write_kinds(write, "loaded:", facts.plugins, true)
  write_kinds(write, "left out:", facts.plugins, false)
end

local function write_modules(write, facts)
  write("  %d of %d modules of Lua read\n", #facts.modules, facts.module_count)
  local names = {}
  for i, name in ipairs(facts.modules) do names[i] = name:match "^ambit%.(.*)" end
  write_words(write, "read:", #names > 0 and names or { "none" })
end

local function write_libraries(write, facts)
  local names, mapped, resident, large = {}, 0, 0, {}
  for i, library in ipairs(facts.libraries) do
    names[i], large[i] = library.name, library
    mapped, resident = mapped + library.mapped, resident + library.resident
  end
  write("  %d shared libraries, %s mapped, %s of it in memory\n", #names, bytes(mapped), bytes(resident))
  write_words(write, "libraries:", names)
  table.sort(large, function(a, b) return a.resident > b.resident end)
  local words = {}
  for i = 1, math.min(4, #large) do words[i] = ("%s %s"):format(large[i].name, bytes(large[i].resident)) end
  write_words(write, "largest:", { table.concat(words, ", ") })
end

-- -- 2: quantities

local function write_mechanism(write, tree)
  write("\n mechanism \"%s\": %d parts, %d of %d quantities built, %d left out (%s); %d coordinate%s%s\n", tree.name,
    tree.count, tree.built, tree.available, tree.available - tree.built,
    percent(tree.available - tree.built, tree.available), tree.coordinates, tree.coordinates == 1 and "" or "s",
    tree.mass and "; " .. explain_tree.text_of_mass(tree.mass) or "")
  local built, none = {}, {}
  for _, q in ipairs(tree.quantities) do
    if q.built > 0 then
      built[#built + 1] = ("%s %d of %d,"):format(q.name, q.built, q.available)
    else
      none[#none + 1] = ("%s (%d),"):format(q.name, q.available)
    end
  end
  for _, list in ipairs { built, none } do
    if #list > 0 then list[#list] = list[#list]:sub(1, -2) end
  end
  write_words(write, "built:", #built > 0 and built or { "nothing" })
  write_words(write, "never asked for:", none)
  explain_parts.write(write, tree)
end

-- -- 3: nodes

local function by(report)
  local arithmetic = (report.arithmetic or "") ~= "" and " in " .. report.arithmetic or ""
  return arithmetic .. (report.solver and " by " .. report.solver or "")
end

local function title(i, verb)
  return ("%d. %s%s"):format(i, verb.verb, by(verb.report))
end

-- Those at both ends of a long list, with "..." between; column(i, verb) writes a line.
local function write_verbs(write, verbs, column)
  for i, verb in ipairs(verbs) do
    if #verbs <= MOST or i <= MOST - 2 or i == #verbs then column(i, verb) end
    if #verbs > MOST and i == MOST - 1 then write("  ... and %d more alike\n", #verbs - MOST + 1) end
  end
end

local function write_nodes(write, facts)
  local all = facts.answers
  write("  %d operations were asked for: %d were there already (%s), %d folded away (%s); %d nodes in the graph\n",
    all.asked, all.shared, percent(all.shared, all.asked), all.folded, percent(all.folded, all.asked), all.nodes)
  if #facts.verbs == 0 then return end
  write("  %-40s %8s %8s %8s %8s %8s %9s %9s\n", "", "asked", "shared", "folded", "nodes", "on tape", "constants",
    "left out")
  write_verbs(write, facts.verbs, function(i, verb)
    local r, own = verb.report, verb.own
    local on_tape = r.tape_slots or 0
    write("  %-40s %8d %8d %8d %8d %8s %9s %9s\n", title(i, verb), own.asked, own.shared, own.folded,
      verb.answers.nodes, r.tape_slots and on_tape or "-", r.tape_constants or "-",
      r.tape_slots and r.graph_nodes and percent(math.max(0, r.graph_nodes - on_tape), r.graph_nodes) or "-")
  end)
end

-- -- 4: coefficients and data

-- "load.mass [95, 105], not needed": where it is known of all verbs what they computed with
local function range_text(facts, datum)
  local text, known = datum.label, #facts.verbs > 0
  if datum.range then text = ("%s %s"):format(text, datum.range:text(6)) end
  for _, verb in ipairs(facts.verbs) do known = known and verb.request end
  return known and #datum.verbs == 0 and text .. " (not needed)" or text
end

local function write_uncertain(write, facts)
  local words = {}
  for _, datum in ipairs(facts.data) do
    if datum.kind == "uncertain" then words[#words + 1] = range_text(facts, datum) .. "," end
  end
  if #words == 0 then return end
  local more = #words - MOST
  if more > 0 then
    words[MOST + 1] = ("... and %d more"):format(more)
    for i = #words, MOST + 2, -1 do words[i] = nil end
  else
    words[#words] = words[#words]:sub(1, -2)
  end
  write_words(write, "uncertain:", words)
end

local function write_data(write, facts)
  local c = facts.data.counts
  write("  %d data: %d fixed (also those of no width), %d uncertain, %d varying with time or state\n", #facts.data,
    c.fixed, c.uncertain, c.varying)
  write_uncertain(write, facts)
end

local function count(n) return n and ("%d"):format(n) or "-" end

-- Variables: uncertain data that a verb computed with; those that no datum names are of parts (play).
local function write_variables(write, facts)
  if #facts.verbs == 0 then return end
  write("  %-40s %9s %9s %9s %12s %12s %9s %12s\n", "", "variables", "of data", "of parts", "coefficients",
    "zero, spared", "left out", "const. slots")
  write_verbs(write, facts.verbs, function(i, verb)
    local r = verb.report
    local all = (r.coefficients or 0) + (r.skipped or 0)
    local has = all > 0
    write("  %-40s %9s %9s %9s %12s %12s %9s %12s\n", title(i, verb), count(r.unknowns), count(verb.named),
      count(verb.nameless), has and count(r.coefficients) or "-", has and count(r.skipped) or "-",
      has and percent(r.skipped, all) or "-", has and count(r.constant_slots) or "-")
  end)
end

-- -- 5: terms

local function field(settings, key)
  for i = 1, #(settings or {}), 2 do
    if settings[i] == key then return settings[i + 1] end
  end
end

local function write_terms(write, facts)
  local asked = false
  for i, verb in ipairs(facts.verbs) do
    local before, after = field(verb.settings, "terms_before"), field(verb.settings, "terms_after")
    if before then
      asked = true
      write("  %-40s %d of %d terms cut (%s), each with a proof; %d proofs\n", title(i, verb), before - after, before,
        percent(before - after, before), field(verb.settings, "proofs") or 0)
    end
  end
  if not asked then write "  not asked for: the scene has no ambit.reduce\n" end
end

-- -- verbs, memory, time

-- "suggested: stiff with interval, as here: ..." of a simulate
local function write_suggestion(write, verb)
  local s = verb.suggestion
  if s then
    write("     best suited: %s with %s%s: %s\n", s.solver, s.arithmetic,
      s.solver == verb.report.solver and ", as here" or "", s.reason)
  end
end

-- Who else was asked, where the first choice was not good enough.
local function write_tried(write, verb)
  for _, try in ipairs(verb.tried or {}) do
    write("     tried: %s%s: %s\n", try.solver, try.pieces and (" in %d parts"):format(try.pieces) or "", try.outcome)
  end
end

local function write_verb(write, i, verb)
  local r = verb.report
  local ended = verb.code == "ok" and verb.status or ("%s, %s"):format(verb.status, verb.code)
  local words = { ("%d. %s (%s)%s"):format(i, verb.verb, ended, by(r)) }
  local function add(value, text)
    if (value or 0) > 0 then words[#words + 1] = ("%d %s%s"):format(value, text, value == 1 and "" or "s") end
  end
  add(r.states, "state")
  add(r.tape_instructions, "instruction")
  add(r.steps, "step")
  words[#words + 1] = seconds(verb.cpu_seconds)
  words[#words + 1] = ("%s in memory, %s at most"):format(bytes(verb.resident), bytes(verb.peak))
  write("  %s\n", table.concat(words, ", "))
  write_suggestion(write, verb)
  write_tried(write, verb)
end

local function write_times(write, facts)
  local words = {}
  for i, entry in ipairs(facts.times) do
    words[i] = ("%s %s%s"):format(entry[1], seconds(entry[2]), i < #facts.times and "," or "")
  end
  write_words(write, "CPU time:", words)
  write("  %-16s %s at the start, %s at the end, %s at most\n", "memory:", bytes(facts.resident_start),
    bytes(facts.resident), bytes(facts.peak))
end

function explain.write(write, facts)
  local function heading(text) write("\n%s\n", text) end
  write("%s: %d verb%s%s\n", facts.file, #facts.verbs, #facts.verbs == 1 and "" or "s",
    facts.problem and ", ended by an error" or "")
  write_verbs(write, facts.verbs, function(i, verb) write_verb(write, i, verb) end)
  write_times(write, facts)
  heading "1  In the process"
  write_plugins(write, facts)
  write_modules(write, facts)
  write_libraries(write, facts)
  heading "2  Quantities"
  if #facts.mechanisms == 0 then write "  the scene has no mechanism\n" end
  for _, tree in ipairs(facts.mechanisms) do write_mechanism(write, tree) end
  heading "3  Nodes of the graph"
  write_nodes(write, facts)
  heading "4  Taylor coefficients and uncertain data"
  write_data(write, facts)
  write_variables(write, facts)
  heading "5  Terms cut by model reduction"
  write_terms(write, facts)
end

return explain
