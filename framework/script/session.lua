-- session.lua -- what happened in this Lua state: asked for by `ambit explain` and by the exit code of `ambit run`.
local code = require "ambit.code"
local core = require "ambit.core"

local weak = { __mode = "v" }

local session = {
  last = nil,                             -- the verb that ended last: { verb, status, code, reason, report, settings,
                                          -- cpu_seconds }
  verbs = nil,                            -- a list: a command wants to know all of them, in order
  mechanisms = setmetatable({}, weak),    -- by number; only what is still alive
  odes = setmetatable({}, weak),
  units = {},                             -- name of a state -> { unit, ..., [unit] = true } of all systems, those that
                                          -- are gone, too
  observer = nil,                         -- `ambit explain`: a function that is told of every verb as it ends
  worst = "ok",                           -- the worst code that a verb ended with
  closing = nil,                          -- a function: the command is over, and wants to know of codes all the same
  asked = nil,                            -- a list: `ambit compare` wants to know what is evaluated
  simulations = nil,                      -- a list: it wants to know what is simulated
  comparisons = {},                       -- what ambit.compare found, in order
  compare = nil,                          -- how the scene wants to be compared
  runs = nil,                             -- a list: `ambit view` wants to know what is simulated
  views = {},                             -- what ambit.view asks to be shown, in order
}

local count = 0

-- Remembers a mechanism or an ode.
function session.add(list, value)
  count = count + 1
  list[count] = value
end

-- Remembers an ode, and for ever the units of its states: what a value may be is no matter of what is still alive.
function session.add_ode(system)
  session.add(session.odes, system)
  for i, name in ipairs(system.states) do
    local units = session.units[name] or {}
    session.units[name] = units
    if not units[system.units[i]] then units[#units + 1], units[system.units[i]] = system.units[i], true end
  end
end

-- For `ambit explain`: from now on nothing is forgotten, and observer(verb) is called at the end of each verb.
function session.keep(observer)
  setmetatable(session.mechanisms, nil)
  setmetatable(session.odes, nil)
  session.asked, session.observer = {}, observer
end

-- What an evaluate is about to compute: { expressions, paths, leaves, values, arithmetic }.
function session.ask(request)
  if not session.asked then return end
  request.place = core.where():gsub(": $", "")
  session.asked[#session.asked + 1] = request
end

-- What a simulate is about to compute: the request as simulate.request makes it.
function session.ask_simulation(question)
  if not session.simulations then return end
  session.simulations[#session.simulations + 1] = { question = question, place = core.where():gsub(": $", "") }
end

-- A simulation that has ended, and what it was asked.
function session.remember(run, request)
  if session.runs then session.runs[#session.runs + 1] = { run = run, request = request } end
  if session.observer then session.last.request = request end
end

-- Called once at the end of every verb: tells of it and writes its `result` record.
function session.finish(verb, result, report, settings)
  if result.status == "stopped" then
    local _, _, limit, sentence = core.interrupted()
    if sentence then result.code, result.reason = limit, sentence end
  end
  local ended = result.code or code.of(result.status)
  if result.code == nil then result.code = ended end
  if code.is_worse(ended, session.worst) then session.worst = ended end
  if session.closing then session.closing(ended) end
  local entry = { verb = verb, status = result.status, code = ended, reason = result.reason, report = report,
    settings = settings, tried = result.tried, cpu_seconds = result.cpu_seconds or report.seconds_run or 0 }
  session.last = entry
  if session.verbs then session.verbs[#session.verbs + 1] = entry end
  if session.observer then session.observer(entry) end
  if not core.recording() then return end
  local fields = { "verb", verb, "status", result.status, "code", ended }
  local function add(key, value)
    if value ~= nil and value ~= "" then fields[#fields + 1], fields[#fields + 2] = key, value end
  end
  add("reason", result.status ~= "complete" and result.reason or nil)
  add("t_reached", result.t_reached)
  add("cpu_seconds", result.cpu_seconds or report.seconds_run)
  add("settings", settings)
  core.record("result", fields)
end

return session
