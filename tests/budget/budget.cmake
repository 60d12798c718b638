# What the example scenes may need (tests/budget/budget.lua), counted; `budget` is the command that writes it anew.
find_program(LUA_PROGRAM NAMES lua5.4 lua REQUIRED)
set(budget_environment "AMBIT_PATH=${PROJECT_BINARY_DIR}/plugins" "AMBIT_BUDGET_MEMORY=$<IF:$<BOOL:${AMBIT_SANITIZE}>,0,1>")
add_test(NAME budget COMMAND ${LUA_PROGRAM} tests/budget/check.lua $<TARGET_FILE:ambit>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
add_test(NAME budget.notices COMMAND ${LUA_PROGRAM} tests/budget/notice.lua $<TARGET_FILE:ambit>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
# What nobody holds is freed, and nobody can tell when.
if(NOT AMBIT_SANITIZE) # sanitizers have a heap of their own
  add_test(NAME budget.memory COMMAND $<TARGET_FILE:ambit> run --quiet tests/budget/memory.lua
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(budget.memory PROPERTIES TIMEOUT 600 ENVIRONMENT "${budget_environment}")
endif()
add_test(NAME budget.collect COMMAND ${LUA_PROGRAM} tests/budget/collect.lua $<TARGET_FILE:ambit>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
add_test(NAME budget.place COMMAND ${LUA_PROGRAM} tests/budget/place.lua $<TARGET_FILE:ambit>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(budget budget.notices budget.collect budget.place PROPERTIES TIMEOUT 600 ENVIRONMENT "${budget_environment}")
add_custom_target(budget COMMAND ${CMAKE_COMMAND} -E env ${budget_environment}
  ${LUA_PROGRAM} tests/budget/check.lua $<TARGET_FILE:ambit> --rewrite WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
