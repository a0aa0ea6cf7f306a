# Embree 3.12 or newer, or Embree 4: montelux/accel/embree.h includes the header of the version that is found.
find_package(embree REQUIRED)
if(EMBREE_VERSION VERSION_LESS 3.12 OR EMBREE_VERSION VERSION_GREATER_EQUAL 5)
    message(FATAL_ERROR "Embree ${EMBREE_VERSION} was found in ${embree_DIR}; expected 3.12 or newer, or 4. "
        "-D embree_DIR=FOLDER names the folder of another version's embree-config.cmake.")
endif()
set(MONTELUX_EMBREE_DEFINITION MONTELUX_EMBREE=${EMBREE_VERSION_MAJOR})
