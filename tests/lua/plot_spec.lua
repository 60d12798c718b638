-- The verb plot: what its boxes claim holds for motions whose closed form is known, bad input, files.
local ambit = require "ambit"
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function quoted(s) return "'" .. s:gsub("'", "'\\''") .. "'" end

local function read(name)
  local file = io.open(name, "rb")
  local text = file and file:read "a"
  if file then file:close() end
  return text
end

local function message(f, ...)
  local good, problem = pcall(f, ...)
  assert.is_false(good)
  return tostring(problem)
end

-- x = a cos t + b sin t with a in [.9, 1.1], b in [-.1, .1]
local function oscillator(t, more)
  local q = { ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end },
    initial = { x = ambit.between("0.9", "1.1"), v = ambit.between("-0.1", "0.1") }, t = t or { 0, 4 } }
  for key, value in pairs(more or {}) do q[key] = value end
  return ambit.simulate(q)
end

-- The rows of a CSV text as lists of numbers; an empty cell is nan.
local function rows_of(text)
  local rows, head = {}, nil
  for line in text:gmatch "[^\n]+" do
    if not head then
      head = line
    else
      local row = {}
      for cell in (line .. ","):gmatch "([^,]*)," do row[#row + 1] = tonumber(cell) or 0 / 0 end
      rows[#rows + 1] = row
    end
  end
  return rows, head
end

local room = 1e-12 -- of the closed forms, which are calculated in doubles

-- f(x, v, t) of all solutions is within the bounds.
local function holds_all(rows, column, f)
  local tried = 0
  for _, row in ipairs(rows) do
    for k = 0, 4 do
      local t = row[1] + (row[2] - row[1]) * k / 4
      for _, a in ipairs { 0.9, 1, 1.1 } do
        for _, b in ipairs { -0.1, 0, 0.1 } do
          local value = f(a * math.cos(t) + b * math.sin(t), b * math.cos(t) - a * math.sin(t), t)
          assert.is_true(row[column] - room <= value and value <= row[column + 1] + room)
          tried = tried + 1
        end
      end
    end
  end
  return tried
end

local function quantities()
  return { "x", energy = function(s) return s.x ^ 2 + s.v ^ 2 end, moved = function(s, _, t) return s.x + t end }
end

describe("plot", function()
  for _, solver in ipairs { "lohner", "taylor_model", "zonotope", "stiff" } do
    it("encloses quantities at instants and between them, by " .. solver, function()
      local rows, head = rows_of(oscillator(nil, { solver = solver }):csv { quantities = quantities() })
      assert.equal("t_from,t_to,x lo,x hi,energy lo,energy hi,moved lo,moved hi", (head:gsub(" %[.-%]", "")))
      assert.is_true(#rows > 40)
      local tried = holds_all(rows, 3, function(x) return x end)
      holds_all(rows, 5, function(x, v) return x * x + v * v end)
      holds_all(rows, 7, function(x, _, t) return x + t end)
      assert.is_true(tried >= 45 * #rows)
      assert.is_true(rows[#rows][4] - rows[#rows][3] < 0.5) -- and is not much too wide
    end)
  end

  it("goes backwards, and starts at a time that is no double", function()
    holds_all(rows_of(oscillator({ 0, -2 }):csv { quantities = { "x" } }), 3, function(x) return x end)
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function() return { x = 1 } end },
      initial = { x = "1/3" }, t = { "1/3", 1 } }
    for _, row in ipairs(rows_of(run:csv { quantities = { gap = function(s, _, t) return s.x - t end } })) do
      assert.is_true(row[3] <= 0 and 0 <= row[4] and row[4] - row[3] < 2)
    end
  end)

  it("judges limits by what is proved", function()
    local run = oscillator { 0, 1 }
    local function verdict(pair) return run:plot { limits = { x = pair }, sample = false }.verdicts.x end
    assert.equal("holds", verdict { "0.3", "1.2" })
    assert.equal("holds", verdict { nil, "1.2" })
    assert.equal("fails", verdict { "0.8", nil }) -- cos 1 < .55
    assert.equal("undecided", verdict { "0.5", nil })
    local gsl = oscillator({ 0, 1 }, { solver = "gsl" })
    assert.equal("undecided", gsl:plot { limits = { x = { -9, 9 } } }.verdicts.x)
  end)

  it("does not say that a limit holds which a run did not reach", function()
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end },
      initial = { x = 1 }, t = { 0, 2 }, solver = "lohner", partial = true }
    assert.equal("unable", run.status)
    assert.equal("undecided", run:plot { limits = { x = { 0, 1e300 } } }.verdicts.x)
  end)

  it("draws the set at the end in a plane by its outline", function()
    local plot = oscillator():plot { quantities = { "x", "v" }, against = "x" }
    local polygon, middle = plot.outlines[2], plot.outlines[2].middle
    assert.is_true(#polygon >= 4)
    for a = 0.9, 1.1, 0.05 do -- each point of the set is on one side of every edge
      for b = -0.1, 0.1, 0.05 do
        local x = a * math.cos(4) + b * math.sin(4) - middle[1]
        local v = b * math.cos(4) - a * math.sin(4) - middle[2]
        local side = 0
        for i, p in ipairs(polygon) do
          local q = polygon[i % #polygon + 1]
          local cross = (q[1] - p[1]) * (v - p[2]) - (q[2] - p[2]) * (x - p[1])
          if math.abs(cross) > 1e-9 then
            assert.is_true(side == 0 or cross * side > 0)
            side = cross
          end
        end
      end
    end
    assert.truthy(plot:text "svg":find('<path class="line"', 1, true))
  end)

  it("knows nothing of what the run says nothing about", function()
    local foreign
    ambit.ode { states = { "y" }, equations = function(s) foreign = s.y return { y = 1 } end }
    local problem = message(ambit.plot, { oscillator { 0, 1 }, quantities = { q = foreign } })
    assert.truthy(problem:find("plot: quantities.q: the run says nothing about `y`", 1, true), problem)
  end)

  it("is not deceived by steps that were not kept", function()
    local run = ambit.simulate { ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = -s.x }
    end }, initial = { x = 1, v = 0 }, t = { 0, 6.28 }, keep = "last", solver = "lohner" }
    assert.equal("fails", run:plot { limits = { x = { "0.9", nil } } }.verdicts.x) -- asked once more for all steps
    local many = {}
    for k = 0, 200 do many[k + 1] = 6.28 * k / 200 end
    run = ambit.simulate { ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = -s.x }
    end }, initial = { x = 1, v = 0 }, t = many, keep = "last", solver = "gsl" }
    for _, row in ipairs(rows_of(run:csv { quantities = { "x" } })) do
      assert.is_true(row[1] == row[2] or row[3] ~= row[3] or row[2] - row[1] < 1 or row[3] < -0.9)
    end
  end)

  it("judges no limit of what is not defined for all data", function()
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function() return { x = 0 } end },
      initial = { x = ambit.between(-1, 1) }, t = 1 }
    local plot = run:plot { quantities = { l = function(s) return ambit.log(s.x) end }, limits = { l = { nil, 1 } } }
    assert.equal("undecided", plot.verdicts.l)
    assert.truthy(plot:text "svg":find("only where it is defined", 1, true))
    assert.truthy(plot:text "csv":find("0,0,,", 1, true))
  end)

  it("ends where an event ends the run", function()
    local run = ambit.simulate { ambit.ode { states = { "y", "v" }, equations = function(s)
      return { y = s.v, v = -9.81 }
    end }, initial = { y = ambit.around(10, "1%"), v = 0 }, t = { 0, 3 },
      events = { { g = function(s) return s.y end, name = "ground", direction = "falling", stop = true } } }
    assert.equal("ground", run.ended_by)
    local function verdict(pair) return run:plot { limits = { y = pair } }.verdicts.y end
    assert.is_true(verdict { 0, nil } ~= "fails")
    assert.equal("holds", verdict { -5, "10.2" })
    assert.equal("fails", verdict { 5, nil })
    local rows = rows_of(run:csv { quantities = { "y" } })
    assert.is_true(rows[#rows][2] <= run.events[1].t.hi)
  end)

  it("ends where an event may have ended the run", function()
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function() return { x = 1 } end },
      initial = { x = 0 }, t = { 0, 3 },
      events = { { g = function(s) return (s.x - 1) ^ 3 end, name = "flat", stop = true } } }
    assert.equal("unable.event", run.code)
    assert.is_true(run:plot { limits = { x = { nil, 1.5 } } }.verdicts.x ~= "fails")
  end)

  it("asks once more without the events of the run", function()
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end },
      initial = { x = ambit.around(1, "1%") }, t = { 0, 8 },
      events = { { g = function(s) return s.x - 0.5 end, name = "half", stop = true } } }
    assert.equal("half", run.ended_by)
    local again = run.question.again({ dense = true }, { 0, run.t_reached })
    assert.equal("complete", again.status)
    assert.equal(run.t_reached, again.t_reached)
  end)

  it("samples what leaps", function()
    local run = ambit.simulate { ambit.map { states = { "x" }, next = function(s) return { x = 2 * s.x } end },
      initial = { x = ambit.between("0.9", "1.1") }, t = 5 }
    local plot = run:plot { quantities = { "x", twice = function(s) return 2 * s.x end } }
    local hull = plot.hull
    assert.is_true(hull.hi[hull.k[1]][#hull.t] > 30)
    assert.is_nil(hull.k[2])
  end)

  it("holds at instants that are no doubles", function()
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function() return { x = 1e6 } end },
      initial = { x = 0 }, t = { "1/3", 1 } }
    local third = ambit.number "1/3"
    local function inside(t, row) -- 1e6 (t - 1/3), exactly
      local x = ambit.interval(1e6 * (ambit.number(t) - third))
      return row[3] <= x.lo and x.hi <= row[4]
    end
    local rows = rows_of(run:csv())
    assert.is_true(rows[1][1] < rows[1][2] and not inside(rows[1][1], rows[1]))
    for _, row in ipairs(rows) do
      if row[2] - row[1] > 1e-9 then assert.is_true(inside(row[1], row) and inside(row[2], row)) end
    end
  end)

  it("outlines sets that are small beside where they are", function()
    local run = ambit.simulate { ambit.ode { states = { "x", "y" }, equations = function()
      return { x = 1, y = 1 }
    end }, initial = { x = ambit.around(7e6, 2e-8), y = ambit.around(1, 1) }, t = 1 }
    local polygon = assert(run:plot { against = "x" }.outlines[2])
    local left, right, off = math.huge, -math.huge, 7000001 - polygon.middle[1] -- exactly
    for _, p in ipairs(polygon) do left, right = math.min(left, p[1]), math.max(right, p[1]) end
    assert.is_true(left <= off - 2e-8 and off + 2e-8 <= right)
  end)

  it("says what is wrong with its input", function()
    local run = oscillator { 0, 1 }
    local function says(text, t) assert.truthy(message(ambit.plot, t):find(text, 1, true), message(ambit.plot, t)) end
    says("plot: expected what ambit.simulate returned as the first entry, got number", { 1 })
    says("plot: quantities[1]: there is no state `y`; did you mean", { run, quantities = { "y" } })
    says("plot: quantities: expected names of states or formulas, got an empty table", { run, quantities = {} })
    says("plot: limits: there is no quantity `z`", { run, limits = { z = { 0, 1 } } })
    says("plot: limits.x: the lowest is above the highest", { run, limits = { x = { 2, 1 } } })
    says("plot: limits.x: expected { lowest, highest }", { run, limits = { x = {} } })
    says("a limit cannot be uncertain", { run, limits = { x = { ambit.between(0, 1) } } })
    says("plot: against: there is no quantity `w`", { run, against = "w" })
    says("expected a name that ends with one of .svg", { run, file = "p.jpeg" })
    says("plot: cannot write", { run, file = "/nowhere/p.svg" })
    says("unknown key `limit`; did you mean `limits`?", { run, limit = {} })
    says("plot: sample: expected a positive integer", { run, sample = 0 })
    says("there are two of the name", { run, quantities = { "x", x = function(s) return s.v end } })
  end)

  it("knows what csv is asked for", function()
    local run = oscillator { 0, 1 }
    assert.truthy(message(run.csv, run, { "x" }):find("csv: unexpected entry [1]", 1, true))
    assert.truthy(message(run.csv, run, { sample = 3 }):find("csv: unknown key `sample`", 1, true))
  end)

  it("writes what the name of the file says", function()
    local base, run = os.tmpname(), oscillator { 0, 1 }
    run:plot { file = { base .. ".svg", base .. ".html", base .. ".csv" }, title = "a < b & c" }
    local svg, html, csv = read(base .. ".svg"), read(base .. ".html"), read(base .. ".csv")
    assert.truthy(svg:find("a &lt; b &amp; c", 1, true) and svg:find("sampled motions", 1, true))
    assert.truthy(html:find("Enclosures over time", 1, true) and not html:find("@%u+@"))
    assert.truthy(csv:find "^t_from,t_to,x")
    if os.execute "command -v rsvg-convert >/dev/null 2>&1" then
      run:plot { file = { base .. ".png", base .. ".pdf" } }
      assert.equal("\137PNG", read(base .. ".png"):sub(1, 4))
      assert.equal("%PDF", read(base .. ".pdf"):sub(1, 4))
    end
    for _, format in ipairs { "svg", "html", "csv", "png", "pdf" } do os.remove(base .. "." .. format) end
    os.remove(base)
  end)

  it("keeps names of a scene from being anything else in its files", function()
    local run = ambit.simulate { ambit.ode { states = { '=1+1,"<b>' }, equations = function()
      return { ['=1+1,"<b>'] = 1 }
    end }, initial = { ['=1+1,"<b>'] = 0 }, t = 1 }
    local plot = run:plot()
    assert.truthy(plot:text "csv":find([["'=1+1,""<b> lo"]], 1, true))
    assert.is_nil(plot:text "svg":find("<b>", 1, true))
    assert.is_nil(plot:text "html":find("<b>", 1, true))
  end)
