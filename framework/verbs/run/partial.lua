-- run/partial.lua -- answers that hold only for a part of the data: .partial, the status `partial`, and exit code 3,
-- unless the scene says that it knows.
local check = require "ambit.check"

local partial = {}

-- t.partial: true if the scene knows that a part of the data may have no answer.
function partial.read(t, what)
  if t.partial ~= nil and type(t.partial) ~= "boolean" then
    check.fail("%s: partial: expected true or false, got %s", what, check.kind(t.partial))
  end
  return t.partial or false
end

-- facts: the outcome of a verb. why: nil, or what holds for a part of the data only. Failures are worse than that.
function partial.judge(facts, why, allowed)
  facts.partial = why ~= nil
  if not why or facts.status ~= "complete" then return facts end
  facts.status, facts.code = "partial", allowed and "ok.partial" or "unable.partial"
  facts.reason = ("%s; narrow the data, or say `partial = true`"):format(why)
  return facts
end

return partial
