// Noise of the ways to sample environment light: variance a sample of each, beside BSDF sampling and joined
// with it, for maps and materials of all sorts (docs/environment-light.md).
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "montelux/image/image_read.h"
#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/warp/sphere.h"
#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/light/environment/environment_sampler.h"

using namespace montelux;

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

// A map, what it shines of, and a way to sample it.
struct Light {
    const std::vector<float>& radiance; // of each texel
    const EnvironmentSampler* sampler;
};

enum class Use { light, bsdf, balance, power };
struct Way {
    const char* name;
    EnvironmentSampling sampling;
    bool compensated;
    Use use;
};
using enum EnvironmentSampling;
constexpr Way ways[] = {{"BSDF alone", tabulated, false, Use::bsdf},
                        {"light alone: tabulated", tabulated, false, Use::light},
                        {"median-cut", median_cut, false, Use::light},
                        {"structured", structured, false, Use::light},
                        {"MIS: tabulated, not compensated", tabulated, false, Use::power},
                        {"tabulated", tabulated, true, Use::power},
                        {"median-cut, not compensated", median_cut, false, Use::power},
                        {"median-cut", median_cut, true, Use::power},
                        {"structured, not compensated", structured, false, Use::power},
                        {"structured", structured, true, Use::power},
                        {"MIS, balance: tabulated, not compensated", tabulated, false, Use::balance},
                        {"tabulated", tabulated, true, Use::balance}};

constexpr int normals = 24;
// Normals spread over the sphere, seen at 45 degrees.
Frame frame_of(int i) {
    const double z = 1 - (2 * i + 1.0) / normals, phi = 2 * pi * i * 0.6180339887;
    const double r = std::sqrt(1 - z * z);
    return Frame::from_normal(Vec3f(Vec3d(r * std::cos(phi), r * std::sin(phi), z)));
}

// One sample, of one direction or of two joined by MIS.
double estimate(const Light& light, const Bsdf& bsdf, const Frame& frame, Use use, SampleStream& stream) {
    const Vec3f wo = normalize(Vec3f{1, 0, 1});
    const EnvironmentGrid& grid = light.sampler->grid();
    auto weight = [use](float f, float g) {
        if (use == Use::balance) return balance_heuristic(1, f, 1, g);
        return use == Use::power ? power_heuristic(1, f, 1, g) : 1.0f;
    };
    double sum = 0;
    std::visit(
        [&](const auto& b) {
            if (use != Use::bsdf) {
                const Vec2f u = stream.next_2d();
                const EnvironmentPoint s = light.sampler->sample(u);
                const BsdfEvaluation e =
                    b.evaluate(wo, frame.to_local(grid.direction(s.grid)), TransportMode::radiance, stream);
                sum += double(e.f[0]) * double(light.radiance[grid.texel(s.grid)]) *
                       double(weight(s.pdf, e.pdf) / s.pdf);
            }
            if (use == Use::light) return;
            const auto s = b.sample(wo, TransportMode::radiance, stream);
            if (!s) return;
            const Vec2f place = grid.locate(normalize(frame.to_world(s->wi)));
            sum += double(s->weight[0]) * double(light.radiance[grid.texel(place)]) *
                   double(use == Use::bsdf ? 1.0f : weight(s->pdf, light.sampler->pdf(place)));
        },
        bsdf);
    return sum;
}

struct Noise {
    double independent = 0, sobol = 0; // variance a sample over squared mean, both summed over the normals
    double mean = 0, error = 0;
};
Noise noise_of(const Light& light, const Bsdf& bsdf, Use use, std::uint32_t samples) {
    constexpr std::uint32_t points = 64;
    std::vector<Noise> all(normals);
    parallel_for(normals, [&](std::int64_t n) {
        const Frame frame = frame_of(static_cast<int>(n));
        Noise& result = all[static_cast<std::size_t>(n)];
        RunningMoments independent, sets;
        const SamplerSettings random{SamplerKind::independent, 1, samples};
        const SamplerSettings sobol{SamplerKind::sobol, 2, samples, samples / points};
        double sum = 0;
        for (std::uint32_t i = 0; i < samples; ++i) {
            SampleStream a(random, static_cast<std::uint32_t>(n), 0, i),
                b(sobol, static_cast<std::uint32_t>(n), 0, i);
            independent.add(estimate(light, bsdf, frame, use, a));
            sum += estimate(light, bsdf, frame, use, b);
            if (i % points == points - 1) {
                sets.add(sum / points);
                sum = 0;
            }
        }
        result = {independent.variance(), sets.variance() * points, independent.mean(),
                  independent.standard_error()};
    });
    Noise noise;
    double squares = 0;
    for (const Noise& n : all) {
        noise.independent += n.independent;
        noise.sobol += n.sobol;
        noise.mean += n.mean;
        noise.error += n.error * n.error;
        squares += n.mean * n.mean;
    }
    noise.error = std::sqrt(noise.error);
    noise.independent /= squares;
    noise.sobol /= squares;
    return noise;
}

