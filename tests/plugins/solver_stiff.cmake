# Tests of the stiff integrator load it and the interval arithmetic.
add_dependencies(test.plugins.solver_stiff_figures solver_stiff arithmetic_interval)
add_dependencies(test.plugins.solver_stiff_sets solver_stiff arithmetic_interval)

# This test looks into three of its files, and has the others.
file(GLOB stiff_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/solver/stiff/*.c ${PROJECT_SOURCE_DIR}/plugins/shared/*.c)
list(FILTER stiff_sources EXCLUDE REGEX "/(plugin|prove|series|step)\\.c$")
target_sources(test.plugins.solver_stiff_margins PRIVATE ${stiff_sources})
