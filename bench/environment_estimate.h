// One sample of the light that a surface reflects from an environment map, by light sampling, BSDF sampling,
// or both with MIS; with the maps and materials of bench/environment_sampling and its test.
#pragma once

#include <cmath>
#include <filesystem>
#include <vector>

#include "montelux/image/image_read.h"
#include "montelux/mc/integrate/mis.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/frame.h"
#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/bsdf/bsdf.h"
#include "montelux/scene/light/environment/environment_sampler.h"

namespace montelux::bench {

// Of R, G and B the mean, which all strategies sample by.
struct EnvironmentPicture {
    Image image;
    EnvironmentLayout layout;
    std::vector<float> radiance; // of each texel
};
inline EnvironmentPicture read_environment(const std::filesystem::path& path) {
    EnvironmentPicture map{read_image(path).to_linear_f32(), {}, {}};
    const auto layout = layout_of_size(map.image.width(), map.image.height());
    if (!layout || map.image.channels() < 3)
        throw Error(path.string(), "expected an RGB map, square or 2 : 1");
    map.layout = *layout;
    map.radiance.resize(static_cast<std::size_t>(map.image.width()) * map.image.height());
    for (std::size_t i = 0; i < map.radiance.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            map.radiance[i] += map.image.value_at(i * static_cast<std::size_t>(map.image.channels()) + c) / 3;
    return map;
}

struct EnvironmentMaterial {
    const char* name;
    Bsdf bsdf;
};
inline std::vector<EnvironmentMaterial> environment_materials() {
    const SampledSpectrum white(1), eta(0.2f), k(3.9f);
    return {{"diffuse", DiffuseBsdf{white}},
            {"conductor, alpha 0.3", ConductorBsdf{eta, k, {0.3f, 0.3f}}},
            {"conductor, alpha 0.05", ConductorBsdf{eta, k, {0.05f, 0.05f}}}};
}

enum class Use { light, bsdf, balance, power };

constexpr int normals = 24;
// Normals spread over the sphere, seen at 45 degrees.
inline Frame frame_of(int i) {
    const double z = 1 - (2 * i + 1.0) / normals, phi = 2 * pi * i * 0.6180339887;
    const double r = std::sqrt(1 - z * z);
    return Frame::from_normal(Vec3f(Vec3d(r * std::cos(phi), r * std::sin(phi), z)));
}
inline const Vec3f view = normalize(Vec3f{1, 0, 1});

// One sample, of one direction or of two joined by MIS.
inline double estimate(const std::vector<float>& radiance, const EnvironmentSampler& sampler,
                       const Bsdf& bsdf, const Frame& frame, Use use, SampleStream& stream) {
    const EnvironmentGrid& grid = sampler.grid();
    auto weight = [use](float f, float g) {
        if (use == Use::balance) return balance_heuristic(1, f, 1, g);
        return use == Use::power ? power_heuristic(1, f, 1, g) : 1.0f;
    };
    double sum = 0;
    std::visit(
        [&](const auto& b) {
            if (use != Use::bsdf) {
                const Vec2f u = stream.next_2d();
                const EnvironmentPoint s = sampler.sample(u);
                const BsdfEvaluation e =
                    b.evaluate(view, frame.to_local(grid.direction(s.grid)), TransportMode::radiance, stream);
                sum += double(e.f[0]) * double(radiance[grid.texel(s.grid)]) *
                       double(weight(s.pdf, e.pdf) / s.pdf);
            }
            if (use == Use::light) return;
            const auto s = b.sample(view, TransportMode::radiance, stream);
            if (!s) return;
            const Vec2f place = grid.locate(normalize(frame.to_world(s->wi)));
            sum += double(s->weight[0]) * double(radiance[grid.texel(place)]) *
                   double(use == Use::bsdf ? 1.0f : weight(s->pdf, sampler.pdf(place)));
        },
        bsdf);
    return sum;
}

} // namespace montelux::bench
