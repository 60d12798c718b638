# Products of interval series and matrices: the instruction set of the variant that the kernel chooses at run time. gcc would split their
# loops in two, and take the sums apart that wait for each other least together.
set(product ${PROJECT_SOURCE_DIR}/framework/kernel/num/product)
set(product_flags $<$<C_COMPILER_ID:GNU>:-fno-tree-loop-distribution>)
set_source_files_properties(${product}_portable.c PROPERTIES COMPILE_OPTIONS "${product_flags}")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set_source_files_properties(${product}_avx2.c PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma;${product_flags}")
endif()
