# Installation: headers, static libraries and the package that find_package(Montelux) reads.
include(CMakePackageConfigHelpers)
get_property(libraries GLOBAL PROPERTY MONTELUX_LIBRARIES)
install(TARGETS ${libraries} EXPORT MonteluxTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY montelux/mc DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/montelux FILES_MATCHING PATTERN "*.h")
if(MONTELUX_RENDER)
    install(DIRECTORY montelux/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/montelux
        FILES_MATCHING PATTERN "*.h" PATTERN "mc" EXCLUDE)
endif()
install(EXPORT MonteluxTargets NAMESPACE montelux:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Montelux)
configure_package_config_file(cmake/MonteluxConfig.cmake.in MonteluxConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Montelux)
write_basic_package_version_file(MonteluxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/MonteluxConfig.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/MonteluxConfigVersion.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Montelux)
