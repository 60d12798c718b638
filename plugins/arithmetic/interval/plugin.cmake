# One source three times: for every machine, for AVX2 with FMA, and for AVX-512; chosen at run time (context.c).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(interval ${PROJECT_SOURCE_DIR}/plugins/arithmetic/interval)
  set_source_files_properties(${interval}/avx2.c PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma")
  set_source_files_properties(${interval}/avx512.c PROPERTIES COMPILE_OPTIONS "-mavx512f;-mavx512dq;-mavx512vl;-mavx2;-mfma")
endif()
