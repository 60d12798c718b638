# The command `ambit` and the Lua module lua/ambit.so: the same files of framework/lua and the same embedded scripts.
# The module leaves Lua's own symbols to the interpreter that loads it; the command brings liblua along.
pkg_search_module(LUA REQUIRED IMPORTED_TARGET lua5.4 lua-5.4 lua54)
pkg_check_modules(FFI REQUIRED IMPORTED_TARGET libffi)

set(embedded "")
set(embedded_paths "")
# scripts/prelude/reduce/pass.lua -> ambit.reduce.pass, scripts/command/run.lua -> ambit.command.run
# What every scene reads comes first, side by side: a process maps the pages that it reads and their neighbours.
set(first_prelude init.lua check.lua code.lua provenance.lua session.lua)
set(first_command main.lua run.lua scene.lua)
foreach(folder command prelude)
  set(from ${PROJECT_SOURCE_DIR}/scripts/${folder})
  file(GLOB_RECURSE scripts CONFIGURE_DEPENDS RELATIVE ${from} ${from}/*.lua)
  list(REMOVE_ITEM scripts ${first_${folder}})
  list(PREPEND scripts ${first_${folder}})
  foreach(script ${scripts})
    string(REGEX REPLACE "\\.lua$" "" name ${script})
    if(NOT folder STREQUAL "prelude")
      string(PREPEND name ${folder}/)
    endif()
    string(REPLACE "/" "." module ambit/${name})
    list(APPEND embedded "${module}|${name}|${from}/${script}")
    list(APPEND embedded_paths ${from}/${script})
  endforeach()
endforeach()
include(cmake/skeleton.cmake)
list(APPEND embedded "ambit.command.skeletons|command/skeletons|${AMBIT_SKELETONS}")
list(APPEND embedded "ambit.view.parts|view/parts|${AMBIT_VIEW_PARTS}")
list(APPEND embedded "ambit.page.parts|page/parts|${AMBIT_PAGE_PARTS}")
list(APPEND embedded_paths ${AMBIT_SKELETONS} ${AMBIT_VIEW_PARTS} ${AMBIT_PAGE_PARTS})
set(embedded_source ${PROJECT_BINARY_DIR}/embedded.c)
add_custom_command(OUTPUT ${embedded_source}
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${embedded_source} "-DFILES=${embedded}" -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
  DEPENDS ${embedded_paths} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake VERBATIM)

file(GLOB lua_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/framework/lua/*.c)
add_library(ambit_lua OBJECT ${lua_sources} ${embedded_source})
target_include_directories(ambit_lua PRIVATE ${PROJECT_SOURCE_DIR}/framework ${LUA_INCLUDE_DIRS} ${FFI_INCLUDE_DIRS})
target_compile_definitions(ambit_lua PRIVATE AMBIT_VERSION="${PROJECT_VERSION}")
target_link_libraries(ambit_lua PRIVATE ambit_flags)

add_executable(ambit ${PROJECT_SOURCE_DIR}/framework/main.c $<TARGET_OBJECTS:ambit_lua>)
target_include_directories(ambit PRIVATE ${PROJECT_SOURCE_DIR}/framework)
target_link_libraries(ambit PRIVATE ambit_flags libambit PkgConfig::LUA PkgConfig::FFI ${CMAKE_DL_LIBS} m)
set_target_properties(ambit PROPERTIES ENABLE_EXPORTS ON)
ambit_place(ambit ${CMAKE_INSTALL_BINDIR} RUNTIME_OUTPUT_DIRECTORY)
add_custom_command(TARGET ambit POST_BUILD
  COMMAND ln -sf ${CMAKE_INSTALL_BINDIR}/ambit ${PROJECT_BINARY_DIR}/ambit VERBATIM)

add_library(ambit_module MODULE $<TARGET_OBJECTS:ambit_lua>)
target_link_libraries(ambit_module PRIVATE ambit_flags libambit PkgConfig::FFI ${CMAKE_DL_LIBS} m)
set_target_properties(ambit_module PROPERTIES PREFIX "" OUTPUT_NAME ambit)
ambit_place(ambit_module ${AMBIT_LUA_DIR} LIBRARY_OUTPUT_DIRECTORY)
