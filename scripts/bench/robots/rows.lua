-- rows.lua -- the table of robots.lua: scenes, the words that they get, and what is required of them.
-- over: width of a hull from which on the factor counts.
local function row(name, what, scene, words, t, over, factor, cpu, memory)
  return { kind = "tolerances", name = name, what = what, scene = scene, words = words, t = t, over = over,
    factor = factor, cpu = cpu, memory = memory }
end

-- A chain without uncertain data; its digits at the end, from tests/oracle/multibody_digits.c.
local function exact(n, t, damping, digits, reference)
  return { kind = "exact", name = "chain-" .. n,
    what = ("chain of %d links, exact%s"):format(n, damping and ", damped joints" or ""),
    scene = "chain", words = { tostring(n), t, "exact", damping }, t = tonumber(t), digits = digits, cpu = 10,
    reference = reference }
end

local UR5 = "UR5 with 2 kg, PD, everything within "

return {
  row("ur5-0.1", UR5 .. "0.1 %", "ur5", { "0.1%" }, 5, 1e-4, 1.05, 5),
  row("ur5-1", UR5 .. "1 %", "ur5", { "1%" }, 5, 1e-4, 1.2, 20),
  row("ur5-2", UR5 .. "2 %", "ur5", { "2%" }, 5, 1e-4, 1.5, 60),
  row("ur5-components", "... 1 %, each moment of inertia, centre, gain and friction by itself", "ur5",
    { "1%", "components" }, 5, 1e-4, 1.3, 60, 500),
  row("ur5-payload", "... payload 5 %, all else exact", "ur5", { "5%", "payload" }, 5, 1e-4, 1.05, 10),
  row("ur5-trajectory", "UR5, computed torque along a trajectory, masses 2 %", "ur5_trajectory", { "2%" }, 2, 1e-4,
    1.3, 10),
  row("arm7", "arm of 7 joints from a URDF, PD, 1 %", "arm7", { "1%" }, 5, 1e-4, 1.3),
  row("chain-3", "chain of 3 links, 1 %", "chain", { "3", "1", "1%" }, 1, 1e-6, 1.3),
  row("chain-5-1", "chain of 5 links, 1 %", "chain", { "5", "0.6", "1%" }, 0.6, 1e-6, 1.3),
  row("chain-5-0.1", "chain of 5 links, 0.1 %", "chain", { "5", "1", "0.1%" }, 1, 1e-6, 1.3),
  row("chain-10", "chain of 10 links, 0.1 %", "chain", { "10", "0.9", "0.1%" }, 0.9, 1e-6, 1.3),
  exact(20, "1", nil, 8, {
    q1 = "-1.0856778753269035104", ["q1'"] = "-0.69864659480300503029",
    q5 = "0.023270825695377309362", ["q5'"] = "0.62006164711895602271",
    q9 = "0.08523475213177738194", ["q9'"] = "-0.86922207981243767638",
    q13 = "0.28685143089143261686", ["q13'"] = "0.90106240872880272713",
    q17 = "0.0023883198605256454779", ["q17'"] = "0.081342163222119740521",
  }),
  exact(30, "1", nil, 8, {
    q1 = "-0.9518811192394106998", ["q1'"] = "-0.67056103375615394485",
    q8 = "0.049141127428030794403", ["q8'"] = "-0.31948183642638175617",
    q15 = "0.18892075613899086647", ["q15'"] = "0.76880543012980420207",
    q22 = "8.4249558573209674259e-06", ["q22'"] = "0.00039506676372763065352",
    q29 = "1.234054804319023e-15", ["q29'"] = "9.219555915629961e-14",
  }),
  exact(50, "5", "0.1", 10, {
    q1 = "-2.37802186037974048", ["q1'"] = "0.40126793774621647022",
    q13 = "0.03111386920039183549", ["q13'"] = "-0.1472520077618033391",
    q25 = "0.02795274047849369914", ["q25'"] = "0.022461891295386371118",
    q37 = "0.028449901196246997126", ["q37'"] = "0.013637888838743636034",
    q49 = "0.065164521111007121603", ["q49'"] = "0.084701744946437529424",
  }),
  row("four_bar", "four-bar, lengths and masses 0.1 %, 3 turns under drive", "four_bar", { "0.1%" }, 1.9, 1e-6, 1.3),
  row("slider_crank", "slider-crank, lengths and masses 0.1 %, 3 turns under drive", "slider_crank", { "0.1%" }, 1.9,
    1e-6, 1.3),
  row("andrews", "Andrews' squeezer, masses and moments of inertia 0.1 %", "../../andrews", { "0.03", "0.1%" }, 0.03, 1e-6,
    1.3),
  row("stewart", "Stewart platform on servo legs, radii and masses 0.1 %", "stewart", { "0.1%" }, 1, 1e-6, 1.3),
  { kind = "verify", name = "cart_pole", what = "cart-pole under LQR, stays within 5 degrees for 10 s",
    scene = "cart_pole", words = {}, cpu = 10 },
}
