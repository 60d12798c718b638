# From inside: with the files of the plugin.
file(GLOB lohner_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/solver/lohner/*.c)
target_sources(test.plugins.solver_lohner_set PRIVATE ${lohner_sources})
