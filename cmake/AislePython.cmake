# Python for the generators and tests: the one tools/setup.sh made, else the system's.
if(NOT Python3_EXECUTABLE AND EXISTS ${CMAKE_SOURCE_DIR}/build/venv/bin/python3)
  set(Python3_EXECUTABLE ${CMAKE_SOURCE_DIR}/build/venv/bin/python3)
endif()
find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)
