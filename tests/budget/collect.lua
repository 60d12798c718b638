-- collect.lua AMBIT -- no result depends on when nodes are freed: the records of scenes are the same, byte for byte but
-- for times of computing, when everything that nothing holds is freed at every chance; and specs pass.
local ambit = arg[1]
local scenes = { "double_pendulum", "manipulator", "n_link_chain", "four_bar", "leg", "bouncing_ball", "bricard",
  "inverse_kinematics", "ur5", "verify_arm", "slider_crank_loop" }

local function records(scene, environment)
  local command = ("%s '%s' run --quiet --json - scripts/%s.lua 2>/dev/null"):format(environment, ambit, scene)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  local good = pipe:close()
  return good and text:gsub('"[a-z_]*seconds[a-z_]*":[-+0-9.e]+', "")
end

local bad = 0
for _, scene in ipairs(scenes) do
  local plain, forced = records(scene, ""), records(scene, "AMBIT_COLLECT_ALWAYS=1")
  if not plain or not forced or #plain < 100 or plain ~= forced then
    bad = bad + 1
    print(scene .. ": the records differ")
  end
end

-- Where every node would be too much: collected once so many have been made.
for _, spec in ipairs { "implicit", "state", "hybrid" } do
  local command = ("AMBIT_COLLECT_ALWAYS=1000 '%s' test tests/lua/%s_spec.lua >/dev/null 2>&1"):format(ambit, spec)
  if not os.execute(command) then
    bad = bad + 1
    print(spec .. "_spec fails")
  end
end
os.exit(bad == 0 and 0 or 1)
