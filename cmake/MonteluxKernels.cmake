# The kernels of devices are embedded into the library as text: they are compiled while the program runs.
set(kernel_folder ${PROJECT_SOURCE_DIR}/montelux/mc/device)
set(kernel_data ${PROJECT_BINARY_DIR}/kernel_files.cpp)
set(kernel_script ${PROJECT_SOURCE_DIR}/cmake/generators/embed_kernels.cmake)
add_custom_command(OUTPUT ${kernel_data}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${kernel_data} -D FOLDER=${kernel_folder} -P ${kernel_script}
    DEPENDS ${kernel_folder}/device_job.h ${kernel_folder}/points.cu ${kernel_folder}/mixture.cu
        ${kernel_folder}/evaluate.cu ${kernel_folder}/summarise.cu ${kernel_script}
    COMMENT "Embedding the kernels of devices" VERBATIM)
target_sources(montelux_room_mc_device PRIVATE ${kernel_data})
