# Installation: headers, static libraries and the package that find_package(Montelux) reads. Each library has an
# export of its own, so that a user of montelux::mc alone needs neither Embree nor an image library.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Montelux)

get_property(libraries GLOBAL PROPERTY MONTELUX_LIBRARIES)
foreach(library ${libraries})
    string(REPLACE "montelux_" "" component ${library})
    install(TARGETS ${library} EXPORT ${library}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component})
    install(EXPORT ${library} NAMESPACE montelux:: FILE Montelux_${component}.cmake
        DESTINATION ${package_folder} COMPONENT ${component})
endforeach()

install(DIRECTORY montelux/mc DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/montelux COMPONENT mc
    FILES_MATCHING PATTERN "*.h")
if(MONTELUX_RENDER)
    install(DIRECTORY montelux/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/montelux COMPONENT render
        FILES_MATCHING PATTERN "*.h" PATTERN "mc" EXCLUDE)
endif()

configure_package_config_file(cmake/MonteluxConfig.cmake.in MonteluxConfig.cmake
    INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(MonteluxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/MonteluxConfig.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/MonteluxConfigVersion.cmake
    DESTINATION ${package_folder} COMPONENT mc)
