-- chain/cable.lua -- m:cable { from = a, to = b, length = l0, stiffness = k, damping = c }: it pulls when it is longer
-- than l0, with the force -k max(l - l0, 0) (1 + c l'), which is continuous where it goes slack (Hunt & Crossley, J.
-- Appl. Mech. 42 (1975)). The law holds as long as it shortens no faster than 1/c; beyond that the force changes its
-- sign.
local chain = require "ambit.chain"
local core = require "ambit.core"

local function build(m, p)
  m:force_law { from = p.from, to = p.to, name = "law", force = function(length, rate)
    return -p.stiffness * core.max(length - p.length, 0) * (1 + p.damping * rate)
  end }
  return {}
end

return chain.new({
  "cable",
  doc = "A cable between two points: a spring that pulls where it is longer than `length`, and is slack where not.",
  ports = { from = { "frame", "one end" }, to = { "frame", "the other end" } },
  parameters = {
    length = { "m", nil, "at which it goes slack" },
    stiffness = { "N/m", nil, "force per length beyond that" },
    damping = { "s/m", "0", "share of the force per speed at which it grows longer" },
  },
  build = build,
}, true)
