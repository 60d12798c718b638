-- profile/text.lua -- a profile for people: tables of sums and a flame of indented bars; and folded stacks for programs
-- that draw flame graphs.
local json = require "ambit.report.json"

local text = {}

local BAR = 24
local LEAST = 0.005 -- share of the whole from which on a frame is printed

local function percent(part, whole) return whole > 0 and 100 * part / whole or 0 end

local function bar(part, whole)
  local n = whole > 0 and math.floor(BAR * part / whole + 0.5) or 0
  return ("#"):rep(math.min(math.max(n, 0), BAR))
end

local function line(write, name, seconds, whole, rest)
  local columns = ("  %-36s %10.4f %6.1f %%  %s"):format(name, seconds, percent(seconds, whole), rest or "")
  write((columns:gsub("%s+$", "")), "\n")
end

local function print_stages(write, p)
  write "\nstages                                          s\n"
  for _, s in ipairs(p.stages) do line(write, s.name, s.self, p.total, s.about) end
end

-- How a frame is called: services and opcodes say what they are, others by kind. A long name was cut between bytes,
-- not letters.
local function label(frame)
  local name = json.clean(frame.name)
  if frame.kind == "operation" then return name:lower() end
  local plain = { script = true, verb = true, stage = true, service = true, thread = true }
  return plain[frame.kind] and name or frame.kind .. " " .. name
end

text.label = label

local function print_calls(write, p)
  write "\nservices, solvers, arithmetics, elements      own s          total s      calls\n"
  local shown = 0
  for _, c in ipairs(p.calls) do
    local counts = c.kind ~= "stage" and c.kind ~= "verb" and c.kind ~= "thread"
    if counts and percent(c.self, p.total) >= 100 * LEAST and shown < 20 then
      shown = shown + 1
      line(write, label(c), c.self, p.total, ("%10.4f %10.0f"):format(c.total, c.count))
    end
  end
end

local function print_operations(write, p)
  if not p.operations[1] then return end
  local sum = 0
  for _, o in ipairs(p.operations) do sum = sum + o.self end
  write "\nopcodes, with what they call                    s             looks\n"
  for _, o in ipairs(p.operations) do
    if percent(o.self, sum) >= 0.5 then line(write, o.name, o.self, p.total, ("%10.0f"):format(o.count)) end
  end
end

local function names_of(with)
  local list = {}
  for i = 1, math.min(#with, 4) do list[i] = with[i].name end
  if #with > 4 then list[5] = ("%d more"):format(#with - 4) end
  return table.concat(list, ", ")
end

-- Those that cost anything, the dearest first.
local function dear(equations)
  local list = {}
  for _, e in ipairs(equations) do
    if e.self > 0 then list[#list + 1] = e end
  end
  table.sort(list, function(a, b)
    if a.self ~= b.self then return a.self > b.self end
    return a.tape .. a.name < b.tape .. b.name
  end)
  return list
end

local function print_equations(write, p)
  for _, verb in ipairs(p.verbs) do
    if verb.total < 2 * LEAST * p.total then return end -- those behind it take less still
    local list = dear(verb.equations)
    write(("\nequations of %s: apportioned, from the opcodes measured\n"):format(json.clean(verb.name)))
    if not list[1] then write "  no operations, or none that its solver and arithmetic tell\n" end
    for k = 1, math.min(#list, 12) do
      local e = list[k]
      local shared = e.shared > 0 and ("%.0f %% of it shared with %s"):format(percent(e.shared, e.self),
        names_of(e.with)) or "all its own"
      line(write, ("%s: %s"):format(e.tape, e.name), e.self, verb.operations, shared)
    end
    if #list > 12 then write(("  (%d more)\n"):format(#list - 12)) end
  end
end

local function print_flame(write, p, frame, depth)
  if frame.total < LEAST * p.total then return end
  local name = ("  "):rep(depth) .. label(frame)
  if utf8.len(name) > 60 then name = name:sub(1, utf8.offset(name, 58) - 1) .. "..." end
  name = name .. (" "):rep(60 - utf8.len(name))
  write((("%6.1f %% %10.4f  %s %s"):format(percent(frame.total, p.total), frame.total, name,
    bar(frame.total, p.total)):gsub("%s+$", "")), "\n")
  for _, inner in ipairs(frame.frames) do print_flame(write, p, inner, depth + 1) end
end

-- The sentence on how sure these numbers are.
local function print_head(write, p)
  write(("profile of %s: %.4f s"):format(p.scene, p.total))
  if p.waiting > 0 then write((", of which %.4f s waiting for threads"):format(p.waiting)) end
  write((" (CPU time of the process %.4f s)\n"):format(p.cpu_seconds))
  write(("measuring took %.4f s besides (%.1f %%), which is taken off; unaccounted for: %.4f s (%.1f %%)\n"):format(
    p.cost, percent(p.cost, p.total + p.cost), p.unaccounted, percent(p.unaccounted, p.wall_seconds)))
  if p.total - p.waiting > 1.2 * p.cpu_seconds then
    write "other programs had the processor part of the time: seconds are too long, shares of short runs are rough\n"
  end
  if p.is_cut then write "too many different frames: some are counted with those around them\n" end
end

function text.print(write, p)
  print_head(write, p)
  print_stages(write, p)
  print_calls(write, p)
  print_operations(write, p)
  print_equations(write, p)
  write(("\nall frames of at least %g %%, with those inside\n"):format(100 * LEAST))
  print_flame(write, p, p.frames, 0)
end

-- "script;simulate;run 1234": own time in microseconds
function text.fold(write, frame, path)
  path = (path and path .. ";" or "") .. label(frame):gsub("[;\n]", ",")
  local us = math.floor(1e6 * frame.self + 0.5)
  if us > 0 then write(("%s %d\n"):format(path, us)) end
  for _, inner in ipairs(frame.frames) do text.fold(write, inner, path) end
end

return text
