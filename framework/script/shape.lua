-- shape.lua -- tables of any shape: their leaves as one list, and the same shape again around the results.
local check = require "ambit.check"
local core = require "ambit.core"

local shape = {}

-- What may stand for a number.
function shape.is_datum(value)
  local kind = check.kind(value)
  return kind == "number" or kind == "string" or kind == "expression" or kind == "enclosure"
end

-- flatten(value, what) -> { expression, ... }, { path, ... }, rebuild(results): the shape with results[i] for leaf i.
function shape.flatten(value, what)
  local leaves, paths, open = {}, {}, {}
  local function walk(node, path)
    if shape.is_datum(node) then
      leaves[#leaves + 1] = core.expression(node, nil, path == "" and what or what .. ": " .. path)
      paths[#paths + 1] = path
      return #leaves
    end
    local meta = getmetatable(node)
    if type(node) ~= "table" or (meta and not meta.is_shape) then
      check.fail("%s: %sexpected an expression or a table of them, got %s", what, path == "" and "" or path .. ": ",
        check.kind(node))
    end
    if open[node] then check.fail("%s: the table contains itself", what) end
    open[node] = true
    local copy = setmetatable({}, meta and meta.is_shape ~= "plain" and meta or nil)
    for _, key in ipairs(check.sorted(node)) do
      rawset(copy, key, walk(node[key], path == "" and tostring(key) or path .. "." .. tostring(key)))
    end
    open[node] = nil
    return copy
  end
  local template = walk(value, "")
  local function rebuild(results, node)
    node = node == nil and template or node
    if math.type(node) == "integer" then return results[node] end
    local copy = setmetatable({}, getmetatable(node))
    for key, child in next, node do rawset(copy, key, rebuild(results, child)) end
    return copy
  end
  return leaves, paths, rebuild
end

return shape
