-- view/target.lua -- the file that a page goes to: whole or not at all. What is written goes under another name beside
-- it, which takes the place of the old file when everything is there.
local target = {}

local function is(what, name)
  return os.execute(("test %s '%s'"):format(what, (name:gsub("'", "'\\''")))) == true
end

local function is_special(name) return is("-e", name) and not is("-f", name) end

local function unused(name)
  local other
  repeat
    other = ("%s.part-%06x"):format(name, math.random(0, 0xffffff))
    local there = io.open(other)
    if there then there:close() end
  until not there
  return other
end

local function put(name, text)
  local file, problem = io.open(name, "w")
  if not file then return problem end
  local good
  good, problem = file:write(text)
  local closed, late = file:close()
  if not (good and closed) then return problem or late end
end

-- Said before anything is computed: that the file cannot be written.
function target.problem(name)
  if is("-d", name) then return ("cannot write %s: it is a directory"):format(name) end
  if name == "-" or is_special(name) then return nil end
  local other = unused(name)
  local problem = put(other, "")
  os.remove(other)
  return problem and ("cannot write %s: %s"):format(name, problem)
end

-- nil, or what went wrong; then the file is what it was.
function target.write(name, text)
  if name == "-" then
    local good, problem = io.stdout:write(text)
    if good then good, problem = io.stdout:flush() end
    return not good and ("cannot write to standard output: %s"):format(problem) or nil
  end
  local special = is_special(name) -- a pipe or a device has no other name
  local other = special and name or unused(name)
  local problem = put(other, text)
  if not problem and not special then
    local good, late = os.rename(other, name)
    if not good then problem = late end
  end
  if not problem then return nil end
  if not special then os.remove(other) end
  return ("cannot write %s: %s"):format(name, problem)
end

return target
