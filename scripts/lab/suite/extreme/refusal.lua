-- suite/extreme/refusal.lua -- inputs that must be refused by a message that says what is wrong with them:
-- { "what is put in", function(ambit), "words", "of the message", ... }
local refusal = {}

-- The words that a message lacks.
local function missing(message, entry)
  for i = 3, #entry do
    if not message:find(entry[i], 1, true) then return entry[i] end
  end
end

-- Why entry is not refused as it has to be, or nil. more: arguments of its function
function refusal.fault(ambit, entry, ...)
  local accepted, message = pcall(entry[2], ambit, ...)
  if accepted then return ("%s is accepted"):format(entry[1]) end
  message = tostring(message)
  local word = missing(message, entry)
  if word then return ("%s: the message `%s` does not say `%s`"):format(entry[1], message, word) end
end

-- entries, or a function(ambit, solver) that returns them -> run of a case
function refusal.run(entries)
  return function(ambit, solver, arithmetic)
    local list = type(entries) == "function" and entries(ambit, solver) or entries
    for _, entry in ipairs(list) do
      local fault = refusal.fault(ambit, entry, solver, arithmetic)
      if fault then return { outcome = "wrong", reason = fault } end
    end
    return { outcome = "refused", reason = ("%d inputs, each with a message that names it"):format(#list),
      steps = #list }
  end
end

-- over: combinations; nil: none, the input has nothing to do with one
function refusal.case(name, title, entries, over)
  return { name = name, group = "extreme", title = title, source = "", question = "refusal", quick = true,
    budget = { cpu = 5 }, run = refusal.run(entries), over = over or { {} }, expected = { default = "refused" } }
end

return refusal
