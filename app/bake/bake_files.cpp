#include "app/bake/bake_files.h"

#include "app/option_values.h"
#include "app/output_files.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "montelux/image/dds_write.h"
#include "montelux/image/image_write.h"
#include "montelux/image/ktx1_write.h"
#include "montelux/image/ktx2_write.h"
#include "montelux/mc/io/file.h"

namespace montelux::app {
namespace {

enum class Kind { ktx2, ktx1, dds, picture };

Kind kind_of(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    return extension == ".ktx2"  ? Kind::ktx2
           : extension == ".ktx" ? Kind::ktx1
           : extension == ".dds" ? Kind::dds
                                 : Kind::picture;
}

TexelFormat format_of(const BakeFileOptions& options) { return *texel_format_named(options.format); }

bool holds_colours(TexelFormat format) {
    return format != TexelFormat::rg16f && format != TexelFormat::rg32f;
}

struct Picture {
    std::filesystem::path path;
    std::size_t level = 0;
    int face = -1; // all
};

std::vector<Picture> pictures_of(const std::filesystem::path& path, const BakeFileOptions& options,
                                 std::size_t levels) {
    std::vector<Picture> pictures;
    for (std::size_t level = 0; level < levels; ++level) {
        const std::optional<int> number =
            levels > 1 ? std::optional<int>(static_cast<int>(level)) : std::nullopt;
        if (options.layout == "faces") {
            for (int face = 0; face < cube_faces; ++face)
                pictures.push_back({cube_face_path(path, static_cast<CubeFace>(face), number), level, face});
        } else {
            std::filesystem::path name = path;
            if (number)
                name.replace_filename(path.stem().string() + "_m" + std::to_string(*number) +
                                      path.extension().string());
            pictures.push_back({name, level, -1});
        }
    }
    return pictures;
}

Image flat(const CubeMap& map, const BakeFileOptions& options, int face) {
    if (face >= 0) return map.faces[static_cast<std::size_t>(face)];
    return lay_out(map, *cube_layout_named(options.layout));
}

void warn_of(const std::string& path, const TexelLosses& losses, TexelFormat format) {
    if (losses.any())
        std::fprintf(stderr, "montelux: warning: %s: %s\n", path.c_str(), losses.sentence(format).c_str());
}

} // namespace

void declare(CLI::App& command, BakeFileOptions& options) {
    command
        .add_option("--layout", options.layout,
                    "Of pictures: cross, vertical, horizontal, or faces (six files per level, _px to _nz)")
        ->check(CLI::IsMember({"cross", "vertical", "horizontal", "faces"}))
        ->type_name("LAYOUT");
    command
        .add_option(
            "--format", options.format,
            "Of the texels in .ktx2, .ktx and .dds: rgba16f, rgba32f, rgb9e5, r11g11b10f or rgbm8 (.ktx and "
            ".dds: the first two); with rgbm8 a .png holds RGBM as well")
        ->check(CLI::IsMember({"rgba16f", "rgba32f", "rgb9e5", "r11g11b10f", "rgbm8"}))
        ->type_name("FORMAT");
    auto given = [&options](const std::string&) { options.rgbm_given = true; };
    command.add_option("--rgbm-range", options.rgbm.range, "RGBM: light = (range * RGB * M)^power")
        ->check(number_within(1, 65536))
        ->type_name("RANGE")
        ->each(given);
    command.add_option("--rgbm-power", options.rgbm.power, "RGBM: 1, or 2 for more precision in the dark")
        ->check(CLI::Range(1, 2))
        ->type_name("POWER")
        ->each(given);
    declare(command, options.tone);
}

void check(const BakeFileOptions& options, const std::vector<std::string>& outputs) {
    check(options.tone, outputs);
    if (options.rgbm_given && options.format != "rgbm8")
        throw UsageError("--rgbm-range and --rgbm-power",
                         "they are of --format rgbm8; the format is " + options.format);
}

std::vector<std::string> cube_file_names(const std::string& path, const BakeFileOptions& options,
                                         std::size_t levels) {
    if (kind_of(path) != Kind::picture) return {path};
    std::vector<std::string> names;
    for (const Picture& picture : pictures_of(path, options, levels)) names.push_back(picture.path.string());
    return names;
}

void check_cube_file(const std::string& path, const BakeFileOptions& options, std::size_t levels) {
    const Kind kind = kind_of(path);
    if (kind == Kind::picture) {
        check_extension(path, {".ktx2", ".ktx", ".dds", ".exr", ".hdr", ".pfm", ".png", ".jpg", ".jpeg"});
        for (const Picture& picture : pictures_of(path, options, levels)) check_writable(picture.path);
        return;
    }
    const TexelFormat format = format_of(options);
    if (!holds_colours(format) ||
        (kind != Kind::ktx2 && format != TexelFormat::rgba16f && format != TexelFormat::rgba32f))
        throw UsageError(path, "--format " + options.format +
                                   " does not go into this kind of file; rgba16f and rgba32f do");
    const AtomicFile never_committed(path);
}

void write_cube_file(const std::string& path, const BakeFileOptions& options, const BakedCubes& baked,
                     const std::map<std::string, std::string>& notes, bool quiet) {
    TextureOptions texture;
    texture.format = format_of(options);
    texture.rgbm = options.rgbm;
    const Kind kind = kind_of(path);
    if (kind == Kind::dds) return warn_of(path, write_dds(path, baked.value, texture), texture.format);
    texture.notes = notes;
    if (kind == Kind::ktx2) return warn_of(path, write_ktx2(path, baked.value, texture), texture.format);
    if (kind == Kind::ktx1) return warn_of(path, write_ktx1(path, baked.value, texture), texture.format);

    const std::string extension = std::filesystem::path(path).extension().string();
    const bool as_rgbm = extension == ".png" && texture.format == TexelFormat::rgbm8;
    // The corners of a cross are black, those of a strip are not there.
    const WriteOptions writing =
        as_rgbm ? WriteOptions{}
                : tone_of(options.tone, path, lay_out(baked.value.levels[0], CubeLayout::horizontal_strip),
                          DefaultExposure::suitable, quiet);
    TexelLosses losses;
    for (const Picture& picture : pictures_of(path, options, baked.value.levels.size())) {
        Image image = flat(baked.value.levels[picture.level], options, picture.face);
        if (extension == ".exr")
            image.append(flat(baked.standard_error.levels[picture.level], options, picture.face), "stderr.");
        if (as_rgbm) image = rgbm_picture(image, options.rgbm, losses);
        write_image(picture.path, image, writing);
    }
    warn_of(path, losses, texture.format);
}

} // namespace montelux::app
