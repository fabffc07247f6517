# Flags of every file we wrote: warnings are errors, floating point is as written. gcc 12 from -O2 on takes two neighbours
# (double)(float)x as one vector and forgets to round them (tests/base/test_rounding.c), hence no SLP vectorizer.
add_library(aisle_warnings INTERFACE)
target_compile_options(aisle_warnings INTERFACE
  -pedantic -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wvla -Wundef
  -Wstrict-prototypes -Wmissing-prototypes $<$<BOOL:${AISLE_WERROR}>:-Werror> -ffp-contract=off
  -fno-tree-slp-vectorize)
