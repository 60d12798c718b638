# From inside: with the files of the plugin that the tested one needs.
foreach(file cell functions range restrict rules series kink)
  target_sources(test.plugins.solver_taylor_model_functions PRIVATE ${PROJECT_SOURCE_DIR}/plugins/solver/taylor_model/${file}.c)
endforeach()
file(GLOB taylor_model_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/solver/taylor_model/*.c)
list(FILTER taylor_model_sources EXCLUDE REGEX "/pieces\\.c$")
target_sources(test.plugins.solver_taylor_model_pieces PRIVATE ${taylor_model_sources})
