# From inside: with the objects of the plugin.
target_sources(test.plugins.solver_lohner_set PRIVATE $<TARGET_OBJECTS:solver_lohner>)
