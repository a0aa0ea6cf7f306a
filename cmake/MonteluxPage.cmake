# The files of the viewer's page are embedded into the library.
set(page_folder ${PROJECT_SOURCE_DIR}/montelux/view/page)
set(page_data ${PROJECT_BINARY_DIR}/page_files_data.cpp)
set(page_script ${PROJECT_SOURCE_DIR}/cmake/generators/embed_page.cmake)
file(GLOB page_files CONFIGURE_DEPENDS ${page_folder}/*)
add_custom_command(OUTPUT ${page_data}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${page_data} -D FOLDER=${page_folder} -P ${page_script}
    DEPENDS ${page_files} ${page_script} COMMENT "Embedding the viewer's page" VERBATIM)
target_sources(montelux_room_view PRIVATE ${page_data})
