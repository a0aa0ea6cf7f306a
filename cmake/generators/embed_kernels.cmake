# Writes a .cpp file that holds the text of the kernels, for the compilers of devices.
# Usage: cmake -D OUTPUT=kernel_files.cpp -D FOLDER=montelux/mc/device -P embed_kernels.cmake
file(READ ${FOLDER}/device_job.h job)
string(REPLACE "#pragma once\n" "" job "${job}")
set(texts "const std::string_view device_job_text = R\"kernel(${job})kernel\";\n")
foreach(name points mixture evaluate summarise)
    file(READ ${FOLDER}/${name}.cu text)
    string(APPEND texts "const std::string_view ${name}_kernel_text = R\"kernel(${text})kernel\";\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"montelux/mc/device/kernel_text.h\"

namespace montelux {

${texts}
} // namespace montelux
")
