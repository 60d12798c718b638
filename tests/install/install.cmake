find_program(LUA_INTERPRETER NAMES lua5.4 lua54 lua)
set(install_flags "")
set(install_lua ${LUA_INTERPRETER})
if(AMBIT_SANITIZE) # a stock interpreter cannot load a sanitized module without help
  set(install_flags "-fsanitize=address,undefined")
  set(install_lua "")
endif()
add_test(NAME install COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR}
  -DSOURCE=${PROJECT_SOURCE_DIR}/tests/install -DTREE=${PROJECT_SOURCE_DIR}
  -DWORK=${PROJECT_BINARY_DIR}/tests/install -DC_COMPILER=${CMAKE_C_COMPILER} "-DC_FLAGS=${install_flags}" -DLUA=${install_lua}
  -P ${PROJECT_SOURCE_DIR}/cmake/check_install.cmake)
set_tests_properties(install PROPERTIES TIMEOUT 120)

find_program(DPKG_SHLIBDEPS dpkg-shlibdeps)
find_program(LINTIAN lintian)
if(AMBIT_ONCE AND GZIP AND DPKG_SHLIBDEPS)
  add_test(NAME package COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DWORK=${PROJECT_BINARY_DIR}/tests/package
    -DCPACK=${CMAKE_CPACK_COMMAND} "-DLINTIAN=$<$<BOOL:${LINTIAN}>:${LINTIAN}>" -P ${PROJECT_SOURCE_DIR}/cmake/check_package.cmake)
  set_tests_properties(package PROPERTIES TIMEOUT 300)
endif()
