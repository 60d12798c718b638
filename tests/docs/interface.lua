-- Tables of keys in docs/ are what `ambit types --markdown NAME` prints for the NAME in `<!-- keys: NAME -->` above
-- them: lua5.4 interface.lua AMBIT PAGES [--rewrite]
local ambit, wrong, found = arg[1], {}, 0
local rewrite = arg[#arg] == "--rewrite" and table.remove(arg)

local function output(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  assert(pipe:close(), command)
  return text
end

for i = 2, #arg do
  local file = assert(io.open(arg[i]))
  local text = file:read "a"
  file:close()
  local made = text:gsub("(<!%-%- keys: ([%w_.]+) %-%->\n)(|.-|\n)\n", function(head, name)
    found = found + 1
    return head .. output(("%s types --markdown %s"):format(ambit, name)) .. "\n"
  end)
  if made ~= text then
    wrong[#wrong + 1] = arg[i]
    if rewrite then assert(io.open(arg[i], "w")):write(made):close() end
  end
end
assert(found > 0, "no page has a table of keys")
assert(rewrite or #wrong == 0, table.concat(wrong, ", ") .. ": not what `ambit types --markdown` prints (--rewrite)")
print "ok"
