-- explain/parts.lua -- a mechanism as text: its parts as an indented tree, closed loops, chains, what was not built.
local explain_tree = require "ambit.explain.tree"

local explain = {}

local LEVELS = 30 -- deeper branches are not indented further
local NAMES = 30  -- of idle parts

local function remarks(tree, part)
  local list = {}
  for i, link in ipairs(part.on) do
    list[#list + 1] = (i == 1 and "on " or "and ") .. tree[link.part].name
  end
  if #part.coordinates > 0 then
    list[#list + 1] = "coordinate " .. table.concat(part.coordinates, ", ")
  elseif part.is_joint then
    list[#list + 1] = "motion given"
  end
  if part.mass then list[#list + 1] = explain_tree.text_of_mass(part.mass) end
  return table.concat(list, "; ")
end

local function line(write, tree, part, depth)
  local name = ("  "):rep(math.min(depth, LEVELS) + 1) .. part.name
  local text = ("%-40s %2d of %2d  %-14s %s"):format(name, part.built, part.available, part.type, remarks(tree, part))
  write("%s\n", (text:gsub("%s+$", "")))
end

-- Depth first, without recursion: mechanisms may be deep. What is the only carrier on its carrier stays on its level.
local function write_parts(write, tree, shown)
  local stack = { { tree[0], 0 } }
  while #stack > 0 do
    local part, depth = table.unpack(table.remove(stack))
    if shown[part.part] then line(write, tree, part, depth) end
    local carriers, ends = {}, {}
    for _, child in ipairs(part.attached) do table.insert(child.carries and carriers or ends, child) end
    for i = #carriers, 1, -1 do
      stack[#stack + 1] = { carriers[i], #carriers > 1 and part.part ~= 0 and depth + 1 or depth }
    end
    for i = #ends, 1, -1 do stack[#stack + 1] = { ends[i], part.part == 0 and depth or depth + 1 } end
  end
end

local function chains(nodes, depth, list)
  for _, node in ipairs(nodes) do
    if node.parts then
      list[#list + 1] = ("  %s%s: %s, %d parts"):format(("  "):rep(depth), node.path, node.type, #node.parts)
      chains(node.parts, depth + 1, list)
    end
  end
  return list
end

-- The first few of a list of lines, and how many more there are.
local function write_some(write, title, lines)
  if #lines == 0 then return end
  write(" %s\n", title)
  for i = 1, math.min(#lines, NAMES) do write("%s\n", lines[i]) end
  if #lines > NAMES then write("  ... and %d more\n", #lines - NAMES) end
end

-- The parts of which nobody asked for anything, in lines of a readable length.
local function write_idle(write, tree)
  local idle = tree.idle
  if #idle == 0 then return end
  write(" not built: nothing was asked of %d part%s\n", #idle, #idle == 1 and "" or "s")
  local row = " "
  for i = 1, math.min(#idle, NAMES) do
    if #row + #idle[i].name > 100 then
      write("%s\n", row)
      row = " "
    end
    row = row .. " " .. idle[i].name
  end
  write("%s%s\n", row, #idle > NAMES and (" ... and %d more"):format(#idle - NAMES) or "")
end

-- Prints the tree of one mechanism.
function explain.write(write, tree)
  local shown, hidden = explain_tree.selection(tree)
  write_parts(write, tree, shown)
  if hidden.count > 0 then write("  ... and %d more alike: %s\n", hidden.count, explain_tree.alike(hidden)) end
  write_some(write, "chains", chains(tree.mechanism:tree().parts, 0, {}))
  local loops = {}
  for _, part in ipairs(tree.loops) do
    line(function(...) loops[#loops + 1] = string.format(...):sub(1, -2) end, tree, part, 0)
  end
  write_some(write, "closed loops", loops)
  write_idle(write, tree)
end

return explain
