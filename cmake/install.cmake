# Installation: the program, two libraries with their headers, find_package(carom), the Python module, documents.
# Components: program, library, python; each is a Debian package (package.cmake).
include(CMakePackageConfigHelpers)
set(carom_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/carom)

install(TARGETS carom_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
if(TARGET carom_mpi)
  install(TARGETS carom_mpi RUNTIME DESTINATION libexec/carom COMPONENT program)
endif()

# Two export sets, so that a project that uses geometry alone needs none of the other packages.
install(TARGETS carom_geometry EXPORT carom-geometry-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(TARGETS carom EXPORT carom-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
foreach(set carom-geometry-targets carom-targets)
  install(EXPORT ${set} NAMESPACE carom:: DESTINATION ${carom_package_dir} COMPONENT library)
endforeach()

install(DIRECTORY include/ geometry/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)

configure_package_config_file(cmake/carom-config.cmake.in ${PROJECT_BINARY_DIR}/carom-config.cmake
  INSTALL_DESTINATION ${carom_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/carom-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/carom-config.cmake
              ${PROJECT_BINARY_DIR}/carom-config-version.cmake
  DESTINATION ${carom_package_dir} COMPONENT library)

# Man pages and completions. Debian's are compressed.
set(carom_zsh_dir ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
set(carom_man_pattern "*.1")
if(CAROM_DEBIAN)
  set(carom_zsh_dir ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
  set(carom_man_pattern "*.1.gz")
endif()
if(TARGET man_pages)
  install(DIRECTORY ${man_pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program
    FILES_MATCHING PATTERN ${carom_man_pattern})
endif()
install(FILES cmake/completion/carom DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES cmake/completion/_carom DESTINATION ${carom_zsh_dir} COMPONENT program)

# Documents; the gallery is a part of the guide.
install(FILES LICENSE CITATION.cff CHANGELOG.md README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs/guide docs/physics docs/developer DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT program)
install(FILES build/page/carom.html DESTINATION ${CMAKE_INSTALL_DATADIR}/carom COMPONENT program OPTIONAL)  # where ./dev page was run
install(DIRECTORY build/docs/html DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program OPTIONAL)  # where ./dev docs was run
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
