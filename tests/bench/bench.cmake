# The programs of scripts/bench run: they print a table and end without an error. Their times are nobody's test.
function(ambit_bench name)
  add_test(NAME bench.${name} COMMAND ${CMAKE_COMMAND} -DCOMMAND=$<TARGET_FILE:ambit>
    -DPROGRAM=${PROJECT_SOURCE_DIR}/scripts/bench/${name}.lua "-DWORDS=${ARGN}" -P ${PROJECT_SOURCE_DIR}/cmake/check_bench.cmake)
  set_tests_properties(bench.${name} PROPERTIES TIMEOUT 300 ENVIRONMENT "AMBIT_PATH=${PROJECT_BINARY_DIR}/plugins;NO_COLOR=1")
endfunction()
ambit_bench(figures)
ambit_bench(loops)
ambit_bench(peers P2 P4 P6)
ambit_bench(questions)
ambit_bench(reduction reduce_double_pendulum)
ambit_bench(solvers P3 roots escape)
