# MONTELUX_PROCESSOR_FLAGS: the instructions that the compiler may use.
# MONTELUX_PROCESSOR is a level of x86-64, or native: all features of this machine's processor. On other
# architectures everything but native is the compiler's default.
set(MONTELUX_PROCESSOR x86-64-v3 CACHE STRING "Level of x86-64 to compile for, or native")
set(levels x86-64 x86-64-v2 x86-64-v3 x86-64-v4 native)
set_property(CACHE MONTELUX_PROCESSOR PROPERTY STRINGS ${levels})
if(NOT MONTELUX_PROCESSOR IN_LIST levels)
    list(JOIN levels ", " expected)
    message(FATAL_ERROR "MONTELUX_PROCESSOR=${MONTELUX_PROCESSOR}; expected one of ${expected}")
endif()
set(MONTELUX_PROCESSOR_FLAGS)
if(MONTELUX_PROCESSOR STREQUAL native)
    include(CheckCXXCompilerFlag)
    foreach(option march mcpu) # POWER has the latter alone
        check_cxx_compiler_flag(-${option}=native MONTELUX_HAS_${option}_NATIVE)
        if(MONTELUX_HAS_${option}_NATIVE)
            set(MONTELUX_PROCESSOR_FLAGS -${option}=native)
            break()
        endif()
    endforeach()
    if(NOT MONTELUX_PROCESSOR_FLAGS)
        message(FATAL_ERROR "MONTELUX_PROCESSOR=native: ${CMAKE_CXX_COMPILER} has neither -march=native nor "
            "-mcpu=native; expected x86-64-v3, which means the compiler's default here")
    endif()
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    set(MONTELUX_PROCESSOR_FLAGS -march=${MONTELUX_PROCESSOR})
endif()
if(MONTELUX_PROCESSOR MATCHES "^(native|x86-64-v4)$")
    # GCC 12 warns of its own header of AVX-512.
    list(APPEND MONTELUX_PROCESSOR_FLAGS $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
        $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized>)
endif()
