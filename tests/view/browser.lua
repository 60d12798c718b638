-- Pages of `ambit view` in a headless browser: lua5.4 tests/view/browser.lua AMBIT
-- probe.js is put into a page, looks at it and writes down what is wrong.
local json = require "cjson"
local ambit = arg[1]
local passed, failed = 0, 0

local function quoted(s) return "'" .. s:gsub("'", "'\\''") .. "'" end

local function read(name)
  local file = assert(io.open(name, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

local function write(name, text)
  local file = assert(io.open(name, "wb"))
  assert(file:write(text))
  assert(file:close())
end

local function output_of(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  local _, _, code = pipe:close()
  return text, code
end

-- -- the browser

local function find_browser()
  local own = os.getenv "AMBIT_BROWSER"
  for _, name in ipairs { own or "chromium", "chromium-browser", "google-chrome" } do
    local path = output_of("command -v " .. quoted(name) .. " 2>/dev/null"):gsub("%s+$", "")
    if path ~= "" then return path end
  end
end

local browser = find_browser()
if not browser then
  if os.getenv "AMBIT_NO_BROWSER" == "1" then
    print "skipped: there is no browser, and AMBIT_NO_BROWSER=1 says not to mind"
    os.exit(77)
  end
  print "there is no browser: install chromium, or set AMBIT_NO_BROWSER=1 to leave this test out"
  os.exit(1)
end

local work = os.tmpname()
os.remove(work)
assert(os.execute("mkdir -p " .. quoted(work)))

-- The pages are our own. Containers often allow neither the browser's sandbox nor much shared memory.
local start = ("timeout 100 %s --headless --no-sandbox --disable-dev-shm-usage --disable-gpu --no-first-run"
  .. " --user-data-dir=%s"):format(quoted(browser), quoted(work .. "/profile"))

-- The document after its scripts have run, and what the browser logged.
local function dump(page, width, height, flags)
  local log = work .. "/log"
  local text = output_of(("%s --hide-scrollbars --host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr"
    .. " --window-size=%d,%d %s --virtual-time-budget=30000 --dump-dom %s 2>%s"):format(start, width, height,
    flags or "", quoted("file://" .. page), quoted(log)))
  return text, read(log)
end

-- -- pages

local function view(scene)
  local page = os.tmpname()
  local _, _, code = os.execute(("%s view %s -o %s --quiet >%s/out 2>%s/problems"):format(quoted(ambit),
    quoted(scene), quoted(page), work, work))
  local text = read(page)
  os.remove(page)
  return text, code, read(work .. "/problems")
end

local probe = read "tests/view/probe.js"

local function unescape(text)
  return (text:gsub("&lt;", "<"):gsub("&gt;", ">"):gsub("&quot;", '"'):gsub("&amp;", "&"))
end

local function fail(name, text)
  failed = failed + 1
  print(("FAILED %s: %s"):format(name, text))
end

-- Nothing in the page leads out of it.
local function check_alone(name, text)
  for _, word in ipairs { "https?://", "file:", "[^-]src%s*=", "url%(", "@import", "fetch%(", "XMLHttp", "WebSocket",
    "import%(" } do
    local shell = text:gsub('<script type="application/json".-</script>', "")
    if shell:find(word) then fail(name, "the page contains " .. word) end
  end
end

-- Text as a JavaScript string that may stand in a script.
local function literal(text) return (json.encode(text):gsub("<", "\\u003c")) end

-- The window of a browser has a least width: the page stands in a frame of the wanted size, and sends what was found.
local frame = [[<!doctype html><iframe id="frame" style="border: 0; width: %dpx; height: %dpx"></iframe><script>
addEventListener("message", event => {
  const result = document.createElement("pre");
  result.id = "result";
  result.textContent = event.data;
  document.body.append(result);
});
document.getElementById("frame").srcdoc = %s;
</script>]]

-- opens the page with the probe in it; expected: { texts = { { selector, text } }, counts = { { selector, n } } }
local function inspect(name, text, expected, width, height, flags)
  local facts = json.encode { texts = expected.texts or {}, counts = expected.counts or {}, width = width }
  facts = facts:gsub("{}", "[]"):gsub("<", "\\u003c")
  local script = ("<script>const EXPECTED = %s;\n%s</script></body>"):format(facts, probe)
  local page = work .. "/page.html"
  write(page, frame:format(width, height, literal((text:gsub("</body>", function() return script end)))))
  local document, log = dump(page, width + 40, height + 40, flags)
  local result = document:match '<pre id="result">(.-)</pre>'
  if not result then return fail(name, "the page did not come to its end:\n" .. log:sub(-2000)) end
  result = json.decode(unescape(result))
  for _, wrong in ipairs(result.wrong) do fail(name, wrong) end
  for line in log:gmatch "[^\n]*CONSOLE[^\n]*" do fail(name, line) end
  if #result.wrong == 0 then passed = passed + 1 end
  return result
end

local function scene(text)
  local name = work .. "/scene.lua"
  write(name, text)
  return name
end

-- -- a run: light and dark, desk and phone

local pendulum, code = view "scripts/double_pendulum.lua"
if code ~= 0 then fail("double pendulum", "exit code " .. code) end
check_alone("double pendulum", pendulum)
local known = { texts = { { "#status", "complete" }, { "#facts", "taylor_model" }, { "#values th", "beta2" } },
  counts = { { "#drawing .line.link", 4 }, { "#drawing .frame", 5 }, { "#drawing .body", 2 },
    { "#drawing .axis", 2 } } }
local light = inspect("double pendulum, light", pendulum, known, 1400, 900, "--blink-settings=preferredColorScheme=1")
local dark = inspect("double pendulum, dark", pendulum, known, 1400, 900, "--blink-settings=preferredColorScheme=0")
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
  ambit.simulate { first:dynamics(), initial = { ambit.between(-1e9, 1e9), 0 }, t = { 0, 10 }, solver = "lohner" }
  local second = pendulum "approximate"
  ambit.simulate { second:dynamics(), initial = { 1, 0 }, t = { 0, 1 }, solver = "gsl" }
  local third = pendulum "still"
]])
if exit_code ~= 3 then fail("a run that proves nothing", ("exit code %s\n%s"):format(exit_code, problems)) end
inspect("a run that proves nothing", nothing, { texts = { { "#status", "unable at t = 0 s" }, { "#reason", "grew wider" },
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

local paper = work .. "/paper.pdf"
write(work .. "/page.html", pendulum)
os.execute(("%s --print-to-pdf=%s %s 2>/dev/null"):format(start, quoted(paper), quoted("file://" .. work
  .. "/page.html")))
local _, sheets = read(paper):gsub("/Type%s*/Page[^s]", "")
if sheets < 1 or sheets > 2 then fail("paper", ("%d sheets"):format(sheets)) else passed = passed + 1 end

os.execute("rm -rf " .. quoted(work))
print(("%d passed, %d failed"):format(passed, failed))
os.exit(failed == 0)