end)

describe("ambit run --plot", function()
  local scene = os.tmpname() .. ".lua"
  local base = os.tmpname()

  local function run(words)
    local line = 'ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0" %s run %s %s 2>&1' -- a sandbox starts no other process
    local pipe = io.popen(line:format(quoted(command), words, quoted(scene)))
    local text = pipe:read "a"
    local _, _, code = pipe:close()
    return code, text
  end

  local function write(text)
    local file = assert(io.open(scene, "w"))
    file:write('local ambit = require "ambit"\n', text)
    file:close()
  end

  local simulate = [[ambit.simulate { ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end },
    initial = { x = 1 }, t = 1 }
]]

  it("draws each simulation, also of a stranger's scene", function()
    write(simulate .. simulate)
    for _, words in ipairs { "", "--sandbox " } do
      local code, text = run(words .. "--plot " .. base .. ".svg")
      assert.equal(0, code, text)
      assert.truthy(read(base .. ".svg") and read(base .. "-2.svg"))
      os.remove(base .. ".svg")
      os.remove(base .. "-2.svg")
    end
  end)

  it("lets a stranger's scene write nothing else", function()
    write("local run = " .. simulate .. ("print(pcall(run.plot, run, { file = %q }))"):format(base .. "-own.svg"))
    local code, text = run("--sandbox --plot " .. base .. ".svg")
    assert.equal(0, code, text)
    assert.truthy(text:find("not in a sandbox", 1, true), text)
    assert.is_nil(read(base .. "-own.svg"))
    os.remove(base .. ".svg")
  end)

  it("leaves records as they are", function()
    write(simulate)
    local function records(words)
      local code, text = run(words .. "--json " .. base .. ".json")
      assert.equal(0, code, text)
      local steps = select(2, read(base .. ".json"):gsub('"record":"step"', ""))
      os.remove(base .. ".json")
      return steps
    end
    assert.equal(records "", records("--plot " .. base .. ".svg "))
    os.remove(base .. ".svg")
  end)

  it("says what is wrong before and after", function()
    write "print(1)"
    for words, expected in pairs { ["--plot x.foo"] = "--plot: expected a name that ends with one of .svg",
      ["--sandbox --plot x.png"] = "which --sandbox lets nobody start",
      ["--plot /nowhere/x.svg"] = "--plot: cannot write",
      ["--plot " .. base .. ".svg"] = "there is nothing to draw" } do
      local code, text = run(words)
      assert.is_true(code ~= 0)
      assert.truthy(text:find(expected, 1, true), text)
    end
  end)

  teardown(function()
    os.remove(scene)
    os.remove(base)
  end)
end)
