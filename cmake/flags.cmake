# One set of flags for every target. -frounding-math: code relies on the rounding mode (framework/kernel/num/rounding.h); contraction is
# stated per file. Nothing is ever compiled with -ffast-math.
add_library(ambit_flags INTERFACE)
target_compile_definitions(ambit_flags INTERFACE _GNU_SOURCE)
target_compile_options(ambit_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wno-unknown-pragmas -frounding-math -ffp-contract=off -fno-math-errno
  $<$<COMPILE_LANGUAGE:C>:-Wconversion -Wstrict-prototypes -Wmissing-prototypes>)
# No object holds the name of the folder it was built in: not in debug information, not in __FILE__.
target_compile_options(ambit_flags INTERFACE
  -ffile-prefix-map=${PROJECT_SOURCE_DIR}/= -ffile-prefix-map=${PROJECT_BINARY_DIR}/=)
# Hardening, checked in what is built by tests/install (cmake/check_objects.cmake). The sanitizers bring guards of their own.
include(CheckPIESupported)
check_pie_supported()
include(CheckCCompilerFlag)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  set(branches -mbranch-protection=standard)
else()
  set(branches -fcf-protection=full)
endif()
foreach(flag -fstack-protector-strong -fstack-clash-protection ${branches})
  string(MAKE_C_IDENTIFIER "AMBIT_HAS${flag}" known)
  check_c_compiler_flag(${flag} ${known})
  if(${known})
    target_compile_options(ambit_flags INTERFACE ${flag})
  endif()
endforeach()
target_link_options(ambit_flags INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
if(NOT AMBIT_SANITIZE)
  target_compile_options(ambit_flags INTERFACE $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>)
endif()
if(AMBIT_WERROR)
  target_compile_options(ambit_flags INTERFACE -Werror)
endif()
if(AMBIT_SANITIZE)
  target_compile_options(ambit_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(ambit_flags INTERFACE -fsanitize=address,undefined)
endif()
# clang respects the rounding mode only with the strict model
target_compile_options(ambit_flags INTERFACE $<$<C_COMPILER_ID:Clang>:-ffp-model=strict>)
target_include_directories(ambit_flags INTERFACE ${PROJECT_SOURCE_DIR}/framework/kernel/abi)
find_package(PkgConfig REQUIRED)
