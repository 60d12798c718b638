-- explain/svg.lua -- the graph of a scene as a picture: Graphviz lays it out, a style sheet makes it readable in light
-- and dark, tool tips carry the numbers.
local outputs = require "ambit.command.outputs"

local explain = {}

local style = [[
<style>
svg { color-scheme: light dark; background: #fff; }
text { fill: #1b1f24; }
.node path, .node polygon { fill: #f6f8fa; stroke: #57606a; }
.joint path, .joint polygon { fill: #ddf4ff; stroke: #0969da; }
.loop path { fill: #fff1e5; stroke: #bc4c00; }
.verb path { fill: #dafbe1; stroke: #1a7f37; }
.unable path { fill: #ffebe9; stroke: #cf222e; }
.solver path, .arithmetic path { fill: #fbefff; stroke: #8250df; }
.node.left path, .node.left polygon { fill: none; stroke: #8c959f; stroke-dasharray: 5 3; }
.left text { fill: #6e7781; }
.group polygon { fill: none; stroke: #d0d7de; }
.edge path { stroke: #57606a; } .edge polygon { fill: #57606a; stroke: #57606a; }
.edge.left path { stroke: #afb8c1; } .edge.left polygon { fill: #afb8c1; stroke: #afb8c1; }
@media (prefers-color-scheme: dark) {
  svg { background: #0d1117; }
  text { fill: #e6edf3; }
  .node path, .node polygon { fill: #161b22; stroke: #8b949e; }
  .joint path, .joint polygon { fill: #0c2d6b; stroke: #58a6ff; }
  .loop path { fill: #3d1f00; stroke: #f0883e; }
  .verb path { fill: #033a16; stroke: #3fb950; }
  .unable path { fill: #490202; stroke: #f85149; }
  .solver path, .arithmetic path { fill: #271052; stroke: #bc8cff; }
  .node.left path, .node.left polygon { fill: none; stroke: #6e7681; }
  .left text { fill: #8b949e; }
  .group polygon { stroke: #30363d; }
  .edge path { stroke: #8b949e; } .edge polygon { fill: #8b949e; stroke: #8b949e; }
  .edge.left path { stroke: #484f58; } .edge.left polygon { fill: #484f58; stroke: #484f58; }
}
</style>]]

function explain.has_dot()
  return (os.execute "command -v dot >/dev/null 2>&1") == true
end

local function escaped(text) return (text:gsub("&", "&amp;"):gsub("<", "&lt;"):gsub(">", "&gt;")) end

-- Browsers show the title of a group as its tool tip: that of a node becomes its numbers, that of an edge goes.
function explain.styled(svg, tips)
  svg = svg:gsub("<title>(.-)</title>", function(name)
    return tips[name] and "<title>" .. escaped(tips[name]) .. "</title>" or ""
  end)
  svg = svg:gsub("(<svg[^>]*>)", function(tag) return tag .. "\n" .. style end, 1)
  return require "ambit.provenance".svg(svg)
end

-- Writes the picture; nil, or what went wrong.
function explain.write(path, dot, tips)
  local source, picture = os.tmpname(), os.tmpname()
  local file = assert(io.open(source, "w"))
  file:write(dot)
  file:close()
  local good = os.execute(("dot -Tsvg -o '%s' '%s'"):format(picture, source))
  local drawn = good and io.open(picture, "r")
  local text = drawn and drawn:read "a"
  if drawn then drawn:close() end
  os.remove(source)
  os.remove(picture)
  if not text or text == "" then return "`dot` could not draw the graph" end
  local good, problem = pcall(outputs.write, path, explain.styled(text, tips))
  return not good and problem or nil
end

return explain
