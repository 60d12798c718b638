# The short cases of `ambit stability`: an outcome that changed fails. Checked builds are some five times slower.
add_test(NAME suite.quick COMMAND ambit stability --quick --budget 8)
set_tests_properties(suite.quick PROPERTIES TIMEOUT 900 COST 300
  ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/plugins;NO_COLOR=1")
