# Every arithmetic of the tree takes part.
file(GLOB arithmetics CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/arithmetic/*)
foreach(entry ${arithmetics})
  get_filename_component(name ${entry} NAME_WE)
  if(TARGET arithmetic_${name})
    add_dependencies(test.plugins.arithmetics_agree arithmetic_${name})
  endif()
endforeach()
