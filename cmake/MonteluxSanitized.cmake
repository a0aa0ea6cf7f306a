# Sanitized twins: rooms where memory can go wrong, compiled once more with the sanitizers, beside the plain code of all
# other rooms. The build with MONTELUX_SANITIZE has the whole house under them.

# montelux_sanitized_room(path/of/room): the objects montelux_room_NAME_sanitized; of a room that is split, the
# matching files alone.
function(montelux_sanitized_room room)
    string(REPLACE "/" "_" name "montelux_room_${room}")
    get_property(sources GLOBAL PROPERTY MONTELUX_ROOM_SPLIT_${name})
    if(NOT sources)
        get_target_property(sources ${name} SOURCES)
    endif()
    get_target_property(links ${name} LINK_LIBRARIES)
    add_library(${name}_sanitized OBJECT ${sources})
    target_include_directories(${name}_sanitized SYSTEM PRIVATE $<TARGET_PROPERTY:${name},INCLUDE_DIRECTORIES>)
    target_compile_definitions(${name}_sanitized PRIVATE $<TARGET_PROPERTY:${name},COMPILE_DEFINITIONS>)
    target_link_libraries(${name}_sanitized PRIVATE ${links})
    target_compile_options(${name}_sanitized PRIVATE ${MONTELUX_SANITIZER_FLAGS})
endfunction()

# montelux_sanitized_test(room shares [ROOMS rooms...] [FILES regular expression]): links the plain objects of a room's
# tests with the sanitized objects of the room and of ROOMS; FILES selects the test files whose suites run. The tests are
# split into `shares` processes: starting a program with sanitizers takes longer than most tests.
function(montelux_sanitized_test room shares)
    cmake_parse_arguments(ARG "" "FILES" "ROOMS" ${ARGN})
    string(REPLACE "/" "_" plain "${room}_test")
    set(name ${plain}_sanitized)
    # Sanitized objects come first: the linker keeps the first copy of an inline function.
    set(objects)
    foreach(used ${room} ${ARG_ROOMS})
        string(REPLACE "/" "_" used "montelux_room_${used}_sanitized")
        list(APPEND objects $<TARGET_OBJECTS:${used}>)
    endforeach()
    add_executable(${name} sanitizer_options.cpp ${objects} $<TARGET_OBJECTS:${plain}>)
    get_target_property(links ${plain} LINK_LIBRARIES)
    target_link_libraries(${name} PRIVATE ${links})
    target_link_options(${name} PRIVATE ${MONTELUX_SANITIZER_FLAGS})
    set(suites)
    if(ARG_FILES)
        get_target_property(sources ${plain} SOURCES)
        list(FILTER sources INCLUDE REGEX "${ARG_FILES}")
        foreach(source ${sources})
            file(STRINGS ${source} tests REGEX "^(TYPED_)?TEST(_F|_P)?\\(")
            list(TRANSFORM tests REPLACE "^[A-Z_]*\\(([A-Za-z0-9]*),.*" "\\1.*:*/\\1.*:*/\\1/*")
            list(APPEND suites ${tests})
        endforeach()
        list(REMOVE_DUPLICATES suites)
        list(JOIN suites ":" suites)
    endif()
    montelux_shared_tests(${name} sanitized/${room} ${shares} "${suites}" ":${not_under_sanitizers}")
endfunction()
