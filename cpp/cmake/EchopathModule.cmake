# One module is one folder, with folders inside where it has many files, one static library and one test program.
# Third parties go under PRIVATE: their types appear in no header outside the module.
add_library(echopath_options INTERFACE)
target_compile_options(echopath_options INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wno-psabi)
if(ECHOPATH_WERROR)
  target_compile_options(echopath_options INTERFACE -Werror)
endif()
# What is looked at: all modules, and where threads are, the tests too, since their atomics stand in the same programs. Other
# sanitizers leave the tests out, whose code takes twice as long to compile with them; of functions that a header defines, the
# linker may then take the copy of a test.
add_library(echopath_looked_at INTERFACE)
if(ECHOPATH_SANITIZE)
  target_compile_options(echopath_looked_at INTERFACE -fsanitize=${ECHOPATH_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  if(ECHOPATH_SANITIZE MATCHES address AND ECHOPATH_SANITIZE MATCHES undefined)
    # Left out for a third of the time of compiling. The address sanitizer sees accesses through null and outside of objects
    # by itself; misaligned ones, and references to null that nothing is read through, are not seen.
    target_compile_options(echopath_looked_at INTERFACE -fno-sanitize=null,object-size,alignment)
  endif()
  target_link_options(echopath_options INTERFACE -fsanitize=${ECHOPATH_SANITIZE})
  target_compile_definitions(echopath_options INTERFACE ECHOPATH_SANITIZED)
  if(ECHOPATH_SANITIZE MATCHES thread)
    target_compile_definitions(echopath_options INTERFACE ECHOPATH_THREAD_SANITIZER)
    target_link_libraries(echopath_options INTERFACE echopath_looked_at)
  endif()
endif()

# Parsed once for all modules, and once more for all tests, instead of once for each file: about half of the time of compiling.
set(echopath_common_headers <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <complex> <functional> <memory> <string> <vector>)

# Takes the parsed headers of `owner`, which is compiled with the same options; the owner, and what has OWN_OPTIONS, parses them
# for itself.
function(echopath_parse_headers_once target owner)
  cmake_parse_arguments(ARG "OWN_OPTIONS" "" "" ${ARGN})
  if(target STREQUAL owner OR ARG_OWN_OPTIONS)
    target_precompile_headers(${target} PRIVATE ${ARG_UNPARSED_ARGUMENTS})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# A module's files are compiled some at a time: most of the time goes into reading the same templates, so that this halves
# it. Names in unnamed namespaces are therefore unique within a module; each test file has a namespace named after it.
set(ECHOPATH_UNITY_FILES 6 CACHE STRING "Number of files of a module that are compiled as one, 0 for each by itself")
function(echopath_compile_together target)
  if(ECHOPATH_UNITY_FILES GREATER 0)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${ECHOPATH_UNITY_FILES})
  endif()
endfunction()

# echopath_module(NAME [DEPENDS modules...] [PUBLIC targets...] [PRIVATE targets...] [OPTIONS compile options...])
function(echopath_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PUBLIC;PRIVATE;OPTIONS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp */*.cpp)
  list(TRANSFORM ARG_DEPENDS PREPEND echopath_)
  add_library(echopath_${name} STATIC ${sources})
  add_library(echopath::${name} ALIAS echopath_${name})
  target_include_directories(echopath_${name} PUBLIC ${PROJECT_SOURCE_DIR}/cpp)
  target_link_libraries(echopath_${name} PUBLIC ${ARG_DEPENDS} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} echopath_options
    echopath_looked_at)
  if(ARG_OPTIONS)
    target_compile_options(echopath_${name} PRIVATE ${ARG_OPTIONS})
    set(own OWN_OPTIONS)
  endif()
  echopath_compile_together(echopath_${name})
  echopath_parse_headers_once(echopath_${name} echopath_base ${own} ${echopath_common_headers})
endfunction()

# echopath_kernels(MODULE headers...): compiles them into a module once per instruction set that base/simd.h picks from, as
# base/lane_math.h says. What is compiled with options of its own cannot use headers that were parsed without.
function(echopath_kernels name)
  list(TRANSFORM ARGN REPLACE "(.+)" "#include \"echopath/${name}/\\1\"" OUTPUT_VARIABLE includes)
  list(JOIN includes "\n" includes)
  set(sets baseline:2:)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND sets avx2:4:-march=x86-64-v3 avx512:8:-march=x86-64-v4)
  endif()
  foreach(entry ${sets})
    string(REGEX MATCH "(.+):(.+):(.*)" entry ${entry})
    set(file ${CMAKE_CURRENT_BINARY_DIR}/kernels_${CMAKE_MATCH_1}.cpp)
    set_source_files_properties(${file} PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_DEFINITIONS ECHOPATH_LANES=${CMAKE_MATCH_2}
      COMPILE_OPTIONS "${CMAKE_MATCH_3}")
    file(CONFIGURE OUTPUT ${file} CONTENT "${includes}\n")
    target_sources(echopath_${name} PRIVATE ${file})
  endforeach()
endfunction()

# Of modules that compute with finite complex numbers per ray: products and quotients without the care of Annex G for
# infinities, and square roots without errno. Nothing that reorders sums, and nothing that a program notices by linking with
# it.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-fcx-limited-range ECHOPATH_HAS_LIMITED_RANGE)  # clang has it from 18 on
set(echopath_finite_numbers $<$<BOOL:${ECHOPATH_HAS_LIMITED_RANGE}>:-fcx-limited-range> -fno-math-errno)

# echopath_test(NAME [EACH_INSTRUCTION_SET] [LIBS targets...] [HARD patterns...]): every .cpp of this folder in one
# GoogleTest program, test_NAME.
# Tests that match a pattern are the test NAME_hard, with the label hard (ctest -L hard); all others the test NAME.
# EACH_INSTRUCTION_SET: all of them again as NAME_baseline and NAME_avx2, where the machine's best is another.
function(echopath_test name)
  cmake_parse_arguments(ARG "EACH_INSTRUCTION_SET" "" "LIBS;HARD" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  add_executable(test_${name} ${sources})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${name} PRIVATE ECHOPATH_TEST_DATA="${PROJECT_SOURCE_DIR}/data")
  target_link_libraries(test_${name} PRIVATE ${ARG_LIBS} GTest::gtest_main echopath_options)
  echopath_compile_together(test_${name})
  echopath_parse_headers_once(test_${name} test_base <gtest/gtest.h> ${echopath_common_headers})
  list(JOIN ARG_HARD ":" hard)
  if(hard)
    add_test(NAME ${name} COMMAND test_${name} --gtest_filter=-${hard})
    add_test(NAME ${name}_hard COMMAND test_${name} --gtest_filter=${hard})
    set_tests_properties(${name}_hard PROPERTIES LABELS hard FAIL_REGULAR_EXPRESSION "0 tests from 0 test suites ran")
  else()
    add_test(NAME ${name} COMMAND test_${name})
  endif()
  if(ARG_EACH_INSTRUCTION_SET)
    foreach(set baseline avx2)
      add_test(NAME ${name}_${set} COMMAND test_${name})
      set_tests_properties(${name}_${set} PROPERTIES ENVIRONMENT ECHOPATH_INSTRUCTION_SET=${set}
        SKIP_REGULAR_EXPRESSION "must be one that this machine has")
    endforeach()
  endif()
endfunction()
