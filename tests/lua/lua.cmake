# The Lua side: the specs under stock busted (the module ambit.so) and under `ambit test`; the scenes.
add_library(test_callbacks MODULE ${CMAKE_CURRENT_LIST_DIR}/plugins/callbacks.c)
target_link_libraries(test_callbacks PRIVATE ambit_flags)
set_target_properties(test_callbacks PROPERTIES PREFIX "" OUTPUT_NAME callbacks
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/lua/plugins/service)

add_library(test_faulty MODULE ${CMAKE_CURRENT_LIST_DIR}/plugins/faulty.c)
target_link_libraries(test_faulty PRIVATE ambit_flags)
set_target_properties(test_faulty PROPERTIES PREFIX "" OUTPUT_NAME faulty C_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/lua/plugins/solver)

add_library(test_hostile MODULE ${CMAKE_CURRENT_LIST_DIR}/environment/hostile.c)
target_include_directories(test_hostile PRIVATE ${LUA_INCLUDE_DIRS})
target_link_libraries(test_hostile PRIVATE ambit_flags)
set_target_properties(test_hostile PROPERTIES PREFIX "" OUTPUT_NAME hostile LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/lua)

# Motions of random mechanisms, integrated by formulas of their own: tests/oracle/multibody.h
add_library(test_multibody MODULE ${PROJECT_SOURCE_DIR}/tests/oracle/multibody.c ${PROJECT_SOURCE_DIR}/tests/oracle/multibody_flow.c ${PROJECT_SOURCE_DIR}/tests/oracle/multibody_lua.c)
target_include_directories(test_multibody PRIVATE ${LUA_INCLUDE_DIRS})
target_link_libraries(test_multibody PRIVATE ambit_flags)
set_target_properties(test_multibody PROPERTIES PREFIX "" OUTPUT_NAME multibody C_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/lua)

# Solutions of random equations, likewise
add_library(test_equations MODULE ${PROJECT_SOURCE_DIR}/tests/oracle/equations_lua.c)
target_include_directories(test_equations PRIVATE ${LUA_INCLUDE_DIRS})
target_link_libraries(test_equations PRIVATE ambit_flags)
set_target_properties(test_equations PROPERTIES PREFIX "" OUTPUT_NAME equations C_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/lua)

set(lua_environment "AMBIT_PATH=${PROJECT_BINARY_DIR}/tests/lua/plugins:${PROJECT_BINARY_DIR}/tests/plugins:${PROJECT_BINARY_DIR}/plugins"
  "LUA_CPATH=${PROJECT_BINARY_DIR}/${AMBIT_LUA_DIR}/?.so\\;${PROJECT_BINARY_DIR}/tests/lua/?.so\\;\\;" "AMBIT_COMMAND=$<TARGET_FILE:ambit>" "NO_COLOR=1")

pkg_check_modules(GMP REQUIRED IMPORTED_TARGET gmp)
target_link_libraries(test.lua.data_ranges PRIVATE PkgConfig::LUA PkgConfig::GMP)
add_dependencies(test.lua.data_ranges ambit_module)

# Two halves, so that two processors share them.
file(GLOB specs CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*_spec.lua)
set(half 1)
foreach(spec ${specs})
  list(APPEND specs_${half} ${spec})
  math(EXPR half "3 - ${half}")
