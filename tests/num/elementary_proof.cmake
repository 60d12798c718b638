# The error bounds of the elementary functions, re-proved from the code's tables (docs/numerics/elementary.md).
find_program(GAPPA gappa)
find_package(Python3 COMPONENTS Interpreter)
if(GAPPA AND Python3_FOUND)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import mpmath" RESULT_VARIABLE no_mpmath OUTPUT_QUIET ERROR_QUIET)
endif()
if(GAPPA AND Python3_FOUND AND NOT no_mpmath)
  add_test(NAME num.elementary_proof
    COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/proof/check.py ${PROJECT_SOURCE_DIR}/framework/kernel/num)
  set_tests_properties(num.elementary_proof PROPERTIES TIMEOUT 900)
else()
  message(STATUS "gappa or python3-mpmath not found: the proof of the elementary functions is not re-checked")
endif()
