# The loops over directions twice: for every x86-64, and for AVX2, chosen at run time (context.c).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set_source_files_properties(${PROJECT_SOURCE_DIR}/plugins/arithmetic/gradient/avx2.c PROPERTIES
    COMPILE_OPTIONS "-mavx2")
endif()
