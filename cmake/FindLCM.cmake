# FindLCM: liblcm 1.3.1 (Debian) or 1.5.x (PyPI wheel) without pkg-config, whose lcm.pc asks for glib's headers.
# Input: LCM_ROOT, a prefix with include/lcm/lcm.h and lib/ (for the wheel: .../site-packages). Output: LCM::lcm, LCM_GEN.
find_path(LCM_INCLUDE_DIR lcm/lcm.h HINTS ${LCM_ROOT} PATH_SUFFIXES include)
find_library(LCM_LIBRARY NAMES lcm HINTS ${LCM_ROOT} PATH_SUFFIXES lib lib64)
find_program(LCM_GEN lcm-gen HINTS ${LCM_ROOT}/bin) # of the host, also in a cross build
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LCM REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR)
if(LCM_FOUND AND NOT TARGET LCM::lcm)
  add_library(LCM::lcm UNKNOWN IMPORTED)
  set_target_properties(LCM::lcm PROPERTIES
    IMPORTED_LOCATION ${LCM_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
endif()
mark_as_advanced(LCM_INCLUDE_DIR LCM_LIBRARY LCM_GEN)
