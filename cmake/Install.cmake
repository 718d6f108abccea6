# find_package(sunder): targets sunder::engine, sunder::fracture and so on, one a room.

include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/sunder)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sunderConfig.cmake.in
  ${PROJECT_BINARY_DIR}/sunderConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sunderConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sunderConfig.cmake
  ${PROJECT_BINARY_DIR}/sunderConfigVersion.cmake DESTINATION ${package_dir})
install(EXPORT sunderTargets NAMESPACE sunder:: DESTINATION ${package_dir})
