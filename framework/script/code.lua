-- code.lua -- codes of outcomes beside the words and sentences of results; the table is <ambit/code.h>, the page
-- docs/errors.md. A code begins with the word of its family: ok, domain, unable, invalid, memory, stopped or broken.
local check = require "ambit.check"
local core = require "ambit.core"

local code = {}

-- What the words of the verbs mean, where nothing more is known.
local families = {
  complete = "ok", proved = "ok", refuted = "ok.refuted", unique = "ok", several = "ok", none = "ok.none",
  partial = "unable.partial", impossible = "domain", stopped = "stopped", broken = "broken",
  unable = "unable", undecided = "unable.undecided", exceeded = "unable.bound", singular = "unable.undecided",
}

-- The code of a result with this status.
function code.of(status) return families[status] or "unable" end

function code.family(name) return name:match "^[^.]+" end

-- { { code, meaning, advice }, ... }
code.list = core.codes

-- The status word that goes with a code, of verbs that say nothing more special.
local words = { ok = "complete", domain = "impossible", stopped = "stopped", broken = "broken" }
function code.word(name) return words[code.family(name)] or "unable" end

-- What comes after one another: the worst of several.
local severity = { ok = 0, stopped = 0, domain = 1, unable = 2, memory = 3, invalid = 3, broken = 3 }
local exits = { [0] = 0, 4, 3, 1 }

-- Is `a` (a code) worse than `b`?
function code.is_worse(a, b) return severity[code.family(a)] > severity[code.family(b)] end

local by_limit = { ["stopped.time"] = true, ["stopped.memory"] = true, ["stopped.output"] = true }

-- The exit code of the command: 0 done, 4 proved that there is no answer, 3 could not prove, 1 broken or an error, 5 a
-- limit of the command line was reached.
function code.exit(name) return by_limit[name] and 5 or exits[severity[code.family(name)]] end

-- A verb made of many runs may be over with one of them: give_up ends it from within, until_given_up takes that for its
-- outcome.
local Outcome = { __name = "outcome", __tostring = function(self) return self.reason end }

-- outcome: { status, code, reason, t_reached }
function code.give_up(outcome)
  error(setmetatable({ status = outcome.status, code = outcome.code, reason = outcome.reason,
    t_reached = outcome.t_reached }, Outcome), 0)
end

-- After a run that broke its contract a verb says nothing at all.
function code.refuse_broken(outcome)
  if outcome.status ~= "broken" then return end
  require("ambit.session").worst = outcome.code
  code.give_up(outcome)
end

-- Is this error a run that broke its contract?
function code.is_broken(problem) return getmetatable(problem) == Outcome and problem.status == "broken" end

-- f(...) -> nil and what it returns; or the outcome with which it gave up
function code.until_given_up(f, ...)
  local results = table.pack(pcall(f, ...))
  if results[1] then return nil, table.unpack(results, 2, results.n) end
  if getmetatable(results[2]) == Outcome then return results[2] end
  error(results[2], 0)
end

return code
