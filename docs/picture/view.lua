-- The drawing of the page in docs/view.md, as docs/view.svg:
--   lua5.4 docs/picture/view.lua build/release/ambit > docs/view.svg      (needs chromium)
local ambit = arg[1]

local function read(name)
  local file = assert(io.open(name))
  local text = file:read "a"
  file:close()
  return text
end

local function run(line)
  local pipe = assert(io.popen(line))
  local text = pipe:read "a"
  assert(pipe:close(), line)
  return text
end

local base = os.tmpname()
local file = assert(io.open(base .. ".lua", "w"))
file:write((read("docs/view.md"):match "```lua\n(.-)```"))
file:close()
run(("%s view --quiet %s.lua -o %s.html"):format(ambit, base, base))
local document = run(("chromium --headless --no-sandbox --disable-gpu --window-size=900,760 --virtual-time-budget=3000 "
  .. "--dump-dom 'file://%s.html#t=0.4' 2>/dev/null"):format(base))
os.remove(base)
os.remove(base .. ".lua")
os.remove(base .. ".html")

-- The drawing with its own part of the style sheet, in light colours; what is not shown is left out.
local css = read "scripts/lab/view/parts/view.css"
local colours = css:match ":root {%s*color%-scheme: light dark;(.-)}"
local style = css:match "/%* the drawing %*/(.-)%.legend {"
local width, height = document:match '<svg id="drawing".-viewBox="0 0 (%d+) (%d+)"'
local body = document:match '<svg id="drawing".->(.*)</svg>%s*<div class="transport"'
body = body:gsub('<polygon [^>]-display: none[^>]->%s*</polygon>', ""):gsub("<title>.-</title>", "")
io.write(('<svg xmlns="http://www.w3.org/2000/svg" id="drawing" viewBox="0 0 %s %s" width="%s" height="%s">\n'):format(
  width, height, width, height))
io.write("<style>\n:root {", colours, "}\n[hidden] { display: none; }\n", style, "</style>\n", body, "\n</svg>\n")
