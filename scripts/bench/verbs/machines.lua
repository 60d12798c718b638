-- verbs/machines.lua -- the machines that verbs.lua asks about: scenes of scripts/bench/robots, their words, and over
-- what time. joint: the state that questions are about; mass: part of the name of a mass; light: what may be left out,
-- if it is not the last part.
local function machine(name, what, scene, words, t, joint, mass, light)
  return { name = name, what = what, scene = scene, words = words, t = t, joint = joint, mass = mass, light = light }
end

return {
  machine("tree", "tree of 12 joints, 24 data of 1 %", "tree", { "1%" }, "0.1", "waist", "head.mass"),
  machine("ur5", "UR5, PD, 27 data of 1 %", "ur5", { "1%" }, "0.2", "elbow_joint", "forearm_link.mass"),
  machine("arm7", "arm of 7 joints, PD, 34 data of 0.1 %", "arm7", { "0.1%" }, "0.1", "joint4", "link5.mass"),
  machine("chain", "chain of 10 links, 20 data of 0.1 %", "chain", { "10", "1", "0.1%" }, "0.3", "q2", "mass5",
    "point_mass10: weight"),
  machine("four_bar", "four-bar under drive, 7 data of 0.1 %", "four_bar", { "0.1%" }, "0.2", "crank", "mass"),
}
