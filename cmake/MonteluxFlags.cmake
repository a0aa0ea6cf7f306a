# Compiler settings shared by every target: montelux_flags (code of ours) and what users of the library need.
add_library(montelux_flags INTERFACE)
target_compile_features(montelux_flags INTERFACE cxx_std_20)
# Reproducible sums: no reassociation, no contraction that differs between call sites of one formula.
target_compile_options(montelux_flags INTERFACE
    -fno-math-errno -fno-trapping-math -fvisibility=hidden
    -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Woverloaded-virtual
    -Wconversion -Wno-sign-conversion -Wno-float-conversion -Wdouble-promotion -Wno-psabi)
if(MONTELUX_WERROR)
    target_compile_options(montelux_flags INTERFACE -Werror)
endif()
if(MONTELUX_NATIVE)
    target_compile_options(montelux_flags INTERFACE -march=native)
else()
    target_compile_options(montelux_flags INTERFACE -march=x86-64-v3)
endif()
if(MONTELUX_SANITIZE)
    target_compile_options(montelux_flags INTERFACE
        -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    target_link_options(montelux_flags INTERFACE -fsanitize=address,undefined)
endif()
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
