# The conformance kits of tests/kit, compiled once: for tests, and behind `ambit check` as service/conformance_kit.so, a host program in the
# shape of a plugin, which has a kernel of its own.
find_package(Threads REQUIRED)
pkg_check_modules(MPFR REQUIRED IMPORTED_TARGET mpfr)
file(GLOB kit_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/kit/*_kit*.c ${PROJECT_SOURCE_DIR}/tests/kit/conduct*.c
  ${PROJECT_SOURCE_DIR}/tests/kit/conformance*.c ${PROJECT_SOURCE_DIR}/tests/kit/element_stage.c)
list(FILTER kit_sources EXCLUDE REGEX "/conformance_plugin\\.c$")
add_library(kit STATIC ${kit_sources})
target_include_directories(kit PUBLIC ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(kit PRIVATE ambit_flags PUBLIC ambit_inside PkgConfig::MPFR Threads::Threads m)
ambit_plugin(service conformance_kit ${PROJECT_SOURCE_DIR}/tests/kit/conformance_plugin.c)
target_link_libraries(service_conformance_kit PRIVATE kit)
# What its kernel keeps for the life of the process (folders that are trusted) stays reachable when the plugin is closed.
target_link_options(service_conformance_kit PRIVATE LINKER:-z,nodelete)
ambit_from(service_conformance_kit ${CMAKE_INSTALL_LIBDIR}/ambit/service)
