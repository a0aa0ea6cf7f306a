// Pictures with errors beside converged references: how often errors cover the truth, and whether renders
// that are asked for an error end with it.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/image/image_read.h"
#include "montelux/image/metrics.h"
#include "montelux/mc/math/compensated.h"
#include "montelux/render/renderer.h"

using namespace montelux;

namespace {

struct Options {
    std::filesystem::path scenes; // of folders with scene.pbrt, ref/mean.exr and ref/stderr.exr
    std::vector<std::string> names{"cornell-box",     "veach-mis",     "material-testball",
                                   "killeroo-simple", "killeroo-gold", "coffee"};
    std::vector<std::string> samplers{"independent", "sobol"};
    std::uint32_t spp = 256;
    std::vector<double> targets;
    double seconds = 0; // at most, for a target
    std::uint64_t seed = 1;
};

struct Reference {
    Image mean, error;
};

// Of scores z of pixels and channels, errors of both pictures taken together.
struct Coverage {
    std::uint64_t count = 0, within_one = 0, within_two = 0;
    void add(double z) {
        ++count;
        within_one += std::abs(z) <= 1;
        within_two += std::abs(z) <= 2;
    }
    double one() const { return 100 * static_cast<double>(within_one) / static_cast<double>(count); }
    double two() const { return 100 * static_cast<double>(within_two) / static_cast<double>(count); }
};

struct Figures {
    FilmError claimed;
    double true_error = 0;      // root mean square of the luminance's, over the reference's mean
    double reference_error = 0; // the same of the reference's own error, which true_error is free of
    double heavy_share = 0;     // of the pixels, that are told to have heavy tails
    Coverage all, light;        // all pixels, and those without heavy tails
    RenderReport report;
};

Figures render(SceneDescription d, const Reference& reference, const std::string& sampler, bool adaptive,
               const RenderTarget& target, std::uint32_t spp, std::uint64_t seed) {
    d.sampler = {sampler == "independent" ? SamplerKind::independent : SamplerKind::sobol, seed, spp};
    RenderTarget t = target;
    t.adaptive = adaptive;
    Film film(d.film);
    Figures f;
    f.report = Renderer(d, t).render(film);
    f.claimed = film.error();

    const Image picture = film.develop();
    const MeasuredPicture a = measured_picture("picture", picture);
    const MeasuredPicture b = measured_picture("reference", reference.mean, "its errors", reference.error);
    CompensatedSum square, own, mean;
    std::size_t i = 0, heavy_pixels = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x, ++i) {
            const bool heavy = is_heavy_tailed(film.pixels()[i]);
            double luminance = 0, difference = 0, error = 0;
            for (int c = 0; c < 3; ++c) {
                const double w = luminance_weight[c], distance = a.value(x, y, c) - b.value(x, y, c);
                luminance += w * b.value(x, y, c);
                difference += w * distance;
                error += w * b.standard_error(x, y, c);
                const double s = std::hypot(a.standard_error(x, y, c), b.standard_error(x, y, c));
                if (!(s > 0)) continue;
                f.all.add(distance / s);
                if (!heavy) f.light.add(distance / s);
            }
            mean.add(luminance);
            square.add(difference * difference - error * error);
            own.add(error * error);
            heavy_pixels += heavy;
        }
    const auto n = static_cast<double>(i);
    f.true_error = std::sqrt(std::max(0.0, square.value() / n)) / (mean.value() / n);
    f.reference_error = std::sqrt(own.value() / n) / (mean.value() / n);
    f.heavy_share = static_cast<double>(heavy_pixels) / n;
    return f;
}

void print_coverage(const Options& o, const std::string& name, const SceneDescription& d,
                    const Reference& r) {
    for (const std::string& sampler : o.samplers)
        for (bool adaptive : {false, true}) {
            const Figures f = render(d, r, sampler, adaptive, {}, o.spp, o.seed);
            std::printf("| %s | %s | %s | %.1f | %.1f %% | %.1f %% | %.2f %% | %.1f %% | %.1f %% | %.2f %% | "
                        "%.2f %% |\n",
                        name.c_str(), sampler.c_str(), adaptive ? "on" : "off", f.claimed.mean_samples,
                        f.all.one(), f.all.two(), 100 * f.heavy_share, f.light.one(), f.light.two(),
                        100 * f.claimed.relative, 100 * f.true_error);
            std::fflush(stdout);
        }
}

void print_targets(const Options& o, const std::string& name, const SceneDescription& d, const Reference& r) {
    for (double target : o.targets)
        for (const std::string& sampler : o.samplers)
            for (bool adaptive : {false, true}) {
                const Figures f = render(d, r, sampler, adaptive, {.error = target, .seconds = o.seconds},
                                         1u << 30, o.seed);
                std::printf("| %s | %g %% | %s | %s | %.1f | %.2f %% | %.2f %% | %.2f | %.2f %% | %s |\n",
                            name.c_str(), 100 * target, sampler.c_str(), adaptive ? "on" : "off",
                            f.claimed.mean_samples, 100 * f.claimed.relative, 100 * f.true_error,
                            f.true_error / target, 100 * f.reference_error,
                            std::string(to_string(f.report.stop)).c_str());
                std::fflush(stdout);
            }
}

} // namespace

int main(int argc, char** argv) try {
    Options o;
    CLI::App app("Errors of pictures beside references");
    app.add_option("scenes", o.scenes, "Folder of the scenes")->required();
    app.add_option("--scene", o.names, "Some of them");
    app.add_option("--sampler", o.samplers, "independent, sobol");
    app.add_option("--spp", o.spp, "Samples a pixel, for the shares of pixels");
    app.add_option("--target", o.targets, "Errors to ask for, instead of the shares of pixels");
    app.add_option("--time", o.seconds, "Seconds for each of these at most");
    app.add_option("--seed", o.seed, "Seed");
    CLI11_PARSE(app, argc, argv);
    if (o.targets.empty())
        std::printf(
            "| scene | sampler | adaptive | spp | within 1 | within 2 | heavy tails | others within 1 | "
            "within 2 | error claimed | true |\n|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    else
        std::printf("| scene | asked | sampler | adaptive | spp | claimed | true | true / asked | "
                    "reference's | stopped by |\n|---|--:|---|---|--:|--:|--:|--:|--:|---|\n");
    for (const std::string& name : o.names) {
        Warnings warnings;
        const std::filesystem::path folder = o.scenes / name;
        const SceneDescription d = load_pbrt(folder / "scene.pbrt", warnings);
        const Reference r{read_image(folder / "ref" / "mean.exr"), read_image(folder / "ref" / "stderr.exr")};
        if (o.targets.empty())
            print_coverage(o, name, d, r);
        else
            print_targets(o, name, d, r);
    }
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
