# The product of polynomials twice: for every machine, and for AVX2, chosen at run time (space.c). No contraction: both
# give the same numbers.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set_source_files_properties(${PROJECT_SOURCE_DIR}/plugins/solver/taylor_model/avx2.c PROPERTIES
    COMPILE_OPTIONS "-mavx2")
endif()
