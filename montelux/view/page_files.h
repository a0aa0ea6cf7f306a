// The files of the viewer's page, embedded into the library (montelux/view/page).
#pragma once

#include <span>
#include <string_view>

namespace montelux {

struct PageFile {
    std::string_view name, content_type, bytes;
};

// Sorted by name.
std::span<const PageFile> page_files();
// Null: there is no such file.
const PageFile* find_page_file(std::string_view name);

} // namespace montelux
