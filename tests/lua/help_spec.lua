-- help_spec.lua -- whatever the module offers is declared (scripts/lab/interface) as it is.
local ambit = require "ambit"
local interface = require "ambit.interface"

local wrong = {}

local function names_of(members)
  local list = {}
  for _, member in ipairs(members) do list[interface.name(member)] = true end
  return list
end

-- The keys that a verb knows: what it says when it is asked with one that it does not know.
local function known_keys(ask)
  local good, message = pcall(ask, "zzzzzzzz")
  assert.is_false(good)
  local list = message:match "unknown key `zzzzzzzz` %(there is: (.*)%)$"
  assert.is_truthy(list, message)
  local keys = {}
  for key in list:gmatch "[^, ]+" do keys[key] = true end
  return keys
end

-- The same keys, but for those of the solver and entries of a list?
local function same_keys(name, ask, solver)
  local known, declared = known_keys(ask), names_of(interface.members(interface.classes[name]))
  for _, option in ipairs(solver and ambit.plugin("solver", solver).parameters or {}) do known[option.name] = nil end
  for key in pairs(declared) do
    if not key:find "^%[" and not known[key] then wrong[#wrong + 1] = name .. " declares " .. key end
  end
  for key in pairs(known) do
    if not declared[key] then wrong[#wrong + 1] = name .. " does not declare " .. key end
  end
end

-- Has a result what is declared of it? What may be missing is not asked for.
local function has_all(name, result)
  for _, member in ipairs(interface.members(interface.classes[name])) do
    local key = interface.name(member)
    if not member[1]:find "%?$" and not key:find "^%[" and result[key] == nil then
      wrong[#wrong + 1] = name .. " has no " .. key
    end
  end
end

local function system() return ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end } end

describe("help", function()
  it("knows every name of the interface, and no others", function()
    for name in pairs(ambit) do
      local good, text = pcall(ambit.help, name)
      assert.is_true(good, name)
      assert.matches("^ambit%." .. name, text)
    end
    for name in pairs(interface.functions) do assert.is_truthy(ambit[name], name) end
    assert.matches("^ambit%.run\n", ambit.help "run")
  end)

  it("knows every solver, by the options that it declares", function()
    for _, entry in ipairs(ambit.plugins "solver") do
      local text = ambit.help(entry.name)
      for _, option in ipairs(ambit.plugin("solver", entry.name).parameters) do
        assert.is_truthy(text:find("\n  " .. option.name, 1, true), entry.name .. ": " .. option.name)
      end
    end
  end)

  it("says of a verb what it is given and what it gives", function()
    local text = ambit.help "invariant"
    for _, word in ipairs { "about", "within?", "budget?", "settles?", "1/s", "-> invariant" } do
      assert.is_truthy(text:find(word, 1, true), word)
    end
    assert.is_nil(ambit.help("simulate"):find("](", 1, true)) -- links are for pages
    assert.is_truthy(ambit.help("simulate"):find("\n  dense?", 1, true))
  end)
end)

describe("the declared interface", function()
  it("has the keys that verbs know", function()
    wrong = {}
    local model, x = system(), ambit.between(1, 2)
    local requests = {
      ["evaluate.request"] = { ambit.evaluate, x },
      ["ode.request"] = { ambit.ode, "m" }, ["map.request"] = { ambit.map, "m" },
      ["sampled.request"] = { ambit.sampled, "m" }, ["chain.request"] = { ambit.chain, "m" },
      ["mechanism.request"] = { ambit.mechanism, "m" },
      ["view.request"] = { ambit.view, ambit.mechanism "m" },
      ["invariant.request"] = { ambit.invariant, model },
    }
    for name, call in pairs(requests) do same_keys(name, function(key) call[1] { call[2], [key] = 1 } end) end
    local in_time = {
      ["simulate.request"] = { ambit.simulate }, ["sensitivity.request"] = { ambit.sensitivity },
      ["verify.request"] = { ambit.verify, safe = function(s) return s.x - 2 end },
      ["poincare.request"] = { ambit.poincare, section = function(s) return s.x end, t_max = 1 },
      ["certify.request"] = { ambit.certify, outputs = { "x" }, second = true },
      ["reduce.request"] = { ambit.reduce, outputs = { "x" }, error = { x = 1 } },
      ["hybrid.request"] = { ambit.hybrid, modes = { fall = { model } } },
    }
    for name, call in pairs(in_time) do
      same_keys(name, function(key)
        local t = { model, initial = { x = x }, t = { 0, 1 }, solver = "lohner", [key] = 1 }
        for k, value in pairs(call) do if type(k) == "string" then t[k] = value end end
        if call.second then t[2], t.second = model, nil end
        if call.modes then t[1] = nil end
        if call.t_max then t.t = nil end
        call[1](t)
      end, "lohner")
    end
    local function unknown(s) return { s.x } end
    same_keys("roots.request", function(key)
      ambit.roots { unknown, box = { x = { -1, 1 } }, solver = "krawczyk", [key] = 1 }
    end, "krawczyk")
    same_keys("equilibria.request", function(key)
      ambit.equilibria { model, box = { x = { -1, 1 } }, solver = "krawczyk", [key] = 1 }
    end, "krawczyk")
    -- verify has it where t = math.huge; poincare takes the key to say that it means t_max
    table.sort(wrong)
    assert.same({ "poincare.request does not declare t", "verify.request declares about" }, wrong)
  end)

  it("has nothing that verbs do not give", function()
    wrong = {}
    local model, x = system(), ambit.between(1, 2)
    has_all("run", ambit.simulate { model, initial = { x = x }, t = { 0, 1 } })
    has_all("sample", ambit.sample { model, initial = { x = x }, t = { 0, 1 }, n = 10 })
    has_all("verification", ambit.verify { model, initial = { x = x }, t = { 0, 1 },
      safe = function(s) return s.x - 3 end })
    has_all("roots", ambit.roots { function(s) return { s.x } end, box = { x = { -1, 1 } } })
    has_all("invariant", ambit.invariant { model, about = { x = 0 } })
    has_all("provenance", ambit.provenance())
    has_all("plugin", ambit.plugins()[1])
    local start, outputs, bound = { x = 1 }, { "x" }, { x = "0.1" }
    has_all("certificate", ambit.certify { model, model, initial = start, t = 1, outputs = outputs, error = bound })
    has_all("reduction", ambit.reduce { model, initial = start, t = 1, outputs = outputs, error = bound })
    local circle = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end }
    local returns = ambit.poincare { circle, section = function(s) return s.x end, initial = { x = 1, v = 0 }, t_max = 4,
      direction = "falling" }
    has_all("poincare", returns)
    has_all("poincare.return", returns.returns[1])
    has_all("hybrid", ambit.hybrid { modes = { fall = { model } }, initial = { x = x }, t = 1 })
    has_all("sensitivity", ambit.sensitivity { model, initial = { x = x }, t = 1 })
    has_all("equilibria", ambit.equilibria { model, box = { x = { -1, 1 } } })
    has_all("equilibrium", ambit.equilibria { model, box = { x = { -1, 1 } }, stability = true }.proved[1])
    has_all("eigenvalue", ambit.eigenvalues { { 1, 2 }, { 3, 4 } }[1])
    has_all("mechanism", ambit.mechanism "m")
    has_all("enclosure", ambit.interval(1, 2))
    has_all("ode", model)
    assert.same({}, wrong)
  end)

  it("names types that there are", function()
    local plain = {}
    for word in ([[number string boolean integer table any function fun nil self]]):gmatch "%a+" do plain[word] = true end
    local function check(text, where)
      local rest = interface.types(text, function() return "any" end):gsub('"[^"]*"', ""):gsub("[%w_]+%??:", "")
      for word in rest:gmatch "%f[%w_][%a_][%w_.]*" do assert.is_true(plain[word], where .. ": " .. word) end
    end
    for _, entry in ipairs(interface.list) do
      for _, member in ipairs(entry.class and entry or { entry }) do
        check(member[2], member[1])
        for _, parameter in ipairs(interface.parameters(member) or {}) do check(parameter[2], member[1]) end
      end
      for base in (entry.of or ""):gmatch "[%w_.]+" do assert.is_truthy(interface.classes[base], base) end
    end
  end)

  it("is printed for editors, with what plugins declare", function()
    local pipe = assert(io.popen(os.getenv "AMBIT_COMMAND" .. " types"))
    local text = pipe:read "a"
    assert.is_true(pipe:close())
    assert.is_truthy(load(text))
    for name, value in pairs(ambit) do
      local line = type(value) == "function" and "\nfunction ambit." .. name .. "(" or "\n---@field " .. name .. " "
      assert.is_truthy(text:find(line, 1, true), name)
    end
    for _, entry in ipairs(ambit.plugins "element") do
      assert.is_truthy(text:find(("\nfunction mechanism:%s(t) end"):format(entry.name), 1, true), entry.name)
    end
    assert.is_truthy(text:find("\n---@field jacobian_order? integer lohner", 1, true))
  end)
end)
