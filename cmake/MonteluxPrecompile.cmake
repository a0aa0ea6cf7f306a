# Headers that many files include, compiled once (MONTELUX_PRECOMPILE): for the builds of the tests, which compile
# everything twice. Only tests and program: the library is compiled the same in every build.

# montelux_precompile(target headers...)
function(montelux_precompile target)
    if(MONTELUX_PRECOMPILE)
        target_precompile_headers(${target} PRIVATE ${ARGN} <algorithm> <array> <cmath> <filesystem> <functional>
            <limits> <memory> <optional> <random> <span> <string> <utility> <vector>)
        # GCC 12 warns of the standard library's own inlined code when its headers are precompiled.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
            $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
    endif()
endfunction()
