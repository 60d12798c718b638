-- help_spec.lua -- whatever the module offers has a help text.
local ambit = require "ambit"

describe("help", function()
  it("knows every name of the interface", function()
    for name in pairs(ambit) do
      local good, text = pcall(ambit.help, name)
      assert.is_true(good, name)
      assert.matches("^ambit%.", text)
    end
  end)

  it("knows every solver, by the options that it declares", function()
    for _, entry in ipairs(ambit.plugins "solver") do
      local text = ambit.help(entry.name)
      for _, option in ipairs(ambit.plugin("solver", entry.name).parameters) do
        assert.is_truthy(text:find("\n  " .. option.name, 1, true), entry.name .. ": " .. option.name)
      end
    end
  end)
end)
