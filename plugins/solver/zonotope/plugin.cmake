set(AMBIT_PLUGIN_SHARED constant real_schur real_schur_vectors)
# Sums of rows twice: for every machine, and for AVX2, chosen at run time (row.c). No contraction: both give the same numbers.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set_source_files_properties(${PROJECT_SOURCE_DIR}/plugins/solver/zonotope/avx2.c PROPERTIES COMPILE_OPTIONS "-mavx2")
endif()
