# The tests of reductions: one plugin lies about what was proved.
add_library(test_reduction_liar MODULE ${CMAKE_CURRENT_LIST_DIR}/reduction_liar.c)
set_target_properties(test_reduction_liar PROPERTIES PREFIX "" OUTPUT_NAME liar C_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/reduction/solver)
target_link_libraries(test_reduction_liar PRIVATE ambit_flags)
target_compile_definitions(test.plugins.solver_reduction_edges PRIVATE
  REDUCTION_LIAR="$<TARGET_FILE:test_reduction_liar>")
foreach(name solver_reduction solver_reduction_rankings solver_reduction_ladder)
  add_dependencies(test.plugins.${name} solver_reduction arithmetic_real)
endforeach()
add_dependencies(test.plugins.solver_reduction_edges test_reduction_liar solver_reduction solver_krawczyk solver_lohner
  arithmetic_real)
