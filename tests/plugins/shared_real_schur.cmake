file(GLOB schur_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/shared/real_schur*.c)
target_sources(test.plugins.shared_real_schur PRIVATE ${schur_sources})
