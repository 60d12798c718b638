# The test of the root finder counts what a run allocates; a sanitizer's malloc cannot be replaced.
if(NOT AMBIT_SANITIZE)
  target_sources(test.plugins.solver_krawczyk PRIVATE ${PROJECT_SOURCE_DIR}/tests/kit/allocations.c)
  target_compile_definitions(test.plugins.solver_krawczyk PRIVATE ROOTS_COUNT_ALLOCATIONS)
endif()
if(AMBIT_COUNT_ALLOCATIONS)
  target_compile_definitions(test.plugins.solver_krawczyk PRIVATE AMBIT_COUNT_ALLOCATIONS)
endif()
add_dependencies(test.plugins.solver_krawczyk solver_krawczyk arithmetic_interval arithmetic_affine
  arithmetic_taylor_model arithmetic_gradient arithmetic_mpfr arithmetic_real)
