# Tests from inside: linked with the objects of the solver.
foreach(part change rows defects slopes step range products discs equations start reduce)
  target_sources(test.plugins.solver_zonotope_${part} PRIVATE $<TARGET_OBJECTS:solver_zonotope>)
endforeach()
