-- stability/files.lua -- what `ambit stability` writes besides its table: a page, JSON, CSV, Markdown.
local json = require "ambit.report.json"
local outputs = require "ambit.command.outputs"
local provenance = require "ambit.provenance"
local suite_table = require "ambit.suite.table"

local files = {}

local keys = { "html", "json", "csv", "markdown" }

-- Said before anything is computed: the file that cannot be written.
function files.problem(options)
  return outputs.problem(options, keys, { json = true, markdown = true })
end

-- Doubles exactly; JSON has no infinity and no NaN: they are null.
local function exact(value)
  if math.type(value) == "float" then
    local finite = value == value and value ~= math.huge and value ~= -math.huge
    return json.raw(finite and ("%.17g"):format(value) or "null")
  end
  if type(value) ~= "table" then return value end
  local own = {}
  for key, entry in pairs(value) do own[key] = exact(entry) end
  return own
end

local text_of = {
  html = function(result) return require "ambit.page.stability".of(result) end,
  json = function(result) return provenance.json(json.encode(exact(result))) .. "\n" end,
  csv = function(result) return provenance.lines("# ", "\r\n") .. suite_table.csv(result) end,
  markdown = function(result)
    return ("<!--\n%s-->\n"):format(provenance.lines(""):gsub("%-%-", "- -")) .. suite_table.markdown(result)
  end,
}

function files.write(result, options)
  for _, key in ipairs(keys) do
    if options[key] then outputs.write(options[key], text_of[key](result)) end
  end
end

return files
