-- scene.lua -- running a script the way `lua` would: its words in `arg`, errors with a traceback of the script's own
-- lines.
local scene = {
  leave = {}, -- raised where os.exit may not end the process
}

-- Lines of the traceback that a user can do something about: not Ambit's own, not the command's.
local function readable(trace)
  local lines = {}
  for line in trace:gmatch "[^\n]+" do
    if not line:find("(ambit) ", 1, true) and not line:find("[C]: in", 1, true) and not line:find("^%s*%[C%]") then
      lines[#lines + 1] = line
    end
  end
  return #lines > 1 and table.concat(lines, "\n") or nil
end

local function explain(message)
  if message == scene.leave then return message end
  if type(message) ~= "string" then
    local meta = getmetatable(message)
    message = meta and meta.__tostring and tostring(message) or ("error object: " .. type(message))
  end
  local trace = readable(debug.traceback("", 2))
  return trace and message .. "\n" .. trace or message
end

-- Loads and runs file with the given words; false and the message with traceback if that fails.
function scene.run(file, words)
  _G.arg = table.move(words, 1, #words, 1, { [0] = file })
  local chunk, problem = loadfile(file)
  if not chunk then return false, problem end
  return xpcall(chunk, explain, table.unpack(words))
end

scene.explain = explain

-- Splits { options..., SCENE, words... }; `known` says which options take a value. Returns options, file, words or nil,
-- message.
function scene.arguments(list, known)
  local options, i = {}, 1
  while list[i] and list[i]:sub(1, 2) == "--" do
    local name, value = list[i]:match "^%-%-([%w-]+)=?(.*)$"
    if list[i] == "--" then i = i + 1 break end
    if known[name] == nil then return nil, ("unknown option `%s`"):format(list[i]) end
    if known[name] and value == "" then
      i = i + 1
      value = list[i]
      if not value then return nil, ("option `--%s` needs a value"):format(name) end
    end
    options[name] = known[name] and value or true
    i = i + 1
  end
  local file = list[i]
  if not file then return nil, "expected a scene, a Lua file" end
  return options, file, table.move(list, i + 1, #list, 1, {})
end

return scene
