-- stability_files.lua -- what `ambit stability` writes besides its table: a page, JSON, CSV, Markdown.
local json = require "ambit.view.json"
local suite_table = require "ambit.suite.table"

local files = {}

local keys = { "html", "json", "csv", "markdown" }

-- Said before anything is computed: the file that cannot be written.
function files.problem(options)
  local used = {}
  for _, key in ipairs(keys) do
    local name = options[key]
    if name and used[name] then return ("--%s and --%s name the same file, %s"):format(used[name], key, name) end
    if name then used[name] = key end
    if name and not (key == "json" and name == "-") then
      local there = io.open(name)
      if there then there:close() end
      local file, problem = io.open(name, "a")
      if not file then return ("cannot write the file of --%s: %s"):format(key, problem) end
      file:close()
      if not there then os.remove(name) end
    end
  end
end

local function write(name, text)
  local file = name == "-" and io.stdout or assert(io.open(name, "w"))
  local good, problem = file:write(text)
  if good then good, problem = file == io.stdout and file:flush() or file ~= io.stdout and file:close() end
  if not good then error(("cannot write %s: %s"):format(name, problem), 0) end
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
  json = function(result) return json.encode(exact(result)) .. "\n" end,
  csv = suite_table.csv,
  markdown = suite_table.markdown,
}

function files.write(result, options)
  for _, key in ipairs(keys) do
    if options[key] then write(options[key], text_of[key](result)) end
  end
end

return files
