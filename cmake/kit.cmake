# service/conformance_kit.so: the kits of tests/kit behind `ambit check`. A host program in the shape of
# a plugin, so it has a kernel of its own.
file(GLOB kit_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/kit/*_kit*.c ${PROJECT_SOURCE_DIR}/tests/kit/conduct*.c
  ${PROJECT_SOURCE_DIR}/tests/kit/conformance*.c ${PROJECT_SOURCE_DIR}/tests/kit/element_stage.c)
ambit_plugin(service conformance_kit ${kit_sources})
target_include_directories(service_conformance_kit PRIVATE ${PROJECT_SOURCE_DIR}/tests)
ambit_from(service_conformance_kit ${CMAKE_INSTALL_LIBDIR}/ambit/service)
