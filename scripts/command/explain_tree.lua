-- explain_tree.lua -- the model tree of a mechanism: its parts, what hangs on what, coordinates, masses, closed loops,
-- chains.
local core = require "ambit.core"
local element = require "ambit.element"

local explain = {}

local LEVELS = 30 -- deeper branches are not indented further

-- The parameter of that name of a part, as expressions; nil: it has none.
local function value_of(m, part, name)
  for i, param in ipairs(m.declared[part].parameters) do
    if param.name == name then
      local made = element.made(m, part)
      return made and made.values[i] or nil
    end
  end
end

-- The range of a datum; nil: it varies.
local function range_of(expression)
  if core.is_constant(expression) then return core.interval(expression) end
  local good, results = pcall(core.evaluate, "interval", {}, { expression }, {}, {})
  return good and results[1] or nil
end

-- { { port = "from", kind = "frame", part = 0 }, ... }: what the IN ports are connected to
local function connections(m, part)
  local list, made = {}, element.made(m, part)
  for i, port in ipairs(m.declared[part].ports) do
    local on = made and made.links[2 * i - 1]
    if port.role == "in" and on and on >= 0 then list[#list + 1] = { port = port.name, kind = port.kind, part = on } end
  end
  return list
end

local function has_port(declared, kind, role)
  for _, port in ipairs(declared.ports) do
    if port.kind == kind and port.role == role then return true end
  end
  return false
end

local function part_of(m, number)
  local declared = m.declared[number]
  local part = { part = number, name = core.part_name(m.handle, number), type = declared.name,
    on = connections(m, number), coordinates = {}, attached = {},
    carries = has_port(declared, "frame", "out"), closes = has_port(declared, "constraint", "out"),
    is_joint = has_port(declared, "joint", "out") }
  local mass = value_of(m, number, "mass")
  part.mass = mass and range_of(mass[1]) or nil
  part.pulled = core.part_pulled(m.handle, number)
  return part
end

-- tree(m) -> { parts by number, world, coordinates = count, loops = { part, ... } }
function explain.tree(m)
  local world = { part = 0, name = "world", type = "world", on = {}, coordinates = {}, attached = {}, carries = true }
  local tree = { [0] = world, count = core.part_count(m.handle), loops = {}, coordinates = 0, mass = nil }
  for number = 1, tree.count - 1 do
    local part = part_of(m, number)
    tree[number] = part
    if part.closes then tree.loops[#tree.loops + 1] = part end
    local carrier = part.on[1] and tree[part.on[1].part]
    if not part.closes and carrier then table.insert(carrier.attached, part) end
    if not part.closes and not carrier then table.insert(world.attached, part) end
    if part.mass then tree.mass = tree.mass and tree.mass + part.mass or part.mass end
  end
  for _, coordinate in ipairs(core.coordinates(m.handle)) do
    local part = coordinate.part and tree[coordinate.part]
    if part then table.insert(part.coordinates, coordinate.name) end
    tree.coordinates = tree.coordinates + 1
  end
  return tree
end

local function text_of_mass(mass)
  if mass:width() <= 1e-12 * mass:mag() then return ("%.6g kg"):format(mass:mid()) end
  return mass:text(5) .. " kg"
end

local function remarks(tree, part)
  local list = {}
  for i, link in ipairs(part.on) do
    list[#list + 1] = (i == 1 and "on " or "and ") .. tree[link.part].name
  end
  if #part.coordinates > 0 then
    list[#list + 1] = "coordinate " .. table.concat(part.coordinates, ", ")
  elseif part.is_joint then
    list[#list + 1] = "motion given"
  end
  if part.mass then list[#list + 1] = text_of_mass(part.mass) end
  return table.concat(list, "; ")
end

local function line(write, tree, part, depth)
  local name = ("  "):rep(math.min(depth, LEVELS) + 1) .. part.name
  write("%-44s %-14s %s\n", name, part.type, remarks(tree, part))
end

-- Depth first, without recursion: mechanisms may be deep. What is the only carrier on its carrier stays on its level.
local function write_parts(write, tree)
  local stack = { { tree[0], 0 } }
  while #stack > 0 do
    local part, depth = table.unpack(table.remove(stack))
    if part.part ~= 0 then line(write, tree, part, depth) end
    local carriers, ends = {}, {}
    for _, child in ipairs(part.attached) do table.insert(child.carries and carriers or ends, child) end
    for i = #carriers, 1, -1 do
      stack[#stack + 1] = { carriers[i], #carriers > 1 and part.part ~= 0 and depth + 1 or depth }
    end
    for i = #ends, 1, -1 do stack[#stack + 1] = { ends[i], part.part == 0 and depth or depth + 1 } end
  end
end

local function write_chains(write, nodes, depth)
  for _, node in ipairs(nodes) do
    if node.parts then
      write("  %s%s: %s, %d parts\n", ("  "):rep(depth), node.path, node.type, #node.parts)
      write_chains(write, node.parts, depth + 1)
    end
  end
end

local function has_chains(nodes)
  for _, node in ipairs(nodes) do
    if node.parts then return true end
  end
  return false
end

-- The parts of which nobody asked for anything, in lines of a readable length.
local function write_idle(write, tree)
  local idle = {}
  for number = 1, tree.count - 1 do
    if tree[number].pulled == 0 then idle[#idle + 1] = tree[number].name end
  end
  if #idle == 0 then return end
  write(" not built: nothing was asked of %d part%s\n", #idle, #idle == 1 and "" or "s")
  local line = " "
  for _, name in ipairs(idle) do
    if #line + #name > 100 then
      write("%s\n", line)
      line = " "
    end
    line = line .. " " .. name
  end
  write("%s\n", line)
end

-- Prints the tree of one mechanism.
function explain.write(write, m)
  local pulled, available = core.pulled(m.handle) -- before the tree is made: that asks for all coordinates
  local tree = explain.tree(m)
  write("\nmechanism \"%s\": %d parts, %d of %d quantities built, %d not; %d coordinate%s%s\n", m.name, tree.count,
    pulled, available, available - pulled, tree.coordinates, tree.coordinates == 1 and "" or "s",
    tree.mass and "; " .. text_of_mass(tree.mass) or "")
  write_parts(write, tree)
  local nodes = m:tree().parts
  if has_chains(nodes) then
    write " chains\n"
    write_chains(write, nodes, 0)
  end
  if #tree.loops > 0 then
    write " closed loops\n"
    for _, part in ipairs(tree.loops) do line(write, tree, part, 0) end
  end
  write_idle(write, tree)
end

-- The fields of the JSON object of a part.
local function fields(tree, part)
  local on = {}
  for i, link in ipairs(part.on) do on[i] = tree[link.part].name end
  local list = { "name", part.name, "type", part.type, "on", table.concat(on, " "), "pulled", part.pulled }
  if #part.coordinates > 0 then
    list[#list + 1], list[#list + 2] = "coordinates", table.concat(part.coordinates, " ")
  end
  if part.mass then list[#list + 1], list[#list + 2] = "mass", part.mass end
  if part.closes then list[#list + 1], list[#list + 2] = "closes_loop", true end
  return list
end

-- One record for the mechanism and one for each part.
function explain.record(m)
  local pulled, available = core.pulled(m.handle)
  local tree = explain.tree(m)
  core.record("mechanism", { "name", m.name, "parts", tree.count, "pulled", pulled, "available", available,
    "coordinates", tree.coordinates, "loops", #tree.loops })
  for number = 1, tree.count - 1 do
    local list = fields(tree, tree[number])
    table.insert(list, 1, m.name)
    table.insert(list, 1, "mechanism")
    core.record("part", list)
  end
end

return explain
