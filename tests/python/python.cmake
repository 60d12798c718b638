# The Python package: python3 tests/python/test_ambit.py
find_program(PYTHON3 python3)
if(NOT (AMBIT_ONCE AND PYTHON3))
  return()
endif()
add_test(NAME python COMMAND ${PYTHON3} tests/python/test_ambit.py WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(python PROPERTIES TIMEOUT 300
  ENVIRONMENT "AMBIT_COMMAND=$<TARGET_FILE:ambit>;AMBIT_PATH=${PROJECT_BINARY_DIR}/plugins")
