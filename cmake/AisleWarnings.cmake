# Flags of every file we wrote: warnings are errors, floating point is as written. gcc 12 from -O2 on takes two neighbours
# (double)(float)x as one vector and forgets to round them (tests/base/test_rounding.c), hence no SLP vectorizer but in
# AISLE_NOTHING_ROUNDED, where much time goes and nothing is made a float (-Wconversion: not without a cast).
set(AISLE_NOTHING_ROUNDED src/world/layout_gap.c src/world/shape.c src/world/layout_store.c src/world/grid.c)
add_library(aisle_warnings INTERFACE)
target_compile_options(aisle_warnings INTERFACE
  -pedantic -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wvla -Wundef
  -Wstrict-prototypes -Wmissing-prototypes $<$<BOOL:${AISLE_WERROR}>:-Werror> -ffp-contract=off
  $<$<C_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)

foreach(source IN LISTS AISLE_NOTHING_ROUNDED)
  file(STRINGS ${CMAKE_SOURCE_DIR}/${source} casts REGEX "\\(float\\)")
  if(casts)
    message(FATAL_ERROR "${source} rounds to float: take it off AISLE_NOTHING_ROUNDED")
  endif()
  if(CMAKE_C_COMPILER_ID STREQUAL "GNU")
    set_source_files_properties(${CMAKE_SOURCE_DIR}/${source} PROPERTIES COMPILE_OPTIONS -ftree-slp-vectorize)
  endif()
endforeach()
