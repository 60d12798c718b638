# Tests of the stiff integrator load it and the interval arithmetic.
add_dependencies(test.plugins.solver_stiff_figures solver_stiff arithmetic_interval)
add_dependencies(test.plugins.solver_stiff_sets solver_stiff arithmetic_interval)
