# verify: the enclosures of the kernel or of an arithmetic plugin against MPFR, for as many checks as it is told
# (verify.c). ctest runs 10^7 of the kernel's and fewer of the interval plugin's.
add_executable(verify ${CMAKE_CURRENT_LIST_DIR}/verify.c)
set_target_properties(verify PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
target_include_directories(verify PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/tests/num)
find_package(Threads REQUIRED)
target_link_libraries(verify PRIVATE ambit_flags ambit_beside PkgConfig::MPFR Threads::Threads m ${CMAKE_DL_LIBS})
if(TARGET arithmetic_interval)
  add_dependencies(verify arithmetic_interval)
endif()
add_test(NAME num.verify COMMAND verify 1e7 1 -j 2)
add_test(NAME num.verify_interval COMMAND verify 1e6 2 interval -j 2)
set_tests_properties(num.verify num.verify_interval PROPERTIES
  TIMEOUT 900 ENVIRONMENT "${AMBIT_TEST_ENVIRONMENT}" PROCESSORS 2)
