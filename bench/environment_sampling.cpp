// Noise of the ways to sample environment light: variance per sample of each, beside BSDF sampling and
// combined with it, for maps and materials of many kinds (docs/measurements/environment-sampling.md).
#include "bench/environment_estimate.h"
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/mc/warp/sphere.h"

using namespace montelux;
using namespace montelux::bench;

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

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

struct Noise {
    double independent = 0, sobol = 0; // variance per sample over squared mean, both summed over the normals
    double mean = 0, error = 0;
};
Noise noise_of(const EnvironmentPicture& map, const EnvironmentSampler& sampler, const Bsdf& bsdf, Use use,
               std::uint32_t samples) {
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
            independent.add(estimate(map.radiance, sampler, bsdf, frame, use, a));
            sum += estimate(map.radiance, sampler, bsdf, frame, use, b);
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

// Time to draw a direction and to evaluate the density of another.
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
    const std::vector<EnvironmentMaterial> materials = environment_materials();
    for (const std::string& file : files) {
        const std::filesystem::path path(file);
        const EnvironmentPicture map = read_environment(path);
        std::printf("\n%s\n", path.filename().c_str());
        std::vector<EnvironmentSampler> samplers;
        for (const bool compensated : {false, true})
            for (const EnvironmentSampling s : {tabulated, median_cut, structured}) {
                const auto begin = Clock::now();
                samplers.emplace_back(map.image, map.layout, EnvironmentSettings{s, compensated});
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
                const Noise n = noise_of(map, samplers[index], materials[m].bsdf, way.use, samples);
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
