-- man.lua AMBIT > ambit.1: the manual page, made of what the command says about itself.
package.path = arg[0]:gsub("[^/]*$", "?.lua;") .. package.path
local page = require("help").read(arg[1])

local function escaped(text) return (text:gsub("\\", "\\e"):gsub("%-", "\\-"):gsub("\n([.'])", "\n\\&%1")) end

local function write(...) io.write(..., "\n") end

-- As it stands, with its own line breaks.
local function verbatim(text)
  write ".nf"
  write((escaped("\n" .. text:gsub("\n$", "")):sub(2)))
  write ".fi"
end

write((".TH AMBIT 1 \"\" \"ambit %s\" \"User Commands\""):format(page.version))
write ".SH NAME"
write "ambit \\- guaranteed simulation of mechanical systems"
write ".SH SYNOPSIS"
write ".B ambit\n.I command\n.RI [ options ]"
write ".SH DESCRIPTION"
write "Describes a machine and its tolerances in a Lua script, and returns sets that are proved to contain every"
write "behaviour that the tolerances allow, or says why they could not be proved."
verbatim(page.text)
write ".SH COMMANDS"
for _, command in ipairs(page.commands) do
  write(".SS " .. escaped(("ambit %s: %s"):format(command.name, command.summary)))
  verbatim(command.text)
end
write ".SH ENVIRONMENT"
write ".TP\n.B AMBIT_PATH"
write "Folders of further plugins, separated by colons."
write ".TP\n.B NO_COLOR"
write "If set, nothing is coloured."
