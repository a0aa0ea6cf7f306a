# MONTELUX_PROCESSOR_FLAGS: for x86-64 the level v3 (AVX2, FMA), for other processors the compiler's default,
# with MONTELUX_NATIVE all features of this machine's processor.
set(MONTELUX_PROCESSOR_FLAGS)
if(MONTELUX_NATIVE)
    include(CheckCXXCompilerFlag)
    foreach(option march mcpu) # POWER has the latter alone
        check_cxx_compiler_flag(-${option}=native MONTELUX_HAS_${option}_NATIVE)
        if(MONTELUX_HAS_${option}_NATIVE)
            set(MONTELUX_PROCESSOR_FLAGS -${option}=native)
            break()
        endif()
    endforeach()
    if(NOT MONTELUX_PROCESSOR_FLAGS)
        message(FATAL_ERROR "MONTELUX_NATIVE=ON: ${CMAKE_CXX_COMPILER} has neither -march=native nor -mcpu=native; "
            "expected MONTELUX_NATIVE=OFF")
    endif()
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    set(MONTELUX_PROCESSOR_FLAGS -march=x86-64-v3)
endif()
