# The work of a dozen small problems, counted (tests/work/counts.lua); `work` is the command that writes the file anew.
set(work_environment "AMBIT_PATH=${PROJECT_BINARY_DIR}/plugins")
add_test(NAME work COMMAND ambit run --quiet tests/work/check.lua WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
add_test(NAME work.notices COMMAND ambit run --quiet tests/work/notice.lua WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(work work.notices PROPERTIES TIMEOUT 600 ENVIRONMENT "${work_environment}")
add_custom_target(work COMMAND ${CMAKE_COMMAND} -E env ${work_environment}
  $<TARGET_FILE:ambit> run --quiet tests/work/check.lua rewrite WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
