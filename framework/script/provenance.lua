-- provenance.lua -- whence a result comes: Ambit's version and kernel, the scene, and every plugin that was loaded,
-- with its file and the SHA-256 of that file. Reports and records begin with it. Nothing of it is computed unless asked
-- for.
local core = require "ambit.core"

local provenance = {}

local command, scene -- of the command line: its word, and { file, text, sha256 }
local elsewhere = {} -- "kind.name" of the plugins that child processes loaded

function provenance.begin(name) command = name end

-- -- the scene

-- The text of a scene's file, read once: what is hashed is what runs, and a pipe can be read but once. nil and a
-- message: it cannot be read.
function provenance.read(name)
  if scene and scene.file == name then return scene.text end
  local file, problem = io.stdin, nil
  if name ~= "-" then file, problem = io.open(name, "rb") end
  if not file then return nil, "cannot open " .. problem end
  local text, why = file:read "a"
  file:close()
  if not text then return nil, ("cannot read %s: %s"):format(name, why) end
  scene = { file = name, text = text }
  return text
end

-- The function of a scene's file, as loadfile makes it; nil and a message. env: of a scene in a sandbox, its globals.
function provenance.load(name, env)
  local text, problem = provenance.read(name)
  if not text then return nil, problem end
  text = text:gsub("^\xEF\xBB\xBF", ""):gsub("^#[^\n]*", "")
  local chunk = name == "-" and "=standard input" or "@" .. name
  if env then return load(text, chunk, "t", env) end
  return load(text, chunk)
end

-- -- plugins of child processes

-- In a child: what it hands over, behind a line of what it loaded.
function provenance.with(text) return "loaded: " .. table.concat(core.loaded(), " ") .. "\n" .. text end

-- In its parent: what was handed over; what the child loaded is remembered.
function provenance.take(text)
  local line, rest = text:match "^loaded: ([^\n]*)\n(.*)$"
  for id in (line or ""):gmatch "%S+" do elsewhere[id] = true end
  return rest or text
end

-- They are loaded here too, so that their files are known.
local function load_elsewhere()
  local known = {}
  for _, id in ipairs(core.loaded()) do known[id] = true end
  for id in pairs(elsewhere) do
    local kind, name = id:match "^(%a+)%.(.+)$"
    if not known[id] then core.plugin(kind, name) end
  end
end

-- -- what there is to say

local function distinct(plugins)
  local seen, list = {}, {}
  for _, plugin in ipairs(plugins) do
    local key = plugin.kind .. "." .. plugin.name .. " " .. plugin.file
    if not seen[key] then list[#list + 1] = plugin end
    seen[key] = true
  end
  return list
end

local function scene_of()
  if not scene then return nil end
  scene.sha256 = scene.sha256 or core.sha256(scene.text)
  return { file = scene.file, sha256 = scene.sha256 }
end

local function kernel_of()
  local file, sha256 = core.kernel()
  return { file = file, sha256 = sha256 }
end

-- { ambit = version, command, scene = { file, sha256 }, kernel = { file, sha256 }, plugins = { { kind, name, version,
-- file, sha256, shadows = "yes" or nil }, ... in the order in which they were loaded }, trusted = { folder, ... } }
function provenance.now()
  load_elsewhere()
  local all = { ambit = core.version, command = command, scene = scene_of(), kernel = kernel_of() }
  local plugins, trusted = core.provenance()
  all.plugins = distinct(plugins)
  all.trusted = #trusted > 0 and trusted or nil
  return all
end

-- -- forms of it

-- Control characters of a file's name end no line.
local function clean(text) return (text:gsub("%c", "?")) end

-- { { what, text }, ... }
function provenance.facts()
  local all = provenance.now()
  local list = { { "ambit", all.ambit .. (command and ", ambit " .. command or "") } }
  local function add(what, entry) list[#list + 1] = { what, clean(entry.file) .. ", SHA-256 " .. entry.sha256 } end
  if all.scene then add("scene", all.scene) end
  add("kernel", all.kernel)
  for _, plugin in ipairs(all.plugins) do
    list[#list + 1] = { ("%s %s"):format(plugin.kind, plugin.name), ("%s, %s, SHA-256 %s%s"):format(plugin.version,
      clean(plugin.file), plugin.sha256, plugin.shadows and ", takes the place of Ambit's own" or "") }
  end
  for _, folder in ipairs(all.trusted or {}) do list[#list + 1] = { "trusted", clean(folder) } end
  return list
end

-- Lines, each behind `lead` and with the end of a line.
function provenance.lines(lead, ending)
  local lines = {}
  for i, fact in ipairs(provenance.facts()) do
    lines[i] = ("%s%s: %s%s"):format(lead, fact[1], fact[2], ending or "\n")
  end
  return table.concat(lines)
end

-- For the end of a result that a scene prints: a list of lines.
function provenance.tail()
  local lines = { "provenance" }
  for _, fact in ipairs(provenance.facts()) do lines[#lines + 1] = ("  %s: %s"):format(fact[1], fact[2]) end
  return lines
end

local entities = { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;" }

-- The text of an SVG picture, with it behind the first tag.
function provenance.svg(text)
  local lines = provenance.lines "":gsub("[&<>]", entities)
  return (text:gsub("<svg[^>]*>", function(tag) return ("%s\n<metadata>\n%s</metadata>"):format(tag, lines) end, 1))
end

-- The text of a JSON object, beginning with it.
function provenance.json(text)
  local json = require "ambit.report.json"
  local rest = text:match "^{%s*}(.*)"
  return ('{"provenance":%s%s'):format(json.encode(provenance.now()), rest and "}" .. rest or "," .. text:sub(2))
end

-- For the head of an HTML page, folded.
function provenance.html()
  local html = require "ambit.report.html"
  return html.tag("details", { class = "provenance" }, html.tag("summary", {}, "Provenance: version, plugins, SHA-256"),
    html.facts(provenance.facts()))
end

-- Opens the records of `--json`, which begin with it; plugins that are loaded later stand before the first record that
-- rests on them.
function provenance.records(name)
  core.records_open(name)
  local fields = { "ambit", core.version }
  local function add(key, value) fields[#fields + 1], fields[#fields + 2] = key, value end
  local function add_file(key, entry) add(key, { "file", entry.file, "sha256", entry.sha256 }) end
  if command then add("command", command) end
  if scene then add_file("scene", scene_of()) end
  add_file("kernel", kernel_of())
  local _, trusted = core.provenance()
  if #trusted > 0 then add("trusted", table.concat(trusted, ":")) end
  core.record("provenance", fields)
  core.provenance_begin()
end

return provenance
