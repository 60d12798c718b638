-- Pages of `ambit compare` and `ambit stability` in a headless browser: lua5.4 tests/page/browser.lua AMBIT
-- The probes are put into a page, look at it and write down what is wrong.
package.path = "tests/?.lua;tests/page/?.lua;" .. package.path
local browser = require "browser"
local samples = require "samples"
local ambit = arg[1]
local quoted, read, fail = browser.quoted, browser.read, browser.fail

local function page(words)
  local name = browser.work .. "/made.html"
  local kind, rest = words:match "^(%S+) ?(.*)$"
  local good = os.execute(("%s run tests/page/write.lua %s %s %s"):format(quoted(ambit), kind, quoted(name), rest))
  if not good then fail(words, "the page was not written") end
  return read(name)
end

local common = read "tests/page/probe.js"
local probes = { compare = read "tests/page/probe_compare.js" .. common,
  stability = read "tests/page/probe_stability.js" .. common,
  plot = read "tests/page/probe_plot.js" .. common }

-- expected: { texts = { { selector, text } }, counts = { { selector, n } }, sort = true: try the tables at once }
local function inspect(kind, name, text, expected, width, height, flags)
  local facts = { texts = expected.texts or {}, counts = expected.counts or {}, width = width,
    sort = expected.sort or false }
  browser.alone(name, text:gsub("/%*!.-%*/", ""))
  return browser.inspect(("%s, %d x %d"):format(name, width, height), text, probes[kind], facts, width, height, flags)
end

local function count(list, what)
  local n = 0
  for _, entry in ipairs(list) do if what(entry) then n = n + 1 end end
  return n
end

-- A desk and a phone, light and dark.
local function everywhere(kind, name, text, expected)
  local pages = {}
  for _, size in ipairs { { 1280, 900 }, { 390, 844 } } do
    for _, scheme in ipairs { "light", "dark" } do
      local result = inspect(kind, name .. ", " .. scheme, text, expected, size[1], size[2], browser[scheme])
      pages[scheme] = result and result.page
    end
  end
  if pages.light == pages.dark then fail(name, "light and dark are the same colour") end
end

-- -- comparisons

local usual = samples.usual()
local rows = usual.rows
everywhere("compare", "usual", page "compare usual", { sort = true,
  counts = { { "tr[data-row]", #rows }, { "nav.contents", 0 }, { "tr.failed", 2 },
    { ".star", count(rows, function(row) return row.pareto end) } },
  texts = { { ".advice", usual.advice }, { "td", "reduce the tolerances" }, { "footer", "machine" },
    { "h1", "<b>a scene" }, { ".facts", "1\u{202F}000 draws" } } })

local wicked = "</script><script>window.owned = 1</script><!-- & \"double\" 'single' \u{FFFD}"
local hard = page "compare usual odd failed single empty evaluated"
inspect("compare", "hard data", hard, { sort = true, counts = { { "nav.contents li", 6 }, { ".comparison", 6 },
    { ".bars .proved", 4 }, { ".bars .sampled", 6 } },
  texts = { { "h2", wicked }, { ".advice", wicked }, { "td", wicked }, { "h2", "@DATA@ %1" },
    { ".note", "Interrupted" }, { "td", "the reason of crashed" }, { ".quiet", "No combination was run" } } }, 360, 740)
inspect("compare", "hard data", hard, {}, 1280, 900)
inspect("compare", "nothing", page "compare", { texts = { { ".note", "Nothing was compared" } } }, 360, 740)

local many = page "compare usual usual usual usual usual usual usual usual usual many"
inspect("compare", "ten comparisons", many, { counts = { { "nav.contents li", 10 },
  { "tr[data-row]", 9 * #rows + 200 } } }, 390, 844)

-- -- the stability suite

everywhere("stability", "suite", page "stability suite 12 9", { counts = { { "#map a[data-outcome]", 108 },
  { ".case", 12 }, { ".case tbody tr", 108 } }, texts = { { ".note", "not as expected" }, { "td", "raise `order`" },
  { "dd", "Hairer, Wanner" }, { "h1", "Numerical stability" } } })
inspect("stability", "odd suite", page "stability odd_suite", { texts = { { "summary", wicked }, { "td", wicked },
  { "td", "an outcome of tomorrow" }, { ".note", "Interrupted" } } }, 360, 740)
inspect("stability", "empty suite", page "stability empty_suite", { texts = { { ".note", "No case was run" } } }, 360,
  740)
inspect("stability", "a large suite", page "stability suite 70 12", { counts = { { ".case tbody tr", 840 } } }, 1280,
  900)

-- -- plots of a run

everywhere("plot", "over time", page "plot over_time", { counts = { { ".band canvas", 2 } }, texts = {
  { "h1", "</script><b>a title" }, { "figcaption", "<b>v" }, { "dd", "holds at all times" }, { "dd", "fails" } } })
everywhere("plot", "phase plane", page "plot plane", { counts = { { "svg .axis", 2 } },
  texts = { { "svg text", "<b>v" }, { ".quiet", "the set at the end" } } })

-- -- a diagram is first drawn over what tells the combinations apart

local alike = page "compare alike"
inspect("compare", "equal final widths", alike, {}, 1280, 900)
if not alike:find '"first":"over_sample_max"' then fail("alike", "the diagram begins with equal widths") end

-- -- both schemes have the same colours, in a way that older browsers know

local function colours(name)
  local list, known = {}, {}
  for colour in read("scripts/lab/page/parts/" .. name):gmatch "%s(%-%-[%w-]+): #" do
    if not known[colour] then list[#list + 1], known[colour] = colour, true end
  end
  table.sort(list)
  return table.concat(list, " ")
end

local light, dark = colours "page.css", colours "dark.css"
if light ~= dark then fail("colours", ("light %s, but dark %s"):format(light, dark)) end
if alike:find("light-dark(", 1, true) then fail("colours", "light-dark() is not known to older browsers") end

-- -- without scripts the tables are there

for name, text in pairs { compare = page "compare usual", stability = page "stability suite 12 9" } do
  local still = text:gsub("<script.->.-</script>", "")
  local _, lines = still:gsub("<tr", "")
  local wanted = name == "compare" and #rows or 108
  if lines < wanted then fail(name, ("%d lines of tables without scripts"):format(lines)) else browser.pass() end
end

-- -- on paper

local sheets = browser.sheets(page "compare usual")
if sheets < 1 or sheets > 5 then fail("paper", ("%d sheets"):format(sheets)) else browser.pass() end

browser.finish()
