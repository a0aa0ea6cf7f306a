// Output files of baked cube maps; the extension chooses the format.
#pragma once

#include "app/tone_options.h"
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
    ToneOptions tone{};
};

void declare(CLI::App& command, BakeFileOptions& options);

// Throws UsageError for options that contradict each other, or that none of the files takes.
void check(const BakeFileOptions& options, const std::vector<std::string>& outputs);
// The names of the files that are written for `path`.
std::vector<std::string> cube_file_names(const std::string& path, const BakeFileOptions& options,
                                         std::size_t levels);
// Throws Error or UsageError if writing would fail later.
void check_cube_file(const std::string& path, const BakeFileOptions& options, std::size_t levels);
// .ktx2, .ktx, .dds: one file with all levels. .exr, .hdr, .pfm, .png, .jpg: a picture per level (and per face, with
// the layout faces), all at the exposure of level 0; .exr with the standard errors. `notes` are written to .ktx2 and .ktx. Warns of values
// that the format cannot represent.
void write_cube_file(const std::string& path, const BakeFileOptions& options, const BakedCubes& baked,
                     const std::map<std::string, std::string>& notes, bool quiet);

} // namespace montelux::app
