-- Pages of `ambit view` in a headless browser: lua5.4 tests/view/browser.lua AMBIT
-- probe.js is put into a page, looks at it and writes down what is wrong.
package.path = "tests/?.lua;" .. package.path
local browser = require "browser"
local ambit = arg[1]
local quoted, read, write, fail, work = browser.quoted, browser.read, browser.write, browser.fail, browser.work
local probe = read "tests/view/probe.js"

local function view(scene)
  local page = os.tmpname()
  local _, _, code = os.execute(("%s view %s -o %s --quiet >%s/out 2>%s/problems"):format(quoted(ambit),
    quoted(scene), quoted(page), work, work))
  local text = read(page)
  os.remove(page)
  return text, code, read(work .. "/problems")
end

-- expected: { texts = { { selector, text } }, counts = { { selector, n } } }
local function inspect(name, text, expected, width, height, flags)
  local facts = { texts = expected.texts or {}, counts = expected.counts or {}, width = width }
  return browser.inspect(name, text, probe, facts, width, height, flags)
end

local function scene(text)
  local name = work .. "/scene.lua"
  write(name, text)
  return name
end

-- -- a run: light and dark, desk and phone

local pendulum, code = view "scripts/double_pendulum.lua"
if code ~= 0 then fail("double pendulum", "exit code " .. code) end
browser.alone("double pendulum", pendulum)
local known = { texts = { { "#status", "complete" }, { "#facts", "taylor_model" }, { "#values th", "beta2" } },
  counts = { { "#drawing .line.link", 4 }, { "#drawing .frame", 5 }, { "#drawing .body", 2 },
    { "#drawing .axis", 2 } } }
local light = inspect("double pendulum, light", pendulum, known, 1400, 900, browser.light)
local dark = inspect("double pendulum, dark", pendulum, known, 1400, 900, browser.dark)
inspect("double pendulum, phone", pendulum, known, 360, 740)
if light and dark and (light.page == dark.page or light.ink == dark.ink) then
  fail("light and dark", "the same colours: " .. light.page)
end

-- -- names that are code

local injection, exit_code, problems = view(scene [[
  local ambit = require "ambit"
  local m = ambit.mechanism "</script><script>window.owned = 1</script><!-- \u{2028} 'single' \"double\" \xff"
  local foot = m:rigid_link { from = m.world, offset = { 0, 0, ambit.around(1, "1%") },
    name = "<img src=x onerror=owned=1>" }
  local tip = m:rigid_link { from = m:revolute { from = foot, axis = "x", name = "</title><b>" }, offset = { 0, 1, 0 } }
  ambit.view { m, points = { ["</script><script>owned=1</script>"] = tip, ["${owned=1}&amp;\u{1F980}"] = foot },
    title = "@DATA@ <!--<script> %1 </title>" }
]])
if exit_code ~= 0 then fail("names", problems) end
inspect("names", injection, { texts = { { "#title", "@DATA@ <!--<script> %1 </title>" },
  { ".point", "</script><script>owned=1</script>" }, { ".point", "${owned=1}&amp;\u{1F980}" },
  { "#source", "window.owned = 1</script><!-- \u{2028} 'single' \"double\" \u{FFFD}" },
  { "#drawing title", "<img src=x onerror=owned=1>" }, { "#notes", "</title><b>" } } }, 360, 740)

-- -- a run that proves nothing from the start; a solver that never proves; a mechanism without a run: one page each

local nothing
nothing, exit_code, problems = view(scene [[
  local ambit = require "ambit"
  local function pendulum(name)
    local m = ambit.mechanism { name, gravity = { 0, "-9.81", 0 } }
    local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 0, -1, 0 } }
    m:point_mass { at = tip, mass = 1 }
    return m
  end
  local first = pendulum "unable"
  ambit.simulate { first:dynamics(), initial = { ambit.between(-1e9, 1e9), 0 }, t = { 0, 10 }, solver = "taylor_model" }
  local second = pendulum "approximate"
  ambit.simulate { second:dynamics(), initial = { 1, 0 }, t = { 0, 1 }, solver = "gsl" }
  local third = pendulum "still"
]])
if exit_code ~= 3 then fail("a run that proves nothing", ("exit code %s\n%s"):format(exit_code, problems)) end
inspect("a run that proves nothing", nothing, { texts = { { "#status", "unable at t = 0 s" }, { "#reason", "narrow the initial set" },
  { "#which option", "approximate" }, { "#which option", "still" } }, counts = { { "#which option", 3 } } }, 800, 600)

-- -- a thousand parts

local huge
huge, exit_code, problems = view(scene [[
  local ambit = require "ambit"
  local m = ambit.mechanism "chain"
  local at, points = m.world, {}
  for i = 1, 500 do
    local angle = ambit.degrees(4) * ambit.sin(ambit.time + i / 30)
    at = m:revolute { from = at, axis = "z", name = "q" .. i, angle = angle }
    at = m:rigid_link { from = at, offset = { ambit.around("0.1", "0.1%"), 0, 0 } }
    if i % 25 == 0 then points[#points + 1] = at end
  end
  ambit.view { m, points = points, t = { 0, 6 } }
]])
if exit_code ~= 0 then fail("a thousand parts", problems) end
inspect("a thousand parts", huge, { texts = { { "#notes", "instants instead of" }, { "#notes", "each drawn box" } },
  counts = { { "#drawing .frame", 1001 }, { "#drawing .line", 1000 } } }, 1000, 800)

-- -- on paper

local sheets = browser.sheets(pendulum)
if sheets < 1 or sheets > 2 then fail("paper", ("%d sheets"):format(sheets)) else browser.pass() end

browser.finish()
