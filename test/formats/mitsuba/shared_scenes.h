// The scenes of Mitsuba's repository among the shared files. Its tests lie one folder deeper there, so that they name
// their common files by one level more than leads to them here.
#pragma once

#include <filesystem>

namespace montelux::test {

inline std::filesystem::path mitsuba_scenes() {
    return (std::filesystem::path(MONTELUX_SHARED_DIR) / "scenes" / "mitsuba").lexically_normal();
}

} // namespace montelux::test
