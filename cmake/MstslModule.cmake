# mstsl_module(<name> SOURCES a.cpp ... [PUBLIC target...] [PRIVATE target...])
#
# One static library per module, mstsl::<name>, with the headers of include/mstsl/<name>/. PUBLIC names what its
# headers show, PRIVATE what only its .cpp files use. Modules may depend on lower layers only.
function(mstsl_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(mstsl_${name} ${arg_SOURCES})
  add_library(mstsl::${name} ALIAS mstsl_${name})
  set_target_properties(mstsl_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(mstsl_${name} PUBLIC cxx_std_20)
  target_include_directories(mstsl_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_link_libraries(mstsl_${name} PUBLIC ${arg_PUBLIC}
    PRIVATE ${arg_PRIVATE} fmt::fmt $<BUILD_INTERFACE:mstsl_own_flags>)
  mstsl_precompile(mstsl_${name} OWNER mstsl_core)
  set_property(GLOBAL APPEND PROPERTY MSTSL_MODULES mstsl_${name})
endfunction()

# mstsl_precompile(<target> OWNER <target> [MORE <header>...])
#
# Compiles the common headers, and MORE, once, in OWNER, for all targets that share its flags.
function(mstsl_precompile target)
  cmake_parse_arguments(arg "" "OWNER" "MORE" ${ARGN})
  if(NOT MSTSL_PCH)
    return()
  elseif(target STREQUAL arg_OWNER)
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.hpp ${arg_MORE})
  else()
    target_precompile_headers(${target} REUSE_FROM ${arg_OWNER})
  endif()
endfunction()

# mstsl_compile_alone(<source>...): these name things as their neighbours do (each world has its Layout), so a unity
# build (CMAKE_UNITY_BUILD, as the sanitizer presets set it) keeps them out of its common files.
function(mstsl_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# mstsl_test(<name> SOURCES a.cpp ... [LINK target...]): one GoogleTest program, its cases known to ctest.
function(mstsl_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(test_${name} ${arg_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${arg_LINK} mstsl_test_support GTest::gtest_main fmt::fmt mstsl_own_flags)
  mstsl_precompile(test_${name} OWNER test_core MORE <gtest/gtest.h>)
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}. PROPERTIES TIMEOUT 300 DISCOVERY_TIMEOUT 60)
endfunction()
