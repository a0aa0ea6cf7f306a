# Writes a .cpp file that embeds the files of the viewer's page.
# Usage: cmake -D OUTPUT=page_files_data.cpp -D FOLDER=montelux/view/page -P embed_page.cmake
file(GLOB files ${FOLDER}/*)
list(SORT files COMPARE STRING)
set(arrays "")
set(table "")
set(number 0)
foreach(file ${files})
    get_filename_component(name ${file} NAME)
    get_filename_component(extension ${file} LAST_EXT)
    if(extension STREQUAL ".html")
        set(type "text/html; charset=utf-8")
    elseif(extension STREQUAL ".css")
        set(type "text/css; charset=utf-8")
    elseif(extension STREQUAL ".js")
        set(type "text/javascript; charset=utf-8")
    else()
        message(FATAL_ERROR "${file}: the page has .html, .css and .js files only")
    endif()
    file(READ ${file} hex HEX)
    string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${hex}")
    # Compilers limit the length of one literal; adjacent ones are joined.
    string(REGEX REPLACE "(................................................................................)" "\\1\"\n    \"" bytes "${bytes}")
    string(LENGTH "${hex}" digits)
    math(EXPR size "${digits} / 2")
    string(APPEND arrays "constexpr char file_${number}[] =\n    \"${bytes}\";\n")
    string(APPEND table "    {\"${name}\", \"${type}\", {file_${number}, ${size}}},\n")
    math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"montelux/view/page_files.h\"

namespace montelux {

namespace {

${arrays}
constexpr PageFile embedded[] = {
${table}};

} // namespace

std::span<const PageFile> page_files() { return embedded; }

} // namespace montelux
")
