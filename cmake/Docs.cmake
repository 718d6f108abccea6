# The target docs_html: the reference of the public headers, by Doxygen, in docs/ of the build
# folder. A warning of Doxygen is an error.

find_program(SUNDER_DOXYGEN doxygen)
if(SUNDER_DOXYGEN)
  list(TRANSFORM public_headers PREPEND "${PROJECT_SOURCE_DIR}/" OUTPUT_VARIABLE doxygen_input)
  list(JOIN doxygen_input " " doxygen_input)
  configure_file(cmake/Doxyfile.in Doxyfile @ONLY)
  add_custom_target(docs_html COMMAND ${SUNDER_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
    COMMENT "Writing ${PROJECT_BINARY_DIR}/docs/index.html" VERBATIM)
else()
  message(STATUS "No doxygen: the target docs_html is left out; install the package doxygen")
endif()
