# Installs the library, its headers, the program and a package that find_package(setka) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(installed_targets setka)
if(SETKA_IO)
    list(APPEND installed_targets setka_io)
    install(TARGETS setka_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS ${installed_targets} EXPORT setka_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/setka DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT setka_targets NAMESPACE setka:: FILE setka-targets.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/setka)
configure_package_config_file(cmake/setka-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/setka-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/setka)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/setka-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/setka-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/setka-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/setka)
