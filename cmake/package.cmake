# Packages: cpack -G DEB makes ambit (the command, plugins, library, module, manual page), libambit-dev (headers, find_package, pkg-config) and
# ambit-gsl (solver/gsl, which links the GPL library GSL); cpack -G TGZ one archive that runs wherever it is unpacked.
set(made ${PROJECT_BINARY_DIR}/package)
find_program(GZIP gzip)
set(AMBIT_CONTACT "the authors of Ambit <ambit@localhost>" CACHE STRING "who made the packages, with an address")

# What the command says about itself -> manual page and completions.
add_custom_command(OUTPUT ${made}/ambit.1.gz ${made}/ambit.bash ${made}/_ambit ${made}/changelog.gz
  COMMAND ${CMAKE_COMMAND} -DAMBIT=$<TARGET_FILE:ambit> -DTREE=${PROJECT_SOURCE_DIR} -DMADE=${made} -DGZIP=${GZIP}
    -DVERSION=${PROJECT_VERSION}-1 "-DCONTACT=${AMBIT_CONTACT}" -P ${PROJECT_SOURCE_DIR}/cmake/make_package_files.cmake
  DEPENDS ambit ${PROJECT_SOURCE_DIR}/scripts/package/help.lua ${PROJECT_SOURCE_DIR}/scripts/package/man.lua
    ${PROJECT_SOURCE_DIR}/scripts/package/completion.lua ${PROJECT_SOURCE_DIR}/cmake/make_package_files.cmake
  VERBATIM)
if(GZIP AND NOT CMAKE_CROSSCOMPILING)
  add_custom_target(package_files ALL DEPENDS ${made}/ambit.1.gz)
endif()

install(FILES ${made}/ambit.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ambit OPTIONAL)
install(FILES ${made}/ambit.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ambit RENAME ambit OPTIONAL)
install(FILES ${made}/_ambit DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT ambit OPTIONAL)
foreach(package ambit libambit-dev ambit-gsl)
  install(FILES ${made}/copyright ${made}/changelog.gz ${made}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
    COMPONENT ${package} OPTIONAL)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/lintian/${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${package})
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ambit COMPONENT ambit)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ambit COMPONENT ambit
  FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN picture EXCLUDE)

set(CPACK_PACKAGE_NAME ambit)
set(CPACK_PACKAGE_VENDOR "the authors of Ambit")
set(CPACK_PACKAGE_CONTACT "${AMBIT_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "guaranteed simulation of mechanical systems")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL ambit libambit-dev)
if(AMBIT_GPL_PLUGINS)
  list(APPEND CPACK_COMPONENTS_ALL ambit-gsl)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(long_text "A machine and its tolerances are described in a Lua script; Ambit
returns sets that are proved to contain every behaviour that the
tolerances allow, or says why it could not prove one.")
set(CPACK_COMPONENT_AMBIT_DESCRIPTION "${long_text}")
set(CPACK_DEBIAN_AMBIT_PACKAGE_NAME ambit)
set(CPACK_DEBIAN_AMBIT_PACKAGE_RECOMMENDS "lua-expat")
set(CPACK_DEBIAN_AMBIT_PACKAGE_SUGGESTS "ambit-gsl, graphviz, librsvg2-bin, lua-busted")
set(CPACK_DEBIAN_AMBIT_PACKAGE_CONTROL_EXTRA ${made}/triggers)
set(CPACK_COMPONENT_LIBAMBIT-DEV_DESCRIPTION "headers for programs that link Ambit and for its plugins
${long_text}")
set(CPACK_DEBIAN_LIBAMBIT-DEV_PACKAGE_NAME libambit-dev)
set(CPACK_DEBIAN_LIBAMBIT-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBAMBIT-DEV_PACKAGE_DEPENDS "ambit (= ${PROJECT_VERSION}-1)")
set(CPACK_COMPONENT_AMBIT-GSL_DESCRIPTION "solver gsl of Ambit, which links the GNU Scientific Library
${long_text}
.
The solver gsl follows motions by the GNU Scientific Library and proves
nothing. It is under the terms of the GPL.")
set(CPACK_DEBIAN_AMBIT-GSL_PACKAGE_NAME ambit-gsl)
set(CPACK_DEBIAN_AMBIT-GSL_PACKAGE_DEPENDS "ambit (= ${PROJECT_VERSION}-1)")
include(CPack)
foreach(package ambit libambit-dev ambit-gsl)
  cpack_add_component(${package})
endforeach()
