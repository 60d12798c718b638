-- compare.lua -- counts against what they may be: what grew, what shrank, in sentences.
local compare = {}

-- Steps may differ by a rounding between compilers where a solver's choices are made in floating point (fused
-- operations); a count of ten thousand may then grow by a hundred, but no count by more.
local SLACK = 0.01

-- of(name, pinned, found, counts) -> {grown}, {shrunk}
function compare.of(name, pinned, found, counts)
  local grown, shrunk = {}, {}
  if not pinned then return { ("%s: is not in the file"):format(name) }, shrunk end
  for _, count in ipairs(counts) do
    local old, new = pinned[count] or 0, found[count]
    if new > old * (1 + SLACK) then
      grown[#grown + 1] = ("%s: %s grew from %d to %d"):format(name, count, old, new)
    elseif new < old * (1 - SLACK) then
      shrunk[#shrunk + 1] = ("%s: %s shrank from %d to %d"):format(name, count, old, new)
    end
  end
  return grown, shrunk
end

return compare
