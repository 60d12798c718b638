# The page of `ambit view` in a headless browser (Debian: chromium); without one it fails, unless AMBIT_NO_BROWSER=1.
if(NOT AMBIT_ONCE)
  return()
endif()
add_test(NAME view.browser COMMAND ${LUA_PROGRAM} tests/view/browser.lua $<TARGET_FILE:ambit>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(view.browser PROPERTIES TIMEOUT 900 SKIP_RETURN_CODE 77
  ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/tests/plugins:${PROJECT_BINARY_DIR}/plugins")
