# Debian 12 ships these without a CMake package; each becomes a target NAME::NAME, or the error says what is missing.
# plain_library(NAME header library [folders of the header ...])
function(plain_library name header library)
  find_path(${name}_INCLUDE_DIR ${header} PATH_SUFFIXES ${ARGN})
  find_library(${name}_LIBRARY ${library})
  if(NOT ${name}_INCLUDE_DIR OR NOT ${name}_LIBRARY)
    message(FATAL_ERROR "${name}: ${header} or lib${library} not found; simulator/cmake/packages.sh lists the packages")
  endif()
  add_library(${name}::${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(${name}::${name} PROPERTIES
    IMPORTED_LOCATION ${${name}_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${${name}_INCLUDE_DIR})
endfunction()

# The same of one that is not needed: without it there is no target.
function(optional_plain_library name header library)
  find_path(${name}_INCLUDE_DIR ${header} PATH_SUFFIXES ${ARGN})
  find_library(${name}_LIBRARY ${library})
  if(${name}_INCLUDE_DIR AND ${name}_LIBRARY)
    plain_library(${name} ${header} ${library} ${ARGN})
  endif()
endfunction()

plain_library(CHOLMOD cholmod.h cholmod suitesparse)
plain_library(METIS metis.h metis)
plain_library(UDUNITS2 udunits2.h udunits2)
# By name and not as "BLAS": its threads and kernel are read and set (openblas_set_num_threads).
plain_library(OpenBLAS openblas_config.h openblas x86_64-linux-gnu/openblas-pthread x86_64-linux-gnu
              aarch64-linux-gnu/openblas-pthread openblas openblas-pthread)
optional_plain_library(OPM opm/io/eclipse/EGrid.hpp opmcommon)   # EGRID and restart files
