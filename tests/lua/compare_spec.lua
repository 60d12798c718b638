-- The verb compare over arithmetics, its picture, and the command that repeats a scene's evaluations. AMBIT_COMMAND is
-- the command to test.
local ambit = require "ambit"
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function fails(f, ...)
  local good, problem = pcall(f)
  assert.is_false(good, "no error was raised")
  problem = tostring(problem)
  assert.truthy(problem:find "compare_spec%.lua:%d+: ", problem)
  for _, text in ipairs { ... } do assert.truthy(problem:find(text, 1, true), problem) end
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

local function count(text, piece)
  local n = 0
  for _ in text:gmatch(piece) do n = n + 1 end
  return n
end

describe("compare", function()
  local a = ambit.between(0, 1)
  local f = a * (1 - a) + ambit.sin(a) * a

  it("gives a row for each arithmetic, in the shape that was asked for", function()
    local r = ambit.compare { { p = f, list = { a } }, arithmetics = { "real", "interval" }, repeats = 3 }
    assert.equal("complete", r.status)
    assert.equal(2, #r.rows)
    local real, interval = r.rows[1], r.rows[2]
    assert.equal("real", real.label)
    assert.is_false(real.rigorous)
    assert.is_nil(real.over_tightest)
    assert.equal("complete", interval.status)
    assert.is_true(interval.rigorous)
    assert.equal(1, interval.x.list[1].hi)
    assert.equal(interval.x.p:width(), interval.widths.p)
    assert.equal(math.max(interval.widths.p, interval.widths["list.1"]), interval.width)
    assert.equal(1, interval.over_tightest)
    assert.equal(3, interval.repeats)
    assert.is_true(interval.seconds_run > 0 and interval.seconds_build > 0)
  end)

  it("agrees with evaluate and holds widths against the tightest and against samples", function()
    local r = ambit.compare { f, arithmetics = { "interval", { "affine", symbols = 20 }, "affine" } }
    assert.equal(ambit.evaluate { f }, r.rows[1].x)
    assert.equal(ambit.evaluate { f, arithmetic = { "affine", symbols = 20 } }, r.rows[2].x)
    assert.equal("affine symbols=20", r.rows[2].label)
    local least = math.huge
    for _, row in ipairs(r.rows) do least = math.min(least, row.width) end
    for _, row in ipairs(r.rows) do
      assert.equal(row.width / least, row.over_tightest)
      assert.is_true(row.over_sample > 1)
      assert.is_true(row.x:contains(r.sample.x[1]))
    end
  end)

  it("runs through a list of values, its line in their order", function()
    local r = ambit.compare { f, arithmetics = { { "affine", symbols = { 0, 5, 10 }, product = { "fast", "tight" } } },
      repeats = 1 }
    local labels = {}
    for i, row in ipairs(r.rows) do labels[i] = row.label end
    assert.same({ "affine product=fast symbols=0", "affine product=fast symbols=5", "affine product=fast symbols=10",
      "affine product=tight symbols=0", "affine product=tight symbols=5", "affine product=tight symbols=10" }, labels)
    assert.equal("symbols", r.rows[1].axis)
    assert.equal("affine product=fast", r.rows[1].family)
  end)

  it("takes values by name", function()
    local d = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local r = ambit.compare { d:rate "x", at = { x = "[0.5, 0.75]" }, arithmetics = { "interval" } }
    assert.equal(-0.75, r.rows[1].x.lo)
  end)

  it("compares everything that is installed unless it is told otherwise", function()
    local seen = {}
    for _, row in ipairs(ambit.compare({ f, repeats = 1 }).rows) do
      seen[row.arithmetic] = true
      assert.equal("complete", row.status, row.label .. ": " .. tostring(row.reason))
    end
    for _, entry in ipairs(ambit.plugins "arithmetic") do assert.is_true(seen[entry.name], entry.name) end
  end)

  it("prints an aligned table with reasons", function()
    local text = tostring(ambit.compare { { x = f, y = ambit.sqrt(a - 2), z = 1 / a },
      arithmetics = { "real", "interval" } })
    has(text, "width of x", "/ tightest", "/ sampled", "proves nothing", "empty: y has no point in the domain")
    text = tostring(ambit.compare { 1 / a, arithmetics = { "interval" } })
    has(text, "unbounded: the value has no bounds", "inf")
    local columns = {}
    for line in tostring(ambit.compare { f, arithmetics = { "interval", { "affine", symbols = 10 } } })
      :gmatch "[^\n]+" do columns[#columns + 1] = utf8.len(line) end
    assert.equal(columns[2], columns[3])
  end)

  it("proves nothing with arithmetics that prove nothing", function()
    local r = ambit.compare { f, arithmetics = { "real" } }
    assert.equal("unable", r.status)
    has(r.reason, "no arithmetic")
  end)

  it("tells bad input apart, with the nearest name", function()
    fails(function() ambit.compare(f) end, "table")
    fails(function() ambit.compare { f, arithmetics = { "intervl" } } end, "intervl", "`interval`")
    fails(function() ambit.compare { arithmetics = { "interval", "afine" } } end, "afine", "`affine`")
    fails(function() ambit.compare { f, arithmetics = { { "affine", symbls = 3 } } } end, "symbls", "`symbols`")
    fails(function() ambit.compare { f, arithmetics = { { "affine", symbols = {} } } } end, "symbols", "empty")
    fails(function() ambit.compare { f, arithmetics = {} } end, "empty")
    fails(function() ambit.compare { f, arithmetics = { 3 } } end, "number")
    fails(function() ambit.compare { f, arithmetics = "interval" } end, "table")
    fails(function() ambit.compare { f, arithmetic = "interval" } end, "arithmetic", "`arithmetics`")
    fails(function() ambit.compare { f, repeats = 0 } end, "repeats", "positive integer")
    fails(function() ambit.compare { f, limit = -1 } end, "limit", "positive")
    fails(function() ambit.compare { f, seed = "x" } end, "seed", "integer")
    fails(function() ambit.compare { at = {} } end, "at")
    fails(function() ambit.compare { a + ambit.time, arithmetics = { "affine" }, repeats = "many" } end, "repeats")
  end)

  it("keeps a combination that fails as a row with its reason", function()
    local r = ambit.compare { f, arithmetics = { "interval", { "affine", product = { "fast", "wrong" } } } }
    assert.equal("failed", r.rows[3].status)
    has(r.rows[3].reason, "product", "fast", "wrong")
    has(tostring(r), "affine product=wrong", "failed: ")
    assert.equal("complete", r.status)
    r = ambit.compare { f, arithmetics = { { "affine", symbols = { 20, 5, 40 } } }, limit = 1e-12 }
    assert.equal("complete", r.rows[1].status)
    assert.equal(1, r.rows[1].repeats)
    assert.equal("complete", r.rows[2].status)
    assert.equal("skipped", r.rows[3].status)
    has(r.rows[3].reason, "affine symbols=5 took", "over the limit")
    r = ambit.compare { f + ambit.time, arithmetics = { "interval" } }
    assert.equal("failed", r.rows[1].status)
    has(r.rows[1].reason, "has no value")
    assert.equal("unable", r.status)
  end)
end)

describe("the picture", function()
  local axis, label = require "ambit.report.axis", require "ambit.compare.label"
  local state = 1
  local function random()
    state = (state * 16807) % 2147483647
    return state / 2147483647
  end

  it("has ticks at round numbers within its range", function()
    for _ = 1, 500 do
      local lo = 10 ^ (40 * random() - 20)
      local r = axis.range({ lo, lo * (1 + 10 ^ (10 * random() - 4)) }, 1.2)
      assert.is_true(r.lo < lo and #r.ticks >= 2 and #r.ticks <= 13, #r.ticks)
      for i, t in ipairs(r.ticks) do
        assert.is_true(r.lo <= t and t <= r.hi)
        assert.is_true(i == 1 or t > r.ticks[i - 1])
        assert.is_true(#("%.6g"):format(t) <= 8)
      end
    end
  end)

  it("has an axis for every double, or says that there is none", function()
    for _, v in ipairs { 0, 5e-324, 1e-300, 1e300, math.huge } do assert.is_false(axis.on_axis(v)) end
    for _, values in ipairs { { 1e-250 }, { 1e250 }, { 1e-250, 1e250 }, { 1, 1e250 }, { 1e-250, 1.0000001e-250 } } do
      for _, v in ipairs(values) do assert.is_true(axis.on_axis(v)) end
      local r = axis.range(values, 1.2)
      assert.is_true(r.lo > 0 and r.lo < values[1] and r.hi > values[#values] and r.hi < math.huge)
      assert.is_true(#r.ticks >= 2 and #r.ticks <= 13, #r.ticks)
      local x = axis.pixel(r, values[1], 0, 100)
      assert.is_true(x > 0 and x <= 50, x)
    end
  end)

  it("keeps labels clear of points, of each other and of the frame", function()
    local frame = { left = 90, right = 490, bottom = 60, top = 360 }
    for _ = 1, 50 do
      local points, before = {}, nil
      for i = 1, 20 do
        before = { x = 90 + 400 * random(), y = 60 + 300 * random(), text = tostring(i * 7), before = before }
        points[i] = before
      end
      local placed = label.place(points, frame)
      assert.is_true(#placed >= 15)
      for i, p in ipairs(placed) do
        assert.is_true(p.x > frame.left and p.x < frame.right and p.y > frame.bottom and p.y < frame.top)
        for _, q in ipairs(points) do
          assert.is_true(math.abs(p.x - q.x) > 6 or math.abs(p.y - q.y) > 6)
        end
        for k = 1, i - 1 do
          assert.is_true(math.abs(p.x - placed[k].x) > 6 or math.abs(p.y - placed[k].y) >= 12)
        end
      end
    end
  end)
end)

-- -- the command

local function write(text, name)
  name = name or os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  return name
end

local function read(name)
  local file = io.open(name)
  if not file then return nil end
  local text = file:read "a"
  file:close()
  os.remove(name)
  return text
end

-- run(words, environment) -> exit code, stdout, stderr
local function run(words, environment)
  local out, problems = os.tmpname(), os.tmpname()
  local line = ("%s '%s' compare %s >%s 2>%s"):format(environment or "", command, words, out, problems)
  local _, _, code = os.execute(line)
  return code, read(out), read(problems)
end

local function scene(text, options, environment)
  local file = write(text)
  local code, stdout, stderr = run((options or "") .. " " .. file, environment)
  os.remove(file)
  return code, stdout, stderr, file
end

local small = [[
  local ambit = require "ambit"
  print "the scene itself"
  ambit.compare { arithmetics = { "real", "interval", { "affine", symbols = { 5, 10 } } } }
  local x = ambit.between(1, 2)
  for _, name in ipairs { "interval", "real" } do
    ambit.evaluate { { u = x * ambit.sin(x), v = x - x * x }, arithmetic = name }
  end
  ambit.evaluate { x ^ 3 }]]

describe("ambit compare", function()
  it("runs the scene once and repeats what it evaluates", function()
    local code, stdout, stderr = scene(small)
    assert.equal(0, code, stderr)
    assert.equal(1, count(stdout, "the scene itself"))
    has(stdout, "1. ", "2 results of 1 uncertain datum", "asked for 2 times", "width of u", "2. ",
      "affine symbols=10", "proves nothing")
    assert.falsy(stdout:find("3. ", 1, true))
    assert.falsy(stdout:find("\27", 1, true))
    assert.equal("", stderr)
  end)

  it("writes CSV with a line for each combination and result", function()
    local name = os.tmpname()
    assert.equal(0, (scene(small, "--repeat 1 --csv " .. name)))
    local text = read(name):gsub("#[^\n]*\n", "")
    assert.equal(1 + 4 * 2 + 4, count(text, "\r\n"))
    has(text, "comparison,verb,place,solver,arithmetic,options,", ",affine,symbols=10,yes,complete,,,u,",
      ",interval,,yes,")
    for line in text:gmatch "[^\r\n]+" do assert.equal(25, count(line, ",")) end
  end)

  it("gives each result its own status in the CSV, an empty one no bounds", function()
    local name = os.tmpname()
    scene("local a = require 'ambit' local x = a.between(1, 2) a.evaluate { { a = x, b = a.sqrt(-x) } }",
      "--repeat 1 --csv " .. name)
    local text = read(name):gsub("#[^\n]*\n", "")
    has(text, ",interval,,yes,complete,,,a,1,2,1,", ",interval,,yes,empty,,,b,,,0")
    for line in text:gmatch "[^\r\n]+" do assert.falsy(line:find(",b,[^,]", 1), line) end
  end)

  it("says which file is full", function()
    local device = io.open("/dev/full", "w")
    if not device then return end
    device:close()
    local code, stdout, stderr = scene(small, "--repeat 1 --csv /dev/full")
    assert.equal(1, code)
    has(stderr, "cannot write /dev/full: ")
    has(stdout, "affine symbols=10")
  end)

  it("writes records", function()
    local found, json = pcall(require, "cjson")
    if not found then return end
    local code, stdout, stderr = scene(small, "--json -")
    assert.equal(0, code)
    has(stderr, "the scene itself", "affine symbols=10")
    local records = {}
    for line in stdout:gmatch "[^\n]+" do
      local record = json.decode(line)
      if record.record ~= "provenance" and record.record ~= "plugin" then records[#records + 1] = record end
    end
    assert.equal(9, #records)
    assert.equal("row", records[3].record)
    assert.equal("affine", records[3].arithmetic)
    assert.equal("5", records[3].options.symbols)
    assert.is_true(records[3].values.u[1] <= 1 and records[3].seconds_run > 0)
    assert.equal("result", records[9].record)
    assert.equal("compare", records[9].verb)
    assert.equal(5, records[9].settings.repeats)
  end)

  it("draws, with nothing but itself", function()
    local svg, csv = os.tmpname(), os.tmpname()
    local code, stdout, stderr = scene(small, ("--csv %s --svg %s"):format(csv, svg), "PATH=/nonexistent")
    assert.equal(0, code, stderr)
    has(stdout, "affine symbols=10")
    has(read(csv), "affine")
    local text = read(svg)
    has(text, "<svg", "</svg>", "CPU time of one run", "affine, by symbols",
      "largest overestimation of u, v: width / sampled width")
    local lxp = require "lxp"
    local open, markers = 0, 0
    local parser = lxp.new { StartElement = function(_, name, attributes)
      open = open + 1
      if attributes.class == "dot" then markers = markers + 1 end
      for _, key in ipairs { "x", "y", "cx", "cy" } do -- nothing is drawn outside
        local at = tonumber(attributes[key])
        assert.is_true(at == nil or (at > -5 and at < 1300), name)
      end
    end, EndElement = function() open = open - 1 end }
    assert(parser:parse(text))
    assert(parser:parse())
    assert.equal(0, open)
    assert.is_true(markers >= 8, markers) -- of the legend and of the points
    os.remove(svg)
    os.remove(csv)
  end)

  it("draws around widths beyond the axis", function()
    local svg = os.tmpname()
    local code, _, stderr = scene([[
      local ambit = require "ambit"
      ambit.evaluate { ambit.between(0, 5e-324) }
      ambit.evaluate { ambit.between(0, 8e307) }]], "--repeat 1 --svg " .. svg)
    assert.equal(0, code, stderr)
    has(read(svg), "1. interval: 4.94e-324 is beyond the axis", "no enclosure with a finite width above zero")
  end)

  it("takes names of results that are no UTF-8", function()
    local text = [[
      local ambit = require "ambit"
      local x = ambit.between(1, 2)
      ambit.evaluate { { ["\xff\x80\1%s"] = x * x - x, [("\xe9"):rep(300)] = x ^ 3 } }]]
    local svg = os.tmpname()
    local code, stdout, stderr = scene(text, "--repeat 1 --svg " .. svg)
    assert.equal(0, code, stderr)
    has(stdout, "width of \xff\x80\1%s")
    local picture = read(svg)
    assert.truthy(utf8.len(picture))
    assert.falsy(picture:find "[\1-\8]")
  end)

  it("lists what failed, in the table and in the files", function()
    local folder, csv = os.tmpname(), os.tmpname()
    os.remove(folder)
    os.execute(("mkdir -p %s/arithmetic"):format(folder))
    write("not a library", folder .. "/arithmetic/broken.so")
    local path = ('AMBIT_PATH="%s:$AMBIT_PATH"'):format(folder)
    local code, stdout = scene("local ambit = require 'ambit' ambit.evaluate { ambit.between(0, 1) ^ 2 }",
      "--repeat 1 --csv " .. csv, path)
    os.execute("rm -r " .. folder)
    assert.equal(0, code)
    assert.truthy(stdout:find "\n +broken +failed")
    assert.truthy(stdout:find "\nbroken: failed: [^\n]*broken")
    assert.truthy(read(csv):find "broken,,no,failed,[^\r]*broken")
  end)

  it("says what it leaves out", function()
    local code, _, stderr, file = scene [[
      local ambit = require "ambit"
      ambit.sample { ambit.between(0, 1), n = 3 }]]
    assert.equal(1, code)
    has(stderr, file .. " asks nothing that can be compared", "not sample (1)")
    code, _, stderr = scene([[
      local ambit = require "ambit"
      ambit.sample { ambit.between(0, 1), n = 3 }
      ambit.evaluate { ambit.between(0, 1) }
      os.exit(7)]], "--repeat 1")
    assert.equal(0, code)
    has(stderr, "left out: sample (1)")
    code, _, stderr = scene "print 'hello'"
    assert.equal(1, code)
    has(stderr, "asks nothing that can be compared")
  end)

  it("compares what a scene asked before it failed", function()
    local code, stdout, stderr = scene([[
      local ambit = require "ambit"
      ambit.evaluate { ambit.between(0, 1) }
      error "later"]], "--repeat 1")
    assert.equal(1, code)
    has(stderr, "later", "before it failed")
    has(stdout, "1 result of 1 uncertain datum")
  end)

  it("shows what the scene compares itself", function()
    local code, stdout = scene [[
      local ambit = require "ambit"
      local x = ambit.between(1, 2)
      ambit.compare { x * x - x, arithmetics = { "interval" } }]]
    assert.equal(0, code)
    has(stdout, "1. ", "interval")
    assert.falsy(stdout:find "real")
  end)

  it("stops at bad input", function()
    local code, _, stderr = run "--cvs x scene.lua"
    assert.equal(2, code)
    has(stderr, "unknown option `--cvs`", "`--csv`")
    assert.equal(2, (run "--csv"))
    code, _, stderr = scene(small, "--csv /tmp/one --svg /tmp/one")
    assert.equal(1, code)
    has(stderr, "--csv and --svg name the same file")
    code, _, stderr = scene(small, "--repeat 1 --svg /dev/full")
    assert.equal(1, code)
    has(stderr, "/dev/full")
    assert.equal(2, (run ""))
    code, _, stderr = scene(small, "--csv /nonexistent/x.csv")
    assert.equal(1, code)
    has(stderr, "/nonexistent/x.csv")
    code, _, stderr = scene(small, "--repeat none")
    assert.equal(1, code)
    has(stderr, "repeats", "none")
    code, _, stderr = scene "error 'later'"
    assert.equal(1, code)
    has(stderr, "later")
    local stdout
    code, stdout = run "--help"
    assert.equal(0, code)
    has(stdout, "usage: ambit compare")
  end)
end)
