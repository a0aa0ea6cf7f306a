// XML of Mitsuba 3; the content of every file that it names is the whole input, too, of the first hundred. Nothing is
// read from the disk.
#include "test/fuzz/fuzz_target.h"
#include <string_view>
#include <vector>

#include "montelux/formats/mitsuba/load_mitsuba.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

class OneFile final : public montelux::FileSource {
  public:
    explicit OneFile(Bytes bytes) : bytes_(std::move(bytes)) {}
    bool exists(const std::filesystem::path&) override { return true; }
    // A file that includes itself would else be read thousands of times.
    Bytes read(const std::filesystem::path&, std::size_t) override {
        constexpr std::string_view empty = "<scene version=\"3.0.0\"/>";
        return ++reads_ <= 100 ? bytes_ : Bytes(empty.begin(), empty.end());
    }

  private:
    Bytes bytes_;
    int reads_ = 0;
};

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    OneFile files({data, data + size});
    return montelux::read_or_refuse([&] {
        montelux::Warnings warnings;
        montelux::load_mitsuba({data, data + size}, "scene.xml", warnings, files);
    });
}
