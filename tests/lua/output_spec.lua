-- output_spec.lua -- files that commands write: whole, in place of the old one, which others go on reading.
local core = require "ambit.core"

local function read(file)
  local text = file:read "a"
  file:close()
  return text
end

local function lines(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  pipe:close()
  return text
end

describe("a file that a command writes", function()
  local folder = os.tmpname()
  os.remove(folder)
  os.execute("mkdir " .. folder)
  local name = folder .. "/report.json"

  it("takes the place of the old one, which is not written over", function()
    assert.is_nil(core.write_file(name, "first"))
    os.execute("chmod 640 " .. name)
    local old = assert(io.open(name))
    assert.is_nil(core.write_file(name, "second\0line"))
    assert.equal("first", read(old)) -- a reader that had it open
    assert.equal("second\0line", read(assert(io.open(name, "rb"))))
    assert.equal("640\n", lines("stat -c %a " .. name))
    assert.equal("report.json\n", lines("ls -A " .. folder))
  end)

  it("stays where a link leads", function()
    os.execute(("ln -s report.json %s/link"):format(folder))
    assert.is_nil(core.write_file(folder .. "/link", "third"))
    assert.equal("third", read(assert(io.open(name))))
    assert.equal("report.json\n", lines(("readlink %s/link"):format(folder)))
  end)

  it("is what it was if that fails", function()
    assert.equal(folder .. "/no/file: No such file or directory", core.write_file(folder .. "/no/file", "x"))
    assert.truthy(core.write_file("/dev/full", "x"):find("^/dev/full: No space left"))
    assert.equal("third", read(assert(io.open(name))))
    os.execute("rm -r " .. folder)
  end)
end)
