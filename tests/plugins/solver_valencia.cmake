# What these tests load at run time.
foreach(test solver_valencia solver_valencia_kinks solver_valencia_figures)
  if(TARGET test.plugins.${test} AND TARGET solver_valencia)
    add_dependencies(test.plugins.${test} solver_valencia arithmetic_interval arithmetic_taylor_model arithmetic_affine
      arithmetic_gradient arithmetic_mpfr)
  endif()
endforeach()
