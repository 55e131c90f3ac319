option(MSTSL_BUILD_APPS "Build the mstsl command" ON)
option(MSTSL_BUILD_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(MSTSL_BUILD_FUZZERS "Build the libFuzzer targets (needs clang)" OFF)
option(MSTSL_BUILD_BENCHMARKS "Build the benchmarks" OFF)
option(MSTSL_BUILD_EXAMPLES "Build the examples" ${PROJECT_IS_TOP_LEVEL})
option(MSTSL_WITH_MRPT "Build the baseline mcl if MRPT is installed; each start of the program then takes 0.4 s and 85 MB more" OFF)
option(MSTSL_WITH_MPI "Let `mpirun -n N mstsl bench` share the runs among processes, if MPI is installed" OFF)
option(MSTSL_PCH "Precompile the common headers: builds in about half the time" ON)
set(MSTSL_DATA_DIR "${PROJECT_SOURCE_DIR}/../shared/data" CACHE PATH
    "Folder with the real recordings; tests that need one are skipped where it is absent")
set(MSTSL_SIMD "portable" CACHE STRING
    "Instruction set of the library's own objects: portable (runs anywhere), avx2, or native (this machine only)")
set_property(CACHE MSTSL_SIMD PROPERTY STRINGS portable avx2 native)
set(MSTSL_SANITIZE "" CACHE STRING "Sanitizers for every object of this build, e.g. address,undefined")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)  # where CMAKE_UNITY_BUILD is on

# Flags for our own objects only: linked PRIVATE by mstsl_module(), so users of the library inherit none of them.
add_library(mstsl_own_flags INTERFACE)
target_compile_options(mstsl_own_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wno-sign-conversion -Wnon-virtual-dtor -Werror=return-type
  -Wno-missing-field-initializers  # what a designated initializer leaves out has its default
  # The same bytes on every machine: no fused multiply-add that one compiler makes and another does not.
  -ffp-contract=off)
if(MSTSL_SIMD STREQUAL "avx2")
  target_compile_options(mstsl_own_flags INTERFACE -mavx2 -mfma)
elseif(MSTSL_SIMD STREQUAL "native")
  target_compile_options(mstsl_own_flags INTERFACE -march=native)
elseif(NOT MSTSL_SIMD STREQUAL "portable")
  message(FATAL_ERROR "MSTSL_SIMD is '${MSTSL_SIMD}'; choose portable, avx2 or native")
endif()
if(CMAKE_UNITY_BUILD)
  # Both ask what is whose in a file, and one file is made of several.
  target_compile_options(mstsl_own_flags INTERFACE -Wno-shadow -Wno-subobject-linkage)
endif()
if(MSTSL_SANITIZE)
  target_compile_options(mstsl_own_flags INTERFACE -fsanitize=${MSTSL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(mstsl_own_flags INTERFACE -fsanitize=${MSTSL_SANITIZE})
endif()
if(MSTSL_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "MSTSL_BUILD_FUZZERS needs clang: configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  # Coverage for libFuzzer to steer by, in every object, and sanitizers to see what goes wrong.
  target_compile_options(mstsl_own_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all)
  target_link_options(mstsl_own_flags INTERFACE -fsanitize=address,undefined)
endif()
