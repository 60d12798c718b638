-- trial.lua -- one mutation tried: written into a copy of the tree, built, tested, taken back.
--
-- Outcomes: "killed" and the test that noticed; "unbuilt" (the compiler refuses it); "survived". Only what the mutation
-- touches is built; the tests that noticed the most in the same file come first, then quick ones.
local source = require "mutate.source"

local trial = {}

-- No test may use more memory (kB) than this, or more CPU time than 10 times what it uses without a mutation and 20 s.
local LIMITS = "ulimit -v 8000000; ulimit -c 0; ulimit -t %d; "

local function shell(command, log)
  local ok = os.execute(("( %s ) >%s 2>&1"):format(command, log))
  return ok == true
end

local function read(file)
  local input = assert(io.open(file))
  local text = input:read "a"
  input:close()
  return text
end

local function exists(file)
  local input = io.open(file)
  if input then input:close() end
  return input ~= nil
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

-- Makes `place` a copy of the committed tree, or brings the one that is there up to date. Tests are not linked anew when
-- only the library changes. A mutation that an interrupted run left behind is taken back.
function trial.prepare(place)
  local make = ([[set -e; [ -d %s/.git ] || git clone -q --shared --no-checkout . %s
    head=$(git rev-parse HEAD); cd %s; git fetch -q origin $head; git checkout -q --force --detach $head
    [ -d build ] || cmake -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DAMBIT_TESTS=ON -DCMAKE_LINK_DEPENDS_NO_SHARED=ON]]):gsub("%%s", place)
  assert(shell(make, place .. ".log"), "no copy of the tree: see " .. place .. ".log")
end

local function build(place, target, log) return shell(("ninja -C %s/build %s"):format(place, target), log) end

-- What tests load at run time: all plugins, those of the specs, the command.
local function build_loaded(place, log)
  local list = {}
  for target in output_of(("ninja -C %s/build -t targets all"):format(place)):gmatch "%f[^\n\0]([%w_]+): phony" do
    local kind = target:match "^(%l+)_"
    if target == "ambit" or target == "ambit_module" or kind == "arithmetic" or kind == "element" or kind == "service"
      or kind == "solver" or kind == "test" then list[#list + 1] = target end
  end
  assert(build(place, table.concat(list, " "), log), "the tree does not build: see " .. log)
end

-- The program of a test, as cmake/tests.cmake names it.
local function source_of(name)
  local layer, rest = name:match "^(%w+)%.(.*)$"
  return ("tests/%s/test_%s.c"):format(layer, rest)
end

-- The tests of an area: { name, command, target or nil, seconds }.
local function tests_of(area, place)
  local list = {}
  for name in output_of(("ctest --test-dir %s/build -N"):format(place)):gmatch "#%d+: (%S+)" do
    for _, pattern in ipairs(area.tests) do
      if name:find(pattern) and exists(("%s/%s"):format(place, source_of(name))) then
        list[#list + 1] = { name = name, target = "test." .. name,
          command = ("ctest --test-dir %s/build -R '^%s$'"):format(place, name:gsub("%.", "\\.")) }
        break
      end
    end
  end
  for _, spec in ipairs(area.specs or {}) do
    local path = ("%s/build/tests/lua/plugins:%s/build/tests/plugins:%s/build/plugins"):gsub("%%s", place)
    local cpath = ("%s/build/lib/lua/5.4/?.so;%s/build/tests/lua/?.so;;"):gsub("%%s", place)
    local command = "cd %s && AMBIT_PATH=%s LUA_CPATH='%s' AMBIT_COMMAND=%s/build/ambit NO_COLOR=1 timeout 900 build/ambit test "
      .. "tests/lua/%s_spec.lua -- --no-keep-going"
    list[#list + 1] = { name = spec .. "_spec", command = command:format(place, path, cpath, place, spec) }
  end
  return list
end

-- CPU seconds that the tests used, which the shell has printed last.
local function seconds_of(log)
  local minutes, seconds = read(log):match "(%d+)m([%d.]+)s %d+m[%d.]+s%s*$"
  return 60 * tonumber(minutes) + tonumber(seconds)
end

-- The tests of an area, ready to run, each with the seconds that it used when it last passed.
function trial.tests(area, place, log)
  build_loaded(place, log) -- first: new tests of the tree are listed from then on
  local list, passed = tests_of(area, place), {}
  local path, commit = place .. ".passed", output_of(("git -C %s rev-parse HEAD"):format(place)):match "%x+"
  if exists(path) then
    for at, name, seconds in read(path):gmatch "(%x+) (%S+) (%S+)\n" do
      passed[name] = { seconds = tonumber(seconds), now = at == commit or passed[name] and passed[name].now }
    end
  end
  for _, test in ipairs(list) do
    local before = passed[test.name] or { seconds = 10 }
    test.seconds, test.passed, test.note = before.seconds, before.now, ("%s %s"):format(commit, test.name)
  end
  return list
end

-- A test that notices must pass without the mutation, once for each commit.
local function check(test, area, place, log)
  if test.passed then return end
  assert(build(place, (test.target or "") .. " " .. area.target, log), "the tree does not build: see " .. log)
  if not shell(test.command .. " && times", log) then
    error(("a test of `%s` fails without a mutation: %s"):format(area.name, test.name), 0)
  end
  test.passed, test.seconds = true, seconds_of(log)
  local output = assert(io.open(place .. ".passed", "a"))
  output:write(("%s %.2f\n"):format(test.note, test.seconds))
  output:close()
end

-- Those that noticed more in the file first, then those whose name holds the file's, then quick ones.
local function sort_tests(tests, file, known)
  local stem, kills = file:match "([^/]+)%.%w+$", {}
  for key, found in pairs(known) do
    if found[1] == "killed" and key:match "^%S+" == file then kills[found[2]] = (kills[found[2]] or 0) + 1 end
  end
  for _, test in ipairs(tests) do
    test.rank = (kills[test.name] or 0) + (test.name:find(stem, 1, true) and 0.5 or 0)
  end
  table.sort(tests, function(a, b)
    if a.rank ~= b.rank then return a.rank > b.rank end
    if a.seconds ~= b.seconds then return a.seconds < b.seconds end
    return a.name < b.name
  end)
end

-- The first test that fails.
local function noticed(tests, place, log)
  for _, test in ipairs(tests) do
    if test.target and not build(place, test.target, log) then return test end
    if not shell(LIMITS:format(20 + 10 * test.seconds // 1) .. test.command, log) then return test end
  end
end

-- known: what was tried before, for the order of the tests.
function trial.run(area, tests, mutation, known, place, log)
  local file = place .. "/" .. mutation.file
  local text = read(file)
  sort_tests(tests, mutation.file, known)
  write(file, source.with(text, mutation))
  local outcome, by = "unbuilt", nil
  if build(place, area.target .. (area.specs and " ambit" or ""), log) then
    by = noticed(tests, place, log)
    outcome = by and "killed" or "survived"
  end
  write(file, text)
  if by then check(by, area, place, log) end
  return outcome, by and by.name
end

return trial
