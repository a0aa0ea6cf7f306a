# Sanitized twins: rooms where memory can go wrong, compiled once more with the sanitizers, beside the plain code of all
# other rooms. The build with MONTELUX_SANITIZE has the whole house under them.

# montelux_sanitized_room(path/of/room): the objects montelux_room_NAME_sanitized.
function(montelux_sanitized_room room)
    string(REPLACE "/" "_" name "montelux_room_${room}")
    get_target_property(sources ${name} SOURCES)
    get_target_property(links ${name} LINK_LIBRARIES)
    add_library(${name}_sanitized OBJECT ${sources})
    target_include_directories(${name}_sanitized SYSTEM PRIVATE $<TARGET_PROPERTY:${name},INCLUDE_DIRECTORIES>)
    target_compile_definitions(${name}_sanitized PRIVATE $<TARGET_PROPERTY:${name},COMPILE_DEFINITIONS>)
    target_link_libraries(${name}_sanitized PRIVATE ${links})
    target_compile_options(${name}_sanitized PRIVATE ${MONTELUX_SANITIZER_FLAGS})
endfunction()

# montelux_sanitized_test(room shares [ROOMS rooms...] [FILES regular expression]): the program of a room's tests once
# more, or of those files alone, with the sanitized objects of the room and of ROOMS. Their tests share as many processes
# as `shares` says: a program with sanitizers takes longer to start than most tests take.
function(montelux_sanitized_test room shares)
    cmake_parse_arguments(ARG "" "FILES" "ROOMS" ${ARGN})
    string(REPLACE "/" "_" plain "${room}_test")
    set(name ${plain}_sanitized)
    get_target_property(sources ${plain} SOURCES)
    get_target_property(links ${plain} LINK_LIBRARIES)
    if(ARG_FILES)
        list(FILTER sources INCLUDE REGEX "${ARG_FILES}")
    endif()
    add_executable(${name} ${sources} sanitizer_options.cpp)
    foreach(used ${room} ${ARG_ROOMS})
        string(REPLACE "/" "_" objects "montelux_room_${used}_sanitized")
        target_sources(${name} PRIVATE $<TARGET_OBJECTS:${objects}>)
    endforeach()
    target_include_directories(${name} SYSTEM PRIVATE $<TARGET_PROPERTY:${plain},INCLUDE_DIRECTORIES>)
    target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:${plain},COMPILE_DEFINITIONS>)
    target_link_libraries(${name} PRIVATE ${links})
    target_compile_options(${name} PRIVATE ${MONTELUX_SANITIZER_FLAGS})
    target_link_options(${name} PRIVATE ${MONTELUX_SANITIZER_FLAGS})
    montelux_shared_tests(${name} sanitized/${room} ${shares})
endfunction()
