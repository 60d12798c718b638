# The short cases of `ambit stability`: an outcome that changed fails. Checked builds are some five times slower. The build that counts
# allocations leaves out what allocates in libraries of others while it runs: MPFR, and the implicit methods of GSL.
set(suite_words --quick --budget 8)
if(AMBIT_COUNT_ALLOCATIONS)
  foreach(solver lohner stiff taylor_model)
    add_test(NAME suite.quick_${solver} COMMAND ambit stability ${suite_words} --solver ${solver})
    list(APPEND suite_tests suite.quick_${solver})
  endforeach()
else()
  add_test(NAME suite.quick COMMAND ambit stability ${suite_words})
  set(suite_tests suite.quick)
endif()
set_tests_properties(${suite_tests} PROPERTIES TIMEOUT 900 COST 300
  ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/plugins;NO_COLOR=1")
