-- rooms.lua -- lua5.4 scripts/rooms.lua [PAGE.md]: the rooms of the tree with their lines of C and Lua, as a table;
-- written into the page between <!-- rooms --> and <!-- /rooms --> if one is named.
local rooms = {
  { "framework/kernel", "knows no verb, no joint and no plugin by name", parts = {
    { "framework/kernel/abi", "what plugins and the framework say to each other: the SDK, `<ambit/...>`" },
    { "framework/kernel/base", "arenas, failures and codes, the meter behind profiles" },
    { "framework/kernel/num", "enclosures of functions and products, decimals" },
    { "framework/kernel/graph", "expressions: folding, derivatives, tapes, series and their tails" },
    { "framework/kernel/host", "finds, checks and loads plugins; what it lends them" } } },
  { "framework/api", "the C API: headers of what `libambit` exports" },
  { "framework/functions", "log1p, hypot and their like: one file each, which says all that others need to know" },
  { "framework/algebra", "rewriting of expressions that the kernel does without" },
  { "framework/mechanics", "what elements add up to: dynamics, loops, constraints" },
  { "framework/models", "what a scene states a model with: units, mechanisms, robots, equations" },
  { "framework/verbs", "one room for each question: C, bridge to Lua (`*_lua.c`), Lua" },
  { "framework/script", "the bridge to Lua that verbs share, and what all Lua code uses" },
  { "plugins/arithmetic", "ways to compute with sets" },
  { "plugins/element", "formulas of mechanics" },
  { "plugins/solver", "ways to integrate, to find roots, to choose what a model does without" },
  { "plugins/service", "what several plugins ask for: digests, eigenvalues, random points" },
  { "plugins/shared", "sources that several plugins are built with" },
  { "scripts/command", "the commands" },
  { "scripts/lab", "what looks at scenes and results: compare, stability, explain, profile, view" },
  { "tests", "tests, conformance kits, oracles, benchmarks" },
}

local function lines(folder, pattern)
  local pipe = assert(io.popen(("find %s -type f -name '%s' -exec cat {} + | wc -l"):format(folder, pattern)))
  local n = math.tointeger(tonumber(pipe:read "a"))
  pipe:close()
  return n
end

local function row(room)
  local c, lua = lines(room[1], "*.[ch]"), lines(room[1], "*.lua")
  return ("| `%s` | %d | %d | %s |"):format(room[1], c, lua, room[2])
end

local list = { "| room | C | Lua | |", "|---|---|---|---|" }
for _, room in ipairs(rooms) do
  list[#list + 1] = row(room)
  for _, part in ipairs(room.parts or {}) do list[#list + 1] = row(part) end
end
local text = table.concat(list, "\n")

local page = ...
if not page then return print(text) end
local file = assert(io.open(page))
local whole = file:read "a"
file:close()
local from, to = whole:find("<!%-%- rooms %-%->\n.-<!%-%- /rooms %-%->")
assert(from, page .. " has no place for the rooms")
file = assert(io.open(page, "w"))
file:write(whole:sub(1, from - 1), "<!-- rooms -->\n", text, "\n<!-- /rooms -->", whole:sub(to + 1))
file:close()
