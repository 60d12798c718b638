-- help.lua -- what `ambit --help` and `ambit COMMAND --help` print, for the manual page and the completions.
local help = {}

local function output(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  assert(pipe:close(), command)
  return text
end

-- program: the path of ambit -> { text, commands = { { name, summary, text, options = { "--json", ... } }, ... } }
function help.read(program)
  local quoted = "'" .. program:gsub("'", "'\\''") .. "'"
  local self = { text = output(quoted .. " --help"), version = output(quoted .. " --version"):match "(%S+)%s*$",
    commands = {} }
  for name, summary in self.text:match("commands:\n(.-)\n\n"):gmatch "  (%w+)%s+([^\n]+)" do
    local text, options, known = output(("%s %s --help"):format(quoted, name)), {}, {}
    for option in text:gmatch "%f[%w-](%-%-[%l][%l-]*)" do
      if not known[option] then options[#options + 1], known[option] = option, true end
    end
    table.sort(options)
    self.commands[#self.commands + 1] = { name = name, summary = summary, text = text, options = options }
  end
  assert(#self.commands > 5, "no commands were found")
  return self
end

return help
