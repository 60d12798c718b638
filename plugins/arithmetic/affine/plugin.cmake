# The passes over coefficients thrice: for every x86-64, for AVX2 with FMA, for AVX-512; chosen at run time (context.c).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(affine ${PROJECT_SOURCE_DIR}/plugins/arithmetic/affine)
  set_source_files_properties(${affine}/avx2.c PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma")
  set_source_files_properties(${affine}/avx512.c PROPERTIES COMPILE_OPTIONS "-mavx512f;-mavx512dq;-mavx512vl;-mfma;-mprefer-vector-width=512")
endif()
