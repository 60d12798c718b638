# The kernel, algebra, mechanics, models and verbs, compiled once (no Lua inside: *_lua.c is the bridge, cmake/command.cmake):
#   libambit        the C API for other programs, framework/api/ambit, and nothing else (test host.exported)
#   ambit_inside    everything, for what is built here: the command, the Lua module, the conformance kit, tests
set(framework ${PROJECT_SOURCE_DIR}/framework)
set(kernel_sources "")
foreach(room kernel functions algebra mechanics models verbs)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${framework}/${room}/*.c)
  list(APPEND kernel_sources ${sources})
endforeach()
list(FILTER kernel_sources EXCLUDE REGEX "_lua\\.c$|/host/place\\.c$")
pkg_check_modules(YAJL REQUIRED IMPORTED_TARGET yajl)
add_library(ambit_objects OBJECT ${kernel_sources})
target_include_directories(ambit_objects PUBLIC ${framework}/api ${framework}/kernel/abi ${framework}/kernel ${framework})
target_link_libraries(ambit_objects PRIVATE ambit_flags PkgConfig::YAJL)

# What it is linked into says where Ambit's own plugins are, seen from there.
function(ambit_from target folder)
  file(RELATIVE_PATH place /${folder} /${CMAKE_INSTALL_LIBDIR}/ambit)
  target_sources(${target} PRIVATE ${framework}/kernel/host/place.c)
  target_compile_definitions(${target} PRIVATE AMBIT_PLACE="${place}")
  target_include_directories(${target} PRIVATE $<TARGET_PROPERTY:ambit_objects,INTERFACE_INCLUDE_DIRECTORIES>)
endfunction()

add_library(libambit SHARED $<TARGET_OBJECTS:ambit_objects>)
ambit_from(libambit ${CMAKE_INSTALL_LIBDIR})
set_target_properties(libambit PROPERTIES OUTPUT_NAME ambit SOVERSION 0 VERSION ${PROJECT_VERSION}
  LIBRARY_OUTPUT_DIRECTORY ${AMBIT_BUILD_LIBDIR})
target_include_directories(libambit INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(libambit PRIVATE $<BUILD_INTERFACE:ambit_flags> PkgConfig::YAJL ${CMAKE_DL_LIBS} m)

add_library(ambit_inside STATIC $<TARGET_OBJECTS:ambit_objects>)
target_include_directories(ambit_inside PUBLIC ${framework}/api ${framework}/kernel/abi ${framework}/kernel ${framework})
target_link_libraries(ambit_inside PUBLIC PkgConfig::YAJL ${CMAKE_DL_LIBS} m)
set(keeper LINKER:--exclude-libs,ALL) # whoever has it keeps it to himself ...
if(AMBIT_COUNT_ALLOCATIONS) # ... but a program's own malloc must be that of its plugins
  set(keeper "$<$<NOT:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>>:${keeper}>")
endif()
target_link_options(ambit_inside INTERFACE ${keeper})

# Programs of the build tree in a folder beside lib: tests, benchmarks.
add_library(ambit_place_beside OBJECT)
ambit_from(ambit_place_beside bin)
add_library(ambit_beside INTERFACE)
target_sources(ambit_beside INTERFACE $<TARGET_OBJECTS:ambit_place_beside>)
target_link_libraries(ambit_beside INTERFACE ambit_inside)
include(cmake/elementary.cmake)
include(cmake/product.cmake)
