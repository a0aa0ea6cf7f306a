# MPI, as the cluster room links it, in MONTELUX_MPI_LINKS; empty if it is not wanted or not found.
set(MONTELUX_MPI_LINKS)
if(MONTELUX_MPI)
    find_package(MPI 3.0 QUIET COMPONENTS CXX)
    if(MPI_CXX_FOUND)
        set(MONTELUX_MPI_LINKS MPI::MPI_CXX)
        set_source_files_properties(${PROJECT_SOURCE_DIR}/montelux/cluster/communicator.cpp
            PROPERTIES COMPILE_DEFINITIONS MONTELUX_WITH_MPI)
    elseif(NOT MONTELUX_MPI STREQUAL "AUTO")
        message(FATAL_ERROR "MONTELUX_MPI=ON, and there is no MPI (libopenmpi-dev)")
    endif()
endif()
