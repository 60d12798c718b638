# Instruction sets of the elementary functions' variants; the kernel chooses one at run time.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(elementary ${PROJECT_SOURCE_DIR}/framework/kernel/num/elementary)
  set_source_files_properties(${elementary}_fma.c PROPERTIES COMPILE_OPTIONS "-mfma")
  set_source_files_properties(${elementary}_avx2.c PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma")
  set_source_files_properties(${elementary}_avx512.c PROPERTIES COMPILE_OPTIONS "-mavx512f;-mavx512dq;-mavx512vl;-mfma")
endif()
