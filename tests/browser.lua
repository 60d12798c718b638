-- browser.lua -- pages in a headless browser, for tests: a probe is put into a page, looks at it as a reader does, and
-- sends what is wrong to the window around it. Without a browser the test fails, unless AMBIT_NO_BROWSER=1: then it is
-- skipped.
local json = require "cjson"

local browser = { passed = 0, failed = 0 }

function browser.quoted(s) return "'" .. s:gsub("'", "'\\''") .. "'" end

function browser.read(name)
  local file = assert(io.open(name, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

function browser.write(name, text)
  local file = assert(io.open(name, "wb"))
  assert(file:write(text))
  assert(file:close())
end

local quoted, read, write = browser.quoted, browser.read, browser.write

local function output_of(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  local _, _, code = pipe:close()
  return text, code
end

local function find_browser()
  local own = os.getenv "AMBIT_BROWSER"
  for _, name in ipairs { own or "chromium", "chromium-browser", "google-chrome" } do
    local path = output_of("command -v " .. quoted(name) .. " 2>/dev/null"):gsub("%s+$", "")
    if path ~= "" then return path end
  end
end

local program = find_browser()
if not program then
  if os.getenv "AMBIT_NO_BROWSER" == "1" then
    print "skipped: there is no browser, and AMBIT_NO_BROWSER=1 says not to mind"
    os.exit(77)
  end
  print "there is no browser: install chromium, or set AMBIT_NO_BROWSER=1 to leave this test out"
  os.exit(1)
end

-- A folder of the test's own; browser.finish removes it.
browser.work = os.tmpname()
os.remove(browser.work)
assert(os.execute("mkdir -p " .. quoted(browser.work)))

-- The pages are our own. Containers often allow neither the browser's sandbox nor much shared memory.
local start = ("timeout 100 %s --headless --no-sandbox --disable-dev-shm-usage --disable-gpu --no-first-run"
  .. " --user-data-dir=%s"):format(quoted(program), quoted(browser.work .. "/profile"))

-- The document after its scripts have run, and what the browser logged.
local function dump(page, width, height, flags)
  local log = browser.work .. "/log"
  local text = output_of(("%s --hide-scrollbars --host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr"
    .. " --window-size=%d,%d %s --virtual-time-budget=30000 --dump-dom %s 2>%s"):format(start, width, height,
    flags or "", quoted("file://" .. page), quoted(log)))
  return text, read(log)
end

local function unescape(text)
  return (text:gsub("&lt;", "<"):gsub("&gt;", ">"):gsub("&quot;", '"'):gsub("&amp;", "&"))
end

function browser.fail(name, text)
  browser.failed = browser.failed + 1
  print(("FAILED %s: %s"):format(name, text))
end

function browser.pass() browser.passed = browser.passed + 1 end

-- Nothing in the page leads out of it.
function browser.alone(name, text)
  local shell = text:gsub('<script type="application/json".-</script>', "")
  for _, word in ipairs { "https?://", "file:", "[^-]src%s*=", "url%(", "@import", "fetch%(", "XMLHttp", "WebSocket",
    "import%(" } do
    if shell:find(word) then browser.fail(name, "the page contains " .. word) end
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

-- Opens the page with the probe in it, to which `facts` is EXPECTED -> what the probe sent, or nil.
function browser.inspect(name, text, probe, facts, width, height, flags)
  local expected = json.encode(facts):gsub("{}", "[]"):gsub("<", "\\u003c")
  local script = ("<script>const EXPECTED = %s;\n%s</script></body>"):format(expected, probe)
  local page = browser.work .. "/page.html"
  write(page, frame:format(width, height, literal((text:gsub("</body>", function() return script end)))))
  local document, log = dump(page, width + 40, height + 40, flags)
  local result = document:match '<pre id="result">(.-)</pre>'
  if not result then return browser.fail(name, "the page did not come to its end:\n" .. log:sub(-2000)) end
  result = json.decode(unescape(result))
  for _, wrong in ipairs(result.wrong) do browser.fail(name, wrong) end
  for line in log:gmatch "[^\n]*CONSOLE[^\n]*" do browser.fail(name, line) end
  if #result.wrong == 0 then browser.pass() end
  return result
end

-- How many sheets of paper it takes.
function browser.sheets(text)
  local page, paper = browser.work .. "/page.html", browser.work .. "/paper.pdf"
  write(page, text)
  os.execute(("%s --print-to-pdf=%s %s 2>/dev/null"):format(start, quoted(paper), quoted("file://" .. page)))
  return select(2, read(paper):gsub("/Type%s*/Page[^s]", ""))
end

browser.light, browser.dark = "--blink-settings=preferredColorScheme=1", "--blink-settings=preferredColorScheme=0"

function browser.finish()
  os.execute("rm -rf " .. quoted(browser.work))
  print(("%d passed, %d failed"):format(browser.passed, browser.failed))
  os.exit(browser.failed == 0)
end

return browser
