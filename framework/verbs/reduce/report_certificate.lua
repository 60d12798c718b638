-- reduce/report_certificate.lua -- what a certificate of ambit.certify can be asked besides its verdict: the same as a
-- reduction, as far as there is no search to report.
local json = require "ambit.reduce.json"
local picture = require "ambit.reduce.picture"
local sample = require "ambit.reduce.sample"
local text = require "ambit.reduce.report_text"

local certificate = {}

-- A certificate as the facts of a reduction: bounds by place, nil where none was given.
local function facts(self)
  local bounds = {}
  for k, name in ipairs(self.outputs) do bounds[k] = self.bounds[name] end
  return setmetatable({ model = self.reduced, bounds = bounds }, { __index = self })
end

-- Adds the methods to the class.
function certificate.install(class)
  function class:json(file) return json.write(facts(self), file, "json") end
  function class:picture(file, options) return picture.write(facts(self), file, options, "picture") end
  function class:sample(t) return sample.of(facts(self), t, "sample") end
end

-- The lines of its report.
function certificate.lines(self) return text.proof(facts(self)) end

return certificate
