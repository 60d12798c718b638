-- reduce/report.lua -- what ambit.reduce gives back: the facts that the driver found, and what can be asked of them.
-- What each method prints or writes is in a file of its own.
--
-- The facts are those that the driver collects: status, reason, ode, detailed, model, outputs, bounds, error,
-- scenarios, criterion, ranking, cluster, settings, terms, log, history, sizes before and after, times; and
--   given: the scenarios that were proved, as ambit.certify.scenario reads them, in the order of `scenarios`;
--   rankings: { { pass =, residual = { value of each candidate }, exact = { ... } }, ... }, for `judge`.
local check = require "ambit.check"
local json = require "ambit.reduce.json"
local judge = require "ambit.reduce.report_judge"
local picture = require "ambit.reduce.picture"
local sample = require "ambit.reduce.sample"
local text = require "ambit.reduce.report_text"

local Reduction = { __name = "reduction" }
Reduction.__index = Reduction

local methods = {}

-- The terms in the order in which they were decided: a row for each, with what its cluster cost.
function methods:report()
  local rows = {}
  for i, term in ipairs(self.terms) do
    local output, error, share = text.worst(self, term.effect)
    rows[i] = { pass = term.pass, equation = term.equation, level = term.level, term = term.text,
      technique = term.technique, replacement = term.replacement, rank = term.rank, status = term.status,
      output = output, error = error, share = share }
  end
  return rows
end

-- The same as lines of text, no wider than `width` characters (100): long terms are cut, the JSON has them whole.
function methods:table(width)
  return text.terms(self, check.count(width == nil and text.width or width, "table: width"))
end

-- The undo log: a line for each decision, in order.
function methods:decisions() return text.decisions(self) end

-- How well each ranking foretold the exact effect: { { pass, ranking, correlation, candidates }, ... }.
function methods:judge() return judge.of(self) end

-- Everything as JSON: the text, and in a file if one is named.
function methods:json(file) return json.write(self, file, "json") end

-- Error against the number of terms and against time, as an SVG file.
function methods:picture(file, options) return picture.write(self, file, options, "picture") end

-- The true error from inside: both models at the same draws of the data.
function methods:sample(t) return sample.of(self, t, "sample") end

check.methods(methods, Reduction)
for name, method in pairs(methods) do Reduction[name] = method end

function Reduction.__tostring(self) return text.whole(self) end

local report = {}

-- The facts of a reduction -> its result.
function report.of(facts) return setmetatable(facts, Reduction) end

function report.is(value) return getmetatable(value) == Reduction end

return report
