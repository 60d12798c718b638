-- tree.lua -- what a mechanism consists of, as the user built it: chains within chains, parts within them, and the
-- names that say so ("robot.left.knee").
--
-- A scope is the inside of one chain while it is being built (the outermost one: the mechanism itself). Parts get the
-- scope's path in front of their names; the kernel keeps the full names unique, a scope its own.
local check = require "ambit.check"
local core = require "ambit.core"

local tree = {}

local DEEPEST = 50 -- chains within chains

local function new_scope(node, path, parent)
  return { node = node, path = path, parent = parent, names = {}, count = {}, depth = parent and parent.depth + 1 or 0 }
end

-- The scope in which parts are being added.
function tree.scope(self)
  if not self.scope then
    self.scope = new_scope({ name = self.name, type = "mechanism", parts = {} }, "", nil)
    self.root, self.listed = self.scope, 0
  end
  return self.scope
end

-- Parts that were added since the last call belong to the present scope.
local function catch_up(self)
  local scope = tree.scope(self)
  for part = self.listed + 1, core.part_count(self.handle) - 1 do
    local path, declared = core.part_name(self.handle, part), self.declared[part]
    local own = path:sub(1, #scope.path) == scope.path and path:sub(#scope.path + 1) or path
    local node = { name = own, path = path, type = declared and declared.name or "part", part = part,
      where = declared and self.places[part] }
    table.insert(scope.node.parts, node)
    scope.names[own] = node
    self.listed = part
  end
  return scope
end

local function who(node)
  return ("%s `%s`%s"):format(node.type, node.path, node.where and (" (%s)"):format(node.where) or "")
end

local function free_name(scope, type)
  local name
  repeat
    scope.count[type] = (scope.count[type] or 0) + 1
    name = type .. scope.count[type]
  until not scope.names[name]
  return name
end

-- The parameters t of a part of that type, with its full name; t itself where nothing is to be changed.
function tree.named(self, type, t)
  local scope = catch_up(self)
  if check.kind(t) ~= "table" and check.kind(t) ~= "vector" then return t end
  local name = rawget(t, "name")
  if name ~= nil and check.kind(name) ~= "string" then return t end
  local other = name and scope.names[name]
  if other and other.parts then
    check.fail("%s `%s`: the name is taken by the %s", type, scope.path .. name, who(other))
  end
  if scope == self.root then return t end
  local copy = setmetatable({}, getmetatable(t))
  for key, value in next, t do rawset(copy, key, value) end
  rawset(copy, "name", scope.path .. (name or free_name(scope, type)))
  return copy
end

local function check_name(scope, name, type)
  check.text(name, type .. ": name")
  if name == "" then check.fail("%s: the name is empty", type) end
  if name:find "%c" then check.fail("%s: the name has a control character", type) end
  if name:find "'$" then check.fail("%s `%s`: a name cannot end in `'`: that marks time derivatives", type, name) end
  local other = scope.names[name]
  if other then check.fail("%s `%s`: the name is taken by the %s", type, scope.path .. name, who(other)) end
end

-- Goes into a new chain; leaves it when the returned value is closed, also by an error.
function tree.enter(self, type, name, doc)
  local outer = catch_up(self)
  if name ~= nil then check_name(outer, name, type) end
  name = name or free_name(outer, type)
  if outer.depth >= DEEPEST then
    check.fail("%s: chains within chains, %d deep (%s.%s): does `%s` build itself without end?", type, DEEPEST,
      outer.path:sub(1, 40) .. "..", name, type)
  end
  local path = outer.path .. name
  local node = { name = name, path = path, type = type, doc = doc, where = core.where():gsub(": $", ""), parts = {} }
  table.insert(outer.node.parts, node)
  outer.names[name] = node
  self.scope = new_scope(node, path .. ".", outer)
  return setmetatable(self.scope, {
    __close = function()
      catch_up(self)
      self.scope = outer
    end,
  })
end

local function copy_of(node)
  local copy = {}
  for key, value in pairs(node) do copy[key] = value end
  if node.parts then
    copy.parts = {}
    for i, part in ipairs(node.parts) do copy.parts[i] = copy_of(part) end
  end
  return copy
end

-- m:tree() -> { name, type = "mechanism", parts = { { name, path, type, where, part }, { ..., parts = {...} }, ... } }:
-- `part` is a part's number, `parts` what a chain consists of.
tree.methods = {}

function tree.methods:tree()
  catch_up(self)
  return copy_of(self.root.node)
end

return tree
