# The Debian packages montelux, libmontelux-dev and python3-montelux, by CPack: `make packages`. docs/install.md.
# Who answers for them: as for Debian's own tools.
set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
if("$ENV{DEBEMAIL}" STREQUAL "")
    set(maintainer "Nobody <nobody@montelux.invalid>")
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME montelux)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Monte Carlo integration and light transport with error bars")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
# Policy, section 10.9: folders that all may enter.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${maintainer})
set(CPACK_DEBIAN_PACKAGE_RELEASE 0montelux1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)


set(about "Montelux integrates formulas and renders scenes of pbrt-v4, glTF and Mitsuba
by Monte Carlo methods. Every value and every pixel has a standard error.\n\n")
set(processor "Compiled for ${CMAKE_SYSTEM_PROCESSOR} processors")
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    set(processor "Compiled for processors of the level ${MONTELUX_PROCESSOR} or newer")
endif()
# debian_package(GROUP component-of-its-notes name section dependencies what-it-holds)
macro(debian_package group component name section depends holds)
    set(CPACK_DEBIAN_${group}_PACKAGE_NAME ${name})
    set(CPACK_DEBIAN_${group}_PACKAGE_SECTION ${section})
    set(CPACK_DEBIAN_${group}_PACKAGE_DEPENDS "${depends}")
    set(CPACK_COMPONENT_${group}_DESCRIPTION "${about}${holds}\n${processor}.")
    foreach(file copyright changelog)
        set(installed ${file})
        set(source ${PROJECT_SOURCE_DIR}/packaging/debian/${file})
        if(file STREQUAL changelog)
            set(installed changelog.Debian.gz)
            set(source ${PROJECT_BINARY_DIR}/debian/changelog.Debian.gz)
        endif()
        install(FILES ${source} DESTINATION share/doc/${name} RENAME ${installed} COMPONENT ${component})
    endforeach()
endmacro()
configure_file(packaging/debian/changelog.in debian/changelog @ONLY)
execute_process(COMMAND gzip -9nc ${PROJECT_BINARY_DIR}/debian/changelog
    OUTPUT_FILE ${PROJECT_BINARY_DIR}/debian/changelog.Debian.gz COMMAND_ERROR_IS_FATAL ANY)

debian_package(APP app montelux graphics "" "This package holds the program.")
# What MonteluxConfig.cmake looks for.
set(development libtbb-dev libembree-dev libopenexr-dev libpng-dev libjpeg62-turbo-dev zlib1g-dev libexpat1-dev)
foreach(optional blosc meshoptimizer draco webp)
    string(TOUPPER ${optional} variable)
    if(${variable}_LIBRARY)
        list(APPEND development lib${optional}-dev)
    endif()
endforeach()
if(MPI_CXX_FOUND)
    list(APPEND development libopenmpi-dev)
endif()
list(JOIN development ", " development)
debian_package(DEVELOPMENT mc libmontelux-dev libdevel "${development}"
    "This package holds the headers and the static libraries, with a\npackage for CMake.")
if(TARGET montelux_python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/debian/postinst
        ${PROJECT_SOURCE_DIR}/packaging/debian/prerm)
    math(EXPR next "${MONTELUX_PYTHON_MINOR} + 1")
    debian_package(PYTHON python python3-montelux python
        "python3 (>= 3.${MONTELUX_PYTHON_MINOR}), python3 (<< 3.${next}), python3-numpy (>= 1:1.22), python3-numpy-abi9"
        "This package holds the module for Python.")
endif()

# As debhelper does: objects of link-time optimisation serve one version of the compiler only, and are most of the size.
foreach(library ${libraries})
    string(REPLACE "montelux_" "" component ${library})
    install(CODE "execute_process(COMMAND ${CMAKE_STRIP} --strip-debug --enable-deterministic-archives -R .comment
        -R .gnu.lto_* -R .gnu.debuglto_* -N __gnu_lto_slim -N __gnu_lto_v1
        \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/lib${library}.a COMMAND_ERROR_IS_FATAL ANY)"
        COMPONENT ${component})
endforeach()

include(CPack)
foreach(component mc render cluster view)
    cpack_add_component(${component} GROUP development)
endforeach()
cpack_add_component_group(development)
