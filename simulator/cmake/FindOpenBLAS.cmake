# OpenBLAS by name: its thread count and kernel name are read and set (openblas_set_num_threads).
find_path(OPENBLAS_INCLUDE_DIR openblas_config.h PATH_SUFFIXES x86_64-linux-gnu/openblas-pthread
          x86_64-linux-gnu aarch64-linux-gnu/openblas-pthread openblas openblas-pthread)
find_library(OPENBLAS_LIBRARY openblas)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenBLAS REQUIRED_VARS OPENBLAS_LIBRARY OPENBLAS_INCLUDE_DIR)
if(OpenBLAS_FOUND AND NOT TARGET OpenBLAS::OpenBLAS)
  add_library(OpenBLAS::OpenBLAS UNKNOWN IMPORTED)
  set_target_properties(OpenBLAS::OpenBLAS PROPERTIES
    IMPORTED_LOCATION ${OPENBLAS_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${OPENBLAS_INCLUDE_DIR})
endif()
