// glTF 2.0, text or binary; the content of every other file that it names is the whole input, too. Nothing is read from
// the disk.
#include "test/fuzz/fuzz_target.h"
#include <vector>

#include "montelux/formats/gltf/load_gltf.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

class OneFile final : public montelux::FileSource {
  public:
    explicit OneFile(Bytes bytes) : bytes_(std::move(bytes)) {}
    bool exists(const std::filesystem::path&) override { return true; }
    Bytes read(const std::filesystem::path&, std::size_t) override { return bytes_; }

  private:
    Bytes bytes_;
};

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    OneFile files({data, data + size});
    return montelux::read_or_refuse([&] {
        montelux::Warnings warnings;
        montelux::load_gltf({data, data + size}, "scene.gltf", warnings, files,
                            {.time = 0.5, .shutter = 0.25});
    });
}
