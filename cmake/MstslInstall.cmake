include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY MSTSL_MODULES)
install(TARGETS ${modules} EXPORT mstslTargets)
install(EXPORT mstslTargets NAMESPACE mstsl:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mstsl)
install(DIRECTORY include/mstsl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
configure_package_config_file(cmake/mstslConfig.cmake.in mstslConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mstsl)
write_basic_package_version_file(mstslConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/mstslConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/mstslConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mstsl)
