-- results.lua: measures anew what the pages of results quote: lua5.4 scripts/results.lua BUILD [WORD ...]
-- A block between <!-- run: COMMAND --> and <!-- end --> becomes what the command prints; with `run text:` it is
-- fenced. COMMAND starts with `ambit`, `bench/NAME` or `tests/NAME`, all of the folder BUILD, or is a script for
-- `ambit run --quiet`. With words, only blocks whose command contains one of them. Pages are written after each block,
-- so nothing is lost by Ctrl-C; a command that prints nothing leaves its block as it was. Exit 1 if one failed or
-- missed a figure.
local build = table.remove(arg, 1)
local pages = { "docs/results.md" }
for name in io.popen("ls docs/results/*.md 2>/dev/null"):lines() do pages[#pages + 1] = name end

local function read(name)
  local file = assert(io.open(name))
  local text = file:read "a"
  file:close()
  return text
end

local function write(name, text)
  local file = assert(io.open(name .. ".new", "w"))
  assert(file:write(text))
  assert(file:close())
  assert(os.rename(name .. ".new", name))
end

local function is_wanted(command)
  if #arg == 0 then return true end
  for _, word in ipairs(arg) do
    if command:find(word, 1, true) then return true end
  end
  return false
end

local function full(command)
  if command:find "^ambit " then return build .. "/" .. command end
  if command:find "^bench/" or command:find "^tests/" then return build .. "/" .. command end
  return ("%s/ambit run --quiet %s"):format(build, command)
end

-- What it prints, and the exit code; nil: it was interrupted.
local function output_of(command)
  local pipe = assert(io.popen(full(command)))
  local text = pipe:read "a"
  local _, how, code = pipe:close()
  if how == "signal" or code == 130 then os.exit(130) end
  return text, code
end

local failed = 0
local function measure(kind, command)
  io.stderr:write(command, "\n")
  local text, code = output_of(command)
  if code ~= 0 then
    failed = failed + 1
    io.stderr:write(("results: `%s` ended with exit code %d\n"):format(command, code))
  end
  text = text:gsub("^\n+", ""):gsub("%s+$", "")
  if text == "" then return nil end
  return kind == "run text" and "```text\n" .. text .. "\n```" or text
end

local block = "(<!%-%- (run[ tex]*): (.-) %-%->\n)(.-)(\n*<!%-%- end %-%->)"

for _, page in ipairs(pages) do
  local from = 1
  while true do
    local text = read(page)
    local first, last, head, kind, command = text:find(block, from)
    if not first then break end
    local measured = is_wanted(command) and measure(kind, command)
    if measured then
      local now = ("%s\n%s\n\n<!-- end -->"):format(head, measured)
      write(page, text:sub(1, first - 1) .. now .. text:sub(last + 1))
      last = first + #now - 1
    end
    from = last + 1
  end
end
os.exit(failed == 0 and 0 or 1)
