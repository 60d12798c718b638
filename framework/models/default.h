/* default.h -- the plugins that the framework itself names: what is taken where a scene names none, and the elements
** that files of robots and reductions of mechanisms speak of. No other file of framework/ has a plugin's name in a
** text (test host.names). X(name, plugin): core.default.NAME in Lua; C has macros for those that it needs.
*/
#ifndef AMBIT_DEFAULT_H
#define AMBIT_DEFAULT_H

#define AMBIT_DEFAULT_RANGES "interval"
#define AMBIT_DEFAULT_DIGITS "mpfr"
#define AMBIT_DEFAULT_POINTS "real"
#define AMBIT_DEFAULT_ROOTS "krawczyk"
#define AMBIT_DEFAULT_DRAWS "gsl"
#define AMBIT_DEFAULT_STRATEGY "reduction"

#define AMBIT_DEFAULTS(X)                                                                                              \
  /* arithmetics */                                                                                                    \
  X(ranges, AMBIT_DEFAULT_RANGES)                                                                                      \
  X(linear, "affine")                                                                                                  \
  X(polynomials, "taylor_model")                                                                                       \
  X(digits, AMBIT_DEFAULT_DIGITS)                                                                                      \
  X(points, AMBIT_DEFAULT_POINTS)                                                                                      \
  /* solvers: of equations, of draws that prove nothing, of sets of many starts, of what ambit.reduce tries */         \
  X(roots, AMBIT_DEFAULT_ROOTS)                                                                                        \
  X(draws, AMBIT_DEFAULT_DRAWS)                                                                                        \
  X(sets, "zonotope")                                                                                                  \
  X(strategy, AMBIT_DEFAULT_STRATEGY)                                                                                  \
  /* elements */                                                                                                       \
  X(fixed, "weld")                                                                                                     \
  X(link, "rigid_link")                                                                                                \
  X(hinge, "revolute")                                                                                                 \
  X(slide, "prismatic")                                                                                                \
  X(screw, "screw")                                                                                                    \
  X(plane, "planar")                                                                                                   \
  X(ball, "spherical_quaternion")                                                                                      \
  X(floating, "free_quaternion")                                                                                       \
  X(body, "rigid_body")                                                                                                \
  X(point_mass, "point_mass")                                                                                          \
  X(rotor, "armature")                                                                                                 \
  X(damper, "joint_damper")                                                                                            \
  X(friction, "joint_friction")                                                                                        \
  X(spring, "joint_spring")                                                                                            \
  X(strut, "spring_damper")                                                                                            \
  X(bushing, "bushing")                                                                                                \
  X(force, "applied_force")                                                                                            \
  X(state, "state")

#endif
