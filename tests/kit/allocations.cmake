# The counting malloc: always in the test that counts; in the kernel itself when AMBIT_COUNT_ALLOCATIONS is on, so that all tests and scenes run with it.
# A sanitizer's malloc cannot be replaced, so there both are left out.
if(AMBIT_COUNT_ALLOCATIONS AND AMBIT_SANITIZE)
  message(FATAL_ERROR "AMBIT_COUNT_ALLOCATIONS and AMBIT_SANITIZE both replace malloc: choose one")
endif()
if(AMBIT_COUNT_ALLOCATIONS)
  target_sources(ambit_objects PRIVATE ${PROJECT_SOURCE_DIR}/tests/kit/allocations.c)
  target_include_directories(ambit_objects PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(ambit_objects PRIVATE AMBIT_COUNT_ALLOCATIONS)
  target_compile_definitions(test.verbs.allocations PRIVATE AMBIT_COUNT_ALLOCATIONS)
elseif(TARGET test.verbs.allocations AND NOT AMBIT_SANITIZE)
  target_sources(test.verbs.allocations PRIVATE ${PROJECT_SOURCE_DIR}/tests/kit/allocations.c)
endif()
if(AMBIT_SANITIZE AND TARGET test.verbs.allocations)
  set_tests_properties(verbs.allocations PROPERTIES DISABLED TRUE)
  set_target_properties(test.verbs.allocations PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()
set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/kit/allocations.c PROPERTIES COMPILE_OPTIONS -fvisibility=default) # libc's own calls too
