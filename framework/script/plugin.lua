-- plugin.lua -- ambit.plugins(): what there is, without loading it; ambit.plugin(kind, name): one, loaded, with its
-- functions.
local check = require "ambit.check"
local core = require "ambit.core"

local plugin = {}

local kinds = { "arithmetic", "element", "solver", "service" }

local function check_kind(kind)
  for _, known in ipairs(kinds) do if kind == known then return end end
  check.fail('unknown kind of plugin `%s`%s', tostring(kind), check.suggest(kind, kinds))
end

-- plugins() -> { { kind, name, file, loaded }, ... }; plugins(kind): those of a kind, also by name:
-- plugins("arithmetic").affine
function plugin.plugins(kind)
  if kind == nil then return core.list() end
  check_kind(kind)
  local some = {}
  for _, entry in ipairs(core.list()) do
    if entry.kind == kind then
      some[#some + 1] = entry
      some[entry.name] = entry
    end
  end
  return some
end

local loaded = {}

-- Exported functions are in .fn: ambit.plugin("service", "fit").fn.slope(...)
function plugin.plugin(kind, name)
  check_kind(kind)
  local id = kind .. "." .. check.text(name, "plugin: name")
  if loaded[id] then return loaded[id] end
  local p = core.plugin(kind, name)
  p.fn, p.functions = core.exports(kind, name)
  setmetatable(p.fn, {
    __index = function(fn, key)
      check.fail('plugin %s exports no function `%s`%s', id, tostring(key), check.suggest(key, check.sorted(fn)))
    end,
  })
  loaded[id] = p
  return p
end

-- trust { folder, ..., shadow = true }: what `ambit --trust FOLDER --allow-shadow` says, for a program that hosts Ambit
-- in a Lua state. It holds for the whole process, and for plugins that are loaded from then on.
function plugin.trust(t)
  check.table(t, "trust")
  check.keys(t, { "shadow" }, "trust", #t)
  if t.shadow ~= nil and type(t.shadow) ~= "boolean" then
    check.fail("trust: shadow: expected true or false, got %s", type(t.shadow))
  end
  for i, folder in ipairs(t) do core.trust(check.text(folder, ("trust: folder %d"):format(i))) end
  if t.shadow then core.allow_shadow() end
end

return plugin
