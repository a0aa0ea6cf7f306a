// montelux bake brdf: the split sum's table of scale and bias.
#include "app/bake/bake.h"
#include "app/bake/bake_run.h"
#include "app/commands.h"
#include "app/json_number.h"
#include "app/output_files.h"
#include "app/progress_line.h"
#include "app/usage_error.h"
#include <CLI/CLI.hpp>
#include <algorithm>
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
    BakeRunOptions run;
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

// The most that the numbers of a file can differ from those that were computed, the largest of which is
// `largest`.
double rounding(const std::string& path, double largest, const BrdfOptions& o) {
    const int exponent = largest > 0 ? std::ilogb(largest) : 0;
    if (is(path, ".png")) return 0.5 / 255 + std::max(0.0, largest - 1);
    if (is(path, ".hdr")) return std::ldexp(1.0, exponent - 7); // 8 bits beside a shared exponent
    if (is(path, ".ktx2") && o.format.ends_with("16f")) return std::ldexp(1.0, exponent - 11);
    return std::ldexp(1.0, exponent - 24);
}

int run(const BrdfOptions& o) {
    check_output_names(o.outputs, {});
    for (const std::string& path : o.outputs) {
        check_extension(path, {".exr", ".ktx2", ".pfm", ".hdr", ".png"});
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
    BakeRun bake(o.run.quiet, "the table");
    settings.progress = bake.progress();
    settings.cancel = bake.cancel();
    Image table = brdf_table(settings);
    if (bake.interrupted(table.empty())) return exit_interrupted;
    const double time = bake.seconds();
    if (o.order == "bias-sum") reorder(table);
    if (o.first_row == "rough") turn_over(table);
    double error = 0, largest = 0;
    for (int y = 0; y < table.height(); ++y)
        for (int x = 0; x < table.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                largest = std::max(largest, static_cast<double>(table.value(x, y, c)));
                error = std::max(error, static_cast<double>(table.value(x, y, c + 3)));
            }

    OutputFiles files;
    for (const std::string& path : o.outputs) files.write(path, [&] { write_table(path, table, o); });
    if (o.run.json) {
        nlohmann::ordered_json out;
        out["size"] = o.size;
        out["largest_error_bound"] = json_number(error);
        for (const std::string& path : files.written())
            out["files"].push_back(
                {{"file", path}, {"largest_error_bound", json_number(error + rounding(path, largest, o))}});
        out["seconds"] = time;
        std::printf("%s\n", out.dump(2).c_str());
    } else if (!o.run.quiet) {
        for (const std::string& path : files.written())
            std::printf("%s: %d x %d texels, error below %.2g, %s\n", path.c_str(), o.size, o.size,
                        error + rounding(path, largest, o), duration_text(time).c_str());
    }
    files.throw_failures();
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
    declare(*command, o->run);
    command->footer("Texel (x, y) belongs to n.v = (x + 1/2) / size and perceptual roughness (y + 1/2) / "
                    "size, alpha = roughness^2.\n"
                    "\n"
                    "Example:\n  montelux bake brdf -o brdf.exr --size 256");
    on_command(*command, o->run, exit_code, [o] { return run(*o); });
}

} // namespace montelux::app
