# Writes the file OUT, which defines the commit of the sources: COMMIT if it is given, otherwise that of
# the checkout in FOLDER, with "+changes" if a source differs from it, or "unknown". The file is only
# written if its content changes, so that a build compiles nothing else.
set(commit "${COMMIT}")
if(NOT commit AND GIT AND EXISTS ${FOLDER}/.git)
  execute_process(COMMAND ${GIT} rev-parse --short=12 HEAD WORKING_DIRECTORY ${FOLDER}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0
    ${GIT} diff --quiet HEAD -- CMakeLists.txt cmake engine fracture solver render scenes
    WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE differs ERROR_QUIET OUTPUT_QUIET)
  if(commit AND differs EQUAL 1)
    string(APPEND commit +changes)
  endif()
endif()
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#include "scenes/app/build_info.h"
const char* const sunder::app::kCommit = "@commit@";
]])
