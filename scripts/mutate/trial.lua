-- trial.lua -- one mutation tried: written into a copy of the tree, built, tested, taken back.
--
-- Outcomes: "killed" and the test that noticed; "unbuilt" (the compiler refuses it); "survived".
local source = require "mutate.source"

local trial = {}

-- Every process of a test may use so much: a mutation may loop for ever, or ask for all memory.
local LIMITS = "ulimit -t 120; ulimit -v 8000000; ulimit -c 0; "
local WALL = 900 -- s for a stage

local function shell(command, log)
  local ok, _, code = os.execute(("( %s ) >%s 2>&1"):format(command, log))
  return ok == true, code
end

local function read(file)
  local input = assert(io.open(file))
  local text = input:read "a"
  input:close()
  return text
end

local function write(file, text)
  local output = assert(io.open(file, "w"))
  output:write(text)
  assert(output:close())
end

local function output_of(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  pipe:close()
  return text
end

-- Makes `place` a built copy of the committed tree, or keeps the one that is there. Tests are not linked anew when only
-- the library changes. A mutation that an interrupted run left behind is taken back.
function trial.prepare(place)
  local commit = output_of "git rev-parse HEAD"
  local known = io.open(place .. "/commit")
  if known and known:read "a" == commit then
    local left = io.open(place .. "/mutated")
    if left then
      local file = left:read "l"
      if file then write(place .. "/" .. file, output_of("git show HEAD:" .. file)) end
    end
    return
  end
  local make = ([[set -e; rm -rf %s; mkdir -p %s; git archive HEAD | tar -x -C %s;
    cmake -S %s -B %s/build -G Ninja -DCMAKE_BUILD_TYPE=Release -DAMBIT_TESTS=ON -DCMAKE_LINK_DEPENDS_NO_SHARED=ON;
    cmake --build %s/build]]):gsub("%%s", place)
  assert(shell(make, "/dev/null") or nil, "the tree does not build: " .. place)
  write(place .. "/commit", commit)
end

-- The commands that test an area, quick ones first: { name, command }.
local function stages(area, place)
  local list = {}
  for _, pattern in ipairs(area.tests) do
    list[#list + 1] = { pattern, ("%stimeout %d ctest --test-dir %s/build -R '%s' --stop-on-failure"):format(LIMITS, WALL,
      place, pattern) }
  end
  for _, spec in ipairs(area.specs or {}) do
    local path = ("%s/build/tests/lua/plugins:%s/build/tests/plugins:%s/build/plugins"):gsub("%%s", place)
    local command = "%scd %s && AMBIT_PATH=%s AMBIT_COMMAND=%s/build/ambit NO_COLOR=1 timeout %d build/ambit test tests/lua/%s_spec.lua"
    list[#list + 1] = { spec .. "_spec", command:format(LIMITS, place, path, place, WALL, spec) }
  end
  return list
end

-- The first stage that fails, and what failed in it; nil if all pass.
local function noticed(area, place, log)
  for _, stage in ipairs(stages(area, place)) do
    if not shell(stage[2], log) then
      local text = read(log)
      return text:match "%d+ %- ([%w_.]+) %(" or text:match "Failure[^\n]*\n[^\n]*" or stage[1]
    end
  end
end

-- Some tests contain the code of a plugin, so that all is built.
local function build(place, log) return shell(("cmake --build %s/build"):format(place), log) end

-- The first test of the area that fails without a mutation; nil if none does.
function trial.failing(area, place, log)
  assert(build(place, log), "the tree does not build")
  return noticed(area, place, log)
end

function trial.run(area, mutation, place, log)
  local file = place .. "/" .. mutation.file
  local text = read(file)
  write(place .. "/mutated", mutation.file)
  write(file, source.with(text, mutation))
  local outcome, by = "unbuilt", nil
  if build(place, log) then
    by = noticed(area, place, log)
    outcome = by and "killed" or "survived"
  end
  write(file, text)
  write(place .. "/mutated", "")
  return outcome, by
end

return trial
