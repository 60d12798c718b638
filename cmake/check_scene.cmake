# cmake -DCOMMAND=ambit -DSCENE=file -DEXIT_CODE=n -DEXPECTED=regex -P check_scene.cmake
execute_process(COMMAND ${COMMAND} run --quiet ${SCENE} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE problems)
message("${output}${problems}")
if(NOT code EQUAL EXIT_CODE)
  message(FATAL_ERROR "exit code ${code} instead of ${EXIT_CODE}")
endif()
if(NOT output MATCHES "${EXPECTED}")
  message(FATAL_ERROR "the output does not match ${EXPECTED}")
endif()
