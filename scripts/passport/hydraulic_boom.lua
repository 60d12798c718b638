-- A hydraulic cylinder raises a boom: valve, two chambers of oil, friction, load. Mass +-2 %, bulk modulus and leakage
-- +-5 %, lengths +-0.1 mm.
local ambit = require "ambit"
local around = ambit.around

local load = around(900, "2%", "load")
local bulk, leak = around("1.2e9", "5%", "bulk modulus"), around("2e-12", "5%", "leakage")
local viscous = around(9000, "5%", "seal")
local area, ring, stroke = "2.0e-3", "1.2e-3", around("0.6", "0.1 mm", "stroke")
local supply = "1.8e7"

local boom = ambit.ode { "boom", states = { "x", "v", "pa", "pb" }, check_units = false,
  equations = function(s, _, t)
    local opening = "0.6" * (1 - ambit.exp(-t / "0.1")) * ("0.3" - s.x) * "3e-8"
    local qa = opening * ambit.sqrt(supply - s.pa)
    local qb = opening * ambit.sqrt(s.pb)
    local across = leak * (s.pa - s.pb)
    local va, vb = "2e-4" + ambit.number(area) * s.x, "2e-4" + ambit.number(ring) * (stroke - s.x)
    return {
      x = s.v,
      v = (ambit.number(area) * s.pa - ambit.number(ring) * s.pb - viscous * s.v) / load - "9.81",
      pa = bulk / va * (qa * 100 - ambit.number(area) * s.v - across),
      pb = bulk / vb * (ambit.number(ring) * s.v - qb * 100 + across),
    }
  end }

local run = ambit.simulate { boom, initial = { x = "0.1", v = 0, pa = "5.0e6", pb = "1.0e6" },
  t = { 0, "0.1", "0.25", "0.5", 1 } }
print(run)
