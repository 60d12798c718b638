# tests/host/broken/<kind>/<name>.c -> <build>/tests/broken/<kind>/<name>.so: plugins for tests, most of them broken on purpose.
set(AMBIT_BROKEN_DIR ${PROJECT_BINARY_DIR}/tests/broken)
add_custom_target(broken_plugins)
file(GLOB broken_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/host/broken/*/*.c)
foreach(source ${broken_sources})
  get_filename_component(name ${source} NAME_WE)
  get_filename_component(directory ${source} DIRECTORY)
  get_filename_component(kind ${directory} NAME)
  add_library(broken_${kind}_${name} MODULE ${source})
  set_target_properties(broken_${kind}_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} C_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${AMBIT_BROKEN_DIR}/${kind})
  target_link_libraries(broken_${kind}_${name} PRIVATE ambit_flags)
  # undefined symbols are the point of one of them
  target_link_options(broken_${kind}_${name} PRIVATE -Wl,--unresolved-symbols=ignore-all)
  add_dependencies(broken_plugins broken_${kind}_${name})
endforeach()
foreach(test host.registry host.object host.services model.environment model.evaluate model.simulate model.sample
    model.sample_lanes model.split_solver
    model.allocations model.work)
  if(TARGET test.${test})
    target_compile_definitions(test.${test} PRIVATE AMBIT_BROKEN_DIR="${AMBIT_BROKEN_DIR}")
    add_dependencies(test.${test} broken_plugins)
  endif()
endforeach()
