# Configures Montelux as other machines would: cmake -D source=... -D work=... -D compiler=... -D render=ON|OFF
# -P configure_test.cmake. Nothing is compiled but what CMake tries.
cmake_minimum_required(VERSION 3.25)

# configure(NAME [ARGUMENTS...]): `result`, `output`, and `commands`, the command lines of the compiler.
function(configure name)
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${work}/${name} -G Ninja
        -D CMAKE_CXX_COMPILER=${compiler} -D MONTELUX_RENDER=${render} -D MONTELUX_APP=OFF -D MONTELUX_TESTS=OFF
        -D MONTELUX_MPI=OFF ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    set(commands)
    if(result EQUAL 0)
        file(READ ${work}/${name}/compile_commands.json commands)
    endif()
    foreach(variable result output commands)
        set(${variable} "${${variable}}" PARENT_SCOPE)
    endforeach()
endfunction()

function(expect what)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${what}: CMake ended with ${result}:\n${output}")
    endif()
endfunction()

file(REMOVE_RECURSE ${work})

# Other processors get no option of x86-64's.
foreach(processor aarch64 riscv64 x86_64)
    configure(${processor} -D CMAKE_SYSTEM_NAME=Linux -D CMAKE_SYSTEM_PROCESSOR=${processor})
    expect(${processor})
    string(FIND "${commands}" "-march=" march)
    if(processor STREQUAL "x86_64" AND march EQUAL -1)
        message(FATAL_ERROR "${processor}: -march=x86-64-v3 is expected")
    elseif(NOT processor STREQUAL "x86_64" AND NOT march EQUAL -1)
        string(SUBSTRING "${commands}" ${march} 20 found)
        message(FATAL_ERROR "${processor}: no -march is expected, but there is ${found}")
    endif()
endforeach()
if(NOT render)
    return()
endif()

# Packages of Embree that are names and numbers alone.
foreach(version 3.11.0 3.12.0 4.0.0 4.4.1 5.0.0)
    string(REGEX MATCH "^[0-9]+" major ${version})
    set(package ${work}/embree-${version})
    file(WRITE ${package}/embree-config.cmake "set(EMBREE_VERSION ${version})
set(EMBREE_VERSION_MAJOR ${major})
add_library(embree INTERFACE IMPORTED)
")
    configure(with-${version} -D embree_DIR=${package})
    if(version MATCHES "^(3\\.11|5)")
        string(REGEX REPLACE "[ \n]+" " " output "${output}") # CMake breaks lines
        if(result EQUAL 0 OR NOT output MATCHES "Embree ${version} was found in.*expected 3\\.12 or newer, or 4")
            message(FATAL_ERROR "Embree ${version}: a sentence is expected, not:\n${output}")
        endif()
    else()
        expect("Embree ${version}")
        if(NOT commands MATCHES "-DMONTELUX_EMBREE=${major} ")
            message(FATAL_ERROR "Embree ${version}: MONTELUX_EMBREE is not ${major}")
        endif()
    endif()
endforeach()
