# The smallest arithmetic plugin, as a user would build it, and the conformance kit that it is put through.
add_library(arithmetic_minimal MODULE ${PROJECT_SOURCE_DIR}/tests/kit/minimal_arithmetic.c)
set_target_properties(arithmetic_minimal PROPERTIES PREFIX "" OUTPUT_NAME minimal C_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/plugins/arithmetic)
target_link_libraries(arithmetic_minimal PRIVATE ambit_flags)

add_library(arithmetic_kit STATIC ${PROJECT_SOURCE_DIR}/tests/kit/arithmetic_kit.c
  ${PROJECT_SOURCE_DIR}/tests/kit/arithmetic_kit_tier_2.c)
target_include_directories(arithmetic_kit PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(arithmetic_kit PRIVATE ambit_flags PUBLIC libambit m)
foreach(name real interval minimal)
  target_link_libraries(test.plugins.arithmetic_${name} PRIVATE arithmetic_kit)
  add_dependencies(test.plugins.arithmetic_${name} arithmetic_${name})
endforeach()
add_dependencies(test.plugins.arithmetic_interval_jets arithmetic_interval)
set_tests_properties(plugins.arithmetic_minimal PROPERTIES ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/tests/plugins")
