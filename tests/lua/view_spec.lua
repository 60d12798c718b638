-- The verb view, and the command that writes a page: what the page claims holds for motions that are computed here, by
-- other means; bad input; files. How the page looks in a browser is tests/view. AMBIT_COMMAND is the command to test.
local ambit = require "ambit"
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function quoted(s) return "'" .. s:gsub("'", "'\\''") .. "'" end

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
  return text
end

local function shell(line)
  local out, problems = os.tmpname(), os.tmpname()
  local _, _, code = os.execute(("%s </dev/null >%s 2>%s"):format(line, out, problems))
  local stdout, stderr = read(out), read(problems)
  os.remove(out)
  os.remove(problems)
  return code, stdout, stderr
end

local function run(words) return shell(quoted(command) .. " view " .. words) end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

-- The data of the page that a scene makes, exit code, standard error.
local function page_of(text, options)
  local scene, page = write(text), os.tmpname()
  local code, _, stderr = run(("%s -o %s --quiet %s"):format(scene, page, options or ""))
  local content = read(page)
  os.remove(scene)
  os.remove(page)
  local found = content:match '<script type="application/json" id="data">(.-)</script>'
  return found and require("cjson").decode(found), code, stderr
end

-- The numbers that the text of an enclosure says.
local function bounds(text)
  local lo, hi = text:match "^%[(.-), (.-)%]$"
  if not lo then lo, hi = text, text end
  return assert(tonumber(lo), text), assert(tonumber(hi), text)
end

local function inside(box, point, slack, what)
  for k = 1, 3 do
    local lo, hi = bounds(box[k])
    if point[k] < lo - slack or point[k] > hi + slack then
      error(("%s: coordinate %d is %.17g, outside %s"):format(what, k, point[k], box[k]))
    end
  end
end

-- -- a double pendulum with plain numbers: absolute angles, classical Runge-Kutta

local g = 9.81

local function rates(s, l1, l2)
  local a, b, u, v = s[1], s[2], s[3], s[4]
  local d, denominator = a - b, 3 - math.cos(2 * a - 2 * b)
  return { u, v,
    (-3 * g * math.sin(a) - g * math.sin(a - 2 * b) - 2 * math.sin(d) * (v * v * l2 + u * u * l1 * math.cos(d)))
      / (l1 * denominator),
    2 * math.sin(d) * (2 * u * u * l1 + 2 * g * math.cos(a) + v * v * l2 * math.cos(d)) / (l2 * denominator) }
end

local function along(s, k, h)
  local moved = {}
  for i = 1, 4 do moved[i] = s[i] + h * k[i] end
  return moved
end

local function advance(s, h, l1, l2)
  local a = rates(s, l1, l2)
  local b = rates(along(s, a, h / 2), l1, l2)
  local c = rates(along(s, b, h / 2), l1, l2)
  local d = rates(along(s, c, h), l1, l2)
  local sum = {}
  for i = 1, 4 do sum[i] = a[i] + 2 * b[i] + 2 * c[i] + d[i] end
  return along(s, sum, h / 6)
end

local function hand(s, l1, l2)
  return { l1 * math.sin(s[1]) + l2 * math.sin(s[2]), -l1 * math.cos(s[1]) - l2 * math.cos(s[2]), 0 }
end

local pendulum = [[
local ambit = require "ambit"
local pi, around = ambit.pi, ambit.around
local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
local l1 = around(1, "0.5%")
local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -l1, 0 } }
local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
m:point_mass { at = elbow, mass = 1 }
m:point_mass { at = hand, mass = 1 }
local run = ambit.simulate { m:dynamics(), t = { 0, "0.2", "0.3" }, solver = "lohner",
  initial = { beta1 = around(3 * pi / 4, "0.5%"), beta2 = -11 * pi / 20, ["beta1'"] = "0.43", ["beta2'"] = "0.67" } }
ambit.view { m, run = run, points = { hand = hand, elbow = elbow } }
]]

