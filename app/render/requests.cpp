#include "app/render/requests.h"

#include "app/usage_error.h"
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <system_error>

#include "montelux/film/film.h"
#include "montelux/film/film_layers.h"
#include "montelux/film/spectral_buckets.h"
#include "montelux/image/image_write.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/physical_memory.h"

namespace montelux::app {

namespace {

// Without this check the kernel would kill a process for memory, seconds or hours later.
void check_memory(const FilmSettings& film, const FilmLayers& layers, bool with_checkpoints) {
    const double there = physical_memory();
    constexpr double copies = 2; // the picture, and its encoding
    const auto channels =
        static_cast<double>(layers.channels().size() + 6); // with those of slices and denoising
    double pixels = static_cast<double>(film.crop.width()) * film.crop.height();
    const double buckets = film.spectral ? film.spectral->buckets : 0;
    double needed =
        pixels * buckets * ((with_checkpoints ? 2 : 1) * sizeof(BucketMoments) + 2 * copies * sizeof(float));
    needed += pixels * ((with_checkpoints ? 2 : 1) * (sizeof(Pixel) + sizeof(std::uint32_t) +
                                                      static_cast<double>(sizeof(double) * layers.sums())) +
                        channels * copies * sizeof(float));
    if (needed <= there) return;
    constexpr double gib = 1 << 30;
    char text[160];
    std::snprintf(text, sizeof text, "%d x %d pixels need %.1f GiB of memory; this machine has %.1f GiB",
                  film.crop.width(), film.crop.height(), needed / gib, there / gib);
    throw Error("film", text);
}

} // namespace

std::vector<std::string> outputs_of(const RenderOptions& options, const SceneDescription& description) {
    if (!options.outputs.empty()) {
        std::vector<std::string> outputs;
        for (const std::string& output : options.outputs)
            if (std::find(outputs.begin(), outputs.end(), output) == outputs.end()) outputs.push_back(output);
        return outputs;
    }
    // The file's own name, in the current folder, always as EXR, the only format with all layers.
    std::filesystem::path name = description.output_file.empty() ? options.scene : description.output_file;
    return {name.filename().replace_extension(".exr").string()};
}

void check_not_read(const std::string& output, const std::vector<std::filesystem::path>& files_read) {
    std::error_code ignored;
    for (const std::filesystem::path& file : files_read)
        if (std::filesystem::equivalent(output, file, ignored))
            throw UsageError(output, "the scene is read from this file; what is written needs another name");
}

void check_picture_path(const std::string& output, const std::vector<std::filesystem::path>& files_read) {
    check_writable(output);
    check_not_read(output, files_read);
}

void check_requested(const SceneDescription& description, const RenderTarget& target, bool with_checkpoints) {
    if (target.slice.count > 1 && description.film.layers.set != LayerSet::standard())
        throw UsageError("--slice", "slices are joined by their standard layers; add --layers default");
    check_memory(description.film, film_layers_of(description), with_checkpoints);
}

void LoadNotices::print(const std::string& scene, const Warnings& warnings, const StudioParts& added) {
    for (const std::string& w : warnings.messages()) print_once("montelux: warning: " + w);
    if (warnings.left_out() > 0)
        print_once("montelux: warning: " + std::to_string(warnings.left_out()) +
                   " more warnings were left out");
    if (added.missing().empty()) return;
    print_once("montelux: " + std::filesystem::path(scene).filename().string() + " has no " +
               std::string(added.missing()) +
               ": a studio was added (--environment, --orbit, --ground, --background change it)");
}

void LoadNotices::print_once(const std::string& line) {
    if (printed_.insert(line).second) std::fprintf(stderr, "%s\n", line.c_str());
}

} // namespace montelux::app
