# find_package(faultsim): the target faultsim::simulation, and what its static libraries are linked with.
include(CMakeFindDependencyMacro)
set(HDF5_PREFER_PARALLEL OFF)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(nlohmann_json 3.11)
find_dependency(HDF5 1.10.5 COMPONENTS C)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/plain_libraries.cmake)   # CHOLMOD METIS UDUNITS2 OpenBLAS OPM
include(${CMAKE_CURRENT_LIST_DIR}/faultsim-targets.cmake)
