// montelux bake brdf: the split sum's table of scale and bias.
#include "app/bake.h"
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/json_number.h"
#include "app/progress_line.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "montelux/bake/brdf_table.h"
#include "montelux/image/image_write.h"
#include "montelux/image/ktx2_write.h"
#include "montelux/mc/io/file.h"

namespace montelux::app {
namespace {

struct BrdfOptions {
    std::vector<std::string> outputs;
    int size = 256;
    std::string blue = "zero", order = "scale-bias", first_row = "smooth", format = "rg16f";
    int threads = 0;
    bool json = false, quiet = false;
};

bool is(const std::string& path, const char* extension) {
    return std::filesystem::path(path).extension() == extension;
}

// R scale, G bias; or R bias, G their sum.
void reorder(Image& table) {
    for (int y = 0; y < table.height(); ++y)
        for (int x = 0; x < table.width(); ++x) {
            const float scale = table.value(x, y, 0), bias = table.value(x, y, 1);
            const float error = table.value(x, y, 3) + table.value(x, y, 4);
            table.set(x, y, 0, bias);
            table.set(x, y, 1, scale + bias);
            table.set(x, y, 3, table.value(x, y, 4));
            table.set(x, y, 4, error);
        }
}

void turn_over(Image& table) {
    const std::size_t row = static_cast<std::size_t>(table.width()) * table.channels();
    const auto samples = table.f32();
    for (int y = 0; y < table.height() / 2; ++y)
        std::swap_ranges(samples.begin() + static_cast<std::ptrdiff_t>(y * row),
                         samples.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                         samples.begin() + static_cast<std::ptrdiff_t>((table.height() - 1 - y) * row));
}

// The numbers themselves in eight bits, which write_image leaves alone under this name.
Image eight_bits(const Image& table) {
    Image picture(table.width(), table.height(), {"R", "G", "B"}, PixelFormat::u8, ColorEncoding::srgb());
    for (int y = 0; y < table.height(); ++y)
        for (int x = 0; x < table.width(); ++x)
            for (int c = 0; c < 3; ++c)
                picture.u8()[picture.index(x, y, c)] = static_cast<std::uint8_t>(
                    std::lround(255 * std::clamp(table.value(x, y, c), 0.0f, 1.0f)));
    return picture;
}

void write_table(const std::string& path, const Image& table, const BrdfOptions& o) {
    if (is(path, ".ktx2")) {
        TextureOptions texture;
        texture.format = *texel_format_named(o.format);
        const TexelLosses losses = write_ktx2(path, table, texture);
        if (losses.any())
            std::fprintf(stderr, "montelux: warning: %s: %s\n", path.c_str(),
                         losses.sentence(texture.format).c_str());
    } else if (is(path, ".png")) {
        write_image(path, eight_bits(table));
    } else {
        write_image(path, table);
    }
}

int run(const BrdfOptions& o) {
    end_on_signals();
    for (const std::string& path : o.outputs) {
        if (is(path, ".ktx2")) {
            const AtomicFile never_committed(path);
        } else {
            check_writable(path);
        }
        if (is(path, ".ktx2") && o.blue != "zero" && o.format.starts_with("rg") && o.format[2] != 'b')
            throw UsageError("--format", o.format + " has no channel B, which --blue " + o.blue +
                                             " fills; rgba16f and rgba32f have one");
    }
    BrdfTableSettings settings;
    settings.size = o.size;
    settings.extra = o.blue == "sheen"            ? BrdfTableExtra::sheen
                     : o.blue == "average-albedo" ? BrdfTableExtra::average_albedo
                                                  : BrdfTableExtra::zero;
    const auto begin = std::chrono::steady_clock::now();
    auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    ProgressLine line(o.quiet);
    settings.progress = [&](double fraction) {
        if (line.due(seconds())) line.show("bake", percent_text(fraction) + " of the table");
    };
    settings.cancel = &cancel_on_signals();
    Image table = brdf_table(settings);
    line.finish();
    if (table.empty()) {
        std::fprintf(stderr, "montelux: interrupted, nothing was written\n");
        return exit_interrupted;
    }
    const double time = seconds();
    double error = 0;
    for (int y = 0; y < table.height(); ++y)
        for (int x = 0; x < table.width(); ++x)
            for (int c = 3; c < 6; ++c) error = std::max(error, static_cast<double>(table.value(x, y, c)));
    if (o.order == "bias-sum") reorder(table);
    if (o.first_row == "rough") turn_over(table);

    finish_on_signals();
    for (const std::string& path : o.outputs) write_table(path, table, o);
    if (o.json) {
        nlohmann::ordered_json out;
        out["size"] = o.size;
        out["largest_error_bound"] = json_number(error);
        out["seconds"] = time;
        std::printf("%s\n", out.dump(2).c_str());
    } else if (!o.quiet) {
        for (const std::string& path : o.outputs)
            std::printf("%s: %d x %d texels, error below %.2g, %s\n", path.c_str(), o.size, o.size, error,
                        duration_text(time).c_str());
    }
    return exit_done;
}

} // namespace

void add_bake_brdf(CLI::App& bake, int& exit_code) {
    auto o = std::make_shared<BrdfOptions>();
    CLI::App* command =
        bake.add_subcommand("brdf", "Tabulate GGX as F0 * scale + bias over n.v and roughness");
    command
        ->add_option("-o,--output", o->outputs,
                     "Table to write; may be given several times. .exr has the errors as well; .ktx2, .pfm; "
                     ".hdr and .png, "
                     "whose 8 bits are coarse")
        ->type_name("FILE")
        ->allow_extra_args(false)
        ->required();
    command->add_option("--size", o->size, "Texels along an edge")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command
        ->add_option(
            "--blue", o->blue,
            "Channel B. zero; sheen: albedo of Charlie sheen; average-albedo: mean albedo of the row for F = "
            "1, for light that is scattered more than once")
        ->check(CLI::IsMember({"zero", "sheen", "average-albedo"}))
        ->type_name("WHAT");
    command
        ->add_option("--terms", o->order,
                     "scale-bias: R scale, G bias; bias-sum: R bias, G scale + bias, as Filament has them")
        ->check(CLI::IsMember({"scale-bias", "bias-sum"}))
        ->type_name("WHICH");
    command->add_option("--first-row", o->first_row, "The top row: smooth or rough")
        ->check(CLI::IsMember({"smooth", "rough"}))
        ->type_name("WHICH");
    command->add_option("--format", o->format, "Of the texels in .ktx2: rg16f, rg32f, rgba16f or rgba32f")
        ->check(CLI::IsMember({"rg16f", "rg32f", "rgba16f", "rgba32f"}))
        ->type_name("FORMAT");
    command->add_option("--threads", o->threads, "Threads at most; 0: one a processor")
        ->type_name("N")
        ->check(CLI::Range(0, most_threads));
    command->add_flag("--json", o->json, "Print a summary as JSON");
    command->add_flag("--quiet", o->quiet, "Print nothing but errors");
    command->footer("Texel (x, y) belongs to n.v = (x + 1/2) / size and perceptual roughness (y + 1/2) / "
                    "size, alpha = roughness^2.\n"
                    "\n"
                    "Example:\n  montelux bake brdf -o brdf.exr --size 256");
    command->callback([o, &exit_code] { exit_code = with_threads(o->threads, [&] { return run(*o); }); });
}

} // namespace montelux::app
