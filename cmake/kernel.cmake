# libambit: the layers base, num, graph, host, mechanism, model; no Lua inside.
set(kernel_sources "")
foreach(layer base num graph host mechanism model)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/framework/${layer}/*.c)
  list(APPEND kernel_sources ${sources})
endforeach()
pkg_check_modules(YAJL REQUIRED IMPORTED_TARGET yajl)
add_library(libambit SHARED ${kernel_sources})
set_target_properties(libambit PROPERTIES OUTPUT_NAME ambit SOVERSION 0 VERSION ${PROJECT_VERSION})
target_include_directories(libambit PUBLIC
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/framework/abi> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/framework>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/ambit-kernel>)
set_target_properties(libambit PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${AMBIT_BUILD_LIBDIR})
target_link_libraries(libambit PRIVATE $<BUILD_INTERFACE:ambit_flags> PkgConfig::YAJL ${CMAKE_DL_LIBS} m)
include(cmake/elementary.cmake)
include(cmake/product.cmake)
