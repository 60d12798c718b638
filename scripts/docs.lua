-- docs.lua: puts the files that a page shows into it again: lua5.4 scripts/docs.lua docs/plugins.md
-- A block below the line <!-- file: PATH --> becomes the text of that file.
for _, page in ipairs(arg) do
  local file = assert(io.open(page))
  local text = file:read "a"
  file:close()
  text = text:gsub("(<!%-%- file: (.-) %-%->\n```%w*\n)(.-)(\n```)", function(head, path, _, tail)
    local source = assert(io.open(path)):read "a"
    return head .. source:gsub("\n$", "") .. tail
  end)
  file = assert(io.open(page, "w"))
  file:write(text)
  file:close()
end
