// read_whole_file: what a file of saved state holds, where only its newest version will do.
#pragma once

#include <string>
#include <string_view>

#include "montelux/mc/integrate/state_archive.h"
#include "montelux/mc/math/error.h"

namespace montelux {

// What `read` makes of the file; its errors begin with the path. A damaged file is an error: the one before, which a
// checkpoint would be resumed from, holds something else.
template <typename Read>
auto read_whole_file(const std::string& path, std::string_view kind, const Read& read) {
    SavedState saved = read_state(path, kind);
    if (!saved.newest_refused_because.empty()) throw Error(saved.newest_refused_because);
    try {
        return read(saved.reader);
    } catch (const Error& error) {
        throw Error(path, error.what());
    }
}

} // namespace montelux
