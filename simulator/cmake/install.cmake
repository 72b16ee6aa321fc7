# cmake --install BUILD --prefix DIR: the programs, their manual pages (from --help), completion for bash, schemas, documents.
include(GNUInstallDirs)
set(manual ${PROJECT_BINARY_DIR}/manual)
set(pages "")
foreach(program faultsim faultsweep)
  add_custom_command(OUTPUT ${manual}/${program}.1 DEPENDS ${program} ${PROJECT_SOURCE_DIR}/simulator/cmake/make_manual
    COMMAND ${PROJECT_SOURCE_DIR}/simulator/cmake/make_manual $<TARGET_FILE:${program}> ${manual}/${program}.1)
  list(APPEND pages ${manual}/${program}.1)
endforeach()
add_custom_target(manual ALL DEPENDS ${pages})
install(TARGETS faultsim faultsweep RUNTIME)
install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
foreach(program faultsim faultsweep)
  install(FILES ${PROJECT_SOURCE_DIR}/simulator/cmake/completion.bash
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
endforeach()
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN performance.md EXCLUDE)
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY schemas/ DESTINATION ${CMAKE_INSTALL_DATADIR}/faultsim/schemas)
