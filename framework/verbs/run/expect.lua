-- run/expect.lua -- the verdict that a scene expects: it ends with exit code 0 with this one, and with 3 with another.
local check = require "ambit.check"
local code = require "ambit.code"

local expect = {}

-- t.expect: nil, or one of these words.
function expect.read(t, what, words)
  if t.expect == nil then return nil end
  for _, word in ipairs(words) do
    if t.expect == word then return word end
  end
  check.fail("%s: expect: expected one of %s, got %s%s", what, table.concat(words, ", "), check.shown(t.expect),
    type(t.expect) == "string" and check.suggest(t.expect, words) or "")
end

-- result: status, code, reason of a verb, changed if a verdict is expected. What stopped or broke is no verdict.
function expect.judge(result, wanted)
  local family = code.family(result.code or code.of(result.status))
  if not wanted or not (family == "ok" or family == "unable") then return end
  if result.status == wanted then
    result.code = family == "ok" and result.code or "ok.expected"
    return
  end
  result.code = "unable.unexpected"
  result.reason = ("the verdict is `%s`, where `%s` was expected%s"):format(result.status, wanted,
    (result.reason or "") ~= "" and ": " .. result.reason or "")
end

return expect
