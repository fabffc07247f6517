# FindInih: the .ini reader. Input: INIH_ROOT. Output: Inih::inih.
find_path(INIH_INCLUDE_DIR ini.h HINTS ${INIH_ROOT} PATH_SUFFIXES include)
find_library(INIH_LIBRARY NAMES inih HINTS ${INIH_ROOT} PATH_SUFFIXES lib lib64)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Inih REQUIRED_VARS INIH_LIBRARY INIH_INCLUDE_DIR)
if(INIH_FOUND AND NOT TARGET Inih::inih)
  add_library(Inih::inih UNKNOWN IMPORTED)
  set_target_properties(Inih::inih PROPERTIES
    IMPORTED_LOCATION ${INIH_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${INIH_INCLUDE_DIR})
endif()
mark_as_advanced(INIH_INCLUDE_DIR INIH_LIBRARY)
