# host.exported: what libambit exports is the C API (framework/api/ambit), listed in exported.txt; the module and the kit export their entries.
add_test(NAME host.exported COMMAND ${CMAKE_COMMAND} -D LIBRARY=$<TARGET_FILE:libambit> -D LIST=${CMAKE_CURRENT_LIST_DIR}/exported.txt
  -D MODULE=$<TARGET_FILE:ambit_module> -D KIT=$<TARGET_FILE:service_conformance_kit> -P ${PROJECT_SOURCE_DIR}/cmake/check_exported.cmake)
