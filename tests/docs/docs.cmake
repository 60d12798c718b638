# Every example of README.md and docs/ runs; for the other compiler nothing new would be learnt.
if(NOT (AMBIT_ONCE OR AMBIT_SANITIZE))
  return()
endif()
file(GLOB_RECURSE pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md)
find_program(LUA_PROGRAM NAMES lua5.4 lua REQUIRED)
add_test(NAME docs.examples COMMAND ${LUA_PROGRAM} tests/docs/examples.lua $<TARGET_FILE:ambit> README.md ${pages}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
add_test(NAME docs.codes COMMAND ${LUA_PROGRAM} tests/docs/codes.lua $<TARGET_FILE:ambit>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
add_test(NAME docs.interface COMMAND ${LUA_PROGRAM} tests/docs/interface.lua $<TARGET_FILE:ambit> ${pages}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
add_test(NAME docs.architecture COMMAND ${LUA_PROGRAM} tests/docs/architecture.lua WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(docs.examples PROPERTIES TIMEOUT 900
  ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/tests/plugins:${PROJECT_BINARY_DIR}/plugins")
