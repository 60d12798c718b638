-- chain/two_slope_damper.lua -- m:two_slope_damper { from = a, to = b, compression = c, rebound = d }: a damper between
-- two points that is of different strength in its two directions, as those of cars are. Force -c l' while the length l
-- falls, -d l' while it grows.
local chain = require "ambit.chain"
local core = require "ambit.core"

local function build(m, p)
  m:force_law { from = p.from, to = p.to, name = "law", force = function(_, rate)
    return -p.compression * core.min(rate, 0) - p.rebound * core.max(rate, 0)
  end }
  return {}
end

return chain.new({
  "two_slope_damper",
  doc = "A damper between two points, of different strength while its length falls and while it grows.",
  ports = { from = { "frame", "one end" }, to = { "frame", "the other end" } },
  parameters = {
    compression = { "N s/m", nil, "while the length falls" },
    rebound = { "N s/m", nil, "while it grows" },
  },
  build = build,
}, true)
