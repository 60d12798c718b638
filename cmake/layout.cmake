# The build tree is laid out as the installed one, so that both find the plugins relative to themselves, and what is installed is
# what was built and tested: no RUNPATH is edited. (CMake's editing leaves an empty entry in what is built, which means the current folder.)
set(AMBIT_LUA_DIR ${CMAKE_INSTALL_LIBDIR}/lua/5.4 CACHE STRING "where the Lua module goes, below the prefix")
set(AMBIT_BUILD_LIBDIR ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)

# The kernel looks for plugins in the folder `ambit` beside itself (framework/kernel/host/path.c).
file(MAKE_DIRECTORY ${AMBIT_BUILD_LIBDIR} ${PROJECT_BINARY_DIR}/plugins)
file(RELATIVE_PATH lib_to_plugins ${AMBIT_BUILD_LIBDIR} ${PROJECT_BINARY_DIR}/plugins)
file(CREATE_LINK ${lib_to_plugins} ${AMBIT_BUILD_LIBDIR}/ambit SYMBOLIC)

# The target goes to `folder`, below the prefix and the build tree alike; it looks for no library of Ambit's.
function(ambit_place target folder property)
  set_target_properties(${target} PROPERTIES ${property} ${PROJECT_BINARY_DIR}/${folder} BUILD_WITH_INSTALL_RPATH ON)
endfunction()
