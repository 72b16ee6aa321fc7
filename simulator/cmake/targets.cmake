# The compile rules of every target of ours, once.
option(FAULTSIM_WERROR "Treat warnings as errors" OFF)
# What ./check chooses; left alone, everything is built and each test is one of ctest's.
option(FAULTSIM_UNIT_TESTS "Build and register the unit tests" ON)
option(FAULTSIM_STUDIES "Build the benchmarks, the programs behind results/ and the tests beside optional peers" ON)
option(FAULTSIM_TEST_PROGRAMS "Give ctest whole test programs, not each of their tests" OFF)
option(FAULTSIM_PRECOMPILE "Compile against precompiled headers: less work from nothing, more after a change" OFF)

add_library(faultsim_options INTERFACE)
target_compile_features(faultsim_options INTERFACE cxx_std_20)
target_compile_options(faultsim_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor
  -Wno-restrict       # GCC 12 warns wrongly on string + string (GCC bug 105651); drop with GCC 13
  $<$<BOOL:${CMAKE_UNITY_BUILD}>:-Wno-subobject-linkage>   # takes sources for headers there
  -ffp-contract=off   # no silent FMA: one cause of differing digits less
  $<$<AND:$<BOOL:${FAULTSIM_WERROR}>,$<NOT:$<BOOL:${FAULTSIM_PRECOMPILE}>>>:-Werror>)

# faultsim_precompile(target kind): compiles target against the headers that most units include, of its kind, which are
# its optimisation and whether it is a test: library, text (no numbers, not optimised under the sanitizers), shell
# (commands and pictures, which nobody waits for: -Og compiles in half of -O3's time), test, text_test, whole_test
# (optimised as the library).
# All but tests are position independent, for the Python module and shared libraries of others; calls within a unit
# stay direct (decision 28).
function(faultsim_precompile target kind)
  if(NOT kind MATCHES "test$|test_")
    target_compile_options(${target} PRIVATE -fPIC -fno-semantic-interposition)
  endif()
  if(kind MATCHES "text|shell")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Debug>:-O0>)
    if(CMAKE_BUILD_TYPE STREQUAL Debug)   # kinds of the same flags are one
      string(REPLACE shell text kind ${kind})
    else()
      string(REPLACE text library kind ${kind})
      string(REPLACE library_test test kind ${kind})
    endif()
  endif()
  if(kind STREQUAL shell)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og> -Wno-maybe-uninitialized)
  endif()
  if(NOT FAULTSIM_PRECOMPILE)
    return()
  endif()
  set(headers faultsim_headers_${kind})
  if(NOT TARGET ${headers})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/headers.cc CONTENT "")
    add_library(${headers} STATIC EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/headers.cc)
    set(names <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory> <numeric> <optional> <set>
        <span> <sstream> <string> <unordered_map> <vector> <Eigen/Core> <Eigen/Geometry> <nlohmann/json.hpp>)
    target_link_libraries(${headers} PRIVATE faultsim_options Eigen3::Eigen nlohmann_json::nlohmann_json)
    if(kind MATCHES "test")
      list(APPEND names <random> <Eigen/Dense> <gmock/gmock.h> <gtest/gtest.h>)
      target_link_libraries(${headers} PRIVATE GTest::gmock)
    endif()
    target_compile_options(${headers} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_OPTIONS>)
    target_precompile_headers(${headers} PRIVATE ${names})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
  # Headers of the system count as ours there, and GCC 12's false alarms on their strings (bug 105651) with them, so
  # that only builds without, as Release in check --full, stop at warnings. Its collector frees little in a minute.
  target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread
                         "SHELL:--param ggc-min-heapsize=1048576")
endfunction()

# faultsim_library(name [TEXT | SHELL] SOURCES ... PUBLIC deps ... PRIVATE deps ...): one module of the simulator.
function(faultsim_library name)
  cmake_parse_arguments(ARG "TEXT;SHELL" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(faultsim_${name} STATIC ${ARG_SOURCES})
  add_library(faultsim::${name} ALIAS faultsim_${name})
  set_target_properties(faultsim_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(faultsim_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(faultsim_${name} PUBLIC ${ARG_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:faultsim_options> ${ARG_PRIVATE})
  if(ARG_SHELL)
    faultsim_precompile(faultsim_${name} shell)
  elseif(ARG_TEXT)
    faultsim_precompile(faultsim_${name} text)
  else()
    faultsim_precompile(faultsim_${name} library)
  endif()
endfunction()

# faultsweep_library(name [SHELL] ...): the same for a module of the campaign manager, all of them text.
function(faultsweep_library name)
  cmake_parse_arguments(ARG "SHELL" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(faultsweep_${name} STATIC ${ARG_SOURCES})
  add_library(faultsweep::${name} ALIAS faultsweep_${name})
  target_include_directories(faultsweep_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(faultsweep_${name} PUBLIC ${ARG_PUBLIC} PRIVATE faultsim_options ${ARG_PRIVATE})
  if(ARG_SHELL)
    faultsim_precompile(faultsweep_${name} shell)
  else()
    faultsim_precompile(faultsweep_${name} text)
  endif()
endfunction()

# All unit tests, without the binaries and the tests of whole runs: what the sanitizers build.
add_custom_target(unit_tests)

# A test program runs for a second and starts for half of one under the sanitizers: as one test of ctest, which
# starts the longest first (cost: seconds). A failure names its test in the output.
function(faultsim_add_test_program target label cost)
  add_test(NAME ${target} COMMAND ${target} --gtest_filter=-*Slow* --gtest_brief=1)
  set_tests_properties(${target} PROPERTIES LABELS ${label} TIMEOUT 600 COST ${cost})
endfunction()

# faultsim_test(target label [COST s] SOURCES ... LIBS ...): one GoogleTest binary; label is unit,
# stress, verification, regression or campaign. Tests whose name contains "Slow" get the label slow instead.
# COST: about how many seconds it takes, if many.
function(faultsim_test target label)
  cmake_parse_arguments(ARG "" "COST" "SOURCES;LIBS" ${ARGN})
  if(NOT ARG_COST)
    set(ARG_COST 1)
  endif()
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE faultsim_options ${ARG_LIBS} GTest::gmock GTest::gtest_main)
  # Not timed, half of all code, mostly templates: -Og compiles in half of the time of -O3.
  set(kind whole_test)
  if(label MATCHES "unit|campaign")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>
                           -Wno-maybe-uninitialized)   # false alarms in Eigen below -O2
    set(kind test)
    if(ARG_LIBS MATCHES "faultsweep::|^faultsim::(reading|figure|case_figures)$")
      set(kind text_test)
    endif()
  endif()
  faultsim_precompile(${target} ${kind})
  target_compile_definitions(${target} PRIVATE FAULTSIM_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             FAULTSIM_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(label STREQUAL unit)
    add_dependencies(unit_tests ${target})
    if(NOT FAULTSIM_UNIT_TESTS)
      set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
      return()
    endif()
  endif()
  if(FAULTSIM_TEST_PROGRAMS)
    faultsim_add_test_program(${target} ${label} ${ARG_COST})
    return()
  endif()
  gtest_discover_tests(${target} TEST_FILTER "-*Slow*" PROPERTIES LABELS ${label} TIMEOUT 600 COST ${ARG_COST}
                       DISCOVERY_TIMEOUT 120)
  gtest_discover_tests(${target} TEST_FILTER "*Slow*" TEST_SUFFIX .slow
                       PROPERTIES LABELS slow TIMEOUT 3600 DISCOVERY_TIMEOUT 120)
endfunction()
