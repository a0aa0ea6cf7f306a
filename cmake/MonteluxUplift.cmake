# The RGB uplift tables of montelux/spectrum are computed by a program of our own while Montelux is built
# (seconds, once), and embedded into the library by montelux/spectrum/rgb_uplift_tables.cpp.
set(spectrum ${PROJECT_SOURCE_DIR}/montelux/spectrum)
set(tables ${PROJECT_BINARY_DIR}/rgb_uplift.bin)
add_executable(rgb_uplift_generator ${PROJECT_SOURCE_DIR}/cmake/generators/rgb_uplift_generator.cpp
    ${spectrum}/rgb_uplift.cpp ${spectrum}/rgb_uplift_solver.cpp ${spectrum}/rgb_colorspace.cpp
    ${spectrum}/illuminants.cpp ${spectrum}/illuminant_data.cpp ${spectrum}/cie_data.cpp)
target_compile_features(rgb_uplift_generator PRIVATE cxx_std_20)
target_include_directories(rgb_uplift_generator PRIVATE ${PROJECT_SOURCE_DIR})
# Always optimised and never instrumented: it would take minutes otherwise.
target_compile_options(rgb_uplift_generator PRIVATE -O3 -fno-math-errno -fno-trapping-math
    ${MONTELUX_PROCESSOR_FLAGS} -Wno-psabi)
find_package(Threads REQUIRED)
target_link_libraries(rgb_uplift_generator PRIVATE Threads::Threads)
add_custom_command(OUTPUT ${tables} COMMAND rgb_uplift_generator ${tables} DEPENDS rgb_uplift_generator
    COMMENT "Computing the RGB uplift tables" VERBATIM)
# The file embeds the tables by an assembler directive, which link-time optimisation cannot see into.
set_source_files_properties(${spectrum}/rgb_uplift_tables.cpp PROPERTIES OBJECT_DEPENDS ${tables}
    COMPILE_DEFINITIONS "MONTELUX_RGB_UPLIFT_FILE=\"${tables}\"" COMPILE_OPTIONS "-fno-lto")
