# Compiler settings shared by every target: montelux_flags (code of ours) and what users of the library need.
add_library(montelux_flags INTERFACE)
target_compile_features(montelux_flags INTERFACE cxx_std_20)
# Reproducible arithmetic: nothing is reassociated and no multiply-adds are fused, so a formula has the same bits
# wherever it is inlined and however many paths it computes at a time. Functions of the C library may still differ
# between processors.
target_compile_options(montelux_flags INTERFACE
    -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden
    -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Woverloaded-virtual
    -Wconversion -Wno-sign-conversion -Wno-float-conversion -Wdouble-promotion -Wno-psabi $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(MONTELUX_WERROR)
    target_compile_options(montelux_flags INTERFACE -Werror)
endif()
# GCC looks for garbage in its memory before there is much of it: a twentieth of its time for 0.2 to 0.3 GB. Not where
# clang-tidy reads the command lines.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(montelux_flags INTERFACE $<$<NOT:$<CONFIG:Debug>>:--param=ggc-min-heapsize=524288>) # kB
endif()
include(MonteluxProcessor)
target_compile_options(montelux_flags INTERFACE ${MONTELUX_PROCESSOR_FLAGS})
# pointer-overflow takes a third of the compiler's time; what such a pointer reads, the address sanitizer sees. GCC 12
# sees uninitialised members in std::regex once the sanitizers have instrumented it. Outside of the integrals, tests take
# longer to compile than to run.
set(MONTELUX_SANITIZER_FLAGS -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
    -fno-sanitize=pointer-overflow $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
    "$<$<NOT:$<OR:$<CONFIG:Debug>,$<BOOL:$<FILTER:$<TARGET_PROPERTY:NAME>,INCLUDE,^mc_(integrate|random)|_room_mc_>>>>:-Og;-g1>")
if(MONTELUX_SANITIZE)
    target_compile_options(montelux_flags INTERFACE ${MONTELUX_SANITIZER_FLAGS})
    target_link_options(montelux_flags INTERFACE -fsanitize=address,undefined)
endif()
if(MONTELUX_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "MONTELUX_FUZZ needs Clang, whose libFuzzer drives the targets: use the preset `fuzz`")
    endif()
    target_compile_options(montelux_flags INTERFACE -fsanitize=fuzzer-no-link) # branches are counted
endif()
if(CMAKE_UNITY_BUILD)
    # Several files as one compile in half the time. GCC then takes their unnamed namespaces for those of a header,
    # and warns falsely of a local variable in Pixel::end_replicate.
    target_compile_options(montelux_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>
        $<$<CXX_COMPILER_ID:GNU>:-Wno-dangling-pointer>)
endif()
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
endif()

# Link-time optimisation: libraries hold machine code beside GCC's intermediate code, so that programs built
# without it can link them too. Clang 14 has no such objects.
set(MONTELUX_LTO_FLAGS)
if(MONTELUX_LTO)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        set(MONTELUX_LTO_FLAGS -flto=auto -ffat-lto-objects)
    else()
        message(STATUS "Link-time optimisation is used with GCC only; building without it")
    endif()
endif()

# Code outside of the sampling loop: a higher level would take longer to compile than it saves.
set(MONTELUX_COLD_FLAGS $<$<CONFIG:Release>:-O1>)

find_program(MONTELUX_CCACHE ccache)
mark_as_advanced(MONTELUX_CCACHE)
if(PROJECT_IS_TOP_LEVEL AND MONTELUX_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${MONTELUX_CCACHE})
endif()
