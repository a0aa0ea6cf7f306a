#include "montelux/view/picture_download.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "montelux/film/film_layers.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// Readable by this user alone, and removed with all that it contains.
class PrivateFolder {
  public:
    PrivateFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "montelux-view-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw Error(name, "cannot be created");
        path_ = name;
    }
    ~PrivateFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

std::string file_bytes(const char* name, const Image& image, const WriteOptions& options) {
    const PrivateFolder folder;
    const std::filesystem::path path = folder.path() / name;
    write_image(path, image, options);
    std::ifstream in(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    if (!in || !bytes) throw Error(path.string(), "cannot be read");
    return std::move(bytes).str();
}

} // namespace

std::string exr_bytes(const RenderSnapshot& snapshot) {
    WriteOptions options;
    if (snapshot.half) options.exr_half = half_channels_of(snapshot.image->channel_names());
    return file_bytes("picture.exr", *snapshot.image, options);
}

std::string png_bytes(const RenderSnapshot& snapshot, const ToneCurve& curve) {
    WriteOptions options;
    options.tone = curve;
    return file_bytes("picture.png", snapshot.image->select(std::vector<std::string>{"R", "G", "B"}),
                      options);
}

} // namespace montelux
