# Executables hold GMP, MPFR, HDF5, GSL and SUNDIALS themselves where a system has their archives: at their start 8 libraries
# are loaded then, not 53. Debian's HDF5 alone brings thirty, with which it can read files in the cloud; Carom never does
# (no_cloud.c). FLINT, which has none in Debian, is opened late (late_flint.cmake). All else (the Python module, users of the installed library) takes the shared libraries.

# Sets `result` to the archives beside shared libraries, or to nothing where one of them is missing.
function(carom_archives result)
  set(archives)
  foreach(library IN LISTS ARGN)
    string(REGEX REPLACE "\\.(so|dylib)[.0-9]*$" ".a" archive "${library}")
    if(archive STREQUAL library OR NOT EXISTS ${archive})
      set(archives)
      break()
    endif()
    list(APPEND archives ${archive})
  endforeach()
  set(${result} ${archives} PARENT_SCOPE)
endfunction()

# Makes a target that is the archives for executables, if there are some, and the shared libraries for all else.
function(carom_held_by_programs name shared archives)
  add_library(${name} INTERFACE)
  if(archives)
    target_link_libraries(${name} INTERFACE "$<IF:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>,${archives},${shared}>")
  else()
    target_link_libraries(${name} INTERFACE ${shared})
  endif()
endfunction()

carom_archives(gmp_archives ${GMPXX_LIBRARY} ${MPFR_LIBRARY} ${GMP_LIBRARY})
carom_held_by_programs(carom_gmp "${GMPXX_LIBRARY};${MPFR_LIBRARY};${GMP_LIBRARY}" "${gmp_archives}")

carom_archives(zlib_archives ${ZLIB_LIBRARIES})
carom_held_by_programs(carom_zlib ZLIB::ZLIB "${zlib_archives}")
target_include_directories(carom_zlib SYSTEM INTERFACE ${ZLIB_INCLUDE_DIRS})

set(hdf5_libraries ${HDF5_C_LIBRARIES})
list(FILTER hdf5_libraries INCLUDE REGEX "/libhdf5[^/]*$")
carom_archives(hdf5_archives ${hdf5_libraries})
if(hdf5_archives)
  foreach(library sz aec)  # not everywhere of two parts
    find_library(CAROM_${library}_LIBRARY ${library})
    if(CAROM_${library}_LIBRARY)
      carom_archives(archive ${CAROM_${library}_LIBRARY})
      if(NOT archive)
        set(archive ${CAROM_${library}_LIBRARY})
      endif()
      list(APPEND hdf5_archives ${archive})
    endif()
  endforeach()
  if(zlib_archives)
    list(APPEND hdf5_archives ${zlib_archives})
  else()
    list(APPEND hdf5_archives ${ZLIB_LIBRARIES})
  endif()
  list(APPEND hdf5_archives ${CMAKE_DL_LIBS} m)
  try_compile(CAROM_HDF5_HOLDS  # another system's HDF5 may ask for more
    SOURCES ${PROJECT_SOURCE_DIR}/cmake/no_cloud.c
    SOURCE_FROM_CONTENT holds.c "#include <hdf5.h>\nint main(void) { return H5open(); }\n"
    CMAKE_FLAGS "-DINCLUDE_DIRECTORIES=${HDF5_INCLUDE_DIRS}"
    LINK_LIBRARIES ${hdf5_archives})
  if(CAROM_HDF5_HOLDS)
    add_library(carom_no_cloud STATIC cmake/no_cloud.c)
    list(INSERT hdf5_archives 1 carom_no_cloud)
  else()
    set(hdf5_archives)
  endif()
endif()
carom_held_by_programs(carom_hdf5 hdf5::hdf5 "${hdf5_archives}")
target_include_directories(carom_hdf5 SYSTEM INTERFACE ${HDF5_INCLUDE_DIRS})

carom_archives(gsl_archives ${GSL_LIBRARIES})
carom_held_by_programs(carom_gsl GSL::gsl "${gsl_archives}")

set(sundials_archives)
if(TARGET SUNDIALS::arkode_static AND TARGET SUNDIALS::cvode_static AND TARGET SUNDIALS::nvecserial_static)
  set(sundials_archives SUNDIALS::arkode_static SUNDIALS::cvode_static SUNDIALS::nvecserial_static)
endif()
set(sundials_asks)
if(TARGET SUNDIALS::core_static)
  get_target_property(sundials_asks SUNDIALS::core_static INTERFACE_LINK_LIBRARIES)
endif()
set(sundials_headers)
if(sundials_archives AND sundials_asks MATCHES "MPI::[A-Z_]+")  # a dozen libraries more, of which no function is called (no_mpi.c)
  set(with_mpi ${sundials_archives} SUNDIALS::core_static)
  list(TRANSFORM with_mpi REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE without_mpi)
  add_library(carom_no_mpi STATIC cmake/no_mpi.c)
  list(APPEND without_mpi carom_no_mpi m)
  set(sundials_headers $<TARGET_PROPERTY:${CMAKE_MATCH_0},INTERFACE_INCLUDE_DIRECTORIES>)  # its own include them
  set(sundials_archives "$<IF:$<BOOL:$<TARGET_PROPERTY:CAROM_RANKS>>,${with_mpi},${without_mpi}>")
endif()
carom_held_by_programs(carom_sundials "SUNDIALS::arkode_shared;SUNDIALS::cvode_shared;SUNDIALS::nvecserial_shared" "${sundials_archives}")
target_include_directories(carom_sundials SYSTEM INTERFACE ${sundials_headers})
