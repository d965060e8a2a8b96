# What the program is built with, and the versions that it has been built with: Debian 12's, the oldest, to Debian 13's.
find_package(CGAL 5.5 REQUIRED)
find_package(HDF5 1.10.5 REQUIRED COMPONENTS C)
add_compile_definitions(H5_USE_110_API)  # in 1.12 and later functions and structs have other forms
find_package(fmt 9 REQUIRED)
# With -stdlib=libc++ on Linux, whose packages are made with GCC's library of C++, those of fmt, toml++ and GoogleTest
# cannot be linked: their headers hold all, and GoogleTest is compiled.
set(CAROM_FMT fmt::fmt)
set(CAROM_TOML tomlplusplus::tomlplusplus)
if(CMAKE_CXX_FLAGS MATCHES "-stdlib=libc[+][+]" AND NOT APPLE)
  set(CAROM_FOREIGN_LIBRARY ON)
  set(CAROM_FMT fmt::fmt-header-only)
  set(CAROM_TOML)
  add_compile_definitions(_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION)  # for Boost before 1.81
endif()
find_path(FAST_FLOAT_INCLUDE_DIR fast_float/fast_float.h)  # for libraries of C++ that read no doubles: libc++ before 20
if(FAST_FLOAT_INCLUDE_DIR)
  include_directories(SYSTEM ${FAST_FLOAT_INCLUDE_DIR})
endif()
find_package(CLI11 2.1 REQUIRED)
find_package(tomlplusplus 3.3 REQUIRED)
find_package(SUNDIALS REQUIRED COMPONENTS arkode cvode nvecserial)
find_package(GSL 2.7 REQUIRED)
find_package(ZLIB REQUIRED)
find_library(ISAL_LIBRARY isal)  # makes archives quicker; without it zlib does
find_path(ISAL_INCLUDE_DIR isa-l/igzip_lib.h)
find_package(OpenMP REQUIRED COMPONENTS CXX)
if(CAROM_USE_MPI)
  find_package(MPI QUIET COMPONENTS CXX)
endif()
find_library(GMP_LIBRARY gmp REQUIRED)
find_library(GMPXX_LIBRARY gmpxx REQUIRED)
find_library(MPFR_LIBRARY mpfr REQUIRED)
# Arb is part of FLINT from 3 on; before, a library of its own.
find_path(ARB_INCLUDE_DIR arb.h PATH_SUFFIXES flint REQUIRED)
include_directories(SYSTEM ${ARB_INCLUDE_DIR})
find_library(FLINT_LIBRARY flint REQUIRED)
find_library(ARB_LIBRARY NAMES flint-arb arb)
set(FLINT_LIBRARIES ${FLINT_LIBRARY})
if(ARB_LIBRARY)
  list(PREPEND FLINT_LIBRARIES ${ARB_LIBRARY})
endif()
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
find_path(HIGHWAY_INCLUDE_DIR hwy/highway.h REQUIRED)

# Packages that do not say their version, or whose file of it refuses every other major one.
function(carom_at_least name version least)
  if(version VERSION_LESS least)
    message(FATAL_ERROR "${name} ${version} is too old: Carom needs ${least} or newer")
  endif()
endfunction()
carom_at_least(SUNDIALS "${SUNDIALS_VERSION}" 6.4)
set(highway_lines)
foreach(header highway.h base.h)  # where 1.0 and 1.2 have it
  file(STRINGS ${HIGHWAY_INCLUDE_DIR}/hwy/${header} lines REGEX "#define HWY_(MAJOR|MINOR) [0-9]+")
  list(APPEND highway_lines ${lines})
endforeach()
string(REGEX REPLACE "#define HWY_MAJOR ([0-9]+);#define HWY_MINOR ([0-9]+)" "\\1.\\2" highway_version "${highway_lines}")
carom_at_least(Highway "${highway_version}" 1.0)
