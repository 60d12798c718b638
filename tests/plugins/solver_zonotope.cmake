# Phase 1 is tested from inside: its files are linked into the test.
file(GLOB zonotope_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/solver/zonotope/*.c)
list(REMOVE_ITEM zonotope_sources ${PROJECT_SOURCE_DIR}/plugins/solver/zonotope/plugin.c)
target_sources(test.plugins.solver_zonotope_rows PRIVATE ${zonotope_sources})
