// Output files of baked cube maps; the extension chooses the format.
#pragma once

#include "app/usage_error.h"
#include <string>
#include <vector>

#include "montelux/bake/prefilter.h"
#include "montelux/image/cube_layout.h"
#include "montelux/image/texel_format.h"

namespace CLI {
class App;
}

namespace montelux::app {

struct BakeFileOptions {
    std::string layout = "cross", format = "rgba16f";
    RgbmScale rgbm;
    bool rgbm_given = false;
    float exposure = 0;
};

void declare(CLI::App& command, BakeFileOptions& options);

// Throws UsageError for options that contradict each other.
void check(const BakeFileOptions& options);
// The names of the files that are written for `path`.
std::vector<std::string> cube_file_names(const std::string& path, const BakeFileOptions& options,
                                         std::size_t levels);
// Throws Error or UsageError if writing would fail later.
void check_cube_file(const std::string& path, const BakeFileOptions& options, std::size_t levels);
// .ktx2, .ktx, .dds: one file with all levels. .exr, .hdr, .pfm, .png: a picture per level (and per face, with
// the layout faces); .exr with the standard errors. `notes` are written to .ktx2 and .ktx. Warns of values
// that the format cannot represent.
void write_cube_file(const std::string& path, const BakeFileOptions& options, const BakedCubes& baked,
                     const std::map<std::string, std::string>& notes);

} // namespace montelux::app
