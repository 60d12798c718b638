-- wrap.lua -- lines of at most 120 columns: lua5.4 scripts/wrap.lua [--check] [FILE ...]
-- from the root of the tree; without files: of all that git knows. Paragraphs of Markdown and of comments (Lua, C) that
-- have a longer line are filled anew from there on; --check prints what is too long and exits with 1. Free are tables,
-- headings, code and formulas in Markdown, code and data of tests and benchmarks, words that are too long by
-- themselves, and what programs write.
local WIDTH = 120

local code = { "^tests/.*%.lua$", "^scripts/bench/" } -- in these only comments are looked at
local generated = { "^docs/results", "elementary_tables", "%.svg$", "%.min%.", "^scripts/mutate/", "mutations%.txt$" }

local function read(name)
  local file = assert(io.open(name))
  local lines = {}
  for line in file:lines() do lines[#lines + 1] = line end
  file:close()
  return lines
end

local function width(line) return utf8.len(line) or #line end

-- Words; what stands between backquotes is one.
local function words_of(text)
  local words, open = {}, false
  for word in text:gmatch "%S+" do
    if open then words[#words] = words[#words] .. " " .. word else words[#words + 1] = word end
    local _, marks = word:gsub("`", "")
    if marks % 2 == 1 then open = not open end
  end
  return words
end

-- May a line of Markdown begin with it, without a new meaning?
local function may_begin(word)
  return not (word:find "^[-+*>|#=]+$" or word:find "^%d+[.)]$" or word:find "^#")
end

-- Texts filled into lines: the first one behind `first`, the others behind `rest`; `last` is a suffix of the last line.
local function fill(texts, first, rest, last)
  local lines, line = {}, nil
  local words = words_of(table.concat(texts, " "))
  if last ~= "" then words[#words] = words[#words] .. last end
  for i, word in ipairs(words) do
    local follows = words[i + 1]
    local longer = line and line .. " " .. word
    local keeps = longer and follows and not may_begin(follows) and width(longer .. " " .. follows) > WIDTH
    if longer and width(longer) <= WIDTH and not keeps or longer and not may_begin(word) then
      line = longer
    else
      if line then lines[#lines + 1] = line end
      line = (#lines == 0 and first or rest) .. word
    end
  end
  lines[#lines + 1] = line
  return lines
end

-- -- paragraphs: function(lines, i) -> number of the last line, prefix of the first line, of the others, suffix; or nil

local function is_plain(line)
  return not (line:find "^%s*$" or line:find "^%s*|" or line:find "^%s*#" or line:find "^%s*<" or line:find "^%s*```"
    or line:find "^    " or line:find "^%s*!?%[[^%]]*%]%(.*%)$" or line:find "^%s*%$%$")
end

local function markdown(lines, i)
  local bullet = lines[i]:match "^%s*[-*+] +" or lines[i]:match "^%s*%d+[.)] +"
  if not bullet and not is_plain(lines[i]) then return nil end
  local rest = bullet and (" "):rep(#bullet) or lines[i]:match "^%s*"
  local last = i
  while lines[last + 1] and is_plain(lines[last + 1]:sub(#rest + 1)) and lines[last + 1]:sub(1, #rest) == rest
    and not lines[last + 1]:find "^%s*[-*+] " and not lines[last + 1]:find "^%s*%d+[.)] " do
    last = last + 1
  end
  for k = i, last do
    if lines[k]:find "  $" or lines[k]:find "\\$" then return nil end -- breaks that are meant
  end
  return last, bullet or rest, rest, ""
end

local function lua_comment(lines, i)
  local prefix = lines[i]:match "^%s*%-%-%-? "
  if not prefix or lines[i]:sub(#prefix + 1):find "^[%s@-]" then return nil end
  local last = i
  while lines[last + 1] and lines[last + 1]:sub(1, #prefix) == prefix
    and not lines[last + 1]:sub(#prefix + 1):find "^[%s@-]" do
    last = last + 1
  end
  return last, prefix, prefix, ""
end

local function c_comment(lines, i)
  local first = lines[i]:match "^%s*/%* " or lines[i]:match "^%s*%*%* "
  if not first or lines[i]:sub(#first + 1):find "^[%s*-]" then return nil end
  local rest = first:match "^%s*" .. "** "
  local last = i
  while not lines[last]:find("*/", 1, true) and lines[last + 1] and lines[last + 1]:sub(1, #rest) == rest
    and not lines[last + 1]:sub(#rest + 1):find "^[%s*-]" do
    last = last + 1
  end
  if lines[last]:find "%*/%s*%S" then return nil end
  return last, first, rest, lines[last]:match "%s*%*/$" or ""
end

local kinds = { md = markdown, lua = lua_comment, c = c_comment, h = c_comment }

-- -- files

local function longest(lines, first, last)
  local most = 0
  for i = first, last do most = math.max(most, width(lines[i])) end
  return most
end

-- The lines anew.
local function wrapped(lines, paragraph)
  local out, i, is_code = {}, 1, false
  while i <= #lines do
    if paragraph == markdown and lines[i]:find "^%s*```" then is_code = not is_code end
    local last, first, rest, suffix
    if not is_code then last, first, rest, suffix = paragraph(lines, i) end
    if last and longest(lines, i, last) > WIDTH then
      local from, texts = i, {}
      while width(lines[from]) <= WIDTH do
        out[#out + 1], from = lines[from], from + 1
      end
      for k = from, last do texts[#texts + 1] = lines[k]:sub(#(k == i and first or rest) + 1) end
      texts[#texts] = texts[#texts]:sub(1, #texts[#texts] - #suffix)
      for _, line in ipairs(fill(texts, from == i and first or rest, rest, suffix)) do out[#out + 1] = line end
    else
      table.move(lines, i, last or i, #out + 1, out)
    end
    i = (last or i) + 1
  end
  return out
end

-- Lines that are too long and could be shorter: { { number, columns }, ... }
local function faults(lines, extension, comments_only)
  local list, is_code = {}, false
  for i, line in ipairs(lines) do
    if extension == "md" and line:find "^%s*```" then is_code = not is_code end
    local is_comment = line:find "^%s*%-%-" and not line:find "^%s*%-%-%-@"
    local is_text = line:find "^%s*[-*+] " or is_plain(line)
    local is_free = comments_only and not is_comment or extension == "md" and (is_code or not is_text)
      or kinds[extension] == c_comment and not line:find "^%s*[/*]%*" -- clang-format cares for code
    local text = line:gsub("^%s*[-*/+]* *", "")
    if width(line) > WIDTH and not is_free and #words_of(text) > 1 then list[#list + 1] = { i, width(line) } end
  end
  return list
end

local function is_one_of(name, patterns)
  for _, pattern in ipairs(patterns) do
    if name:find(pattern) then return true end
  end
  return false
end

local function files_of(arguments)
  if #arguments > 0 then return arguments end
  local pipe = assert(io.popen "git ls-files '*.md' '*.lua' '*.c' '*.h'")
  local list = {}
  for name in pipe:lines() do list[#list + 1] = name end
  pipe:close()
  return list
end

local arguments, check, failed = {}, false, 0
for _, word in ipairs(arg) do
  if word == "--check" then check = true else arguments[#arguments + 1] = word end
end
for _, name in ipairs(files_of(arguments)) do
  local extension = name:match "%.(%a+)$"
  if kinds[extension] and not is_one_of(name, generated) then
    local lines = read(name)
    if not check then
      local out = wrapped(lines, kinds[extension])
      if table.concat(out, "\n") ~= table.concat(lines, "\n") then
        local file = assert(io.open(name, "w"))
        file:write(table.concat(out, "\n"), "\n")
        file:close()
        lines = out
      end
    end
    for _, fault in ipairs(faults(lines, extension, is_one_of(name, code))) do
      failed = failed + 1
      print(("%s:%d: %d columns, at most %d"):format(name, fault[1], fault[2], WIDTH))
    end
  end
end
os.exit(failed == 0)
