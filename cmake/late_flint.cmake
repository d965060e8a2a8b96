# FLINT (with Arb) has no archives in Debian, and binds all its calls when it is loaded: the greater part of a start. Programs
# and the Python module open it when certified numbers are first asked for (src/certify/late/); users of the installed library
# link it.
add_library(carom_flint INTERFACE)
list(GET FLINT_LIBRARIES 0 flint)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|aarch64)$" AND flint MATCHES "[.]so$")
  execute_process(COMMAND ${CMAKE_OBJDUMP} -p ${flint} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "SONAME +([^ \n]+)" soname "${dynamic}")
  set(flint_name ${CMAKE_MATCH_1})
endif()
set(late_flint)
if(flint_name)
  cmake_path(GET flint PARENT_PATH flint_folder)
  set(late_flint ${flint_folder}/${flint_name})
  enable_language(ASM)
  set(flint_calls ${PROJECT_BINARY_DIR}/flint_calls.inc)
  add_custom_command(OUTPUT ${flint_calls} DEPENDS carom cmake/flint_calls.cmake
    COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} -DLIBRARY=$<TARGET_FILE:carom> -DOUTPUT=${flint_calls}
            -P ${PROJECT_SOURCE_DIR}/cmake/flint_calls.cmake VERBATIM)
  add_library(carom_late_flint STATIC src/certify/late/open.cpp src/certify/late/calls.S)
  set_source_files_properties(src/certify/late/calls.S PROPERTIES OBJECT_DEPENDS ${flint_calls}
    COMPILE_DEFINITIONS FLINT_CALLS="${flint_calls}")
  set_source_files_properties(src/certify/late/open.cpp PROPERTIES COMPILE_DEFINITIONS CAROM_FLINT="${flint_name}")
  target_include_directories(carom_late_flint PRIVATE include src)
  target_link_libraries(carom_late_flint PRIVATE carom_flags ${CMAKE_DL_LIBS})
  target_link_libraries(carom_flint INTERFACE
    "$<IF:$<IN_LIST:$<TARGET_PROPERTY:TYPE>,EXECUTABLE$<SEMICOLON>MODULE_LIBRARY>,carom_late_flint,${FLINT_LIBRARIES}>")
else()
  target_link_libraries(carom_flint INTERFACE ${FLINT_LIBRARIES})
endif()
set(CAROM_LATE_FLINT "${late_flint}" CACHE INTERNAL "The library that programs open late, for those that pack it")
