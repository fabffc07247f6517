# cmake -DBUILD=<build tree> -DSOURCE=<this folder> -DWORK=<scratch> -DC_COMPILER= -DC_FLAGS= -P run.cmake
# Installs into WORK/prefix and builds and runs the programs of this folder against it, nothing else in sight.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_C_FLAGS=${C_FLAGS} -DCMAKE_CXX_FLAGS=${C_FLAGS})
run(${CMAKE_COMMAND} --build ${WORK}/build)
foreach(language c cpp)
  run(${WORK}/build/consumer_${language})
  message(STATUS "${output}")
endforeach()
