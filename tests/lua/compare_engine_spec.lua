-- Combinations in processes of their own: what crashes, hangs, takes all memory or leaves is a row like any other.
require "ambit"
local compare_engine = require "ambit.compare.engine"

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
  end)

  it("may crash", function()
    local row = one(function() os.execute "kill -SEGV $PPID" end, generous)
    assert.equal("crashed", row.status)
    has(row.reason, "invalid memory access")
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

  it("may want too much memory", function()
    local row = one(function()
      local list = {}
      for i = 1, 1000 do list[i] = ("x"):rep(10000000 + i) end
      return list
    end, { limit = 5, memory = 1e8 })
    if row.status ~= "complete" then -- sanitized builds know no limit
      assert.equal("out of memory", row.status)
      has(row.reason, "100 MB")
    end
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

  it("is a row where its plugin cannot be used or does not fit", function()
    local rows = rows_of({ { label = "x", family = "x", settings = {}, problem = "no such file" },
      { label = "y", family = "y", settings = {}, refused = "does not fit" } }, generous)
    assert.equal("failed", rows[1].status)
    assert.equal("refused", rows[2].status)
    assert.equal("does not fit", rows[2].reason)
  end)
end)
