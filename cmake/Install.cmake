# Installs the package for find_package(sunder), with the target sunder::sunder, for users of
# #include <sunder/sunder.h>, and the target sunder::c, for users of #include <sunder/sunder_c.h>.
# The first links the libraries of the modules, the second the shared library alone:
# find_package(sunder COMPONENTS c) needs nothing else. Only the headers listed here are installed.

include(CMakePackageConfigHelpers)

set(public_headers
  engine/base/check.h
  engine/base/loop_times.h
  engine/base/types.h
  engine/geometry/convex_polyhedron.h
  engine/geometry/hull.h
  engine/io/state_hash.h
  engine/io/statistics.h
  engine/io/recording/recording.h
  engine/model/collision_filter.h
  engine/model/compound.h
  engine/model/energy.h
  engine/model/frame.h
  engine/model/joint.h
  engine/model/limits_hit.h
  engine/model/material.h
  engine/model/path.h
  engine/model/scene.h
  engine/model/work.h
  engine/world/world.h
  render/image/image.h
  render/renderer.h
  render/sinks.h
  scenes/api/sunder_c.h
  scenes/file/make_compound.h
  scenes/load.h
  scenes/make_simulation.h
  scenes/sunder.h)

# Users may have folders named engine/ too, so the headers are installed in one folder, sunder/, and
# include each other from there.
set(public_folder ${PROJECT_BINARY_DIR}/include/sunder)
foreach(header ${public_headers})
  cmake_path(GET header FILENAME name)
  file(READ ${PROJECT_SOURCE_DIR}/${header} text)
  string(REGEX REPLACE "#include \"[a-z_/]*/([a-z_]+\\.h)\"" "#include <sunder/\\1>" text "${text}")
  file(CONFIGURE OUTPUT ${public_folder}/${name} CONTENT "@text@" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
  install(FILES ${public_folder}/${name} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sunder)
endforeach()

add_library(sunder_library INTERFACE)
add_library(sunder::sunder ALIAS sunder_library)
target_include_directories(sunder_library INTERFACE
  $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(sunder_library INTERFACE sunder_scenes sunder_render)
set_target_properties(sunder_library PROPERTIES EXPORT_NAME sunder)
install(TARGETS sunder_library EXPORT sunderTargets)
install(TARGETS sunder_c EXPORT sunderCTargets LIBRARY COMPONENT library NAMELINK_COMPONENT dev)
file(RELATIVE_PATH prefix_from_pkgconfig
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/cmake/sunder.pc.in ${PROJECT_BINARY_DIR}/sunder.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/sunder.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/golden
  DESTINATION ${CMAKE_INSTALL_DATADIR}/sunder COMPONENT program
  FILES_MATCHING PATTERN "*.frame" PATTERN "*.glb" PATTERN "*.json" PATTERN "*.png" PATTERN "*.toml" PATTERN "*.txt"
  PATTERN "*.view")

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)
set(scenes_dir ${CMAKE_INSTALL_DATADIR}/sunder/scenes)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sunderConfig.cmake.in
  ${PROJECT_BINARY_DIR}/sunderConfig.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS scenes_dir)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sunderConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sunderConfig.cmake
  ${PROJECT_BINARY_DIR}/sunderConfigVersion.cmake DESTINATION ${package_dir})
install(EXPORT sunderTargets NAMESPACE sunder:: DESTINATION ${package_dir})
install(EXPORT sunderCTargets NAMESPACE sunder:: DESTINATION ${package_dir})
