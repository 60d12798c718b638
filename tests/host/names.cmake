# No plugin's name in framework/, and that the check finds what it is for (tests/host/names is wrong on purpose).
add_test(NAME host.names COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR} -D PLUGINS=${PROJECT_SOURCE_DIR} -P ${PROJECT_SOURCE_DIR}/tests/names.cmake)
add_test(NAME host.names.finds_faults COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR}/tests/host/names -D PLUGINS=${PROJECT_SOURCE_DIR}
  -P ${PROJECT_SOURCE_DIR}/tests/names.cmake)
set_tests_properties(host.names.finds_faults PROPERTIES PASS_REGULAR_EXPRESSION "2 lines of framework/ name plugins")
