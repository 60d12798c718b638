-- What a reduction shows: text, table, JSON, picture, sampled errors, rankings judged; on tables as the driver fills
-- them, whose true errors are known in closed form.
local ambit = require "ambit"
local core = require "ambit.core"
local report = require "ambit.reduce.report"
local judge = require "ambit.reduce.report_judge"
local number = require "ambit.report.number"

local between = ambit.between

-- x' = -k x + c against x' = -k x, x(0) = 1: off by c/k (1 - exp(-k t))
local function models(k, c)
  local x = core.symbol("x", "1")
  local output = { { name = "x", unit = "1", expression = x } }
  local detailed = { states = { "x" }, units = { "1" }, symbols = { x }, rates = { c - k * x }, outputs = output }
  local reduced = { states = { "x" }, units = { "1" }, symbols = { x }, rates = { -k * x }, outputs = output }
  return detailed, reduced
end

local function facts(changes)
  local k, c = between(1, 2, "k"), between("0.001", "0.01", "c")
  local detailed, reduced = models(k, c)
  local self = {
    status = "complete", reason = "", detailed = detailed, model = reduced, outputs = { "x" }, bounds = { 0.02 },
    error = { x = 0.0100001 }, criterion = "difference", ranking = "residual", rankings = {}, cluster = 10,
    settings = { options = { "order", "12" } },
    given = { { name = "decay", times = { 0.0, 5.0 }, initial = { x = core.expression(1) }, leaves = {},
      values = {} } },
    scenarios = { { name = "decay", error = { x = 0.0100001 }, when = { x = 5.0 }, status = "proved", reason = "",
      cpu_seconds = 0.25, steps = 12, solver = "lohner", arithmetic = "interval" } },
    terms = {
      { pass = 1, equation = "x", level = 1, text = "c", technique = "neglect", replacement = "0", rank = 0.012,
        effect = { x = 0.0100001 }, status = "cut" },
      { pass = 1, equation = "x", level = 1, text = "-k*x", technique = "neglect", replacement = "0", rank = 3.1,
        effect = { x = 0.5 }, status = "kept" },
      { pass = 1, equation = "x", level = 2, text = "k", technique = "constant", rank = 0 / 0, status = "kept" },
    },
    log = { { pass = 1, outcome = "accepted", candidates = { "x: c" }, error = { x = 0.0100001 } },
      { pass = 1, outcome = "undone", candidates = { "x: -k*x" }, error = { x = 0.5 } } },
    history = { { terms = 2, error = { x = 0 } }, { terms = 1, error = { x = 0.0100001 } } },
    terms_before = 2, terms_after = 1, equations_before = 1, equations_after = 1, operations_before = 3,
    operations_after = 2, proofs = 3, cpu_seconds = 0.5, cpu_seconds_rank = 0.001, cpu_seconds_detailed = 0.1,
  }
  for key, value in pairs(changes or {}) do self[key] = value end
  return report.of(self)
end

local function has(text, part)
  if not text:find(part, 1, true) then error(("expected %q in\n%s"):format(part, text), 2) end
end

local function assert_refused(part, f, ...)
  local good, message = pcall(f, ...)
  assert.is_false(good)
  has(tostring(message), part)
end

local function read(path)
  local file = assert(io.open(path))
  local text = file:read "a"
  file:close()
  return text
end

describe("numbers of a reduction", function()
  it("rounds a bound up, never down", function()
    local x, seed = 0, 12345
    for _ = 1, 2000 do
      seed = (1103515245 * seed + 12345) % 2147483648
      x = (seed / 2147483648 - 0.3) * 10.0 ^ (seed % 40 - 20)
      for digits = 1, 6 do
        local text = number.up(x, digits)
        assert.is_true(core.interval(text).lo >= x)
        assert.is_true(tonumber(text) - x <= 1.0001 * 10.0 ^ (math.floor(math.log(math.abs(x), 10)) - digits + 1))
      end
    end
    assert.equal("0.0729", number.up(0.07280001))
    assert.equal("0.5", number.up(0.5))
    assert.equal("inf", number.up(math.huge))
    assert.equal("0", number.up(0.0))
  end)

  it("shows ranges as they were written, and never wider ones", function()
    for _, text in ipairs { "[0.001, 0.01]", "[16.6, 19.4]", "[-0.3, 0.1]" } do
      local x = core.interval(text)
      assert.equal(text, number.range(x.lo, x.hi))
    end
    local x = core.interval(1) / 3
    assert.equal(x.lo, tonumber(number.range(x.lo, 1):match "^%[(.*), 1%]$"))
  end)

  it("says 100 % only of what is at most the bound", function()
    assert.equal("100 %", number.percent(1))
    assert.equal("101 %", number.percent(1.0000001))
    assert.equal("< 1 %", number.percent(1e-9))
    assert.equal("0 %", number.percent(0))
  end)
end)

