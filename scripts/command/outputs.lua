-- outputs.lua -- the files that commands write beside their tables: looked at before the work starts, so that nobody
-- waits for a result that has no place, and written as a whole.
local core = require "ambit.core"

local outputs = {}

-- What is wrong with the files of these options (a list of keys); nil: nothing. `plain[key]`: `-` is standard output.
function outputs.problem(options, keys, plain)
  local used = {}
  for _, key in ipairs(keys) do
    local name = options[key]
    if name and used[name] then return ("--%s and --%s name the same file, %s"):format(used[name], key, name) end
    if name then used[name] = key end
    if name and not (name == "-" and plain and plain[key]) then
      local there = io.open(name)
      if there then there:close() end
      local file, problem = io.open(name, "a")
      if not file then return ("cannot write the file of --%s: %s"):format(key, problem) end
      file:close()
      if not there then os.remove(name) end
    end
  end
end

-- Writes a file as a whole, or (`-`) to standard output; an error says what could not be written, and why: then an old
-- file is what it was.
function outputs.write(name, text)
  if name ~= "-" then
    local problem = core.write_file(name, text)
    if problem then error("cannot write " .. problem, 0) end
    return
  end
  local good, problem = io.stdout:write(text)
  if good then good, problem = io.stdout:flush() end
  if not good then error("cannot write to standard output: " .. tostring(problem), 0) end
end

return outputs
