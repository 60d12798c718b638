-- write.lua -- ambit run tests/page/write.lua PAGE FILE SAMPLE...: a page of sample data.
package.path = "tests/page/?.lua;" .. package.path
local samples = require "samples"
local kind, name = arg[1], arg[2]
local text
if kind == "compare" then
  local list = {}
  for i = 3, #arg do list[#list + 1] = samples[arg[i]]() end
  text = require("ambit.page.compare").of(list, "<b>a scene</b>.lua")
elseif kind == "plot" then
  text = samples[arg[3]]():text "html"
else
  text = require("ambit.page.stability").of(samples[arg[3]](tonumber(arg[4]), tonumber(arg[5])))
end
local file = assert(io.open(name, "wb"))
file:write(text)
file:close()
