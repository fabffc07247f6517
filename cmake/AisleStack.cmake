# Tells the daemon the core's stack bound (aisled --memory), measured in this very build from gcc's call graph.
# AISLE_STACK_BOUND in the cache overrides it; with other compilers it is not known.
if(AISLE_STACK_BOUND OR NOT CMAKE_C_COMPILER_ID STREQUAL "GNU")
  return()
endif()
set(aisle_stack_header ${CMAKE_CURRENT_BINARY_DIR}/gen/stack_bound.h)
set(aisle_graphs)
foreach(level IN LISTS AISLE_LEVELS)
  if(TARGET aisle_${level})
    list(APPEND aisle_graphs ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/aisle_${level}.dir)
  endif()
endforeach()
add_custom_command(
  OUTPUT ${aisle_stack_header}
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/tools/gates/stack.py ${aisle_graphs}
          --header ${aisle_stack_header}
  DEPENDS aisle ${CMAKE_CURRENT_SOURCE_DIR}/tools/gates/stack.py ${CMAKE_CURRENT_SOURCE_DIR}/tools/gates/inlets.txt
  COMMENT "Measuring the stack bound")
add_custom_target(aisle_stack DEPENDS ${aisle_stack_header})
add_dependencies(aisle_daemon aisle_stack)
target_compile_options(aisle_daemon PUBLIC -include ${aisle_stack_header})
