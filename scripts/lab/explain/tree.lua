-- explain/tree.lua -- the model tree of a mechanism: its parts, what hangs on what, coordinates, masses, closed loops,
-- and which of its quantities were built.
local core = require "ambit.core"
local element = require "ambit.element"

local explain = {}

local MOST = 60 -- parts that are shown one by one
local ALIKE = 8 -- of each type, where there are more
local TYPES = 12 -- and of so many types

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
  local good, results = pcall(core.evaluate, { expressions = { expression } })
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
  return part
end

-- Which quantities the part has and which were built: { name, built, available } by name, and in all.
local function count_quantities(tree, m, part)
  part.quantities, part.built, part.available = core.quantities(m.handle, part.part), 0, 0
  for _, quantity in ipairs(part.quantities) do
    local entry = tree.of[quantity.name]
    if not entry then
      entry = { name = quantity.name, built = 0, available = 0 }
      tree.of[quantity.name] = entry
      table.insert(tree.quantities, entry)
    end
    for _, count in ipairs { entry, part, tree } do
      count.available = count.available + 1
      count.built = count.built + (quantity.pulled and 1 or 0)
    end
  end
end

-- tree(m) -> { parts by number, world, count, coordinates = count, mass, loops = { part, ... }, idle = { part, ... },
-- quantities = { { name, built, available } }, built, available }
function explain.tree(m)
  local world = { part = 0, name = "world", type = "world", on = {}, coordinates = {}, attached = {}, carries = true }
  local tree = { [0] = world, mechanism = m, name = m.name, count = core.part_count(m.handle), loops = {},
    coordinates = 0, idle = {}, quantities = {}, of = {}, built = 0, available = 0 }
  count_quantities(tree, m, world)
  for number = 1, tree.count - 1 do
    local part = part_of(m, number)
    tree[number] = part
    count_quantities(tree, m, part)
    if part.built == 0 then table.insert(tree.idle, part) end
    if part.closes then tree.loops[#tree.loops + 1] = part end
    local carrier = part.on[1] and tree[part.on[1].part]
    if not part.closes and carrier then table.insert(carrier.attached, part) end
    if not part.closes and not carrier then table.insert(world.attached, part) end
    if part.mass then tree.mass = tree.mass and tree.mass + part.mass or part.mass end
  end
  for _, coordinate in ipairs(core.coordinates(m.handle)) do -- builds them all, so it comes last
    local part = coordinate.part and tree[coordinate.part]
    if part then table.insert(part.coordinates, coordinate.name) end
    tree.coordinates = tree.coordinates + 1
  end
  return tree
end

-- Which parts to show, where there are too many to read: shown by number, the others counted by type in order.
function explain.selection(tree)
  local shown, hidden, seen, types = {}, { count = 0 }, {}, 0
  for number = 1, tree.count - 1 do
    local part = tree[number]
    if not seen[part.type] then
      types = types + 1
      seen[part.type] = { type = part.type, count = 0, hidden = 0, rank = types }
    end
    local kind = seen[part.type]
    kind.count = kind.count + 1
    shown[number] = tree.count - 1 <= MOST or (kind.count <= ALIKE and kind.rank <= TYPES)
    if not shown[number] then
      if kind.hidden == 0 then hidden[#hidden + 1] = kind end
      kind.hidden, hidden.count = kind.hidden + 1, hidden.count + 1
    end
  end
  return shown, hidden
end

-- "492 revolute, 492 rigid_link"
function explain.alike(hidden)
  local words = {}
  for i, kind in ipairs(hidden) do
    words[i] = i <= TYPES and ("%d %s"):format(kind.hidden, kind.type) or nil
  end
  if #hidden > TYPES then words[TYPES + 1] = "..." end
  return table.concat(words, ", ")
end

function explain.text_of_mass(mass)
  if mass:width() <= 1e-12 * mass:mag() then return ("%.6g kg"):format(mass:mid()) end
  return mass:text(5) .. " kg"
end

return explain