describe("a reduction as text", function()
  it("shows equations, errors, terms and the certificate", function()
    local text = tostring(facts())
    has(text, "complete: 1 of 2 terms, 1 of 1 equations, 2 of 3 operations are left")
    has(text, "d x/dt = -x*k")
    has(text, "0.0101")            -- the proved error, rounded up
    has(text, "51 %")
    has(text, "t = 5 s")
    has(text, "cut: 1")
    has(text, "neglect")
    has(text, "kept: 2")
    has(text, "would be 0.5 (2500 % of bound)")
    has(text, "not tried")
    has(text, "difference: max over all times")
    has(text, "decay")
    has(text, "x = 1")
    has(text, "c in [0.001, 0.01]")     -- the data of the scenario, with their ranges
    has(text, "proved with lohner over interval, 12 steps")
    has(text, "order = 12")
    has(text, "ranking residual, clusters within a factor of 10, 3 proofs")
    has(text, ambit.version)
  end)

  it("fits a terminal, whatever terms are called", function()
    local long = ("sin(x)*cos(x) + "):rep(40) .. "1"
    local x = core.symbol("x", "1")
    local sum = x
    for k = 1, 60 do sum = sum + ambit.sin(k * x) * x end
    local self = facts {}
    self.terms[1].text, self.terms[1].replacement = long, long
    self.model.rates = { sum }
    local own, provenance = tostring(self):match "^(.*)(\n%s*provenance\n.*)$" -- files and hashes are not cut
    for line in own:gmatch "[^\n]+" do assert.is_true(utf8.len(line) <= 100) end
    has(provenance, "SHA-256")
    for _, width in ipairs { 40, 60, 200 } do
      for line in self:table(width):gmatch "[^\n]+" do
        if width >= 60 and utf8.len(line) > width then error(("%d: %s"):format(width, line)) end
      end
    end
    has(self:json(), "sin(x)*cos(x) + sin(x)")
    has(self:table(), "...")
    has(self:json(), long)         -- in full there
    assert_refused("table: width: expected a positive integer, got -3", self.table, self, -3)
  end)

  it("shows the first rows of many, and all of them as a table", function()
    local self = facts()
    for k = 1, 100 do
      self.terms[#self.terms + 1] = { pass = 1, equation = "x", level = 1, text = "t" .. k, technique = "neglect",
        rank = k, effect = {}, status = "kept" }
    end
    has(tostring(self), "kept: 102")
    has(tostring(self), "... and 78 more: result:table()")
    assert.is_nil(tostring(self):find("t100 ", 1, true))
    has(self:table(), "t100 ")
    has(self:table(), "no proof within bound")
  end)

  it("says why it ended and what was not proved", function()
    local text = tostring(facts { status = "stopped", reason = "the budget is spent", error = {}, scenarios = {} })
    has(text, "stopped: 1 of 2 terms")
    has(text, "the budget is spent")
    has(text, "not proved")
  end)

  it("gives the rows as a table", function()
    local rows = facts():report()
    assert.equal(3, #rows)
    assert.equal("c", rows[1].term)
    assert.equal("cut", rows[1].status)
    assert.equal("x", rows[1].output)
    assert.equal(0.0100001, rows[1].error)
    assert.is_true(math.abs(rows[2].share - 25) < 1e-12)
    assert.is_nil(rows[3].error)
  end)

  it("lists the decisions", function()
    local text = facts():decisions()
    has(text, "1. pass 1: accepted x: c: x 0.0101")
    has(text, "2. pass 1: undone x: -k*x: x 0.5")
  end)

  it("names the output that a cluster brings closest to its bound", function()
    local self = facts { outputs = { "x", "y" }, bounds = { 1, 0.1 }, error = { x = 0.5, y = 0.09 } }
    self.terms[1].effect = { x = 0.5, y = 0.09 }
    local row = self:report()[1]
    assert.equal("y", row.output)
    has(tostring(self), "y: 0.09 (90 % of bound)")
  end)

  it("refuses a dot for a colon", function()
    local self = facts()
    assert_refused("table: expected the reduction in front of the colon", self.table, 80)
  end)
end)

describe("a reduction as JSON", function()
  local found, cjson = pcall(require, "cjson")

  it("is complete, and valid with numbers that are none", function()
    if not found then return pending "no cjson" end
    local self = facts()
    self.log[2].error, self.history[1].error = { x = math.huge }, { x = math.huge }
    local whole = cjson.decode(self:json())
    assert.equal(ambit.version, whole.ambit)
    assert.equal("complete", whole.status)
    assert.equal(0.0100001, whole.outputs[1].error)
    assert.equal(0.02, whole.outputs[1].bound)
    assert.equal(cjson.null, whole.terms[3].rank)
    assert.equal("inf", whole.log[2].error.x)
    assert.equal("inf", whole.history[1].error.x)
    assert.equal("neglect", whole.terms[1].technique)
    assert.equal("order", whole.settings.options[1])
    assert.equal("x", whole.detailed.states[1].name)
    assert.equal("-x*k", whole.reduced.equations[1].text)
    assert.equal(2, #whole.history)
  end)

  it("tells the data that the proof was for", function()
    if not found then return pending "no cjson" end
    local v = core.symbol("v", "1")
    local self = facts()
    local speed = between("16.6", "19.4", "v")
    self.detailed.rates, self.model.rates = { v * self.detailed.symbols[1] }, { v }
    self.given[1].leaves, self.given[1].values, self.given[1].initial.x = { v }, { speed }, 2 * speed
    local s = cjson.decode(self:json()).scenarios[1]
    assert.equal("v", s.data[1].name)
    assert.equal(core.interval("16.6").lo, s.data[1].lo)
    assert.equal("v", s.given.v)
    assert.equal("2*v", s.initial.x)
    assert.equal(5, s.times[2])
    assert.equal("lohner", s.solver)
  end)

  it("survives any name", function()
    if not found then return pending "no cjson" end
    local self = facts()
    self.terms[1].text = 'a"\\\n</script>\255\0é'
    local whole = cjson.decode(self:json())
    assert.equal('a"\\\n</script>\u{FFFD}\0é', whole.terms[1].text)
  end)

  it("goes into a file, or says why not", function()
    local self, path = facts(), os.tmpname()
    local text = self:json(path)
    assert.equal(text, read(path))
    os.remove(path)
    assert_refused("json: cannot write the file: ", self.json, self, path .. "/no/such/folder.json")
    assert.is_true(#self:json() > 100)
    assert_refused("json: file: expected text, got number", self.json, self, 3)
    if io.open("/dev/full", "a") then assert_refused("json: cannot write the file: /dev/full", self.json, self, "/dev/full") end
  end)
end)

describe("the sampled error", function()
  local EXACT = 0.01 * (1 - math.exp(-5)) -- of c = 0.01, k = 1 at t = 5

  it("comes up to the true one from inside", function()
    local self = facts()
    local s = self:sample { draws = 100, seed = 7 }
    assert.equal(0, s.failed)
    assert.is_true(s.error.x <= EXACT * (1 + 1e-9))
    assert.is_true(s.error.x >= 0.999 * EXACT) -- corners are among the draws
    assert.equal(5, s.when.x)
    assert.is_true(math.abs(s.over.x - 0.0100001 / s.error.x) < 1e-12)
    local curve = s.scenarios[1].curve.x
    assert.equal(0, curve[1])
    for i = 2, #curve do assert.is_true(curve[i] >= curve[i - 1]) end
    has(tostring(s), "sampled: 100 draws with seed 7, all reached the end")
    assert.equal(s.error.x, self:sample({ draws = 100, seed = 7 }).error.x)
  end)

  it("does not lose an error far below the output", function()
    local detailed, reduced = models(between(1, 2), core.expression "1e-12")
    local s = facts { detailed = detailed, model = reduced }:sample { draws = 50 }
    local exact = 1e-12 * (1 - math.exp(-5))
    assert.is_true(s.error.x <= exact and s.error.x > 0.9 * exact) -- less what the draws may be off by
  end)

  it("takes outputs that are no states, what scenarios vary, and several scenarios", function()
    local x, k = core.symbol("x", "1"), core.symbol("k", "1")
    local function model(rate)
      return { states = { "x" }, units = { "1" }, symbols = { x }, rates = { rate },
        outputs = { { name = "square", unit = "1", expression = x ^ 2 } } }
    end
    local function given(name, value, at)
      return { name = name, times = { 0.0, 1.0 }, initial = { x = at }, leaves = { k }, values = { value } }
    end
    local start = between(1, 2)
    local s = facts { detailed = model(-k * x), model = model(core.expression(0)), outputs = { "square" },
      bounds = { 10 }, error = { square = 4 }, given = { given("slow", between("0.1", "0.2"), start),
        given("fast", core.expression(1), start) } }:sample { draws = 40 }
    local exact = 4 - 4 * math.exp(-2)
    assert.is_true(math.abs(s.error.square - exact) < 1e-6)
    assert.equal("fast", s.worst.square)
    assert.equal(2, #s.scenarios)
    has(tostring(s), "t = 1 s, fast")
  end)

  it("follows the definition of the criterion", function()
    -- both hulls are [1, 2] at the end, but x = 1 + p becomes x = 2 - p: the difference is up to 1, the bounds agree
    local x, p = core.symbol("x", "1"), between(0, 1)
    local function model(rate)
      return { states = { "x" }, units = { "1" }, symbols = { x }, rates = { rate },
        outputs = { { name = "x", unit = "1", expression = x } } }
    end
    local changes = { detailed = model(p), model = model(1 - p), bounds = { 2 }, error = { x = 1 } }
    local start = { x = core.expression(1) }
    changes.given = { { name = "s", times = { 0.0, 1.0 }, initial = start, leaves = {}, values = {} } }
    assert.is_true(math.abs(facts(changes):sample({ draws = 40 }).error.x - 1) < 1e-9)
    changes.criterion = "bounds"
    assert.is_true(facts(changes):sample({ draws = 40 }).error.x < 1e-9)
  end)

  it("says what it cannot sample", function()
    local detailed, reduced = models(between(1, 2), core.expression "0.01")
    for _, m in ipairs { detailed, reduced } do
      m.outputs = { { name = "x", unit = "1", expression = ambit.abs(m.symbols[1] - "0.5") } }
    end
    local s = facts { detailed = detailed, model = reduced }:sample { draws = 10 }
    assert.is_nil(s.error.x)
    has(tostring(s), "no derivative: not sampled")
    local self = facts()
    assert_refused("sample: unknown key `drawz`; did you mean `draws`?", self.sample, self, { drawz = 3 })
    assert_refused("sample: draws: expected a positive integer, got 0", self.sample, self, { draws = 0 })
    assert_refused("sample: seed: expected an integer, got the text `x`", self.sample, self, { seed = "x" })
  end)

  it("counts draws that do not reach the end", function()
    local x = core.symbol("x", "1")
    local function model(rate)
      return { states = { "x" }, units = { "1" }, symbols = { x }, rates = { rate },
        outputs = { { name = "x", unit = "1", expression = x } } }
    end
    local s = facts { detailed = model(x ^ 2), model = model(x) }:sample { draws = 4 }
    assert.equal(4, s.failed) -- x = 1/(1 - t)
    has(tostring(s), "4 did not reach the end")
  end)
end)

describe("rankings", function()
  it("are judged by Spearman's correlation", function()
    assert.equal(1, judge.spearman({ 1, 2, 3, 4 }, { 10, 200, 3000, 40000 }))
    assert.equal(-1, judge.spearman({ 1, 2, 3, 4 }, { 4, 3, 2, 1 }))
    -- textbook: 10 pairs, no ties, sum of d^2 = 194: 1 - 6 * 194 / (10 * 99)
    local iq = { 106, 86, 100, 101, 99, 103, 97, 113, 112, 110 }
    local tv = { 7, 0, 27, 50, 28, 29, 20, 12, 6, 17 }
    assert.is_true(math.abs(judge.spearman(iq, tv) - (1 - 6 * 194 / 990)) < 1e-14)
    -- ties share their places: { 1, 2.5, 2.5, 4 } against { 1, 2, 3, 4 }
    assert.is_true(math.abs(judge.spearman({ 1, 2, 2, 3 }, { 1, 2, 3, 4 }) - 4.5 / math.sqrt(4.5 * 5)) < 1e-14)
    assert.is_nil(judge.spearman({ 1, 1, 1 }, { 1, 2, 3 }))
  end)

  it("are held against the exact one, pass by pass", function()
    local self = facts { rankings = {
      { pass = 1, residual = { 1, 2, 3, 0 / 0 }, one_step = { 3, 2, 1, 0 }, exact = { 1, 20, 300, 5 } },
      { pass = 2, residual = { 1, 2 } } } }
    local rows = self:judge()
    assert.equal(2, #rows)
    assert.equal("one_step", rows[1].ranking)
    assert.equal(4, rows[1].candidates)
    assert.equal("residual", rows[2].ranking)
    assert.equal(3, rows[2].candidates)
    assert.equal(1, rows[2].correlation)
    has(tostring(self), "1, 4 candidates: one_step -0.40, residual 1.00")
    assert_refused("judge: there is no exact ranking", facts().judge, facts())
  end)
end)

describe("the picture", function()
  local picture = require "ambit.reduce.picture"

  it("draws both panels and needs nothing but itself", function()
    local self = facts { outputs = { "x" } }
    local s = self:sample { draws = 10 }
    local curves = { { name = "decay", t = { 0, 1, 5 }, error = { x = { 0, 0.008, 0.0100001 } } } }
    local text = picture.text(self, curves, s)
    has(text, "<svg xmlns")
    has(text, "prefers-color-scheme:dark")
    has(text, "number of terms")
    has(text, "t in s")
    has(text, "bound 0.02, proved 0.0101")
    assert.is_nil(text:find("nan", 1, true))
    assert.is_nil(text:find("inf", 1, true))
    assert.is_nil(text:find("href", 1, true))
    local _, dots = text:gsub('<circle class="dot"', "")
    assert.is_true(dots > 40 and dots < 80)
    local _, rings = text:gsub('<circle class="ring"', "")
    assert.equal(1, rings) -- the error 0 of the whole model
  end)

  it("stands errors that are zero, infinite or missing, and any name", function()
    local self = facts { outputs = { "<x&\255>" }, bounds = { 1 }, error = {}, history = {} }
    local text = picture.text(self, {}, nil)
    has(text, "nothing was cut")
    has(text, "&lt;x&amp;?&gt;")
    self.history = { { terms = 3, error = { ["<x&\255>"] = math.huge } }, { terms = 2, error = {} } }
    text = picture.text(self, { { name = "a", t = { 0, 1 }, error = { ["<x&\255>"] = { 0, 0 } } } }, nil)
    assert.is_nil(text:find("nan", 1, true))
    assert.is_nil(text:find('[ "]inf'))
  end)

  it("refuses a file that cannot be written before it computes anything", function()
    local self = facts()
    assert_refused("picture: cannot write the file: ", self.picture, self, "/no/such/folder/a.svg")
    assert_refused("picture: expected the name of a file", self.picture, self)
  end)
end)

describe("a certificate", function()
  -- the pendulum against its linearisation
  local function certify(t)
    local detailed = ambit.ode { states = { "phi", "omega" },
      equations = function(s) return { phi = s.omega, omega = -ambit.sin(s.phi) } end }
    local linear = ambit.ode { states = { "phi", "omega" },
      equations = function(s) return { phi = s.omega, omega = -s.phi } end }
    t[1], t[2], t.t, t.outputs = detailed, linear, { 0, 5 }, { "phi" }
    t.initial = { phi = ambit.around("0.1", "1%"), omega = 0 }
    return ambit.certify(t)
  end

  it("shows its errors and what they were proved for", function()
    local text = tostring(certify { error = { phi = "0.001" } })
    has(text, "0.000308  0.001  31 %")
    has(text, "initial phi in [0.099, 0.101], phi = initial phi, omega = 0")
    has(text, "proved with lohner over interval")
  end)

  it("can be sampled, drawn and written down", function()
    local c = certify {}
    local s = c:sample { draws = 20 }
    assert.is_true(s.error.phi <= c.error.phi and c.error.phi <= 1.01 * s.error.phi)
    local path = os.tmpname()
    c:picture(path, { draws = 5 })
    local text = read(path)
    has(text, "error of the reduced model")
    has(text, "bound none")
    has(c:json(), '"omega":"0"')
    os.remove(path)
  end)
end)

describe("a whole reduction", function()
  -- Two reservoirs, one of them almost without effect on the other.
  local function reduce(t)
    local tanks = ambit.ode { states = { "upper", "lower" }, parameters = { inflow = 1, leak = "0.001" },
      equations = function(s, p)
        return { upper = p.inflow - s.upper - p.leak * s.upper ^ 2 + "1e-5" * s.lower, lower = s.upper - s.lower }
      end }
    t[1], t.outputs, t.error = tanks, { square = function(s) return s.upper ^ 2 end }, { square = "0.01" }
    t.t, t.initial = { 0, 3 }, function(p) return { upper = p.inflow / 2, lower = ambit.between(0, "0.5") } end
    local function swing(time) return 1 + "0.1" * ambit.sin(3 * time) end
    t.scenarios = { { name = "steady", parameters = { inflow = ambit.between("0.9", "1.1") } },
      { name = "swing", t = { 0, 2 }, inputs = { inflow = swing } } }
    return ambit.reduce(t)
  end

  it("is shown, drawn and sampled", function()
    local small = reduce { ranking = { "residual", "exact" } }
    assert.equal("complete", small.status)
    local text = tostring(small)
    has(text, "d upper/dt = inflow - upper")
    has(text, "square = upper^2")
    has(text, "rank against exact effect")
    has(text, "scenario    steady")
    has(text, "inflow in [0.9, 1.1]")
    has(text, "inflow = 1 + 0.1*sin(3*t)")
    local s = small:sample { draws = 30 }
    assert.is_true(s.error.square > 0 and s.error.square <= small.error.square)
    local path = os.tmpname()
    small:picture(path, { draws = 5 })
    has(read(path), "number of terms")
    os.remove(path)
    assert.is_true(#small:judge() > 0)
    has(small:decisions(), "accepted")
  end)

  it("can be proved again from its JSON alone", function()
    local found, cjson = pcall(require, "cjson")
    if not found then return pending "no cjson" end
    local small = reduce {}
    local whole = cjson.decode(small:json())
    local function value(text, data, s) -- Lua with the names of data, in ambit's words
      local scope = setmetatable({ s = s, t = ambit.time, data = data },
        { __index = function(_, k) return data[k] or ambit[k] end })
      return load("return " .. text, text, "t", scope)()
    end
    for k, scenario in ipairs(whole.scenarios) do
      local data, initial = {}, {}
      for _, datum in ipairs(scenario.data) do data[datum.name] = between(datum.lo, datum.hi) end
      for name, text in pairs(scenario.given) do data[name] = value(text, data) end
      for name, text in pairs(scenario.initial) do initial[name] = value(text, data) end
      local function output(model)
        return function(s) return value(model.outputs[1].lua, data, s) end
      end
      local again = ambit.certify { load(whole.detailed.lua)(data), load(whole.reduced.lua)(data), initial = initial,
        t = scenario.times, outputs = { square = output(whole.detailed) }, error = { square = whole.outputs[1].bound },
        reduced_outputs = { square = output(whole.reduced) } }
      assert.equal("proved", again.status)
      assert.is_true(math.abs(again.error.square / small.scenarios[k].error.square - 1) < 1e-6)
    end
  end)
end)
