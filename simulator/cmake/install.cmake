# cmake --install BUILD --prefix DIR: the programs, their manual pages (from --help), completion for bash, schemas, documents.
include(GNUInstallDirs)
set(manual ${PROJECT_BINARY_DIR}/manual)
set(pages "")
foreach(program faultsim faultsim-verify faultsweep)
  add_custom_command(OUTPUT ${manual}/${program}.1 DEPENDS ${program} ${PROJECT_SOURCE_DIR}/simulator/cmake/make_manual
    COMMAND ${PROJECT_SOURCE_DIR}/simulator/cmake/make_manual $<TARGET_FILE:${program}> ${manual}/${program}.1)
  list(APPEND pages ${manual}/${program}.1)
endforeach()
add_custom_target(manual ALL DEPENDS ${pages})
install(TARGETS faultsim faultsim-verify faultsweep RUNTIME)
install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
foreach(program faultsim faultsweep)
  install(FILES ${PROJECT_SOURCE_DIR}/simulator/cmake/completion.bash
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
endforeach()
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN performance.md EXCLUDE)
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY schemas/ DESTINATION ${CMAKE_INSTALL_DATADIR}/faultsim/schemas)

# The library: find_package(faultsim), faultsim::simulation. Its headers stand as they include each other, below a
# folder of the project's name; those of modules that the public one does not need stay out.
set(library_modules common documents scene initial_state reading mesh laws linalg model result files hdf5 cache result_files elasticity condensation contact plan flow gmsh horizons loads
    operators measures loading surface simulation)
list(TRANSFORM library_modules PREPEND faultsim_ OUTPUT_VARIABLE library_targets)
install(TARGETS ${library_targets} EXPORT faultsim COMPONENT library
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/faultsim)
target_include_directories(faultsim_simulation INTERFACE
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/faultsim>)
target_compile_features(faultsim_simulation INTERFACE cxx_std_20)
install(FILES simulator/simulation/simulation.h COMPONENT library DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/faultsim)
foreach(header common/errors common/words common/run_context common/units contact/search_record cache/cache_policy loading/run_watch model/fault_geometry
        model/fault_profile result/field result/measures result/result)
  get_filename_component(module ${header} DIRECTORY)
  install(FILES simulator/${header}.h COMPONENT library
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/faultsim/simulator/${module})
endforeach()
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/faultsim)
install(EXPORT faultsim NAMESPACE faultsim:: COMPONENT library DESTINATION ${package_folder} FILE faultsim-targets.cmake)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/faultsim-config-version.cmake COMPATIBILITY ExactVersion)
install(FILES ${PROJECT_BINARY_DIR}/faultsim-config-version.cmake simulator/cmake/faultsim-config.cmake
              simulator/cmake/plain_libraries.cmake
        COMPONENT library DESTINATION ${package_folder})
