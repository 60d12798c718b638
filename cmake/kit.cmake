# service/conformance_kit.so: the kits of tests/kit behind `ambit check`. A host program in the shape of a plugin, so it links libambit.
file(GLOB kit_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/kit/arithmetic_kit*.c ${PROJECT_SOURCE_DIR}/tests/kit/conformance*.c
  ${PROJECT_SOURCE_DIR}/tests/kit/element_*.c)
ambit_plugin(service conformance_kit ${kit_sources} ${PROJECT_SOURCE_DIR}/tests/kit/solver_kit.c
  ${PROJECT_SOURCE_DIR}/tests/kit/solver_kit_problems.c ${PROJECT_SOURCE_DIR}/tests/kit/solver_kit_values.c)
target_include_directories(service_conformance_kit PRIVATE ${PROJECT_SOURCE_DIR}/tests)
# whoever loads it has loaded libambit
set_target_properties(service_conformance_kit PROPERTIES SKIP_BUILD_RPATH ON)
