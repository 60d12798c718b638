-- matrix.lua -- the metatable of tables of expressions that ambit.evaluate takes and gives back in the same shape. Such
-- a table prints what is in it: lists in brackets, rows one below the other, names in their order.
local check = require "ambit.check"

local Matrix = { __name = "matrix", is_shape = true }

local function entries(self)
  local list = {}
  for i = 1, #self do list[i] = tostring(self[i]) end
  for _, key in ipairs(check.sorted(self)) do
    if type(key) == "string" then list[#list + 1] = ("%s = %s"):format(key, tostring(self[key])) end
  end
  return list
end

function Matrix.__tostring(self)
  if type(self[1]) ~= "table" then return "{ " .. table.concat(entries(self), ", ") .. " }" end
  local rows = {}
  for i, row in ipairs(self) do rows[i] = "  { " .. table.concat(entries(row), ", ") .. " }" end
  return "{\n" .. table.concat(rows, ",\n") .. "\n}"
end

return Matrix
