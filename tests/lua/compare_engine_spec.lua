-- Combinations in processes of their own: what crashes, hangs, takes all memory or leaves is a row like any other.
require "ambit"
local compare_engine = require "ambit.compare.engine"
local core = require "ambit.core"
local wire = require "ambit.wire"

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(tostring(text):find(piece, 1, true), text) end
end

local function rows_of(combinations, settings, progress)
  return compare_engine.new(settings, progress):rows(combinations, function(c) return c.work() end)
end

local function one(work, settings)
  return rows_of({ { label = "it", family = "it", settings = {}, work = work } }, settings)[1]
end

local generous = { limit = 5, memory = 1e9 }

describe("a combination in a child", function()
  it("hands over what it found, exactly", function()
    local row = one(function() return { status = "complete", width = 0.1, list = { 1, 2 } } end, generous)
    assert.equal("complete", row.status)
    assert.equal(0.1, row.width)
    assert.same({ 1, 2 }, row.list)
    assert.is_true(row.cpu_seconds >= 0 and row.memory >= 0)
    local engine = compare_engine.new(generous)
    local a = engine:child(function() return {} end)
    local b = engine:child(function() return {} end)
    assert.equal(a.cpu_seconds + b.cpu_seconds, engine.cpu_seconds) -- what is no row is counted too
  end)

  it("may crash", function()
    local row = one(function() os.execute "kill -SEGV $PPID" end, generous)
    assert.equal("crashed", row.status)
    if not core.is_sanitized then has(row.reason, "invalid memory access") end -- sanitizers catch it and leave
    row = one(function() os.execute "kill -KILL $PPID" end, generous)
    assert.equal("crashed", row.status)
    row = one(function() os.exit(0) end, generous)
    assert.equal("crashed", row.status)
    has(row.reason, "without an answer")
  end)

  it("may hang", function()
    local row = one(function() while true do end end, { limit = 0.05, wall = 0.3, memory = 1e9 })
    assert.equal("late", row.status)
    has(row.reason, "did not stop")
  end)

  it("may wait for what does not come", function()
    local row = one(function() os.execute "sleep 30" end, { limit = 5, wall = 0.2, memory = 1e9 })
    assert.equal("late", row.status)
    has(row.reason, "waits for something")
  end)

  it("may close every file and go on, or leave a process behind that keeps them open", function()
    local hostile, seconds = require "hostile", os.time()
    local row = one(function()
      hostile "closing"
      while true do end
    end, { limit = 0.05, wall = 0.3, memory = 1e9 })
    assert.equal("late", row.status)
    row = one(function()
      hostile "forking"
      return { status = "complete" }
    end, generous)
    assert.equal("complete", row.status)
    assert.is_true(os.time() - seconds < 15) -- the process that is left lives for 20
  end)

  it("may stop itself, and may hand over what cannot be read", function()
    local row = one(function() os.execute "kill -STOP $PPID" end, { limit = 5, wall = 0.2, memory = 1e9 })
    assert.equal("late", row.status)
    local write = wire.write
    wire.write = function() return "garbage" end
    row = one(function() return {} end, generous)
    wire.write = write
    assert.equal("failed", row.status)
    has(row.reason, "cannot be read")
  end)

  it("may want too much memory", function()
    if core.is_sanitized then return pending "no limit of memory" end
    local row = one(function()
      local list = {}
      for i = 1, 1000 do list[i] = ("x"):rep(10000000 + i) end
      return list
    end, { limit = 5, memory = 1e8 })
    assert.equal("out of memory", row.status)
    has(row.reason, "100 MB")
  end)

  it("may fail, and may return what is no plain data", function()
    local row = one(function() error("no such luck", 0) end, generous)
    assert.equal("failed", row.status)
    assert.equal("no such luck", row.reason)
    row = one(function() return { f = print } end, generous)
    assert.equal("failed", row.status)
    has(row.reason, "function")
  end)

  it("is skipped after one of less effort that took too long", function()
    local ran = {}
    local function combination(effort, seconds, family)
      return { label = family .. effort, family = family, effort = effort, settings = {}, work = function()
        return { status = "complete", seconds_first = seconds }
      end }
    end
    local list = { combination(1, 0, "a"), combination(3, 9, "a"), combination(2, 0, "a"), combination(4, 0, "a"),
      combination(4, 0, "b"), combination(5, 0, "c") }
    list[6].follows = "a"
    local progress = { begin = function(i, n) ran[#ran + 1] = i .. "/" .. n end, tick = function() end,
      finish = function() ran[#ran + 1] = "end" end }
    local rows, statuses = rows_of(list, generous, progress), {}
    for i, row in ipairs(rows) do statuses[i] = row.status end
    assert.same({ "complete", "complete", "complete", "skipped", "complete", "skipped" }, statuses)
    has(rows[4].reason, "a3 took 9 s", "limit of 5 s")
    assert.same({ "1/6", "2/6", "3/6", "4/6", "5/6", "6/6", "end" }, ran)
  end)

  it("is skipped where most of what it follows ended early, or stopped at the limit", function()
    local function combination(family, status, way, follows)
      return { label = family .. way, family = family, effort = 1, settings = {}, follows = follows, work = function()
        return { status = status, way = way, seconds_first = 0 }
      end }
    end
    local list = { combination("a", "unable", 0.2), combination("a", "unable", 0.3), combination("a", "complete", 1),
      combination("b", "unable", 0.9), combination("c", "complete", 1), combination("c", "unable", 0.1),
      combination("d", "stopped", 0.1), combination("x", "complete", 1, "a"), combination("y", "complete", 1, "b"),
      combination("z", "complete", 1, "c"), combination("w", "complete", 1, "d") }
    local rows = compare_engine.new(generous):rows(list, function(c) return c.work() end,
      function(row) return row.way end)
    has(rows[8].status .. rows[8].reason, "skipped", "2 of 3 of a ended early", "0.3 of the way")
    assert.equal("complete", rows[9].status)
    assert.equal("complete", rows[10].status)
    assert.equal("skipped", rows[11].status)
  end)

  it("keeps what ran when Ctrl-C comes between two", function()
    local path = os.tmpname()
    local file = assert(io.open(path, "w"))
    file:write [[
      local engine = require "ambit.compare.engine"
      local list, mine = {}, nil
      for i = 1, 4 do list[i] = { label = "c" .. i, family = "f", settings = {} } end
      local progress = { tick = function() end, finish = function() end, begin = function(i)
        if i == 3 and not mine.interrupted then io.popen("kill -INT $PPID"):close() end
      end }
      mine = engine.new({ limit = 5, memory = 1e9 }, progress)
      local rows = mine:calm(function()
        return mine:rows(list, function() return { status = "complete" } end)
      end)
      for _, row in ipairs(rows) do print(row.status) end
]]
    file:close()
    local pipe = assert(io.popen(("'%s' run %s 2>&1"):format(os.getenv "AMBIT_COMMAND" or "ambit", path)))
    local text = pipe:read "a"
    pipe:close()
    os.remove(path)
    has(text:gsub("%s+", " "), "complete complete skipped skipped")
  end)

  it("is a row where its plugin cannot be used or does not fit", function()
    local rows = rows_of({ { label = "x", family = "x", settings = {}, problem = "no such file" },
      { label = "y", family = "y", settings = {}, refused = "does not fit" } }, generous)
    assert.equal("failed", rows[1].status)
    assert.equal("refused", rows[2].status)
    assert.equal("does not fit", rows[2].reason)
  end)
end)
