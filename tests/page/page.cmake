# The pages of `ambit compare` and `ambit stability` in a headless browser; without one as tests/view.
if(NOT AMBIT_ONCE)
  return()
endif()
add_test(NAME page.browser COMMAND ${LUA_PROGRAM} tests/page/browser.lua $<TARGET_FILE:ambit>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(page.browser PROPERTIES TIMEOUT 900 SKIP_RETURN_CODE 77
  ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/tests/plugins:${PROJECT_BINARY_DIR}/plugins")
