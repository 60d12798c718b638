-- rc_ladder.lua -- a line of 50 RC stages with parasites, and how much of it a signal sees.
--
-- A source drives the line; every node has a little stray coupling to the node after next, on both sides, and a little
-- leakage into its substrate. Amplitude and offset of the source are known within tolerances. What happens at nodes 3
-- and 6 in the first 10 us is wanted to a millivolt: the smallest ladder that provably gives it. The RC terms of the
-- first nine nodes are what the line is for and are not put in question.
local ambit = require "ambit"

local stages, near = 50, 9
local rc, both = ambit.number "0.8", ambit.number "1.6"                        -- 1/us: 1.25 kOhm, 1 nF; two
local stray, leak = ambit.number "1e-5", ambit.number "2e-6"                   -- 1/us, V/us
local amplitude, offset = ambit.around(1, "10%"), ambit.between("-0.1", "0.1") -- V

local states, initial, keep = {}, {}, {}
for k = 1, stages do
  states[k] = "v" .. k
  initial["v" .. k] = 0
end
for k = 1, near do
  keep[#keep + 1] = ("0.8*v%d"):format(k)
  keep[#keep + 1] = ("-1.6*v%d"):format(k)
end

local ladder = ambit.ode { "ladder", states = states,
  equations = function(s, _, t)
    local source, rates = offset + amplitude * ambit.sin(t / 2), {}
    local function v(k) return k < 1 and (k == 0 and source or 0) or k <= stages and s["v" .. k] or 0 end
    for k = 1, stages do
      rates["v" .. k] = rc * v(k - 1) - both * v(k) + rc * v(k + 1) + stray * (v(k - 2) + v(k + 2)) - leak
    end
    return rates
  end }

local small = ambit.reduce { ladder, t = { 0, 10 }, initial = initial, outputs = { "v3", "v6" },
  error = { v3 = "1e-3", v6 = "1e-3" }, reductions = { "neglect" }, levels = 1, keep = keep }
print(small)
print(("%d proofs in %.2f s, the ranking in %.3f s, one run of the whole ladder in %.3f s"):format(small.proofs,
  small.cpu_seconds, small.cpu_seconds_rank, small.cpu_seconds_detailed))
