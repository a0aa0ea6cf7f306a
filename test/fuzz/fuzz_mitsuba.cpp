// Scenes of Mitsuba 3, with a file (scene_and_file.h).
#include "test/fuzz/fuzz_target.h"
#include "test/fuzz/scene_and_file.h"
#include <string_view>

#include "montelux/formats/load_scene.h"

namespace {

// The tables of the sky take seconds under sanitizers: libFuzzer leaves it out.
bool is_slow([[maybe_unused]] std::string_view text) {
#ifdef MONTELUX_FUZZ
    return text.find("sunsky") != text.npos;
#else
    return false;
#endif
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (is_slow({reinterpret_cast<const char*>(data), size})) return 0;
    montelux::SceneAndFile files(data, size, "scene.xml");
    return montelux::read_or_refuse([&] {
        montelux::Warnings warnings;
        montelux::load_scene("scene.xml", warnings, {.source = &files});
    });
}
