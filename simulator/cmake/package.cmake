# cpack --config BUILD/CPackConfig.cmake: one package for Debian 12 with all that cmake --install puts.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME faultsim)
set(CPACK_PACKAGE_CONTACT "Authors of faultsim <faultsim@faultsim.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulator of fault reactivation and campaigns of its cases")
set(CPACK_PACKAGE_DESCRIPTION "faultsim simulates how faults of a gas reservoir stick, slip and open as its
pressure changes: finite elements condensed onto the faults, contact with
friction and slip weakening. faultsweep runs thousands of cases and ranks them.
This package has both programs, the library in C++ and the module for Python.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/simulator/cmake/compress_pages.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "openmpi-bin")   # mpirun, which faultsweep starts
if(TARGET faultsim_python)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS
         ", python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3-pandas)
endif()
# Programs of others against the library; PNG and PDF; meshes.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, libeigen3-dev, libsuitesparse-dev, libmetis-dev, libopenblas-dev, libhdf5-dev, \
nlohmann-json3-dev, libudunits2-dev, libopm-common-dev, librsvg2-bin, chromium, gmsh")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/simulator/cmake/debian/postinst
    ${PROJECT_SOURCE_DIR}/simulator/cmake/debian/prerm)
set(debian ${PROJECT_BINARY_DIR}/debian)
configure_file(simulator/cmake/debian/changelog.in ${debian}/changelog @ONLY)
add_custom_command(OUTPUT ${debian}/changelog.gz DEPENDS ${debian}/changelog
  COMMAND gzip -9n <${debian}/changelog >${debian}/changelog.gz)
add_custom_target(package_documents ALL DEPENDS ${debian}/changelog.gz)
install(FILES ${debian}/changelog.gz simulator/cmake/debian/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
include(CPack)
