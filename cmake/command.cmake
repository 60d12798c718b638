# The command `ambit` and the Lua module lua/ambit.so: the same bridge and the same embedded scripts.
# The module leaves Lua's own symbols to the interpreter that loads it; the command brings liblua along.
pkg_search_module(LUA REQUIRED IMPORTED_TARGET lua5.4 lua-5.4 lua54)
pkg_check_modules(FFI REQUIRED IMPORTED_TARGET libffi)

set(embedded "")
set(embedded_paths "")
# framework/verbs/reduce/pass.lua -> ambit.reduce.pass, framework/verbs/reduce/reduce.lua -> ambit.reduce,
# framework/models/frame.lua -> ambit.frame, scripts/command/run.lua -> ambit.command.run
# What every scene reads comes first, side by side: a process maps the pages that it reads and their neighbours.
set(first_scripts/command main.lua run.lua scene.lua)
set(first_framework/script init.lua check.lua code.lua provenance.lua session.lua)
foreach(room scripts/command framework/script framework/models framework/verbs scripts/lab)
  set(from ${PROJECT_SOURCE_DIR}/${room})
  file(GLOB_RECURSE scripts CONFIGURE_DEPENDS RELATIVE ${from} ${from}/*.lua)
  if(first_${room})
    list(REMOVE_ITEM scripts ${first_${room}})
    list(PREPEND scripts ${first_${room}})
  endif()
  foreach(script ${scripts})
    string(REGEX REPLACE "\\.lua$" "" name ${script})
    if(name MATCHES "([^/]+)/([^/]+)$" AND CMAKE_MATCH_1 STREQUAL CMAKE_MATCH_2)
      get_filename_component(name ${name} DIRECTORY)
    endif()
    if(room STREQUAL "scripts/command")
      string(PREPEND name command/)
    endif()
    string(REPLACE "/" "." module ambit/${name})
    if(embedded_at_${module})
      message(FATAL_ERROR "${from}/${script}, ${embedded_at_${module}}: both are ${module}")
    endif()
    set(embedded_at_${module} ${from}/${script})
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

file(GLOB_RECURSE lua_sources CONFIGURE_DEPENDS ${framework}/script/*.c ${framework}/models/*_lua.c ${framework}/verbs/*_lua.c)
add_library(ambit_lua OBJECT ${lua_sources} ${embedded_source})
target_include_directories(ambit_lua PRIVATE ${framework}/kernel ${framework} ${LUA_INCLUDE_DIRS} ${FFI_INCLUDE_DIRS})
target_compile_definitions(ambit_lua PRIVATE AMBIT_VERSION="${PROJECT_VERSION}")
target_link_libraries(ambit_lua PRIVATE ambit_flags)

add_executable(ambit ${framework}/main.c $<TARGET_OBJECTS:ambit_lua>)
target_include_directories(ambit PRIVATE ${framework}/kernel ${framework})
target_link_libraries(ambit PRIVATE ambit_flags libambit PkgConfig::LUA PkgConfig::FFI ${CMAKE_DL_LIBS} m)
set_target_properties(ambit PROPERTIES ENABLE_EXPORTS ON)
ambit_place(ambit ${CMAKE_INSTALL_BINDIR} RUNTIME_OUTPUT_DIRECTORY)
add_custom_command(TARGET ambit POST_BUILD
  COMMAND ln -sf ${CMAKE_INSTALL_BINDIR}/ambit ${PROJECT_BINARY_DIR}/ambit VERBATIM)

add_library(ambit_module MODULE $<TARGET_OBJECTS:ambit_lua>)
target_link_libraries(ambit_module PRIVATE ambit_flags libambit PkgConfig::FFI ${CMAKE_DL_LIBS} m)
set_target_properties(ambit_module PROPERTIES PREFIX "" OUTPUT_NAME ambit)
ambit_place(ambit_module ${AMBIT_LUA_DIR} LIBRARY_OUTPUT_DIRECTORY)
