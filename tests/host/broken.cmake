# tests/host/<folder>/<kind>/<name>.c -> <build>/tests/<folder>/<kind>/<name>.so: plugins for tests. broken: most of them are, on purpose;
# shadow: they take shipped names; lying: a service that gives no enclosures.
add_custom_target(broken_plugins)
foreach(folder broken shadow lying)
  string(TOUPPER ${folder} upper)
  set(AMBIT_${upper}_DIR ${PROJECT_BINARY_DIR}/tests/${folder})
  file(GLOB broken_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/host/${folder}/*/*.c)
  foreach(source ${broken_sources})
    get_filename_component(name ${source} NAME_WE)
    get_filename_component(directory ${source} DIRECTORY)
    get_filename_component(kind ${directory} NAME)
    set(target ${folder}_${kind}_${name})
    add_library(${target} MODULE ${source})
    set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name} C_VISIBILITY_PRESET hidden
      LIBRARY_OUTPUT_DIRECTORY ${AMBIT_${upper}_DIR}/${kind})
    target_link_libraries(${target} PRIVATE ambit_flags)
    # undefined symbols are the point of one of them
    target_link_options(${target} PRIVATE -Wl,--unresolved-symbols=ignore-all)
    add_dependencies(broken_plugins ${target})
  endforeach()
endforeach()
foreach(test host.registry host.object host.services host.slow_fault host.trust verbs.environment verbs.faults verbs.evaluate verbs.simulate verbs.sample
    verbs.sample_lanes verbs.split_solver
    verbs.allocations verbs.work)
  if(TARGET test.${test})
    target_compile_definitions(test.${test} PRIVATE AMBIT_BROKEN_DIR="${AMBIT_BROKEN_DIR}"
      AMBIT_SHADOW_DIR="${AMBIT_SHADOW_DIR}" AMBIT_LYING_DIR="${AMBIT_LYING_DIR}" AMBIT_PLUGINS_DIR="${PROJECT_BINARY_DIR}/plugins")
    add_dependencies(test.${test} broken_plugins)
  endif()
endforeach()
