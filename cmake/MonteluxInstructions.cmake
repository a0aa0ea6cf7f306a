# montelux_instructions(VARIABLE): those of the instruction sets that processor_level.h names which the compiler may
# use, in the words of Linux's /proc/cpuinfo, as a list; empty on other architectures than x86-64.
function(montelux_instructions variable)
    separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS}")
    list(APPEND flags ${MONTELUX_PROCESSOR_FLAGS})
    list(FILTER flags INCLUDE REGEX "^-m")
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${flags} -dM -E -x c++ /dev/null
        OUTPUT_VARIABLE macros COMMAND_ERROR_IS_FATAL ANY)
    set(instructions)
    foreach(instruction sse4_2 avx2 fma bmi2 avx512f avx512bw avx512cd avx512dq avx512vl)
        string(TOUPPER __${instruction}__ macro)
        if(macros MATCHES "#define ${macro} ")
            list(APPEND instructions ${instruction})
        endif()
    endforeach()
    set(${variable} ${instructions} PARENT_SCOPE)
endfunction()
