-- robot/xml.lua -- an XML text as a tree whose nodes know their line. The parser is expat, through the Lua module `lxp`
-- (Debian: lua-expat); it is asked for only when a file is read.
--
-- A node: { tag, line, attr = { name = text }, ... children in order }. Text between tags is dropped: the formats
-- that are read here say everything in attributes. Prefixes of namespaces stay part of the names.
local check = require "ambit.check"

local xml = {}

local function expat(what)
  local lxp = require "ambit.foreign".find "lxp"
  if lxp then return lxp end
  check.fail("%s: to read XML the Lua module `lxp` is needed, which is not installed (Debian: apt install lua-expat)",
    what)
end

-- parse(text, file, what) -> the root; `what` leads the message if there is no parser at all
function xml.parse(text, file, what)
  local root, open = nil, {}
  local parser = expat(what).new {
    StartElement = function(self, tag, attributes)
      local node = { tag = tag, line = (self:pos()), attr = {} }
      for name, value in pairs(attributes) do
        if type(name) == "string" then node.attr[name] = value end
      end
      local parent = open[#open]
      if parent then parent[#parent + 1] = node else root = node end
      open[#open + 1] = node
    end,
    EndElement = function() open[#open] = nil end,
  }
  local good, message, line, column = parser:parse(text)
  if good then good, message, line, column = parser:parse() end -- the end of the text
  if not good then check.fail("%s:%d:%d: not well-formed XML: %s", file, line, column, message) end
  parser:close() -- after an error it would raise that once more
  return root
end

-- The children with that tag.
function xml.all(node, tag)
  local list = {}
  for _, child in ipairs(node) do
    if child.tag == tag then list[#list + 1] = child end
  end
  return list
end

return xml
