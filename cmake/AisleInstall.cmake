# What an integrator gets: the library, its headers, find_package(aisle), and the message types.
include(CMakePackageConfigHelpers)
set(aisle_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/aisle)
install(TARGETS aisle EXPORT aisle-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/aisle ${AISLE_MESSAGES_INCLUDE}/aisle DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")
install(FILES ${AISLE_LCM_FILES} DESTINATION ${CMAKE_INSTALL_DATADIR}/aisle/lcmtypes)
install(EXPORT aisle-targets NAMESPACE aisle:: DESTINATION ${aisle_package_dir})
configure_package_config_file(cmake/aisle-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/aisle-config.cmake
  INSTALL_DESTINATION ${aisle_package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/aisle-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/aisle-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/aisle-config-version.cmake
  DESTINATION ${aisle_package_dir})
