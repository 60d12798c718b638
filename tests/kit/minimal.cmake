# The arithmetics that the documentation shows, as a user would build them, and the tests that put arithmetics through the kit.
function(ambit_example_arithmetic name source directory)
  add_library(arithmetic_${name} MODULE ${PROJECT_SOURCE_DIR}/${source})
  set_target_properties(arithmetic_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} C_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${directory}/arithmetic)
  target_link_libraries(arithmetic_${name} PRIVATE ambit_flags m)
endfunction()
ambit_example_arithmetic(minimal tests/kit/minimal_arithmetic.c tests/plugins)
ambit_example_arithmetic(double_double tests/kit/double_double_arithmetic.c tests/plugins)
ambit_example_arithmetic(skeleton scripts/skeleton/arithmetic/skeleton.c tests/plugins)

# tests/plugins/test_arithmetic_<plugin>[_<topic>].c has the kit at hand, and its plugin is built before it runs
get_directory_property(targets BUILDSYSTEM_TARGETS)
foreach(target ${targets})
  if(target MATCHES "^test\\.plugins\\.arithmetic_(.*)$")
    target_link_libraries(${target} PRIVATE kit)
    set(plugin ${CMAKE_MATCH_1})
    while(plugin MATCHES "_" AND NOT TARGET arithmetic_${plugin})
      string(REGEX REPLACE "_[^_]*$" "" plugin ${plugin})
    endwhile()
    if(TARGET arithmetic_${plugin})
      add_dependencies(${target} arithmetic_${plugin})
    endif()
  endif()
endforeach()
add_dependencies(test.plugins.arithmetic_minimal arithmetic_double_double arithmetic_skeleton)
set_tests_properties(plugins.arithmetic_minimal plugins.arithmetic_double_double PROPERTIES
  ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/tests/plugins")
