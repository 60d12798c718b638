-- explain/graph.lua -- the scene as a graph in the language of Graphviz: parts and what they hang on, quantities that
-- were built of them, verbs that needed these, solvers and arithmetics. What is left out is grey and dashed.
--
-- Every node has a class, by which a style sheet can colour it, and a tool tip with its numbers.
local explain_tree = require "ambit.explain.tree"

local explain = {}

local VERBS = 12 -- shown one by one

local function quoted(text)
  return '"' .. tostring(text):gsub("\\", "\\\\"):gsub('"', '\\"'):gsub("\n", "\\n") .. '"'
end

local left_style = 'style="rounded,dashed", color="gray60", fontcolor="gray50"'

-- A graph being written: lines, and the tool tip of every node.
local function new_graph() return { lines = {}, tips = {}, count = 0 } end

local function emit(g, format, ...) g.lines[#g.lines + 1] = format:format(...) end

-- Adds a node; `left`: it is left out. Returns its name.
local function node(g, class, label, tip, left, more)
  g.count = g.count + 1
  local name = "n" .. g.count
  g.tips[name] = tip
  emit(g, "  %s [label=%s, class=%s, tooltip=%s%s%s];", name, quoted(label), quoted(left and "left" or class),
    quoted(tip), left and ", " .. left_style or "", more and ", " .. more or "")
  return name
end

local function edge(g, from, to, tip, left)
  emit(g, "  %s -> %s [tooltip=%s%s];", from, to, quoted(tip),
    left and ', class="left", style=dashed, color=gray60' or "")
end

local function begin_cluster(g, title)
  g.count = g.count + 1
  local name = "cluster_" .. g.count
  emit(g, "  subgraph %s { label=%s; tooltip=%s; class=\"group\"; color=gray70;", name, quoted(title), quoted(title))
  return name
end

local function end_cluster(g) emit(g, "  }") end

-- -- a mechanism

local function quantities_text(part)
  local built, none = {}, {}
  for _, q in ipairs(part.quantities) do
    table.insert(q.pulled and built or none, (q.port and q.port .. "." or "") .. q.name)
  end
  return ("built: %s\nnot built: %s"):format(#built > 0 and table.concat(built, ", ") or "nothing",
    #none > 0 and table.concat(none, ", ") or "nothing")
end

local function add_part(g, tree, part)
  local lines = { part.name }
  if part.name:gsub("%d+$", "") ~= part.type then lines[2] = part.type end
  if #part.coordinates > 0 then lines[#lines + 1] = "coordinate " .. table.concat(part.coordinates, ", ") end
  if part.mass then lines[#lines + 1] = explain_tree.text_of_mass(part.mass) end
  local tip = ("%s `%s`: %d of %d quantities built\n%s"):format(part.type, part.name, part.built, part.available,
    quantities_text(part))
  return node(g, part.closes and "loop" or part.is_joint and "joint" or "part", table.concat(lines, "\n"), tip,
    part.built == 0)
end

-- Parts that are not shown one by one are one node.
local function add_parts(g, tree)
  local shown, hidden = explain_tree.selection(tree)
  local names = { [0] = add_part(g, tree, tree[0]) }
  local rest = hidden.count > 0 and
    node(g, "more", ("... and %d more alike"):format(hidden.count), explain_tree.alike(hidden), true)
  for number = 1, tree.count - 1 do
    names[number] = shown[number] and add_part(g, tree, tree[number]) or rest
  end
  return names
end

local function add_links(g, tree, names)
  local seen = {}
  for number = 1, tree.count - 1 do
    local part = tree[number]
    for _, link in ipairs(part.on) do
      local from, to = names[link.part], names[number]
      local key = from .. to
      if from ~= to and not seen[key] then
        seen[key] = true
        edge(g, from, to, ("%s hangs on %s"):format(part.name, tree[link.part].name), part.built == 0)
      end
    end
  end
end

-- The quantities by name, and one node that stands for all that were built; its name. `from` is a part in the cluster.
local function add_quantities(g, tree, from, cluster)
  local names = {}
  local own = begin_cluster(g, "quantities")
  local sum = node(g, "sum", ("%d of %d\nquantities built"):format(tree.built, tree.available),
    ("%s: %d of %d quantities built, %d left out"):format(tree.name, tree.built, tree.available,
      tree.available - tree.built))
  for i, q in ipairs(tree.quantities) do
    names[i] = node(g, "quantity", ("%s %d of %d"):format(q.name, q.built, q.available),
      ("%s: built for %d of %d ports or parts that have it"):format(q.name, q.built, q.available), q.built == 0)
  end
  end_cluster(g)
  for i, name in ipairs(names) do
    if tree.quantities[i].built > 0 then edge(g, name, sum, tree.quantities[i].name) end
    emit(g, "  %s -> %s [%s];", from, name, i == (#names + 1) // 2 and
      ("ltail=%s, lhead=%s"):format(cluster, own) or "style=invis")
  end
  return sum
end

local function add_mechanism(g, tree)
  local cluster = begin_cluster(g, ("mechanism %s"):format(tree.name))
  local names = add_parts(g, tree)
  end_cluster(g)
  add_links(g, tree, names)
  return add_quantities(g, tree, names[tree.count - 1], cluster)
end

-- -- verbs and plugins

local function verb_label(number, verb)
  local r = verb.report
  local lines = { ("%d. %s"):format(number, verb.verb) }
  if r.tape_instructions and r.tape_instructions > 0 then
    lines[#lines + 1] = ("%d instructions"):format(r.tape_instructions)
  end
  if (r.steps or 0) > 0 then lines[#lines + 1] = ("%d steps"):format(r.steps) end
  if verb.status ~= "complete" then lines[#lines + 1] = verb.status end
  return table.concat(lines, "\n")
end

local function verb_tip(verb)
  local r, lines = verb.report, { verb.verb .. ": " .. verb.status }
  local function add(key, text) if (r[key] or 0) > 0 then lines[#lines + 1] = ("%d %s"):format(r[key], text) end end
  add("states", "states")
  add("unknowns", "uncertain data that became variables")
  add("graph_nodes", "nodes in the graph")
  add("tape_slots", "slots on the tape")
  add("tape_constants", "of them constants")
  add("tape_instructions", "of them instructions")
  add("constant_slots", "slots constant in time")
  add("coefficients", "Taylor coefficients computed")
  add("skipped", "known to be zero and skipped")
  add("steps", "steps")
  lines[#lines + 1] = ("peak memory %.1f MB"):format(verb.peak / 1e6)
  return table.concat(lines, "\n")
end

-- The mechanism whose quantities a verb took: that of its equations of motion; one that is the only one.
local function source(facts, verb)
  local m = verb.request and verb.request.system and verb.request.system.mechanism
  for i, tree in ipairs(facts.mechanisms) do
    if tree.mechanism == m or (#facts.mechanisms == 1 and not (verb.request and verb.request.system)) then return i end
  end
end

-- What was not loaded, of each kind as one node, in rows of a readable length.
local function add_left_out(g, plugins)
  begin_cluster(g, "not loaded")
  for _, kind in ipairs { "solver", "arithmetic", "element" } do
    local rows, row, count, bytes = {}, "", 0, 0
    for _, plugin in ipairs(plugins) do
      if plugin.kind == kind and not plugin.loaded then
        count, bytes = count + 1, bytes + plugin.bytes
        if #row > 28 then rows[#rows + 1], row = row, "" end
        row = row .. (row == "" and "" or " ") .. plugin.name
      end
    end
    rows[#rows + 1] = row
    local title = ("%d %s%s"):format(count, kind, count == 1 and "" or "s")
    if count > 0 then
      node(g, "more", title .. "\n" .. table.concat(rows, "\n"), ("%s not loaded, %d kB"):format(title, bytes // 1000),
        true)
    end
  end
  end_cluster(g)
end

-- The solvers and arithmetics that are loaded.
local function add_plugins(g, plugins)
  local names = {}
  for _, plugin in ipairs(plugins) do
    if plugin.loaded and (plugin.kind == "solver" or plugin.kind == "arithmetic") then
      names[plugin.kind .. plugin.name] = node(g, plugin.kind, ("%s\n%s"):format(plugin.kind, plugin.name),
        ("%s `%s`: loaded, %d kB"):format(plugin.kind, plugin.name, plugin.bytes // 1000))
    end
  end
  return names
end

local function add_verbs(g, facts, sums, plugins)
  for number, verb in ipairs(facts.verbs) do
    if number > VERBS then
      node(g, "more", ("... and %d more verbs"):format(#facts.verbs - VERBS), "not drawn one by one", true)
      return
    end
    local name, at = node(g, verb.status == "complete" and "verb" or "unable", verb_label(number, verb),
      verb_tip(verb)), source(facts, verb)
    if at then edge(g, sums[at], name, "quantities") end
    local solver = verb.report.solver and plugins["solver" .. verb.report.solver]
    local arithmetic = plugins["arithmetic" .. (verb.report.arithmetic or "")]
    if solver then edge(g, name, solver, "solved by") end
    if arithmetic then edge(g, solver or name, arithmetic, "computes in") end
  end
end

-- dot(facts) -> text, { [name of node] = tool tip }
function explain.dot(facts)
  local g, sums = new_graph(), {}
  emit(g, "digraph scene {")
  emit(g, "  label=%s; labelloc=t; rankdir=LR; bgcolor=transparent; compound=true; newrank=true;", quoted(facts.file))
  emit(g, '  fontname="Helvetica"; node [shape=box, style=rounded, fontname="Helvetica", fontsize=11];')
  emit(g, '  edge [fontname="Helvetica", fontsize=9, arrowsize=0.6];')
  for i, tree in ipairs(facts.mechanisms) do sums[i] = add_mechanism(g, tree) end
  add_verbs(g, facts, sums, add_plugins(g, facts.plugins))
  add_left_out(g, facts.plugins)
  emit(g, "}")
  return table.concat(g.lines, "\n") .. "\n", g.tips
end

return explain
