# libambit: the kernel, algebra, mechanics, models and verbs; no Lua inside: *_lua.c is the bridge (cmake/command.cmake).
set(framework ${PROJECT_SOURCE_DIR}/framework)
set(kernel_sources "")
foreach(room kernel algebra mechanics models verbs)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${framework}/${room}/*.c)
  list(APPEND kernel_sources ${sources})
endforeach()
list(FILTER kernel_sources EXCLUDE REGEX "_lua\\.c$")
pkg_check_modules(YAJL REQUIRED IMPORTED_TARGET yajl)
add_library(libambit SHARED ${kernel_sources})
set_target_properties(libambit PROPERTIES OUTPUT_NAME ambit SOVERSION 0 VERSION ${PROJECT_VERSION})
target_include_directories(libambit PUBLIC
  $<BUILD_INTERFACE:${framework}/kernel/abi> $<BUILD_INTERFACE:${framework}/kernel> $<BUILD_INTERFACE:${framework}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/ambit-kernel>)
set_target_properties(libambit PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${AMBIT_BUILD_LIBDIR})
target_link_libraries(libambit PRIVATE $<BUILD_INTERFACE:ambit_flags> PkgConfig::YAJL ${CMAKE_DL_LIBS} m)
include(cmake/elementary.cmake)
include(cmake/product.cmake)
