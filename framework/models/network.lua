-- network.lua -- ambit.network "controller.txt": a neural network of dense layers as a formula; ambit.lookup { x = {
-- ... }, y = { ... } }: a table between whose points lines are drawn.
--
-- The file: lines of words, # starts a comment.
--   inputs 2
--   dense 3 relu          then 3 lines, of a neuron each: its 2 weights and its bias
--   dense 1 linear
-- Numbers are the doubles next to what the text says.
local check = require "ambit.check"
local core = require "ambit.core"

local Network = { __name = "network" }
Network.__index = Network

local network = {}

local activations = {
  linear = function(x) return x end,
  relu = function(x) return core.max(0, x) end,
  tanh = core.tanh,
  sigmoid = function(x) return 1 / (1 + core.exp(-x)) end,
}

local function activation(name, what)
  if activations[name] then return name end
  check.fail("%s: expected one of %s, got %s%s", what, table.concat(check.sorted(activations), ", "),
    check.shown(name), check.suggest(name, check.sorted(activations)))
end

local function number(value, what)
  local x = type(value) == "number" and value or nil
  if not x or x ~= x or math.abs(x) == math.huge then
    check.fail("%s: expected a finite number, got %s", what, check.shown(value))
  end
  return x
end

-- -- from a file

-- A path is taken from where the command runs.
local function read_text(file)
  local stream, problem = io.open(file, "rb")
  local text, failure
  if stream then
    text, failure = stream:read "a"
    stream:close()
  end
  if not text then check.fail("network: cannot read the file: %s", problem or failure or file) end
  return text
end

-- The words of each line that has some, and the line's number.
local function read_lines(file)
  local lines, n = {}, 0
  for line in (read_text(file) .. "\n"):gmatch "(.-)\n" do
    n = n + 1
    local words = { line = n }
    for word in line:gsub("#.*", ""):gmatch "%S+" do words[#words + 1] = word end
    if #words > 0 then lines[#lines + 1] = words end
  end
  return lines
end

local function count(text, what)
  local n = math.tointeger(tonumber(text))
  if not n or n < 1 then check.fail("%s: expected a positive integer, got `%s`", what, tostring(text)) end
  return n
end

local function read_neuron(words, inputs, where)
  if #words ~= inputs + 1 then
    check.fail("%s: expected %d weights and a bias, got %d numbers", where, inputs, #words)
  end
  local row = {}
  for i, word in ipairs(words) do
    row[i] = tonumber(word)
    if not row[i] then check.fail("%s: expected a number, got `%s`", where, word) end
    number(row[i], where)
  end
  return row, table.remove(row)
end

local function read_file(file)
  local lines, layers = read_lines(file), {}
  local function where(k) return ("network: %s:%d"):format(file, lines[k] and lines[k].line or 0) end
  if not lines[1] or lines[1][1] ~= "inputs" or #lines[1] ~= 2 then
    check.fail("%s: expected `inputs` and their number", where(1))
  end
  local inputs, k = count(lines[1][2], where(1) .. ": inputs"), 2
  while lines[k] do
    local head = lines[k]
    if head[1] ~= "dense" or #head ~= 3 then
      check.fail("%s: expected `dense`, a number of neurons, and their activation", where(k))
    end
    local layer = { weights = {}, bias = {}, activation = activation(head[3], where(k)) }
    for n = 1, count(head[2], where(k) .. ": dense") do
      k = k + 1
      if not lines[k] then check.fail("network: %s: the file ends before neuron %d of its layer", file, n) end
      layer.weights[n], layer.bias[n] = read_neuron(lines[k], inputs, where(k))
    end
    layers[#layers + 1], inputs, k = layer, #layer.bias, k + 1
  end
  return layers
end

-- -- from a table

local function read_table(t)
  local layers = {}
  for n, given in ipairs(t) do
    local what = ("network: layer %d"):format(n)
    check.keys(check.table(given, what), { "weights", "bias", "activation" }, what)
    local weights = what .. ": weights"
    local layer = { weights = {}, bias = {},
      activation = activation(given.activation or "linear", what .. ": activation") }
    for i, row in ipairs(check.table(given.weights, weights)) do
      layer.weights[i] = {}
      for j, w in ipairs(check.table(row, weights)) do layer.weights[i][j] = number(w, weights) end
      local inputs = layers[n - 1] and #layers[n - 1].bias or #layer.weights[1]
      if #row ~= inputs then check.fail("%s: expected %d weights in each row, got %d", what, inputs, #row) end
    end
    if given.bias and #check.table(given.bias, what .. ": bias") ~= #layer.weights then
      check.fail("%s: expected a bias for each of %d rows of weights, got %d", what, #layer.weights, #given.bias)
    end
    for i in ipairs(layer.weights) do layer.bias[i] = number((given.bias or {})[i] or 0, what .. ": bias") end
    layers[n] = layer
  end
  return layers
end

function network.new(given)
  local layers
  if type(given) == "string" then
    layers = read_file(given)
  else
    layers = read_table(check.table(given, "network"))
  end
  if #layers == 0 then check.fail "network: expected at least one layer" end
  return setmetatable({ layers = layers, inputs = #layers[1].weights[1], outputs = #layers[#layers].bias }, Network)
end

function Network.__tostring(self)
  local sizes = { tostring(self.inputs) }
  for _, layer in ipairs(self.layers) do sizes[#sizes + 1] = ("%d %s"):format(#layer.bias, layer.activation) end
  return "network " .. table.concat(sizes, " - ")
end

-- net { x1, x2 } -> { y1, ... }
function Network:__call(x)
  check.table(x, "network: inputs")
  if #x ~= self.inputs then check.fail("network: expected %d inputs, got %d", self.inputs, #x) end
  local values = {}
  for i, value in ipairs(x) do values[i] = core.expression(value, nil, "network: inputs") end
  for _, layer in ipairs(self.layers) do
    local next_values = {}
    for i, row in ipairs(layer.weights) do
      local sum = core.expression(layer.bias[i])
      for j, w in ipairs(row) do
        if w ~= 0 then sum = sum + w * values[j] end
      end
      next_values[i] = activations[layer.activation](sum)
    end
    values = next_values
  end
  return values
end

-- -- tables

-- ambit.lookup { x = { 0, 1, 2 }, y = { 0, 3, 4 } } -> f, f(x): lines between the points, constant beyond the ends
function network.lookup(t)
  check.keys(check.table(t, "lookup"), { "x", "y" }, "lookup")
  local x, y = check.table(t.x, "lookup: x"), check.table(t.y, "lookup: y")
  if #x < 2 or #x ~= #y then
    check.fail("lookup: expected as many numbers in x as in y, two at least, got %d and %d", #x, #y)
  end
  local points, values = {}, {}
  for i = 1, #x do
    points[i], values[i] = core.expression(x[i], nil, "lookup: x"), core.expression(y[i], nil, "lookup: y")
    if not core.is_constant(points[i]) or not core.is_constant(values[i]) then
      check.fail("lookup: point %d: expected known numbers", i)
    end
    if i > 1 and not (core.interval(points[i - 1]).hi < core.interval(points[i]).lo) then
      check.fail("lookup: x: expected rising numbers, but entry %d is not above the one before", i)
    end
  end
  return function(at)
    local e, sum = core.expression(at, nil, "lookup"), values[1]
    for i = 2, #points do -- the part of the way between two points that lies below
      local slope = (values[i] - values[i - 1]) / (points[i] - points[i - 1])
      sum = sum + slope * core.max(0, core.min(points[i] - points[i - 1], e - points[i - 1]))
    end
    return sum
  end
end

return network