// Time to draw a direction and to ask for the density of another.
double nanoseconds(const EnvironmentSampler& sampler) {
    constexpr int n = 2'000'000;
    SampleStream stream({SamplerKind::independent, 3, 1}, 0, 0, 0);
    std::vector<Vec2f> u(n);
    std::vector<Vec3f> w(n);
    for (int i = 0; i < n; ++i) {
        u[static_cast<std::size_t>(i)] = stream.next_2d();
        w[static_cast<std::size_t>(i)] = sample_uniform_sphere(stream.next_2d());
    }
    const auto begin = Clock::now();
    float sum = 0;
    for (std::size_t i = 0; i < n; ++i)
        sum +=
            sampler.grid().direction(sampler.sample(u[i]).grid).x + sampler.pdf(sampler.grid().locate(w[i]));
    const double seconds = seconds_since(begin);
    if (sum == 0.5f) std::printf(" ");
    return 1e9 * seconds / n;
}

int run(const std::vector<std::string>& files, std::uint32_t samples) {
    const SampledSpectrum white(1), eta(0.2f), k(3.9f);
    const struct {
        const char* name;
        Bsdf bsdf;
    } materials[] = {{"diffuse", DiffuseBsdf{white}},
                     {"conductor, alpha 0.3", ConductorBsdf{eta, k, {0.3f, 0.3f}}},
                     {"conductor, alpha 0.05", ConductorBsdf{eta, k, {0.05f, 0.05f}}}};
    for (const std::string& file : files) {
        const std::filesystem::path path(file);
        const Image picture = read_image(path).to_linear_f32();
        const auto layout = layout_of_size(picture.width(), picture.height());
        if (!layout || picture.channels() < 3) throw Error(file, "expected an RGB map, square or 2 : 1");
        const EnvironmentGrid grid(*layout, picture.width(), picture.height());
        std::vector<float> radiance(grid.texel_count());
        for (std::size_t i = 0; i < radiance.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                radiance[i] += picture.value_at(i * static_cast<std::size_t>(picture.channels()) + c) / 3;
        std::printf("\n%s\n", path.filename().c_str());
        std::vector<EnvironmentSampler> samplers;
        for (const bool compensated : {false, true})
            for (const EnvironmentSampling s : {tabulated, median_cut, structured}) {
                const auto begin = Clock::now();
                samplers.emplace_back(picture, *layout, EnvironmentSettings{s, compensated});
                const double seconds = seconds_since(begin);
                std::printf("  %s: built in %.0f ms, %.0f ns a direction and a density\n",
                            samplers.back().description().c_str(), 1e3 * seconds,
                            nanoseconds(samplers.back()));
            }
        std::printf("\n| way |");
        for (const auto& m : materials) std::printf(" %s | Sobol' |", m.name);
        std::printf(" means agree |\n|---|---|---|---|---|---|---|---|\n");
        double means[3] = {}, errors[3] = {};
        for (const Way& way : ways) {
            const std::size_t index = (way.compensated ? 3u : 0u) + static_cast<std::size_t>(way.sampling) -
                                      static_cast<std::size_t>(tabulated);
            std::printf("| %s |", way.name);
            double worst = 0;
            for (std::size_t m = 0; m < 3; ++m) {
                const Noise n = noise_of({radiance, &samplers[index]}, materials[m].bsdf, way.use, samples);
                std::printf(" %.4g | %.4g |", n.independent, n.sobol);
                // Against uncompensated MIS, which is the fifth.
                if (errors[m] > 0)
                    worst = std::max(worst, std::abs(n.mean - means[m]) / std::hypot(n.error, errors[m]));
                if (&way == &ways[4]) {
                    means[m] = n.mean;
                    errors[m] = n.error;
                }
            }
            std::printf(worst > 0 ? " z %.1f |\n" : " |\n", worst);
            std::fflush(stdout);
        }
    }
    return 0;
}

} // namespace

// environment_sampling SAMPLES MAP... : samples of each of the normals, a multiple of 64.
int main(int argc, char** argv) {
    const int samples = argc > 2 ? std::atoi(argv[1]) : 0;
    if (samples < 128) {
        std::fprintf(
            stderr,
            "usage: environment_sampling SAMPLES MAP...\nSAMPLES of each of %d normals, 128 or more\n",
            normals);
        return 2;
    }
    try {
        return run({argv + 2, argv + argc}, static_cast<std::uint32_t>(samples));
    } catch (const Error& e) {
        std::fprintf(stderr, "environment_sampling: %s\n", e.what());
        return 1;
    }
}
