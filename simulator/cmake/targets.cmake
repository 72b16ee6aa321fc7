# The compile rules of every target of ours, once.
option(FAULTSIM_WERROR "Treat warnings as errors" OFF)
add_library(faultsim_options INTERFACE)
target_compile_features(faultsim_options INTERFACE cxx_std_20)
target_compile_options(faultsim_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor
  -Wno-restrict       # GCC 12 warns wrongly on string + string (GCC bug 105651); drop with GCC 13
  $<$<BOOL:${CMAKE_UNITY_BUILD}>:-Wno-subobject-linkage>   # takes sources for headers there
  -ffp-contract=off   # no silent FMA: one cause of differing digits less
  $<$<BOOL:${FAULTSIM_WERROR}>:-Werror>)

# faultsim_library(name SOURCES ... PUBLIC deps ... PRIVATE deps ...): one module of the simulator.
function(faultsim_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(faultsim_${name} STATIC ${ARG_SOURCES})
  add_library(faultsim::${name} ALIAS faultsim_${name})
  set_target_properties(faultsim_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(faultsim_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(faultsim_${name} PUBLIC ${ARG_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:faultsim_options> ${ARG_PRIVATE})
endfunction()

# faultsweep_library(...): the same for a module of the campaign manager.
function(faultsweep_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(faultsweep_${name} STATIC ${ARG_SOURCES})
  add_library(faultsweep::${name} ALIAS faultsweep_${name})
  target_include_directories(faultsweep_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(faultsweep_${name} PUBLIC ${ARG_PUBLIC} PRIVATE faultsim_options ${ARG_PRIVATE})
endfunction()

# All unit tests, without the binaries and the tests of whole runs: what the sanitizers build.
add_custom_target(unit_tests)

# faultsim_test(target label SOURCES ... LIBS ...): one GoogleTest binary; label is unit,
# stress, verification, regression or campaign. Tests whose name contains "Slow" get the label slow instead.
function(faultsim_test target label)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE faultsim_options ${ARG_LIBS} GTest::gmock GTest::gtest_main)
  # Not timed, half of all code, mostly templates: -O1 compiles in two thirds of -O3's time.
  if(label MATCHES "unit|campaign")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>
                           -Wno-maybe-uninitialized)   # false alarms in Eigen below -O2
  endif()
  if(label STREQUAL unit)
    add_dependencies(unit_tests ${target})
  endif()
  target_compile_definitions(${target} PRIVATE FAULTSIM_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             FAULTSIM_BINARY_DIR="${PROJECT_BINARY_DIR}")
  gtest_discover_tests(${target} TEST_FILTER "-*Slow*" PROPERTIES LABELS ${label} TIMEOUT 600
                       DISCOVERY_TIMEOUT 120)
  gtest_discover_tests(${target} TEST_FILTER "*Slow*" TEST_SUFFIX .slow
                       PROPERTIES LABELS slow TIMEOUT 3600 DISCOVERY_TIMEOUT 120)
endfunction()
