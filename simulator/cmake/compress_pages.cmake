# Run by cpack: manual pages are compressed in Debian's packages, without the time.
file(GLOB_RECURSE pages ${CPACK_TEMPORARY_DIRECTORY}/*.1)
if(NOT pages)
  message(FATAL_ERROR "no manual pages below ${CPACK_TEMPORARY_DIRECTORY}")
endif()
execute_process(COMMAND gzip -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