endforeach()
foreach(half 1 2)
  add_test(NAME lua.specs.command_${half} COMMAND ambit test ${specs_${half}} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(lua.specs.command_${half} PROPERTIES TIMEOUT 900 COST 1000 ENVIRONMENT "${lua_environment}") # the longest first
endforeach()

# `ambit test` has run the same specs: once more under the stock interpreter
find_program(BUSTED busted)
if(BUSTED AND AMBIT_ONCE)
  foreach(half 1 2)
    add_test(NAME lua.specs.busted_${half} COMMAND ${BUSTED} --pattern=_spec%.lua$ ${specs_${half}} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(lua.specs.busted_${half} PROPERTIES TIMEOUT 900 COST 900 ENVIRONMENT "${lua_environment}")
  endforeach()
endif()

# A scene must end with this exit code and say this.
function(ambit_scene name exit_code expected)
  add_test(NAME scene.${name} COMMAND ${CMAKE_COMMAND} -DCOMMAND=$<TARGET_FILE:ambit>
    -DSCENE=${PROJECT_SOURCE_DIR}/scripts/${name}.lua
    -DEXIT_CODE=${exit_code} "-DEXPECTED=${expected}" -P ${PROJECT_SOURCE_DIR}/cmake/check_scene.cmake)
  set_tests_properties(scene.${name} PROPERTIES TIMEOUT 300 ENVIRONMENT "${lua_environment}")
endfunction()
ambit_scene(manipulator 0 "interval +.17\\.0[0-9., ]+17\\.1[0-9. ]+[^\n]+ 0\\.[123][0-9]* +0\\.2[0-9]*\n")
ambit_scene(manipulator_mobile 0 "width 1\\.047 m\n.*width 1\\.041 m\n")
ambit_scene(double_pendulum 0 "\n3\\.0 .*complete at t = 3 .*unstable.*stable\n$")
ambit_scene(simple_pendulum 0 "\n100 .*complete at t = 100 ")
ambit_scene(inverse_kinematics 0 "8 postures, 0 undecided\n.*8 postures, 0 undecided\n")
ambit_scene(lorenz 0 "\n20 .*complete at t = 20 ")
ambit_scene(van_der_pol 0 "complete at t = 20 .*complete at t = 7 ")
ambit_scene(leg 0 "1 posture of rest\n.*knee +.-9[0-9.]+, -9[0-9.]+.\n")
ambit_scene(expressions 0 "interval +\\[0, 1\\].*affine +\\[0, 0\\.25[^\n]*\n.*mpfr +\\[-0\\.82739605994682142, -0\\.8273960599468213\\]")
ambit_scene(four_bar 0 "\n90 +.30\\.7[0-9., ]+30\\.89[^\n]+ 1[34][0-9] x 11[0-9] +[0-9.]+e-1[12]\n")
ambit_scene(slider_crank 0 "\n0\\.060 .*complete at t = 0\\.06 ")
ambit_scene(n_link_chain 0 "hinge 1 starts to turn with -39\\.24 .*complete at t = 0\\.1 ")
ambit_scene(andrews 0 "assembly: unique, no wider than [1-9].[0-9]e-15 .*\n0\\.010 +.2\\.1601131315[0-9., ]+2\\.1601131315.*complete at t = 0\\.01 ")
ambit_scene(n_four_bar 0 "complete at t = 1 .*flat: singular\n.*-1\\.76707447631020[0-9., -]+-1\\.767074476310[0-9., ]+. +gap of the loops up to 0 m")
ambit_scene(bricard 0 "follows from the others: ring\\.[1-5]\n.*1\\.95808383233532[0-9., ]+1\\.958083832335.*complete at t = 1 ")
ambit_scene(slider_crank_loop 0 "rank over a turn: proved\n.*complete at t = 0\\.6 ")
ambit_scene(stewart 0 "rank in the workspace: proved\n.*complete at t = 0\\.2 ")
ambit_scene(ur5 0 "taylor_model is at most [0-4]\\.[0-9] %")
ambit_scene(bouncing_ball 0 "bounce in t = .*complete at t = 2 after 3 switches")
ambit_scene(verify_arm 0 "tight_wall: refuted.*g in .0\\.00[0-9]+, 0\\.00.*torque_above: proved.*wall: proved.*goal: proved")
ambit_scene(reduce_arm 0 "2 of 4 states are left")

# Planted zeros of events. `ambit run tests/lua/event_zeros.lua 2000` is its full length; some of its runs are unable.
add_test(NAME lua.event_zeros COMMAND ambit run --quiet tests/lua/event_zeros.lua 160 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(lua.event_zeros PROPERTIES TIMEOUT 600 ENVIRONMENT "${lua_environment}"
  PASS_REGULAR_EXPRESSION "160 systems, [0-9]+ zeros: [^\n]* 0 lost\n")

# Linear systems in any units. `ambit run tests/lua/linear_systems.lua 1000` is its full length: number 461 is 1.11 of
# the truth there.
add_test(NAME lua.linear_systems COMMAND ambit run --quiet tests/lua/linear_systems.lua 200
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(lua.linear_systems PROPERTIES TIMEOUT 600 ENVIRONMENT "${lua_environment}"
  PASS_REGULAR_EXPRESSION "200 linear systems, 0 failed\n")

# Nonlinear systems in any units. `ambit run tests/lua/units_of_systems.lua 300` is its full length.
add_test(NAME lua.units_of_systems COMMAND ambit run --quiet tests/lua/units_of_systems.lua 12
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(lua.units_of_systems PROPERTIES TIMEOUT 600 ENVIRONMENT "${lua_environment}"
  PASS_REGULAR_EXPRESSION "default: 0 of 12 depend[^\n]*\nlohner: 0 of 12[^\n]*\ntaylor_model: 0 of 12[^\n]*\nzonotope: 0 of 12[^\n]*\nstiff: 0 of 12[^\n]*\nvalencia: 0 of 12")

# Springs and dampers of any stiffness for stiff. `ambit run tests/lua/springs_and_dampers.lua 200` is its full length.
add_test(NAME lua.springs_and_dampers COMMAND ambit run --quiet tests/lua/springs_and_dampers.lua 30
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(lua.springs_and_dampers PROPERTIES TIMEOUT 600 ENVIRONMENT "${lua_environment}"
  PASS_REGULAR_EXPRESSION "30 springs and dampers, 0 failed\n")

# Motions of random mechanisms. Full length: `ambit run tests/lua/random_mechanisms.lua --mechanisms 200 --draws 500`.
function(ambit_random_mechanisms name expected)
  add_test(NAME lua.random_mechanisms.${name} COMMAND ambit run --quiet tests/lua/random_mechanisms.lua --joints 4 --data 6
    --time 0.1 --draws 6 --seconds 1000 ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(lua.random_mechanisms.${name} PROPERTIES TIMEOUT 600 ENVIRONMENT "${lua_environment}"
    PASS_REGULAR_EXPRESSION "${expected}")
endfunction()
ambit_random_mechanisms(zonotope "24 mechanisms, 24 complete, [^\n]* 0 outside\n" --mechanisms 24 --solver zonotope)
ambit_random_mechanisms(lohner "6 mechanisms, [1-9][0-9]* complete, [^\n]* 0 outside\n" --mechanisms 6 --solver lohner)
ambit_random_mechanisms(taylor_model "2 mechanisms, 2 complete, [^\n]* 0 outside\n" --mechanisms 2 --data 5
  --joints 3 --solver taylor_model)
ambit_random_mechanisms(suited "6 mechanisms, [1-9][0-9]* complete, [^\n]* 0 outside\n" --mechanisms 6)
ambit_random_mechanisms(beyond "motions, [0-9]+ values: [1-9][0-9]* outside\n" --mechanisms 6 --solver lohner --beyond 2)

# Does any solution of random equations leave what was proved? At length: --systems 2000 --draws 50
add_test(NAME lua.random_equations COMMAND ambit run ${CMAKE_CURRENT_LIST_DIR}/random_equations.lua --systems 60 --draws 6)
set_tests_properties(lua.random_equations PROPERTIES TIMEOUT 300 ENVIRONMENT "${lua_environment}")
add_test(NAME lua.random_equations.kinks COMMAND ambit run ${CMAKE_CURRENT_LIST_DIR}/random_equations.lua --kinks --systems 30 --draws 6)
set_tests_properties(lua.random_equations.kinks PROPERTIES TIMEOUT 300 ENVIRONMENT "${lua_environment}")
