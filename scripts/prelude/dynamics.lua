-- dynamics.lua -- the equations of motion of a mechanism, and its energy.
local core = require "ambit.core"
local Matrix = require "ambit.matrix"
local ode = require "ambit.ode"

local methods = {}

-- Energy of the whole mechanism, J.
function methods:energy()
  local e = core.pull(self.handle, -1, 0, core.ENERGY, 2)
  return setmetatable({ kinetic = e[1], potential = e[2], total = e[1] + e[2] }, Matrix)
end

-- The joint coordinates as expressions, by name: beta1, beta1', beta1''.
function methods:coordinates()
  local t = {}
  for _, c in ipairs(core.coordinates(self.handle)) do
    t[c.name] = c.q
  end
  for _, s in ipairs(core.speeds(self.handle)) do
    t[s.name], t[s.du_name] = s.u, s.du
  end
  return setmetatable(t, Matrix)
end

-- M(q) q'' = h(q, q'): the matrix by rows, and h.
function methods:mass_matrix()
  local n, mass = core.motion(self.handle)
  local rows = {}
  for i = 1, n do rows[i] = table.move(mass, (i - 1) * n + 1, i * n, 1, {}) end
  return setmetatable(rows, Matrix)
end

function methods:generalised_forces()
  local _, _, force = core.motion(self.handle)
  return setmetatable(force, Matrix)
end

-- The equations of motion as a first-order system; made once as long as no part is added.
function methods:dynamics()
  local parts = core.part_count(self.handle)
  if self.cached_parts ~= parts then
    self.cached = ode.of_system(core.dynamics(self.handle), self.name)
    self.cached_parts = parts
  end
  return self.cached
end

local dynamics = {}

function dynamics.install(into)
  for name, method in pairs(methods) do into[name] = method end
end

return dynamics
