# Installation: two libraries, their headers, the program, find_package(carom).
include(CMakePackageConfigHelpers)
set(carom_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/carom)

# Two export sets, so that a project that uses geometry alone needs none of the other packages.
set_target_properties(carom_program PROPERTIES EXPORT_NAME program)
install(TARGETS carom_geometry EXPORT carom-geometry-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS carom carom_program EXPORT carom-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(set carom-geometry-targets carom-targets)
  install(EXPORT ${set} NAMESPACE carom:: DESTINATION ${carom_package_dir})
endforeach()

# The maps are a witness for the tests: neither their header nor their library is installed.
install(DIRECTORY include/ geometry/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  PATTERN maps EXCLUDE)
install(FILES LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/carom-config.cmake.in ${PROJECT_BINARY_DIR}/carom-config.cmake
  INSTALL_DESTINATION ${carom_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/carom-config-version.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/carom-config.cmake
              ${PROJECT_BINARY_DIR}/carom-config-version.cmake
  DESTINATION ${carom_package_dir})
