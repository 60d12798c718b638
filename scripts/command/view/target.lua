-- view/target.lua -- the file that a page goes to: looked at before the work starts, written as a whole or not at all.
local core = require "ambit.core"

local target = {}

local function is(what, name)
  return os.execute(("test %s '%s'"):format(what, (name:gsub("'", "'\\''")))) == true
end

-- Said before anything is computed: that the file cannot be written. A pipe or a device is not opened for that.
function target.problem(name)
  if is("-d", name) then return ("cannot write %s: it is a directory"):format(name) end
  local there = is("-e", name)
  if name == "-" or there and not is("-f", name) then return nil end
  local file, problem = io.open(name, "a")
  if file then file:close() end
  if file and not there then os.remove(name) end
  return problem and ("cannot write %s"):format(problem)
end

-- nil, or what went wrong; then the file is what it was.
function target.write(name, text)
  if name ~= "-" then
    local problem = core.write_file(name, text)
    return problem and "cannot write " .. problem
  end
  local good, problem = io.stdout:write(text)
  if good then good, problem = io.stdout:flush() end
  return not good and ("cannot write to standard output: %s"):format(problem) or nil
end

return target
