-- fresh.lua -- names for quantities that Ambit adds to a user's: a symbol is what its name says, so a name that the
-- user has given to something else would make one of two.

-- name, with as many ' behind it as it takes to be none of `used`, { [name] = true }, where it is written down
local function fresh(name, used)
  while used[name] do name = name .. "'" end
  used[name] = true
  return name
end

local function set(...)
  local used = {}
  for _, list in ipairs { ... } do
    for _, name in ipairs(list) do used[name] = true end
  end
  return used
end

return { name = fresh, set = set }
