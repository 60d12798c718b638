-- States that have the names which verbs give to quantities of their own: a symbol is what its name says, so one would
-- be taken for the other.
local ambit = require "ambit"
local core = require "ambit.core"

local function decaying(k, other)
  return ambit.ode { states = { "x", other }, equations = function(s) return { -k * s.x + s[other], 0 * s.x } end }
end

describe("names of a user's", function()
  it("are not those of errors that certify adds", function()
    local initial = { x = 1, ["error of x"] = 5 }
    local detailed, reduced = decaying(1, "error of x"), decaying(ambit.number "1.1", "error of x")
    local proof = ambit.certify { detailed, reduced, t = { 0, 1 }, initial = initial, outputs = { "x" },
      error = { x = 1 } }
    assert.equal("proved", proof.status)
    local far = 5 - 4 * math.exp(-1) - (5 / 1.1 + (1 - 5 / 1.1) * math.exp(-1.1)) -- at t = 1, in closed form
    assert.truthy(far > 0.16 and proof.error.x >= far, proof.error.x)
  end)

  it("are not those of outputs that certify carries along", function()
    local name = "condition 1"
    local proof = ambit.certify { decaying(1, name), decaying(ambit.number "1.1", name), t = { 0, 1 },
      initial = { x = 1, [name] = "0.001" }, outputs = { y = function(s) return s.x ^ 2 end }, error = { y = 1 } }
    assert.equal("proved", proof.status)
    assert.truthy(proof.error.y >= math.exp(-2) - math.exp(-2.2), proof.error.y)
  end)

  it("are not those of conditions that verify carries along", function()
    local still = ambit.ode { states = { "x", "z", "condition safe" },
      equations = function(s) return { 0 * s.x, 0 * s.x, 0 * s.x } end }
    local answer = ambit.verify { still, t = 1, budget = 50,
      initial = { x = ambit.between(0, 1), z = ambit.between(0, 1), ["condition safe"] = -1 },
      safe = function(s) return ambit.number "1e-7" - (s.x - "0.45671") ^ 2 - (s.z - "0.7123") ^ 2 end }
    assert.not_equal("proved", answer.status) -- at (0.45671, 0.7123) it is 1e-7
  end)
end)

describe("an implicit form that does not fit", function()
  local function given(form)
    local ode = ambit.ode { states = { "x" }, equations = function(s) return { -s.x } end }
    local a = core.symbol("a", "1")
    core.system_give_implicit(ode.system, { unknowns = { a }, rates = { a }, residuals = { a + ode.symbols[1] },
      stage_end = form.stage_end or { 1 }, pivot = form.pivot or { 1 } })
    return ambit.simulate { ode, t = { 0, 1 }, initial = { x = 1 }, solver = "zonotope" }
  end

  it("is refused", function()
    assert.equal("complete", given({}).status)
    for _, form in ipairs { { pivot = { 90000000 } }, { pivot = { 0 } }, { stage_end = { 70000000 } },
      { stage_end = { 0 } }, { stage_end = {} }, { stage_end = { 1, 1 } } } do
      local good, why = pcall(given, form)
      assert.falsy(good)
      assert.truthy(tostring(why):find("the stages of the implicit form do not fit its unknowns", 1, true), why)
    end
    for _, wrong in ipairs { setmetatable({}, { __len = function() return -1 end }), 3 } do
      assert.falsy(pcall(given, { stage_end = wrong }))
      assert.falsy(pcall(given, { pivot = wrong }))
    end
  end)
end)
