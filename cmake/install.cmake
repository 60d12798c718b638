# What a user of the installed tree gets: the command, libambit, its C API and the headers for plugins (ambit/...), find_package(Ambit), ambit.pc, the plugins (cmake/plugins.cmake), the Lua module, the scenes.
include(CMakePackageConfigHelpers)
include(cmake/kit.cmake)

set(AMBIT_SCENE_DIR ${CMAKE_INSTALL_DATADIR}/ambit)

set_target_properties(libambit PROPERTIES EXPORT_NAME kernel)

install(TARGETS libambit EXPORT AmbitTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ambit NAMELINK_COMPONENT libambit-dev)
install(TARGETS ambit RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ambit)
install(TARGETS ambit_module LIBRARY DESTINATION ${AMBIT_LUA_DIR} COMPONENT ambit)

install(DIRECTORY framework/kernel/abi/ambit framework/api/ambit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT libambit-dev FILES_MATCHING PATTERN "*.h")
install(DIRECTORY plugins/shared DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ambit COMPONENT libambit-dev) # sources too: for plugins of others

# Plugins need headers only: Ambit::sdk; hosts link Ambit::kernel.
add_library(ambit_sdk INTERFACE)
set_target_properties(ambit_sdk PROPERTIES EXPORT_NAME sdk)
target_include_directories(ambit_sdk INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
install(TARGETS ambit_sdk EXPORT AmbitTargets)

set(AMBIT_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Ambit)
install(EXPORT AmbitTargets NAMESPACE Ambit:: DESTINATION ${AMBIT_CMAKE_DIR} COMPONENT libambit-dev)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/AmbitConfig.cmake.in ${PROJECT_BINARY_DIR}/AmbitConfig.cmake
  INSTALL_DESTINATION ${AMBIT_CMAKE_DIR} PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_BINDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/AmbitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/AmbitConfig.cmake ${PROJECT_BINARY_DIR}/AmbitConfigVersion.cmake DESTINATION ${AMBIT_CMAKE_DIR}
  COMPONENT libambit-dev)

file(RELATIVE_PATH pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/ambit.pc.in ${PROJECT_BINARY_DIR}/ambit.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/ambit.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT libambit-dev)

file(GLOB scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/*.lua)
list(FILTER scenes EXCLUDE REGEX "/(docs|mutate|results|wrap)\\.lua$") # tools of the tree
install(FILES ${scenes} DESTINATION ${AMBIT_SCENE_DIR}/scenes COMPONENT ambit)
