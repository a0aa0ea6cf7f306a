// montelux convert: pictures from one format to another, scenes to pbrt-v4.
#include "app/commands.h"
#include "app/definitions.h"
#include "app/joined.h"
#include "app/option_values.h"
#include "app/output_files.h"
#include "app/picture_layer.h"
#include "app/tone_options.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "montelux/denoise/denoise_image.h"
#include "montelux/film/film_layers.h"
#include "montelux/formats/load_scene.h"
#include "montelux/formats/pbrt/write_pbrt.h"
#include "montelux/formats/studio.h"
#include "montelux/image/half.h"
#include "montelux/image/image_read.h"

namespace montelux::app {

namespace {

struct ConvertSettings {
    std::string input, output, layer;
    std::map<std::string, std::string> definitions{};
    ToneOptions tone{};
    bool half = false, quiet = false;
};

std::string lower_extension(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

void convert_picture(const ConvertSettings& s) {
    const bool to_exr = lower_extension(s.output) == ".exr";
    if (s.half && !to_exr)
        throw UsageError("--half", "it is for .exr pictures; " + s.output + " is another one");
    check(s.tone, {s.output});
    check_writable(s.output);
    const std::string extension = lower_extension(s.input);
    if (extension == ".pbrt" || extension == ".gz")
        throw UsageError(s.output,
                         "a scene becomes a picture by 'montelux render'; convert writes it as .pbrt");
    Image image = read_image(s.input);
    ToneOptions tone = s.tone;
    if (!s.layer.empty()) {
        PictureLayer layer = layer_of(image, s.layer, s.input);
        if (layer.values != LayerValues::light && takes_tone_curve(s.output)) {
            scale_for_screen(layer);
            if (!tone.tone) tone.tone = ToneKind::linear;
            if (!tone.exposure && !tone.automatic) tone.exposure = 0;
        }
        image = std::move(layer.image);
    } else if (!to_exr && image.find_channel("denoised.R")) {
        image = denoised_picture(image);
    }
    WriteOptions writing = tone_of(tone, s.output, image, DefaultExposure::suitable, s.quiet);
    if (s.half) {
        writing.exr_half = half_channels_of(image.channel_names());
        if (const std::uint64_t beyond = half_overflows(image, writing.exr_half); beyond > 0 && !s.quiet)
            std::fprintf(stderr,
                         "montelux: warning: %s: %llu values beyond the range of 16-bit floats became %g\n",
                         s.output.c_str(), static_cast<unsigned long long>(beyond), double(largest_half));
    }
    write_image(s.output, image, writing);
    if (!s.quiet) std::printf("%s: %d x %d pixels\n", s.output.c_str(), image.width(), image.height());
}

void convert_scene(const ConvertSettings& s) {
    for (const auto& [given, option] : {std::pair(!s.layer.empty(), "--layer"), std::pair(s.half, "--half")})
        if (given) throw UsageError(option, "it is for pictures; " + s.output + " is a scene");
    check(s.tone, {s.output});
    Warnings warnings;
    std::vector<std::filesystem::path> read;
    SceneDescription description =
        load_scene(s.input, warnings, {.files_read = &read, .definitions = s.definitions});
    DiskFiles disk;
    const StudioParts added = add_studio(description, {}, disk, warnings);
    const std::filesystem::path output = s.output;
    const std::filesystem::path folder = output.parent_path() / (output.stem().string() + "-files");
    std::error_code ignored;
    for (const std::filesystem::path& file : read)
        if (std::filesystem::equivalent(file, output, ignored) ||
            std::filesystem::equivalent(file.parent_path(), folder, ignored))
            throw UsageError(s.output, "the scene is read from " + file.string() +
                                           "; what is written needs another name");
    const std::vector<std::filesystem::path> written = write_pbrt(description, output, warnings);
    if (s.quiet) return;
    if (!added.missing().empty())
        std::fprintf(stderr, "montelux: %s has no %s: the studio is written with it\n",
                     std::filesystem::path(s.input).filename().c_str(), std::string(added.missing()).c_str());
    for (const std::string& w : warnings.messages())
        std::fprintf(stderr, "montelux: warning: %s\n", w.c_str());
    if (warnings.left_out() > 0)
        std::fprintf(stderr, "montelux: warning: %zu more warnings were left out\n", warnings.left_out());
    std::printf("%s: %zu shapes, %zu lights", s.output.c_str(), description.scene.shapes.size(),
                description.scene.lights.size());
    if (written.size() > 1) std::printf(", %zu files in %s", written.size() - 1, folder.string().c_str());
    std::printf("\n");
}

} // namespace

void add_convert(CLI::App& app, int& exit_code) {
    auto s = std::make_shared<ConvertSettings>();
    CLI::App* command =
        app.add_subcommand("convert", "Convert a picture to another format, or a scene to pbrt-v4");
    command->add_option("IN", s->input, "A picture, or a scene")->required();
    command
        ->add_option(
            "OUT", s->output,
            "A picture: .exr (all layers), .png, .jpg, .hdr, .pfm; or a scene: .pbrt, whose meshes and "
            "pictures go into a folder beside it")
        ->required();
    command
        ->add_option(
            "--layer", s->layer,
            "The layer to write: mean, error, albedo, normal, depth ..., or the beginning of the names of "
            "channels such as light.key; of normals .png and .jpg show (n + 1) / 2")
        ->type_name("NAME")
        ->check(file_name());
    declare_definitions(*command, s->definitions);
    declare(*command, s->tone);
    command->add_flag("--half", s->half, ".exr: 16-bit floats where those suffice");
    command->add_flag("--quiet", s->quiet, "Print only errors");
    command->footer("Examples:\n"
                    "  montelux convert out.exr out.png --tone agx --exposure auto\n"
                    "  montelux convert out.exr error.png --layer error --exposure 4\n"
                    "  montelux convert scene.pbrt.gz plain.pbrt");
    command->callback([s, &exit_code] {
        if (lower_extension(s->output) == ".pbrt")
            convert_scene(*s);
        else
            convert_picture(*s);
        exit_code = exit_done;
    });
}

} // namespace montelux::app
