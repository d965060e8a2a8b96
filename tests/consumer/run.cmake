# cmake -DBUILD=… -DSOURCE=… -DCXX=… -P run.cmake: installs BUILD into a scratch prefix, then configures, builds and
# runs the installed examples and the project in SOURCE/geometry against it.
set(scratch ${BUILD}/consumer)
file(REMOVE_RECURSE ${scratch})
set(ENV{DESTDIR} "")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${scratch}/prefix)
run(${scratch}/prefix/bin/carom --version)
run(${scratch}/prefix/bin/carom run circle --precision certified --digits 30 --quiet)
if(EXISTS ${scratch}/prefix/include/carom/maps)
  message(FATAL_ERROR "the maps are installed")
endif()
if(EXISTS ${BUILD}/man)  # where help2man was
  set(man_pages share/man/man1/carom.1 share/man/man1/carom-escape.1)
endif()
foreach(file ${man_pages} share/bash-completion/completions/carom share/zsh/site-functions/_carom
    share/doc/carom/LICENSE share/doc/carom/CITATION.cff share/doc/carom/docs/guide/commands.md
    share/doc/carom/docs/guide/gallery/mushroom.py)
  if(NOT EXISTS ${scratch}/prefix/${file})
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()
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

foreach(project ${scratch}/prefix/share/doc/carom/examples ${SOURCE}/geometry)
  get_filename_component(name ${project} NAME)
  run(${CMAKE_COMMAND} -G Ninja -S ${project} -B ${scratch}/${name} -DCMAKE_PREFIX_PATH=${scratch}/prefix
      -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${FLAGS})
  run(${CMAKE_COMMAND} --build ${scratch}/${name})
  run(${CMAKE_CTEST_COMMAND} --test-dir ${scratch}/${name} --output-on-failure --no-tests=error)
endforeach()
