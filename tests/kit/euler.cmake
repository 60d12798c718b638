# The smallest solver plugin, which docs/plugins.md shows, as a user would build it.
add_library(solver_euler MODULE ${PROJECT_SOURCE_DIR}/tests/kit/euler_solver.c)
set_target_properties(solver_euler PROPERTIES PREFIX "" OUTPUT_NAME euler C_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/plugins/solver)
target_link_libraries(solver_euler PRIVATE ambit_flags)
