# Installation: two libraries, their headers, the program, find_package(carom).
include(CMakePackageConfigHelpers)
install(TARGETS carom_geometry carom carom_program EXPORT carom-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The maps are a witness for the tests: neither their header nor their library is installed.
install(DIRECTORY include/ geometry/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  PATTERN maps EXCLUDE)
install(EXPORT carom-targets NAMESPACE carom:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
configure_package_config_file(cmake/carom-config.cmake.in ${PROJECT_BINARY_DIR}/carom-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/carom-config-version.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/carom-config.cmake
              ${PROJECT_BINARY_DIR}/carom-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
