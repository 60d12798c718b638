# Plugins with one fault each, and the program that puts them through the conformance kit. It runs in the release build only: what it finds
# depends on neither compiler nor sanitizer, and takes a minute.
set(mutant_words "")
foreach(kind arithmetic element flow roots reduction service)
  add_library(mutant_${kind} MODULE ${PROJECT_SOURCE_DIR}/tests/kit/mutants/${kind}_mutant.c)
  set_target_properties(mutant_${kind} PROPERTIES PREFIX "" OUTPUT_NAME ${kind}_mutant C_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests/mutants)
  target_include_directories(mutant_${kind} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(mutant_${kind} PRIVATE ambit_flags m ${CMAKE_DL_LIBS})
  set(folder ${kind})
  if(kind MATCHES "flow|roots|reduction")
    set(folder solver)
  endif()
  list(APPEND mutant_words ${kind}=$<TARGET_FILE:mutant_${kind}>=${PROJECT_BINARY_DIR}/plugins/${folder})
endforeach()
add_executable(run_mutants ${PROJECT_SOURCE_DIR}/tests/kit/mutants/run_mutants.c)
set_target_properties(run_mutants PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
target_include_directories(run_mutants PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(run_mutants PRIVATE ambit_flags ambit_beside ${CMAKE_DL_LIBS})
add_dependencies(run_mutants service_conformance_kit)
# The program with its words, for the test and for `./dev bench`.
string(REPLACE ";" " " mutant_text "${mutant_words}")
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/tests/kit_mutants
  CONTENT "#!/bin/sh\nexec $<TARGET_FILE:run_mutants> $<TARGET_FILE:service_conformance_kit> ${mutant_text} \"$@\"\n"
  FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
if(AMBIT_ONCE)
  add_test(NAME kit.mutants COMMAND ${PROJECT_BINARY_DIR}/tests/kit_mutants)
  set_tests_properties(kit.mutants PROPERTIES TIMEOUT 900 ENVIRONMENT "${AMBIT_TEST_ENVIRONMENT}")
endif()
