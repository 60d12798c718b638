# What these tests load at run time.
foreach(test solver_valencia solver_valencia_kinks solver_valencia_figures)
  if(TARGET test.plugins.${test} AND TARGET solver_valencia)
    add_dependencies(test.plugins.${test} solver_valencia arithmetic_interval arithmetic_taylor_model arithmetic_affine
      arithmetic_gradient arithmetic_mpfr)
  endif()
endforeach()
# From inside: with the other files of the plugin, verify.c and frame.c being included.
file(GLOB valencia_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/solver/valencia/*.c ${PROJECT_SOURCE_DIR}/plugins/shared/real_schur*.c)
list(FILTER valencia_sources EXCLUDE REGEX "/(verify|frame)\\.c$")
target_sources(test.plugins.solver_valencia_rounding PRIVATE ${valencia_sources})
target_sources(test.plugins.solver_valencia_series PRIVATE ${PROJECT_SOURCE_DIR}/plugins/solver/valencia/series.c)
