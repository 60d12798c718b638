# The layering of the tree, and that the check finds what it is for (tests/host/layering is wrong on purpose).
add_test(NAME layering COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR} -P ${PROJECT_SOURCE_DIR}/tests/layering.cmake)
add_test(NAME layering.finds_faults
  COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}/tests/host/layering -P ${PROJECT_SOURCE_DIR}/tests/layering.cmake)
set_tests_properties(layering.finds_faults PROPERTIES PASS_REGULAR_EXPRESSION "7 lines break the layering")