-- One motion, against the boxes at each instant and on the way to the next.
local function follow(view, length, share)
  local b1 = 3 * math.pi / 4 * (1 + 0.005 * share)
  local s, parts = { b1, b1 - 11 * math.pi / 20, 0.43, 0.43 + 0.67 }, 10
  local l1 = 1 + 0.005 * length
  for i = 1, #view.t do
    local function check(box, what)
      inside(box[2], hand(s, l1, 1), 1e-9, ("%s, t = %s"):format(what, view.t[i]))
      inside(box[1], hand(s, l1, 0), 1e-9, ("elbow, %s, t = %s"):format(what, view.t[i]))
    end
    check(view.boxes[i], "at the instant")
    if i < #view.t then
      for _ = 1, parts do
        check(view.swept[i], "on the way")
        s = advance(s, (tonumber(view.t[i + 1]) - tonumber(view.t[i])) / parts, l1, 1)
      end
      check(view.swept[i], "on the way")
    end
  end
end

describe("what a page claims", function()
  it("holds for the motions of a double pendulum, at the instants and between them", function()
    local data, code, stderr = page_of(pendulum)
    assert.equal(0, code, stderr)
    local view = data.views[1]
    assert.equal("complete", view.status)
    assert.is_true(view.proved and #view.t > 150 and #view.swept == #view.t - 1 and #view.boxes == #view.t)
    assert.same({ "elbow", "hand" }, { view.points[1].name, view.points[2].name })
    assert.equal("0.3", view.t[#view.t])
    math.randomseed(5)
    for _, corner in ipairs { { -1, -1 }, { -1, 1 }, { 1, -1 }, { 1, 1 }, { 0, 0 } } do
      follow(view, corner[1], corner[2])
    end
    for _ = 1, 20 do follow(view, 2 * math.random() - 1, 2 * math.random() - 1) end
  end)

  it("is not much wider than the motions", function()
    local view = page_of(pendulum).views[1]
    local lo, hi = bounds(view.boxes[#view.boxes][2][1])
    assert.is_true(hi - lo > 0.01 and hi - lo < 0.2)
    lo, hi = bounds(view.swept[1][2][1])
    assert.is_true(hi - lo < 0.05)
  end)

  it("keeps the instants that the scene asks for", function()
    local found = {}
    for _, t in ipairs(page_of(pendulum).views[1].t) do found[t] = true end
    assert.is_true(found["0"] and found["0.2"] and found["0.3"])
  end)

  it("has no box for steps that were not kept", function()
    local spin = [[
      local ambit = require "ambit"
      local m = ambit.mechanism "spin"
      local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 1, 0, 0 } }
      m:point_mass { at = tip, mass = 1 }
      local t = {}
      for k = 0, 150 do t[k + 1] = k / 50 end
      local run = ambit.simulate { m:dynamics(), initial = { q = 0, ["q'"] = 1 }, t = t, keep = "last", solver = "lohner",
        EVENT }
      ambit.view { m, run = run, points = { tip } }
    ]]
    local view = page_of((spin:gsub("EVENT", ""))).views[1]
    local lo, hi = bounds(view.boxes[#view.boxes][1][1])
    assert.is_true(lo <= math.cos(3) and math.cos(3) <= hi)
    if #view.t == 2 then assert.is_false(view.swept[1]) end
    -- and one that an event ends is shown up to there
    view = page_of((spin:gsub("EVENT", "events = { { g = function(s) return s.q - 2 end, stop = true } }"))).views[1]
    assert.is_true(math.abs(tonumber(view.t[#view.t]) - 2) < 0.05)
  end)

  it("holds for a motion given over time, with joints and lengths in closed form", function()
    local data, code, stderr = page_of [[
      local ambit = require "ambit"
      local m = ambit.mechanism "crank"
      local turn = m:revolute { from = m.world, axis = "z", angle = 2 * ambit.time, name = "turn" }
      local arm = m:rigid_link { from = turn, offset = { ambit.around(2, "1%"), 0, 0 } }
      local lift = m:prismatic { from = arm, axis = "z", name = "lift" }
      ambit.view { m, t = { 1, 4 }, at = { lift = ambit.sin(3 * ambit.time) }, points = { lift } }
    ]]
    assert.equal(0, code, stderr)
    local view = data.views[1]
    assert.equal("given motion", view.status)
    local function place(t, r) return { r * math.cos(2 * t), r * math.sin(2 * t), math.sin(3 * t) } end
    for i = 1, #view.t do
      for _, r in ipairs { 1.98, 2, 2.02 } do
        inside(view.boxes[i][1], place(tonumber(view.t[i]), r), 1e-12, "at " .. view.t[i])
        for k = 0, i < #view.t and 10 or -1 do
          local from, to = tonumber(view.t[i]), tonumber(view.t[i + 1])
          local t = from + (to - from) * (k / 10)
          inside(view.swept[i][1], place(t, r), 1e-12, ("from %s, at %.17g"):format(view.t[i], t))
        end
      end
    end
  end)

  it("is rounded outward", function()
    local data = page_of [[
      local ambit = require "ambit"
      local m = ambit.mechanism "third"
      m:rigid_link { from = m.world, offset = { "[1/3, 2/3]", ambit.around("1/3", "1e-9"), "0.1" } }
    ]]
    local box = data.views[1].boxes[1][1]
    for k, true_set in ipairs { "[1/3, 2/3]", "[0.333333332333333333333333, 0.333333334333333333333334]", "0.1" } do
      assert.is_true(ambit.interval(box[k]):contains(ambit.interval(true_set)), box[k])
    end
  end)

  it("draws what there is: frames, lines, axes, bodies with their centres", function()
    local view = page_of([[
      local ambit = require "ambit"
      local m = ambit.mechanism { "arm", gravity = { 0, 0, "-9.81" } }
      local mast = m:rigid_link { from = m.world, offset = { 0, 0, 2 }, name = "mast" }
      local slew = m:revolute { from = mast, axis = "z", name = "slew" }
      local lift = m:revolute { from = slew, axis = "y", name = "lift" }
      local boom = m:rigid_link { from = lift, offset = { 1, 0, 0 }, name = "boom" }
      m:rigid_body { at = boom, mass = 3, centre = { "-0.5", 0, 0 }, name = "beam" }
      ambit.view { m, at = { slew = "90 deg" }, title = "an arm" }
    ]]).views[1]
    assert.equal("an arm", view.title)
    assert.equal("one configuration", view.status)
    assert.same({ "world", "mast", "slew", "lift", "boom" }, { view.frames[1].name, view.frames[2].name,
      view.frames[3].name, view.frames[4].name, view.frames[5].name })
    local lines = {}
    for i, line in ipairs(view.lines) do lines[i] = ("%d-%d %s"):format(line.a, line.b, line.kind) end
    assert.same({ "0-1 link", "1-2 link", "2-3 link", "3-4 link" }, lines)
    assert.equal(2, #view.axes)
    assert.equal("beam", view.bodies[1].name)
    assert.equal(4, view.points[1].frame) -- the only tip
    local position, centre, axis = view.position[1], view.centre[1], view.axis[1]
    for k, wanted in ipairs { 0, 1, 2 } do assert.is_true(math.abs(position[12 + k] - wanted) < 1e-4) end
    for k, wanted in ipairs { 0, 0.5, 2 } do assert.is_true(math.abs(centre[k] - wanted) < 1e-4) end
    for k, wanted in ipairs { 0, 0, 1, -1, 0, 0 } do assert.is_true(math.abs(axis[k] - wanted) < 1e-4) end
    for k, wanted in ipairs { 0, 0, -9.81 } do assert.is_true(math.abs(view.gravity[k] - wanted) < 1e-3) end
    has(table.concat(view.notes, "\n"), "lift at rest")
  end)

  it("calls the frames of a loaded robot after its links", function()
    local file = write('<robot name="r"><link name="base"/><link name="hand"><inertial><mass value="1"/><inertia ixx="1" iyy="1"'
      .. ' izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="wrist" type="revolute"><parent link="base"/>'
      .. '<child link="hand"/><axis xyz="0 0 1"/></joint></robot>')
    local page, code = page_of(('local m = require("ambit").load "%s"\n'):format(file))
    os.remove(file)
    assert.equal(0, code)
    local names = {}
    for _, frame in ipairs(page.views[1].frames) do names[frame.name] = true end
    assert.is_true(names.hand and not names.wrist)
  end)

  it("shows every mechanism with its own last run, unless the scene says otherwise", function()
    local data, code = page_of [[
      local ambit = require "ambit"
      local function pendulum(name, l)
        local m = ambit.mechanism { name, gravity = { 0, "-9.81", 0 } }
        local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 0, -l, 0 } }
        m:point_mass { at = tip, mass = 1 }
        return m
      end
      local short, long = pendulum("short", 1), pendulum("long", 4)
      ambit.simulate { long:dynamics(), initial = { 1, 0 }, t = { 0, "0.1" } }
      ambit.simulate { short:dynamics(), initial = { 1, 0 }, t = { 0, "0.1" } }
      ambit.simulate { short:dynamics(), initial = { "0.5", 0 }, t = { 0, "0.2" } }
      ambit.mechanism "empty"
      os.exit(7)
    ]]
    assert.equal(0, code)
    assert.equal(3, #data.views)
    local short, long, empty = table.unpack(data.views)
    assert.same({ "short", "long", "empty" }, { short.title, long.title, empty.title })
    assert.same({ "0.2", "0.1", "0" }, { short.t[#short.t], long.t[#long.t], empty.t[#empty.t] })
    inside(short.boxes[1][1], { math.sin(0.5), -math.cos(0.5), 0 }, 1e-12, "short")
    inside(long.boxes[1][1], { 4 * math.sin(1), -4 * math.cos(1), 0 }, 1e-12, "long")
    assert.equal(0, #empty.points)
  end)

  it("does not change what a scene does when nobody looks", function()
    local scene = write(pendulum .. "print(run.step_count)")
    local code, with = shell(quoted(command) .. " run --quiet " .. scene)
    assert.equal(0, code)
    write(pendulum:gsub("ambit%.view[^\n]*", "") .. "print(run.step_count)", scene)
    local _, without = shell(quoted(command) .. " run --quiet " .. scene)
    os.remove(scene)
    assert.equal(without, with)
  end)
end)

describe("ambit view", function()
  local scene = [[
    local ambit = require "ambit"
    local m = ambit.mechanism "one"
    m:rigid_link { from = m.world, offset = { 1, 0, 0 } }
    print "said"
  ]]

  it("writes beside nothing: default name, -o, --page=, standard output", function()
    local folder, file = os.tmpname(), write(scene)
    os.remove(folder)
    os.execute("mkdir " .. folder)
    os.rename(file, folder .. "/thing.lua")
    local at = "cd " .. folder .. " && " .. quoted(command) .. " view "
    local code, stdout, stderr = shell(at .. "thing.lua")
    assert.equal(0, code, stderr)
    has(stdout, "said")
    has(stderr, "thing.html")
    local page = read(folder .. "/thing.html")
    has(page, "<!doctype html>", "</html>")
    assert.equal(0, (shell(at .. "--quiet thing.lua --page=other.html")))
    assert.equal(page, read(folder .. "/other.html"))
    write("old", folder .. "/other.html")
    assert.equal(0, (shell(at .. "-o other.html thing.lua")))
    assert.equal(page, read(folder .. "/other.html"))
    code, stdout, stderr = shell(at .. "thing.lua -o -")
    assert.equal(0, code)
    assert.equal(page, stdout)
    has(stderr, "said")
    local _, list = shell("ls " .. folder)
    assert.equal("other.html\nthing.html\nthing.lua\n", list)
    os.execute("rm -r " .. folder)
  end)

  it("says what cannot be written, and leaves nothing half done", function()
    local folder, file = os.tmpname(), write(pendulum)
    os.remove(folder)
    os.execute("mkdir " .. folder)
    local function fails(target, ...)
      local code, _, stderr = run(("%s -o %s"):format(file, target))
      assert.equal(1, code)
      has(stderr, "cannot write " .. target, ...)
    end
    fails(folder .. "/no/page.html", "No such file")
    fails(folder, "directory")
    fails "/dev/full"
    write("old page", folder .. "/page.html")
    local small = ("trap '' XFSZ; ulimit -f 16; %s view %s -o %s/page.html"):format(quoted(command), file, folder)
    local code, _, stderr = shell(small)
    assert.equal(1, code)
    has(stderr, "cannot write", "page.html")
    assert.equal("old page", read(folder .. "/page.html"))
    write("error 'this scene fails'", file)
    code, _, stderr = run(("%s -o %s/page.html"):format(file, folder))
    assert.equal(1, code)
    has(stderr, "this scene fails", file .. ":1:")
    assert.equal("old page", read(folder .. "/page.html"))
    local _, list = shell("ls -A " .. folder)
    assert.equal("page.html\n", list)
    os.execute("rm -r " .. folder)
    os.remove(file)
  end)

  it("tells wrong usage and empty scenes apart", function()
    local code, stdout, stderr = run "--help"
    assert.equal(0, code)
    has(stdout, "usage: ambit view")
    code, _, stderr = run ""
    assert.equal(2, code)
    has(stderr, "expected a scene")
    code, _, stderr = run "x.lua -o"
    assert.equal(2, code)
    has(stderr, "`--page` needs a value")
    code, _, stderr = run "x.lua --pgae=y"
    assert.equal(2, code)
    has(stderr, "--page")
    local file = write "local ambit = require 'ambit' print(ambit.pi)"
    code, _, stderr = run(file .. " -o /tmp/never.html")
    os.remove(file)
    assert.equal(1, code)
    has(stderr, "makes no mechanism")
    assert.is_nil(read "/tmp/never.html")
  end)

  it("ends with 3 and a page where a simulation proves nothing", function()
    local data, code, stderr = page_of [[
      local ambit = require "ambit"
      local m = ambit.mechanism { "wild", gravity = { 0, "-9.81", 0 } }
      local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 0, -1, 0 } }
      m:point_mass { at = tip, mass = 1 }
      ambit.simulate { m:dynamics(), initial = { ambit.between(-1e9, 1e9), 0 }, t = { 0, 10 },
        solver = "taylor_model" }
    ]]
    assert.equal(3, code)
    has(stderr, "could not be proved")
    local view = data.views[1]
    assert.equal("unable", view.status)
    has(view.reason, "t = 0 s")
    assert.same({ "0" }, view.t)
    inside(view.boxes[1][1], { 1, 0, 0 }, 1e-12, "anywhere")
    inside(view.boxes[1][1], { 0, 1, 0 }, 1e-12, "anywhere")
  end)

  it("says of a solver that proves nothing that it does not", function()
    local data, code = page_of [[
      local ambit = require "ambit"
      local m = ambit.mechanism { "p", gravity = { 0, "-9.81", 0 } }
      local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 0, -1, 0 } }
      m:point_mass { at = tip, mass = 1 }
      ambit.simulate { m:dynamics(), initial = { 1, 0 }, t = { 0, 1 }, solver = "gsl" }
    ]]
    assert.equal(0, code)
    assert.is_false(data.views[1].proved)
    for _, swept in ipairs(data.views[1].swept) do assert.is_false(swept) end
  end)

  it("names the line of the request that cannot be shown", function()
    local _, code, stderr = page_of [[
      local ambit = require "ambit"
      local function pendulum(name)
        local m = ambit.mechanism { name, gravity = { 0, "-9.81", 0 } }
        m:point_mass { at = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = name .. "_a" },
          offset = { 0, -1, 0 } }, mass = 1 }
        return m
      end
      local a, b = pendulum "left", pendulum "right"
      local run = ambit.simulate { a:dynamics(), initial = { 1, 0 }, t = { 0, "0.1" } }
      ambit.view { b, run = run }
    ]]
    assert.equal(1, code)
    has(stderr, ":10: ", "`left`, not of `right`")
  end)
end)

describe("view", function()
  local m, other = ambit.mechanism "arm", ambit.mechanism "other arm"
  local joint = m:revolute { from = m.world, axis = "z", name = "shoulder" }
  local tip = m:rigid_link { from = joint, offset = { 1, 0, 0 } }

  local function fails(t, ...)
    local good, problem = pcall(ambit.view, t)
    assert.is_false(good, "no error was raised")
    problem = tostring(problem)
    for _, text in ipairs { ... } do has(problem, text) end
  end

  it("tells bad input apart, with the nearest name", function()
    fails(3, "expected a table", "number")
    fails({}, "expected a mechanism", "nil")
    fails({ "arm" }, "expected a mechanism", "string")
    fails({ m, pionts = {} }, "pionts", "`points`")
    fails({ m, points = tip }, "points")
    fails({ m, points = { tip = 3 } }, "points.tip", "expected a frame", "number")
    fails({ m, points = { tip = other.world } }, "another mechanism", "other arm")
    fails({ m, run = {} }, "run", "ambit.simulate")
    fails({ m, at = { sholder = 1 } }, "sholder", "`shoulder`")
    fails({ m, at = { shoulder = "1 m" } }, "at.shoulder", "rad")
    fails({ m, t = { 1, 1 } }, "view: t")
    fails({ m, title = 3 }, "title", "text")
    fails({ m, arithmetic = 3 }, "arithmetic")
    ambit.view(m)
    ambit.view { m, points = { tip, elbow = joint }, at = { shoulder = "30 deg" } }
  end)
end)
