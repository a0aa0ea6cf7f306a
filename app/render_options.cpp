#include "app/render_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "montelux/mc/math/error.h"

namespace montelux::app {

namespace {

constexpr std::array<std::pair<const char*, SamplerKind>, 6> samplers{
    {{"independent", SamplerKind::independent},
     {"stratified", SamplerKind::stratified},
     {"halton", SamplerKind::halton},
     {"hammersley", SamplerKind::hammersley},
     {"sobol", SamplerKind::sobol},
     {"sobol-blue-noise", SamplerKind::sobol_blue_noise}}};
constexpr std::array<std::pair<const char*, Strategy>, 4> strategies{{{"uniform", Strategy::uniform},
                                                                      {"bsdf", Strategy::bsdf},
                                                                      {"light", Strategy::light},
                                                                      {"mis", Strategy::mis}}};
constexpr std::array<std::pair<const char*, Heuristic>, 2> heuristics{
    {{"balance", Heuristic::balance}, {"power", Heuristic::power}}};

template <typename Table>
std::string names(const Table& table) {
    std::string list;
    for (const auto& [name, value] : table) list += (list.empty() ? "" : ", ") + std::string(name);
    return list;
}

template <typename Table>
auto find(const Table& table, const std::string& name, const char* option) {
    for (const auto& [known, value] : table)
        if (name == known) return value;
    throw UsageError(option, "'" + name + "' is not one of " + names(table));
}

std::pair<int, int> parse_resolution(const std::string& s) {
    int w = 0, h = 0;
    const char* end = s.data() + s.size();
    auto [p, e] = std::from_chars(s.data(), end, w);
    if (e == std::errc() && p != end && (*p == 'x' || *p == 'X')) {
        auto [q, f] = std::from_chars(p + 1, end, h);
        if (f == std::errc() && q == end && w > 0 && h > 0 && w <= Image::max_dimension &&
            h <= Image::max_dimension)
            return {w, h};
    }
    throw UsageError("--resolution", "'" + s +
                                         "' was given; WIDTHxHEIGHT in pixels is expected, each from 1 to " +
                                         std::to_string(Image::max_dimension) + ", for example 640x480");
}

PixelBounds crop_of(const std::vector<double>& c, int width, int height) {
    if (c.size() != 4) throw UsageError("--crop", "four numbers are expected: x0,x1,y0,y1");
    for (double v : c)
        if (!(v >= 0 && v <= 1))
            throw UsageError("--crop", "the numbers are fractions of the film, from 0 to 1: x0,x1,y0,y1");
    auto pixel = [](double v, int n) { return static_cast<int>(std::ceil(v * n - 1e-9)); };
    PixelBounds b{pixel(c[0], width), pixel(c[2], height), pixel(c[1], width), pixel(c[3], height)};
    if (b.width() < 1 || b.height() < 1)
        throw UsageError("--crop", "no pixel lies within; x0 < x1 and y0 < y1 are expected");
    return b;
}

} // namespace

std::string name_of(SamplerKind kind) {
    for (const auto& [name, value] : samplers)
        if (value == kind) return name;
    return "?";
}
std::string name_of(Strategy strategy) {
    for (const auto& [name, value] : strategies)
        if (value == strategy) return name;
    return "?";
}

void declare(CLI::App& c, RenderOptions& o) {
    c.add_option("SCENE", o.scene, "scene file (pbrt-v4; .gz too)")->required();
    c.add_option("-o,--output", o.outputs, "output file, .exr .png .hdr or .pfm; may be given several times");
    c.add_option("--spp", o.spp, "samples a pixel");
    c.add_option("--seed", o.seed, "seed of all random numbers (default 0)");
    c.add_option("--threads", o.threads,
                 "threads (default: one a processor); the picture does not depend on it");
    c.add_option("--resolution", o.resolution, "WIDTHxHEIGHT in pixels");
    c.add_option("--crop", o.crop, "x0,x1,y0,y1 as fractions of the film")->delimiter(',')->expected(4);
    c.add_option("--sampler", o.sampler, names(samplers));
    c.add_option("--strategy", o.strategy, "how light is found: " + names(strategies));
    c.add_option("--heuristic", o.heuristic, "weights of --strategy mis: " + names(heuristics));
    c.add_option("--max-depth", o.max_depth, "scattering events of a path");
    c.add_flag("--stats", o.stats, "print rays/s, share of time inside Embree, memory, ...");
    c.add_flag("--quiet", o.quiet, "print nothing but errors");
}

void apply(const RenderOptions& o, SceneDescription& d) {
    if (o.resolution) {
        auto [w, h] = parse_resolution(*o.resolution);
        // The crop of the file keeps its place on the film.
        auto scaled = [](int v, int from, int to) {
            return static_cast<int>(static_cast<long long>(v) * to / from);
        };
        PixelBounds& b = d.film.crop;
        b = {scaled(b.x0, d.film.width, w), scaled(b.y0, d.film.height, h), scaled(b.x1, d.film.width, w),
             scaled(b.y1, d.film.height, h)};
        b.x1 = std::max(b.x1, b.x0 + 1);
        b.y1 = std::max(b.y1, b.y0 + 1);
        d.film.width = w;
        d.film.height = h;
    }
    if (!o.crop.empty()) d.film.crop = crop_of(o.crop, d.film.width, d.film.height);
    if (o.spp) {
        if (*o.spp < 1 || *o.spp > (1ll << 30))
            throw UsageError("--spp", std::to_string(*o.spp) +
                                          " was given; 1 to 1073741824 samples a pixel are expected");
        d.sampler.samples_per_pixel = static_cast<std::uint32_t>(*o.spp);
    }
    if (o.seed) d.sampler.seed = static_cast<std::uint64_t>(*o.seed);
    if (o.sampler) d.sampler.kind = find(samplers, *o.sampler, "--sampler");
    if (o.strategy) d.integrator.strategy = find(strategies, *o.strategy, "--strategy");
    if (o.heuristic) d.integrator.heuristic = find(heuristics, *o.heuristic, "--heuristic");
    if (o.max_depth) {
        if (*o.max_depth < 0 || *o.max_depth > 1'000'000)
            throw UsageError("--max-depth",
                             std::to_string(*o.max_depth) + " was given; 0 to 1000000 is expected");
        d.integrator.max_depth = static_cast<int>(*o.max_depth);
    }
    if (o.threads < 0 || o.threads > 4096)
        throw UsageError("--threads",
                         std::to_string(o.threads) + " was given; 0 (all processors) to 4096 is expected");
}

} // namespace montelux::app
