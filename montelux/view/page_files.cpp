#include "montelux/view/page_files.h"

#include <algorithm>

namespace montelux {

const PageFile* find_page_file(std::string_view name) {
    const std::span<const PageFile> files = page_files();
    const auto found = std::ranges::lower_bound(files, name, {}, &PageFile::name);
    return found != files.end() && found->name == name ? &*found : nullptr;
}

} // namespace montelux
