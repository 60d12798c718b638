-- compare/progress.lua -- a line on a terminal that says how far a comparison is: combination i of n, how long it has
-- taken, what the rest may take.
local core = require "ambit.core"
local compare_table = require "ambit.compare.table"

local progress = {}

local BAR, LABEL = 12, 24 -- characters, so that all fits on a narrow terminal

local function seconds(s)
  if s < 60 then return ("%.0f s"):format(s) end
  return ("%d:%02d min"):format(s // 60, s % 60 // 1)
end

local function draw(self)
  local now = os.time()
  local done = math.max(self.i - 1, 0)
  local filled = BAR * done // math.max(self.n, 1)
  local rest = done > 0 and self.n > 0 and (now - self.began) * (self.n - done) / done
  io.stderr:write(("\r\27[K%s[%s%s] %d of %d  %s  %s%s"):format(self.head, ("#"):rep(filled), ("-"):rep(BAR - filled),
    self.i, self.n, compare_table.short(self.label, LABEL), seconds(now - self.began),
    rest and (", %s left"):format(seconds(rest)) or ""))
  io.stderr:flush()
end

-- For comparison `number` of `total`; nil where standard error is no terminal.
function progress.new(number, total)
  if not core.terminal "stderr" then return nil end
  local self = { head = total > 1 and ("%d/%d "):format(number, total) or "", began = os.time(), i = 0, n = 0,
    label = "" }
  return {
    begin = function(i, n, label)
      self.i, self.n, self.label = i, n, label
      draw(self)
    end,
    tick = function() draw(self) end,
    finish = function()
      io.stderr:write "\r\27[K"
      io.stderr:flush()
    end,
  }
end

return progress
