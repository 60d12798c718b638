# The tests of the root finder count what a run allocates; a sanitizer's malloc cannot be replaced.
foreach(name solver_krawczyk solver_krawczyk_parameters)
  if(NOT AMBIT_SANITIZE)
    target_sources(test.plugins.${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/kit/allocations.c)
    target_compile_definitions(test.plugins.${name} PRIVATE ROOTS_COUNT_ALLOCATIONS)
  endif()
endforeach()
if(AMBIT_COUNT_ALLOCATIONS)
  target_compile_definitions(test.plugins.solver_krawczyk PRIVATE AMBIT_COUNT_ALLOCATIONS)
endif()
add_dependencies(test.plugins.solver_krawczyk solver_krawczyk arithmetic_interval arithmetic_affine
  arithmetic_taylor_model arithmetic_gradient arithmetic_mpfr arithmetic_real)
foreach(name solver_krawczyk_operators solver_krawczyk_parameters)
  add_dependencies(test.plugins.${name} solver_krawczyk arithmetic_interval)
endforeach()
add_dependencies(test.model.eigen service_eigen)
# From inside: with the files of the plugin.
file(GLOB krawczyk_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/solver/krawczyk/*.c)
target_sources(test.plugins.solver_krawczyk_linear PRIVATE ${krawczyk_sources})
