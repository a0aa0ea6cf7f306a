// Scenes of pbrt-v4. The input up to its first NUL byte is the scene; what follows that byte is the content of every
// other file that the scene names (included scenes, meshes, pictures, spectra, lenses, grids), whatever the name.
// Nothing is read from the disk.
#include "test/fuzz/fuzz_target.h"
#include <algorithm>
#include <string_view>
#include <vector>

#include "montelux/formats/load_scene.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

class TwoFiles final : public montelux::FileSource {
  public:
    TwoFiles(Bytes scene, Bytes other) : scene_(std::move(scene)), other_(std::move(other)) {}
    bool exists(const std::filesystem::path&) override { return true; }
    Bytes read(const std::filesystem::path& path, std::size_t) override {
        return path == "scene.pbrt" ? scene_ : other_;
    }

  private:
    Bytes scene_, other_;
};

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
    const std::uint8_t* end = data + size;
    if (is_slow({reinterpret_cast<const char*>(data), size})) return 0;
    const std::uint8_t* nul = std::find(data, end, std::uint8_t{0});
    TwoFiles files({data, nul}, {nul == end ? end : nul + 1, end});
    return montelux::read_or_refuse([&] {
        montelux::Warnings warnings;
        montelux::load_scene("scene.pbrt", warnings, {.source = &files});
    });
}
