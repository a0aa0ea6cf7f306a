# Writes a .cpp file that holds the text of the kernels, for the compilers of devices.
# Usage: cmake -D OUTPUT=kernel_files.cpp -D FOLDER=montelux/mc/device -P embed_kernels.cmake
file(READ ${FOLDER}/device_job.h job)
string(REPLACE "#pragma once\n" "" job "${job}")
file(READ ${FOLDER}/evaluate.cu kernel)
file(WRITE ${OUTPUT} "#include \"montelux/mc/device/kernel_text.h\"

namespace montelux {

const std::string_view device_job_text = R\"kernel(${job})kernel\";
const std::string_view evaluate_kernel_text = R\"kernel(${kernel})kernel\";

} // namespace montelux
")
