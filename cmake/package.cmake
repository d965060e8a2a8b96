# Debian packages, one for each component of the installation. ./dev release makes them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME carom)
set(CPACK_PACKAGE_VENDOR "The Carom developers")
set(CPACK_PACKAGE_CONTACT "The Carom developers")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")  # the first line of each package
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
cmake_host_system_information(RESULT system QUERY DISTRIB_VERSION_ID)  # each Debian has libraries of its own
if(system)
  set(CPACK_DEBIAN_PACKAGE_RELEASE 1~deb${system})
endif()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENTS_ALL program library)

# The package of what is opened late, which nothing that is linked tells of.
set(opened_late)
if(CAROM_DEBIAN AND CAROM_LATE_FLINT)
  file(REAL_PATH ${CAROM_LATE_FLINT} late_file)
  cmake_path(GET late_file FILENAME late_file)
  execute_process(COMMAND dpkg-query -S "*/${late_file}" OUTPUT_VARIABLE late_package COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE ":.*" "" opened_late "${late_package}")
endif()

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME carom)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${opened_late}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-carom, python3-matplotlib, libcarom-dev")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "Billiards with and without a magnetic field, potentials and interactions.
Every decision between walls is exact; ensembles repeat bit for bit.
.
The package has the program carom, its man pages and documents, the scripts
of the gallery (they need python3-carom) and examples in C++ (they need
libcarom-dev).")

# The libraries are static: whoever links them needs what find_package(carom) looks for.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libcarom-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(library_needs libflint-dev libfmt-dev libgmp-dev libgsl-dev libhdf5-dev libisal-dev libmpfr-dev libsundials-dev
  libtomlplusplus-dev zlib1g-dev)
if(ARB_LIBRARY)
  list(PREPEND library_needs libflint-arb-dev)
endif()
string(JOIN ", " CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS ${library_needs})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS carom)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "Headers, carom::carom and carom::geometry, found by find_package(carom).")

if(CAROM_BUILD_PYTHON)
  find_package(Python 3.9 REQUIRED COMPONENTS Interpreter)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-carom)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The module is compiled for one minor version of Python.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3-numpy, python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~), \
python3 (<< ${Python_VERSION_MAJOR}.${next_minor}~)")
  if(opened_late)
    string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", ${opened_late}")
  endif()
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-matplotlib)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "carom, python3-h5py, python3-pandas, python3-tqdm")
  # Python's compiled files are made and removed with the package.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/debian/postinst;\
${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The module carom computes with the code of the program carom and draws
pictures by matplotlib.")
endif()

if(CAROM_DEBIAN)
  set(ENV{LC_ALL} C)
  string(TIMESTAMP release_date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, if it is set
  configure_file(cmake/debian/changelog.in changelog @ONLY)
  execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)
  foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    string(TOUPPER ${component} name)
    install(FILES cmake/debian/copyright ${PROJECT_BINARY_DIR}/changelog.gz COMPONENT ${component}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${name}_PACKAGE_NAME})
  endforeach()
endif()
include(CPack)
