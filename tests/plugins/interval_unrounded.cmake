# The interval plugin on a machine that does not round as told (unrounded.h): its self-test must refuse to open.
file(GLOB unrounded_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/arithmetic/interval/*.c)
add_library(test_interval_unrounded MODULE ${unrounded_sources})
target_include_directories(test_interval_unrounded PRIVATE ${PROJECT_SOURCE_DIR}/plugins)
target_compile_options(test_interval_unrounded PRIVATE -include ${PROJECT_SOURCE_DIR}/tests/plugins/unrounded.h)
target_link_libraries(test_interval_unrounded PRIVATE ambit_flags m)
set_target_properties(test_interval_unrounded PROPERTIES PREFIX "" OUTPUT_NAME interval C_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/unrounded/arithmetic)
target_compile_definitions(test.plugins.arithmetic_interval_selftest PRIVATE UNROUNDED_PATH="${PROJECT_BINARY_DIR}/tests/unrounded")
add_dependencies(test.plugins.arithmetic_interval_selftest test_interval_unrounded)
