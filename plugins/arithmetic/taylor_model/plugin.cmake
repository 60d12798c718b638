# One source three times: for every x86-64, for AVX2 with FMA, and for AVX-512, chosen at run time (context.c).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(taylor_model ${PROJECT_SOURCE_DIR}/plugins/arithmetic/taylor_model)
  set_source_files_properties(${taylor_model}/avx2.c PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma")
  set_source_files_properties(${taylor_model}/avx512.c PROPERTIES
    COMPILE_OPTIONS "-mavx512f;-mavx512dq;-mavx512vl;-mfma")
endif()
