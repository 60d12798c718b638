-- compare/engine.lua -- combinations one after the other, each in a process of its own with a budget of CPU time, wall
-- time and memory: what crashes, hangs or takes all memory is a row like any other. One at a time, because two
-- neighbours share caches and memory, which would show in the CPU times that are to be compared.
--
-- Ctrl-C at any time ends the child that runs; what was not run by then is a row that says so. What ran stays, wherever
-- in here the Ctrl-C comes.
local core = require "ambit.core"
local provenance = require "ambit.provenance"
local wire = require "ambit.wire"

local Engine = {}
Engine.__index = Engine

local engine = {}

local TICK = 0.2  -- s, how often the progress bar moves
local FAR = 0.75  -- part of the way: a method that ends before it with most of its orders is not tried further
local GRACE = 1   -- s, in which a child that was interrupted may hand over what it has
local signals = { [4] = "illegal instruction", [6] = "abort", [7] = "bus error", [8] = "arithmetic exception",
  [9] = "killed", [11] = "invalid memory access" }

local silent = { begin = function() end, tick = function() end, finish = function() end }

-- settings: limit (s of CPU time), memory (bytes), wall (s; nil: what a busy machine makes of the limit); progress:
-- { begin(i, n, label), tick(), finish() } or nil
function engine.new(settings, progress)
  return setmetatable({ settings = settings, progress = progress or silent, kept = {}, cpu_seconds = 0,
    interrupted = settings.interrupted or false, seen = core.interrupted() }, Engine)
end

-- f(...), again if Ctrl-C raised an error in it: then the engine is interrupted.
function Engine:calm(f, ...)
  local results = table.pack(pcall(f, ...))
  while not results[1] and core.interrupted() and tostring(results[2]):find "interrupted$" do
    self.interrupted = true
    results = table.pack(pcall(f, ...))
  end
  if not results[1] then error(results[2], 0) end
  return table.unpack(results, 2, results.n)
end

local function wait(self, child)
  while true do
    local index, result = core.child_wait({ child }, TICK)
    if result == "interrupted" or core.interrupted() and not self.seen then self.interrupted = true end
    if index then return result end
    if self.interrupted then
      index, result = core.child_wait({ child }, GRACE)
      return index and result or nil
    end
    self.progress.tick()
  end
end

-- Runs f in a child, which returns plain data -> what core.child_wait says of it, with `data` if it is done; nil:
-- interrupted.
function Engine:child(f)
  if self.interrupted then return nil end
  local s = self.settings
  local child = core.child(function() return provenance.with(wire.write(f())) end,
    { cpu = s.limit, wall = s.wall or 3 * s.limit + 10, memory = s.memory })
  local good, result = pcall(wait, self, child)
  core.child_kill(child)
  if not good then error(result, 0) end
  self.cpu_seconds = self.cpu_seconds + (result and result.cpu_seconds or 0)
  if result and result.outcome == "done" then
    local readable, data = pcall(wire.read, provenance.take(result.value))
    if readable then
      result.data = data
    else
      result.outcome, result.message = "failed", "what it handed over cannot be read"
    end
  end
  return result
end

-- The message without the place, which is that of the whole comparison.
function engine.bare(problem)
  local text, where = tostring(problem), core.where()
  if where ~= "" and text:sub(1, #where) == where then text = text:sub(#where + 1) end
  return text
end

local function new_row(c)
  return { solver = c.solver, arithmetic = c.arithmetic, options = c.settings, family = c.family, axis = c.axis,
    value = c.value, label = c.label, rigorous = c.rigorous }
end

function engine.fail(row, status, reason)
  row.status, row.reason = status, reason
  return row
end

local function size(bytes) return ("%.3g MB"):format(bytes / 1e6) end

-- What became of a child that has no data.
local function outcome(self, row, result)
  local text = result.message or ""
  if result.outcome == "late" then
    return engine.fail(row, "late", ("ended after %.3g s of CPU and %.3g s of wall time: it %s"):format(
      result.cpu_seconds, result.wall_seconds, result.cpu_seconds > self.settings.limit and
      "did not stop at its limit" or "waits for something that does not come"))
  elseif result.outcome == "out of memory" or text:find "out of memory" or text:find "not enough memory" then
    return engine.fail(row, "out of memory", ("it wanted more than %s"):format(size(self.settings.memory)))
  elseif result.outcome == "crashed" then
    local name = result.signal and (signals[result.signal] or "signal " .. result.signal) or "it left without an answer"
    return engine.fail(row, "crashed", ("its process ended: %s"):format(name))
  end
  return engine.fail(row, "failed", engine.bare(text))
end

-- One combination -> its row; work(c) runs in the child and returns the fields that it adds.
local function run_one(self, c, work)
  local row = new_row(c)
  if c.problem then return engine.fail(row, "failed", engine.bare(c.problem)) end
  if c.refused then return engine.fail(row, "refused", c.refused) end
  local result = self:child(function() return work(c) end)
  if not result then return engine.fail(row, "skipped", "interrupted") end
  row.cpu_seconds, row.memory = result.cpu_seconds, result.memory
  if not result.data then return outcome(self, row, result) end
  for key, value in pairs(result.data) do row[key] = value end
  return row
end

-- -- what is not worth trying

-- Of each family: { effort, label, seconds } of the first that took too long, how many ran, how many of them were
-- unable before they had gone FAR of the way, the farthest of those.
local function new_record() return { ran = 0, early = 0, farthest = 0 } end

-- Why c is skipped, or nil: one of less effort in the same family took too long, or so did one of the family that it
-- follows, or most of that one ended early.
local function hopeless(families, c, limit)
  local own, other = families[c.family], families[c.follows]
  local slow = own and own.slow and c.effort and c.effort > own.slow.effort and own.slow or other and other.slow
  if slow then
    return ("%s took %.3g s, which is over the limit of %.3g s"):format(slow.label, slow.seconds, limit)
  elseif other and 2 * other.early > other.ran then
    return ("%d of %d of %s ended early, at %.2g of the way at most: what is named in `solvers` runs all the same")
      :format(other.early, other.ran, c.follows, other.farthest)
  end
end

-- way(row): which part of its way a row came, or nil
local function note(families, c, row, limit, way)
  local family = families[c.family] or new_record()
  families[c.family] = family
  local seconds = row.seconds_first or row.status == "late" and row.cpu_seconds or 0
  local slow = seconds > limit or row.status == "late" or row.status == "stopped"
  if c.effort and slow and not (family.slow and family.slow.effort < c.effort) then
    family.slow = { effort = c.effort, label = c.label, seconds = seconds }
  end
  local part = row.status == "unable" and way and way(row)
  family.ran = family.ran + 1
  if part and part < FAR then family.early, family.farthest = family.early + 1, math.max(family.farthest, part) end
end

local function row_of(self, c, work, families, way)
  local limit = self.settings.limit
  local reason = hopeless(families, c, limit) or self.interrupted and "interrupted"
  if reason then return engine.fail(new_row(c), "skipped", reason) end
  local row = self:calm(run_one, self, c, work)
  note(families, c, row, limit, way)
  return row
end

-- The rows of the combinations, in their order, none left out. What an earlier call that Ctrl-C ended had done stays.
function Engine:rows(combinations, work, way)
  local families = {}
  for i, c in ipairs(combinations) do
    self.progress.begin(i, #combinations, c.label)
    self.kept[i] = self.kept[i] or row_of(self, c, work, families, way)
  end
  self.progress.finish()
  return self.kept
end

return engine
