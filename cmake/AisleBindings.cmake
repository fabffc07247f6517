# The message types for other languages, by LCM's own generator: Python for reading along, and the jar that shows
# every message decoded in lcm-spy. Neither is needed by the C side.
find_program(LCM_GEN lcm-gen HINTS ${LCM_ROOT}/bin)
if(NOT LCM_GEN)
  message(STATUS "lcm-gen not found: no Python and Java types")
  return()
endif()

set(aisle_python_dir ${CMAKE_CURRENT_BINARY_DIR}/gen/python)
add_custom_command(
  OUTPUT ${aisle_python_dir}/aisle/__init__.py
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${aisle_python_dir}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${aisle_python_dir}
  COMMAND ${LCM_GEN} -p --ppath ${aisle_python_dir} ${AISLE_LCM_FILES}
  DEPENDS ${AISLE_LCM_FILES}
  COMMENT "Generating the Python message types")
add_custom_target(aisle_python_types ALL DEPENDS ${aisle_python_dir}/aisle/__init__.py)

if(NOT AISLE_BUILD_JAVA)
  return()
endif()
find_program(JAVAC javac)
find_program(JAR jar)
find_file(LCM_JAR lcm.jar HINTS ${LCM_ROOT}/share/java PATHS /usr/share/java /usr/local/share/java)
if(NOT JAVAC OR NOT JAR OR NOT LCM_JAR)
  message(STATUS "javac or lcm.jar not found: no aisle-types.jar")
  return()
endif()
set(aisle_java_dir ${CMAKE_CURRENT_BINARY_DIR}/gen/java)
set(aisle_jar ${CMAKE_CURRENT_BINARY_DIR}/aisle-types.jar)
set(aisle_java_sources)
foreach(file IN LISTS AISLE_LCM_FILES)
  file(STRINGS ${file} structs REGEX "^[ \t]*struct[ \t]+[A-Za-z0-9_]+")
  foreach(line IN LISTS structs)
    string(REGEX REPLACE "^[ \t]*struct[ \t]+([A-Za-z0-9_]+).*" "\\1" name "${line}")
    list(APPEND aisle_java_sources ${aisle_java_dir}/aisle/${name}.java)
  endforeach()
endforeach()
add_custom_command(
  OUTPUT ${aisle_jar}
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${aisle_java_dir}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${aisle_java_dir}/classes
  COMMAND ${LCM_GEN} -j --jpath ${aisle_java_dir} ${AISLE_LCM_FILES}
  COMMAND ${JAVAC} -nowarn -cp ${LCM_JAR} -d ${aisle_java_dir}/classes ${aisle_java_sources}
  COMMAND ${JAR} cf ${aisle_jar} -C ${aisle_java_dir}/classes .
  DEPENDS ${AISLE_LCM_FILES}
  COMMENT "Building aisle-types.jar for lcm-spy")
add_custom_target(aisle_java_types ALL DEPENDS ${aisle_jar})
install(FILES ${aisle_jar} DESTINATION ${CMAKE_INSTALL_DATADIR}/java)
