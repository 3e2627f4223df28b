# One module is one folder, with folders inside where it has many files, one static library and one test program.
# Third parties go under PRIVATE: their types appear in no header outside the module.
add_library(echopath_options INTERFACE)
target_compile_options(echopath_options INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wno-psabi)
if(ECHOPATH_WERROR)
  target_compile_options(echopath_options INTERFACE -Werror)
endif()
# What is looked at: all modules, and where threads are, the tests too, since their atomics stand in the same programs. Other
# sanitizers leave the tests out; of functions that a header defines, the linker may then take the copy of a test.
function(echopath_look target sanitizers)
  target_compile_options(${target} INTERFACE -fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(${target} INTERFACE -fsanitize=${sanitizers})
  if(sanitizers MATCHES address AND sanitizers MATCHES undefined)
    # Left out for a third of the time of compiling. The address sanitizer sees accesses through null and outside of objects
    # by itself; misaligned ones, references to null that nothing is read through, and addresses that wrap around unread are
    # not seen.
    target_compile_options(${target} INTERFACE -fno-sanitize=null,object-size,alignment,pointer-overflow)
  endif()
  # Eigen would align by itself what is looked at: the tests, which are compiled without sanitizers, free what modules made, and
  # the other way round. Memory of the sanitizer is aligned to 16 bytes as that of glibc is.
  target_compile_definitions(${target} INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endfunction()

add_library(echopath_looked_at INTERFACE)
if(ECHOPATH_SANITIZE)
  echopath_look(echopath_looked_at ${ECHOPATH_SANITIZE})
  if(ECHOPATH_SANITIZE MATCHES thread)
    target_compile_definitions(echopath_options INTERFACE ECHOPATH_THREAD_SANITIZER)
    target_link_libraries(echopath_options INTERFACE echopath_looked_at)
  endif()
endif()

# Which instruction sets of base/lanes/simd.h this machine has: tests run with all of them.
if(ECHOPATH_BUILD_TESTS AND NOT CMAKE_CROSSCOMPILING)
  include(CheckCXXSourceRuns)
  foreach(level 3 4)
    check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"x86-64-v${level}\") ? 0 : 1; }" ECHOPATH_RUNS_V${level})
  endforeach()
  # Those below the best, which a test runs with unless told otherwise.
  set(echopath_lesser_sets)
  if(ECHOPATH_RUNS_V3)
    list(APPEND echopath_lesser_sets baseline)
  endif()
  if(ECHOPATH_RUNS_V4)
    list(APPEND echopath_lesser_sets avx2)
  endif()
endif()

# Every module once more as NAME_sanitized, for the tests of that name: the objects of the tests are compiled once for both.
# They are built by the target `sanitized` alone, and run by `ctest -C Sanitized -L sanitized`.
set(ECHOPATH_SANITIZED_TWINS OFF)
if(ECHOPATH_BUILD_TESTS AND NOT ECHOPATH_SANITIZE)
  set(ECHOPATH_SANITIZED_TWINS ON)
  add_library(echopath_looked_at_sanitized INTERFACE)
  echopath_look(echopath_looked_at_sanitized address,undefined)
  # Compiled in two thirds of the time that -O1 takes, and run as fast. Looking for warnings, which the module as it is has, too,
  # would take a twentieth more.
  target_compile_options(echopath_looked_at_sanitized INTERFACE -Og -g1 -w)
  # A machine without AVX-512 runs them as baseline code: between the widest lanes and the narrowest, AVX2 has no code of its own.
  target_compile_definitions(echopath_looked_at_sanitized INTERFACE ECHOPATH_WITHOUT_AVX2)
  set(echopath_sanitized_sets baseline)
  if(ECHOPATH_RUNS_V4)
    list(APPEND echopath_sanitized_sets avx512)
  else()
    target_compile_definitions(echopath_looked_at_sanitized INTERFACE ECHOPATH_WITHOUT_AVX512)
  endif()
  add_custom_target(sanitized)
endif()

# echopath_twin(TARGET LIBS targets...): TARGET_sanitized, of the objects of TARGET, with the twins of LIBS.
function(echopath_twin target)
  cmake_parse_arguments(ARG "" "" "LIBS" ${ARGN})
  if(NOT ECHOPATH_SANITIZED_TWINS)
    return()
  endif()
  get_target_property(type ${target} TYPE)
  set(twin ${target}_sanitized)
  list(TRANSFORM ARG_LIBS APPEND _sanitized)
  if(type STREQUAL EXECUTABLE)
    add_executable(${twin} EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${target}>)
    target_link_libraries(${twin} PRIVATE ${ARG_LIBS} GTest::gtest_main echopath_looked_at_sanitized)
    add_dependencies(sanitized ${twin})
  else()
    add_library(${twin} STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${target}>)
    target_link_libraries(${twin} PUBLIC ${ARG_LIBS})
  endif()
  set_target_properties(${twin} PROPERTIES LINKER_LANGUAGE CXX)
endfunction()

# Parsed once for all modules, and once more for all tests, instead of once for each file: about half of the time of compiling.
set(echopath_common_headers <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <complex> <functional> <memory> <string> <vector>)

set(echopath_test_headers <gtest/gtest.h> <map> <random> <set> <sstream> ${echopath_common_headers})

# Takes the parsed headers of `owner`, which is compiled with the same options: GCC would optimise by those of the headers. The
# owner parses them.
function(echopath_parse_headers_once target owner)
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# A module's files are compiled some at a time: most of the time goes into reading the same templates, so that six at a time
# halve it, and twelve take a tenth less again, of tests a sixth. Bindings, which take 2 GB at twelve, are compiled nine at a time.
# Names in unnamed namespaces are therefore unique within a module; each test file has a namespace named after it.
set(ECHOPATH_UNITY_FILES 12 CACHE STRING "Number of files of a module that are compiled as one, 0 for each by itself")
function(echopath_compile_together target files)
  if(ECHOPATH_UNITY_FILES GREATER 0)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()

# What makes the compiler's work quick where nobody waits for the code: tests sum slowly. They call so much from headers that -Og
# takes as long to compile.
set(echopath_quickly_compiled $<$<CONFIG:Release>:-O1>)

# echopath_module(NAME [DEPENDS modules...] [PUBLIC targets...] [PRIVATE targets...] [OPTIONS compile options...])
function(echopath_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PUBLIC;PRIVATE;OPTIONS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp */*.cpp)
  echopath_library("" ${ECHOPATH_UNITY_FILES})
  if(ECHOPATH_SANITIZED_TWINS)
    # Without options that are for speed, so that it shares the parsed headers, and in large files: nobody changes one alone.
    set(ARG_OPTIONS)
    echopath_library(_sanitized 20)
    set_target_properties(echopath_${name}_sanitized PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endfunction()

# The module of echopath_module's arguments, `name` and `suffix` together.
macro(echopath_library suffix unity_files)
  set(target echopath_${name}${suffix})
  set(depends ${ARG_DEPENDS})
  list(TRANSFORM depends REPLACE "(.+)" "echopath_\\1${suffix}")
  add_library(${target} STATIC ${sources})
  add_library(echopath::${name}${suffix} ALIAS ${target})
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/cpp)
  target_link_libraries(${target} PUBLIC ${depends} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} echopath_options
    echopath_looked_at${suffix})
  set(owner echopath_base${suffix})
  if(ARG_OPTIONS)
    target_compile_options(${target} PRIVATE ${ARG_OPTIONS})
    set(owner ${target})
    if("${ARG_OPTIONS}" STREQUAL "${echopath_finite_numbers}")
      set(owner echopath_em)
    endif()
  endif()
  echopath_compile_together(${target} ${unity_files})
  echopath_parse_headers_once(${target} ${owner} ${echopath_common_headers})
endmacro()

# echopath_kernels(MODULE headers...): compiles them into a module once per instruction set that base/lanes/simd.h picks from, as
# base/lanes/lane_math.h says. What is compiled with options of its own cannot use headers that were parsed without.
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
    # Eigen aligns to 16 bytes in all files: with what the instruction set asks for, matrices would be freed in another way than
    # they were made where the linker takes one of its functions from here.
    set_source_files_properties(${file} PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "${CMAKE_MATCH_3}"
      COMPILE_DEFINITIONS "ECHOPATH_LANES=${CMAKE_MATCH_2};EIGEN_MAX_ALIGN_BYTES=16")
    file(CONFIGURE OUTPUT ${file} CONTENT "${includes}\n")
    target_sources(echopath_${name} PRIVATE ${file})
    if(ECHOPATH_SANITIZED_TWINS AND CMAKE_MATCH_1 IN_LIST echopath_sanitized_sets)
      target_sources(echopath_${name}_sanitized PRIVATE ${file})
    endif()
  endforeach()
endfunction()

# Of modules that compute with finite complex numbers per ray: products and quotients without the care of Annex G for
# infinities, and square roots without errno. Nothing that reorders sums, and nothing that a program notices by linking with
# it.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-fcx-limited-range ECHOPATH_HAS_LIMITED_RANGE)  # clang has it from 18 on
set(echopath_finite_numbers $<$<BOOL:${ECHOPATH_HAS_LIMITED_RANGE}>:-fcx-limited-range> -fno-math-errno)

# A library or program of tests other than those of a module is compiled as these are: with other code for addresses, or another
# definition (GTest has one), it could not take their parsed headers.
function(echopath_compile_as_tests target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${target} PRIVATE -fPIE ${echopath_quickly_compiled})
  target_compile_definitions(${target} PRIVATE ECHOPATH_TEST_DATA="${PROJECT_SOURCE_DIR}/data")
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${target} PRIVATE GTest::gtest)
  echopath_parse_headers_once(${target} test_base ${echopath_test_headers})
endfunction()

# echopath_test(NAME [EACH_INSTRUCTION_SET [ONCE patterns...]] [COST seconds] [LIBS targets...] [HARD patterns...]): every
# .cpp of this folder and of those within in one GoogleTest program, test_NAME.
# Tests that match a pattern are the test NAME_hard, with the label hard (ctest -L hard); all others the test NAME.
# EACH_INSTRUCTION_SET: all of them again as NAME_baseline and NAME_avx2, each where the machine has a better one.
# ONCE: tests that are repeated neither so nor with sanitized modules: statistics over many runs of code that others run, too.
# COST: about how long it takes, so that the longest begin first; 1 where it is not said.
# Each is there a second time with sanitized modules: NAME_sanitized, NAME_hard_sanitized.
function(echopath_test name)
  cmake_parse_arguments(ARG "EACH_INSTRUCTION_SET" "COST" "LIBS;HARD;ONCE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp */*.cpp)
  add_executable(test_${name} ${sources})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${name} PRIVATE ECHOPATH_TEST_DATA="${PROJECT_SOURCE_DIR}/data")
  target_compile_options(test_${name} PRIVATE ${echopath_quickly_compiled})
  target_link_libraries(test_${name} PRIVATE ${ARG_LIBS} GTest::gtest_main echopath_options)
  echopath_twin(test_${name} LIBS ${ARG_LIBS})
  echopath_compile_together(test_${name} ${ECHOPATH_UNITY_FILES})
  echopath_parse_headers_once(test_${name} test_base ${echopath_test_headers})
  list(JOIN ARG_HARD ":" hard)
  list(JOIN ARG_ONCE ":" once)
  echopath_add_tests(${name} test_${name} "-${hard}" "-${hard}:${once}")
  if(hard)
    echopath_add_tests(${name}_hard test_${name} "${hard}" "${hard}-${once}")
    set_tests_properties(${name}_hard PROPERTIES LABELS hard FAIL_REGULAR_EXPRESSION "0 tests from 0 test suites ran")
  endif()
  if(ARG_EACH_INSTRUCTION_SET)
    foreach(set ${echopath_lesser_sets})
      add_test(NAME ${name}_${set} COMMAND test_${name} --gtest_filter=-${once})
      set_tests_properties(${name}_${set} PROPERTIES ENVIRONMENT ECHOPATH_INSTRUCTION_SET=${set}
        SKIP_REGULAR_EXPRESSION "must be one that this machine has")
    endforeach()
  endif()
  if(ARG_COST)
    get_property(tests DIRECTORY PROPERTY TESTS)
    set_tests_properties(${tests} PROPERTIES COST ${ARG_COST})
  endif()
endfunction()

# The test NAME, of those that a filter of a program leaves, and its twin, of those that the filter of the twin leaves.
function(echopath_add_tests name program filter twin_filter)
  add_test(NAME ${name} COMMAND ${program} --gtest_filter=${filter})
  if(ECHOPATH_SANITIZED_TWINS)
    add_test(NAME ${name}_sanitized COMMAND ${program}_sanitized --gtest_filter=${twin_filter} CONFIGURATIONS Sanitized)
    set_tests_properties(${name}_sanitized PROPERTIES LABELS sanitized
      FAIL_REGULAR_EXPRESSION "0 tests from 0 test suites ran")
  endif()
endfunction()
