# cmake -DBUILD=… -DSOURCE=… -DCXX=… -P run.cmake: installs BUILD into a scratch prefix, then configures,
# builds and runs the projects in SOURCE against it.
set(scratch ${BUILD}/consumer)
file(REMOVE_RECURSE ${scratch})
set(ENV{DESTDIR} "")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${scratch}/prefix)
run(${scratch}/prefix/bin/carom --version)
if(EXISTS ${scratch}/prefix/include/carom/maps)
  message(FATAL_ERROR "the maps are installed")
endif()
# No path of the machine that built it may stand in the package.
file(GLOB package_files ${scratch}/prefix/lib*/cmake/carom/*.cmake ${scratch}/prefix/lib*/*/cmake/carom/*.cmake)
if(NOT package_files)
  message(FATAL_ERROR "no package files")
endif()
foreach(file IN LISTS package_files)
  file(READ ${file} text)
  string(FIND "${text}" "${BUILD}" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${file} names the build folder")
  endif()
endforeach()

foreach(project consumer consumer_geometry)
  string(REGEX REPLACE "consumer_?" "" folder ${project})
  run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE}/${folder} -B ${scratch}/${project} -DCMAKE_PREFIX_PATH=${scratch}/prefix
      -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${FLAGS})
  run(${CMAKE_COMMAND} --build ${scratch}/${project})
  run(${CMAKE_CTEST_COMMAND} --test-dir ${scratch}/${project} --output-on-failure --no-tests=error)
endforeach()
