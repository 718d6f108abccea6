# Debian packages by `cpack`, of the preset `package`: sunder, libsunder0, libsunder-dev and
# python3-sunder. tests/package/package.sh builds and checks them.

# The default address is no mailbox: .invalid is reserved for such use.
set(SUNDER_MAINTAINER "The Sunder authors <sunder@sunder.invalid>" CACHE STRING
  "Maintainer of the packages")
set(components program library dev)
set(package_program sunder)
get_target_property(SUNDER_C_SOVERSION sunder_c SOVERSION)
set(package_library libsunder${SUNDER_C_SOVERSION})
set(package_dev libsunder-dev)
if(TARGET sunder_python)
  list(APPEND components python)
  set(package_python python3-sunder)
endif()

# What Debian wants in every package: the license, and the changes, compressed.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
foreach(component ${components})
  set(package ${package_${component}})
  set(doc ${PROJECT_BINARY_DIR}/doc/${package})
  file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
  file(WRITE ${doc}/copyright "Sunder, a rigid-body destruction simulator.\n\n${license}")
  file(WRITE ${doc}/changelog.Debian "sunder (${PROJECT_VERSION}-1) unstable; urgency=medium\n\n\
  * Version ${PROJECT_VERSION}, as CHANGELOG.md in the sources describes it.\n\n\
 -- ${SUNDER_MAINTAINER}  ${date}\n")
  execute_process(COMMAND gzip -9nf ${doc}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${doc}/copyright ${doc}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sunder)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has a description of its own
set(CPACK_PACKAGE_VENDOR "The Sunder authors")
set(CPACK_PACKAGE_CONTACT "${SUNDER_MAINTAINER}")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(text "Sunder breaks walls, houses and meshes into convex pieces where they are\n\
struck, moves the pieces, and draws them.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME ${package_program})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS ffmpeg)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "simulate and render destruction: program and scenes\n${text}\n\
This package has the program, its scenes and the pictures for its tests.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${package_library})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(control ${PROJECT_BINARY_DIR}/control)
file(WRITE ${control}/shlibs
  "libsunder ${SUNDER_C_SOVERSION} ${package_library} (>= ${PROJECT_VERSION})\n")
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${control}/shlibs ${control}/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS sunder)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
  "simulate destruction: shared library\n${text}\n\
This package has the shared library with the C interface.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME ${package_dev})
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${package_library} (= ${PROJECT_VERSION}-1), \
libeigen3-dev, libbox2d-dev, libzstd-dev, libxxhash-dev, nlohmann-json3-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS sunder)
set(CPACK_COMPONENT_DEV_DESCRIPTION
  "simulate destruction: headers and static libraries\n${text}\n\
This package has what programs in C and C++ are built with.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sunder)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
execute_process(COMMAND ${SUNDER_PYTHON} -c
  "import sys; v, w = sys.version_info[:2]; print(f'python3 (>= {v}.{w}), python3 (<< {v}.{w + 1})')"
  OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3-numpy, ${python}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "sunder, libegl1, libgl1-mesa-dri")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
  "simulate destruction: Python module\n${text}\n\
This package has the module for Python 3.")
include(CPack)
