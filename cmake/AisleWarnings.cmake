# Flags of every file we wrote: warnings are errors, floating point is as written.
add_library(aisle_warnings INTERFACE)
target_compile_options(aisle_warnings INTERFACE
  -pedantic -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wvla -Wundef
  -Wstrict-prototypes -Wmissing-prototypes $<$<BOOL:${AISLE_WERROR}>:-Werror> -ffp-contract=off)
