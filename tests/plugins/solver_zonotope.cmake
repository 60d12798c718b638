# Tests from inside: the files of the solver are linked into them.
file(GLOB zonotope_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/solver/zonotope/*.c)
list(REMOVE_ITEM zonotope_sources ${PROJECT_SOURCE_DIR}/plugins/solver/zonotope/plugin.c)
foreach(part rows defects slopes step range)
  target_sources(test.plugins.solver_zonotope_${part} PRIVATE ${zonotope_sources})
endforeach()
