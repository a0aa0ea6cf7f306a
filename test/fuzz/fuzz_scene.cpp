// Scenes of pbrt-v4, with a file (scene_and_file.h).
#include "test/fuzz/fuzz_target.h"
#include "test/fuzz/scene_and_file.h"
#include <string_view>

#include "montelux/formats/load_scene.h"

namespace {

// The tables of the light "sky" and of the camera "realistic" take seconds under sanitizers: libFuzzer leaves them out.
bool is_slow([[maybe_unused]] std::string_view text) {
#ifdef MONTELUX_FUZZ
    return text.find("sky") != text.npos || text.find("realistic") != text.npos;
#else
    return false;
#endif
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (is_slow({reinterpret_cast<const char*>(data), size})) return 0;
    montelux::SceneAndFile files(data, size, "scene.pbrt");
    return montelux::read_or_refuse([&] {
        montelux::Warnings warnings;
        montelux::load_scene("scene.pbrt", warnings, {.source = &files});
    });
}
