-- Runs every Lua example of the documentation: lua5.4 tests/docs/examples.lua AMBIT README.md docs/*.md
-- A fenced block ```lua is a scene of its own and must exit with 0; ```lua fails must exit with 1;
-- ```lua unable with 3, ```lua impossible with 4; ```lua fragment continues the block before it. A block ```text prints
-- behind a scene must be its output. A block below the line <!-- file: PATH --> must be that file, word by word.
local ambit = table.remove(arg, 1)
local count, failed = 0, 0

local function blocks(path)
  local found, current, file = {}, nil, nil
  local number = 0
  for line in io.lines(path) do
    number = number + 1
    local fence, info = line:match "^(```)%s*(.-)%s*$"
    if fence and current then
      found[#found + 1], current = current, nil
    elseif fence then
      current, file = { info = info, line = number + 1, file = file }, nil
    elseif not current and line:match "^<!%-%- file: " then
      file = line:match "^<!%-%- file: (.-) %-%->"
    elseif current then
      current[#current + 1] = line
    end
  end
  return found
end

local function run(source)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(source)
  file:close()
  local pipe = assert(io.popen(("%s run --quiet %s 2>&1"):format(ambit, name)))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  os.remove(name)
  return code, output
end

local expected = { ["lua"] = 0, ["lua fragment"] = 0, ["lua fails"] = 1, ["lua unable"] = 3,
  ["lua impossible"] = 4 }

local function fail(path, block, text)
  failed = failed + 1
  io.write(("%s:%d: %s\n"):format(path, block.line, text))
end

for _, path in ipairs(arg) do
  local before, output = "", nil
  for _, block in ipairs(blocks(path)) do
    local want = expected[block.info]
    if block.file then
      count = count + 1
      local file = assert(io.open(block.file))
      if file:read "a" ~= table.concat(block, "\n") .. "\n" then fail(path, block, "differs from " .. block.file) end
      file:close()
    elseif want then
      local source = table.concat(block, "\n") .. "\n"
      if block.info == "lua fragment" then source = before .. source end
      before = source
      count = count + 1
      local code
      code, output = run(source)
      if code ~= want then fail(path, block, ("exit code %s, expected %d\n%s"):format(code, want, output)) end
    elseif block.info == "text prints" then
      local text = table.concat(block, "\n") .. "\n"
      if output ~= text then fail(path, block, ("printed\n%s\nexpected\n%s"):format(output, text)) end
    end
  end
end

io.write(("%d passed, %d failed\n"):format(count - failed, failed))
os.exit(failed == 0 and count > 0)
