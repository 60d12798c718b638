-- completion.lua AMBIT bash|zsh: completions of commands, options and files, made of what the command says about
-- itself.
package.path = arg[0]:gsub("[^/]*$", "?.lua;") .. package.path
local page = require("help").read(arg[1])

local names = {}
for i, command in ipairs(page.commands) do names[i] = command.name end

local function bash()
  print "# bash completion for ambit"
  print "_ambit() {"
  print '  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} options='
  print "  if [ \"$COMP_CWORD\" = 1 ]; then"
  print(("    COMPREPLY=($(compgen -W '%s --help --version' -- \"$word\"))"):format(table.concat(names, " ")))
  print "    return\n  fi"
  print "  case $command in"
  for _, command in ipairs(page.commands) do
    print(("    %s) options='%s' ;;"):format(command.name, table.concat(command.options, " ")))
  end
  print "  esac"
  print "  if [ \"${word#-}\" != \"$word\" ]; then"
  print "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))"
  print "  else"
  print "    compopt -o default; COMPREPLY=()\n  fi"
  print "}\ncomplete -F _ambit ambit"
end

local function zsh()
  print "#compdef ambit"
  print "local -a commands options"
  print "commands=("
  for _, command in ipairs(page.commands) do
    print(("  '%s:%s'"):format(command.name, command.summary:gsub("[:']", " ")))
  end
  print ")"
  print "if (( CURRENT == 2 )); then\n  _describe command commands\n  return\nfi"
  print "case $words[2] in"
  for _, command in ipairs(page.commands) do
    print(("  %s) options=(%s) ;;"):format(command.name, table.concat(command.options, " ")))
  end
  print "esac"
  print "if [[ $words[CURRENT] == -* ]]; then\n  compadd -- $options\nelse\n  _files\nfi"
end

if arg[2] == "zsh" then zsh() else bash() end
