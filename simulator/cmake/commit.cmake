# cmake -DSOURCE=folder -DOUTPUT=header -P commit.cmake: the commit as FAULTSIM_COMMIT. Run by every build; the
# header is written only when it changes, and one small file includes it.
set(commit "unknown")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --exclude=* --abbrev=12
                  OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
  if(status EQUAL 0 AND said MATCHES "^[0-9a-f]+(-dirty)?$")
    set(commit ${said})
  endif()
endif()
set(text "#pragma once\n#define FAULTSIM_COMMIT \"${commit}\"\n")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
