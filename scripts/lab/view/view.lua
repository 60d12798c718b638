-- view.lua -- ambit.view { m, run = run, points = { tip = frame } }: what `ambit view` shall show of a mechanism. Only
-- remembered: everything is computed by the command, once the scene has ended.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local instant = require "ambit.run.instant"
local mechanism = require "ambit.mechanism"
local option = require "ambit.option"
local run = require "ambit.run"
local session = require "ambit.session"

local verb = {}

local keys = { "run", "points", "title", "at", "t", "arithmetic" }

-- { frame, ... } or { name = frame } -> { { name, part, port }, ... }
local function points(m, t)
  local list = {}
  check.table(t, "view: points")
  for _, key in ipairs(check.sorted(t)) do
    local what = ("view: points.%s"):format(tostring(key))
    local part, port = frame.place(m, t[key], "frame", what)
    list[#list + 1] = { name = type(key) == "string" and key or nil, part = part, port = port }
  end
  return list
end

-- { beta1 = "30 deg" } -> expressions by name
local function configuration(m, t)
  local known, values = {}, {}
  check.table(t, "view: at")
  for i, c in ipairs(core.coordinates(m.handle)) do
    known[i] = c.name
    if t[c.name] ~= nil then
      values[c.name] = core.expression(t[c.name], c.unit, ("view: at.%s"):format(c.name))
    end
  end
  check.keys(t, known, "view: at")
  return values
end

local function subject(t)
  local m = t[1]
  if not mechanism.is(m) then
    check.fail("view: expected a mechanism as the first entry, got %s", check.kind(m))
  end
  return m
end

function verb.view(t)
  if mechanism.is(t) then t = { t } end
  check.table(t, "view")
  check.keys(t, keys, "view", 1)
  local m = subject(t)
  if t.run ~= nil and not run.is(t.run) then
    check.fail("view: run: expected what ambit.simulate returned, got %s", check.kind(t.run))
  end
  if t.run ~= nil and t.t ~= nil then check.fail "view: t is for given motions; a run has its own times" end
  local request = { mechanism = m, run = t.run, title = t.title and check.text(t.title, "view: title"),
    place = core.where() }
  request.points = t.points ~= nil and points(m, t.points) or nil
  request.at = t.at ~= nil and configuration(m, t.at) or {}
  request.times = t.t ~= nil and instant.span(t.t, "view: t") or nil
  if t.arithmetic ~= nil then
    request.arithmetic, request.options = option.arithmetic(t.arithmetic, "view: arithmetic")
  end
  if session.runs then session.views[#session.views + 1] = request end -- else nobody is going to look
end

return verb
