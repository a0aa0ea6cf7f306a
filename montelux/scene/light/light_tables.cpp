#include "montelux/scene/light/light_tables.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/shape/alpha.h"
#include "montelux/scene/shape/surface_point.h"

namespace montelux {

namespace {

LightTriangle light_triangle(const Scene& scene, const AreaLight& light) {
    const Shape& shape = scene.shapes[light.shape];
    const TriangleMesh& mesh = scene.meshes[shape.mesh];
    const Index* v = &mesh.indices[3 * std::size_t{light.primitive}];
    LightTriangle t;
    t.p0 = mesh.positions[v[0]];
    t.e1 = mesh.positions[v[1]] - t.p0;
    t.e2 = mesh.positions[v[2]] - t.p0;
    Vec3f c = cross(t.e1, t.e2);
    float len = length(c);
    t.area = 0.5f * len;
    if (len > 0) {
        // The same side as a hit at the centroid would report.
        Hit hit{.b1 = 1.0f / 3, .b2 = 1.0f / 3, .shape = light.shape, .primitive = light.primitive};
        SurfacePoint s = surface_point(scene, Ray{}, hit, false);
        t.n = s.ng;
        t.error = s.error;
    }
    return t;
}

// Mean over the visible range.
double mean(const Spectrum& s) {
    double sum = 0;
    int n = 0;
    for (float lambda = lambda_min; lambda <= lambda_max; lambda += 5, ++n) sum += double(s(lambda));
    return sum / n;
}

// That of every environment map, as of ImageInfiniteLight.
const RgbColorSpace& map_color_space() { return RgbColorSpace::srgb(); }

RgbUnboundedSpectrum texel_spectrum(const Image& map, std::size_t texel) {
    const std::size_t i = texel * static_cast<std::size_t>(map.channels());
    Vec3f rgb{map.value_at(i), map.value_at(i + 1), map.value_at(i + 2)};
    return {map_color_space(), max(rgb, Vec3f{0, 0, 0})};
}

// Above this size (64 MiB of spectra) texels are uplifted when they are looked up.
constexpr std::size_t max_precomputed_texels = std::size_t{1} << 22;

std::vector<RgbUnboundedSpectrum> map_spectra(const Image& map) {
    if (map.pixel_count() > max_precomputed_texels) return {};
    std::vector<RgbUnboundedSpectrum> spectra(map.pixel_count());
    parallel_for(map.height(), [&](std::int64_t y) {
        for (std::size_t x = 0, i = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width());
             x < static_cast<std::size_t>(map.width()); ++x, ++i)
            spectra[i] = texel_spectrum(map, i);
    });
    return spectra;
}

} // namespace

SampledSpectrum LightTables::texel_factor(const Scene& scene, const ImageInfiniteLight& light,
                                          std::size_t texel, const SampledWavelengths& lambda) const {
    const auto& spectra = map_spectra_[light.environment];
    if (!spectra.empty()) return spectra[texel].sample(lambda);
    return texel_spectrum(scene.environments[light.environment], texel).sample(lambda);
}

SampledSpectrum LightTables::map_radiance(const Scene& scene, const ImageInfiniteLight& light,
                                          const EnvironmentGrid& grid, Vec2f place,
                                          const SampledWavelengths& lambda) const {
    SampledSpectrum white = map_color_space().illuminant().sample(lambda);
    if (lookup_ == EnvironmentLookup::nearest)
        return texel_factor(scene, light, grid.texel(place), lambda) * white;
    const EnvironmentGrid::Blend blend = grid.blend(place);
    SampledSpectrum sum;
    for (std::size_t k = 0; k < 4; ++k)
        sum += texel_factor(scene, light, blend.texel[k], lambda) * blend.share[k];
    return sum * white;
}

Bounds3 bounds_of(const Scene& scene) {
    Bounds3 bounds;
    auto add_shape = [&](Index index, const Transform* t) {
        const Shape& shape = scene.shapes[index];
        auto add = [&](Vec3d p) { bounds.add(t != nullptr ? t->point(p) : p); };
        if (shape.mesh != no_index) {
            for (Point3f p : scene.meshes[shape.mesh].positions) add(Vec3d(p));
        } else {
            const Bounds3 b = world_bounds(scene.quadrics[shape.quadric]);
            for (int i = 0; i < 8; ++i) add(b.corner(i));
        }
    };
    for (Index shape : scene.world_shapes) add_shape(shape, nullptr);
    for (const Instance& instance : scene.instances)
        for (Index shape : scene.objects[instance.object].shapes)
            add_shape(shape, &instance.world_from_object);
    return bounds;
}

LightTables::LightTables(const Scene& scene, const EnvironmentSettings& settings)
    : lookup_(settings.lookup), triangle_of_light_(scene.lights.size(), no_index),
      spheres_(scene.lights.size()), disks_(scene.lights.size()),
      environment_of_light_(scene.lights.size(), no_index), bounds_(bounds_of(scene)) {
    std::map<std::pair<Index, EnvironmentLayout>, Index> known_environments;
    auto environment_of = [&](std::size_t light, Index map, EnvironmentLayout layout) -> const auto& {
        auto [known, is_new] =
            known_environments.try_emplace({map, layout}, static_cast<Index>(environments_.size()));
        if (is_new) environments_.emplace_back(scene.environments[map], layout, settings);
        environment_of_light_[light] = known->second;
        return environments_[known->second];
    };
    map_spectra_.resize(scene.environments.size());

    double radius = std::max(bounds_.radius(), 1e-30);
    double cross_section = pi * radius * radius;
    std::vector<double> powers;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        double power = std::visit(
            [&](const auto& light) -> double {
                using L = std::decay_t<decltype(light)>;
                if constexpr (std::is_same_v<L, AreaLight>) {
                    const Shape& shape = scene.shapes[light.shape];
                    double area;
                    if (shape.mesh != no_index) {
                        triangle_of_light_[i] = static_cast<Index>(triangles_.size());
                        triangles_.push_back(light_triangle(scene, light));
                        area = double(triangles_.back().area);
                    } else {
                        const Quadric& quadric = scene.quadrics[shape.quadric];
                        area = world_area(quadric);
                        // Through its holes the far side is seen, too, which the cone does not sample.
                        if (!is_cut_out(shape)) spheres_[i] = whole_sphere(quadric);
                        disks_[i] = whole_disk(quadric);
                    }
                    const float alpha = constant_alpha(scene, shape).value_or(1);
                    if (alpha > 0 && alpha < 1) area *= double(alpha);
                    return pi * area * (light.two_sided ? 2 : 1) * double(light.scale) * mean(light.spectrum);
                } else if constexpr (std::is_same_v<L, ImageInfiniteLight>) {
                    infinite_lights_.push_back(static_cast<Index>(i));
                    const Image& map = scene.environments[light.environment];
                    auto& spectra = map_spectra_[light.environment];
                    if (spectra.empty()) spectra = map_spectra(map);
                    // The photometric normalisation is in `scale`; so is the mean of the white illuminant.
                    Spectrum white(RgbIlluminantSpectrum(map_color_space(), {1, 1, 1}));
                    const double scale = double(light.scale) * mean(white);
                    if (light.portal) {
                        environment_of_light_[i] = static_cast<Index>(portals_.size());
                        const PortalSampler& portal = portals_.emplace_back(
                            map, light.layout, light.world_from_light, *light.portal, settings.lookup);
                        return scale * std::min(light.portal->area() * portal.irradiance(),
                                                cross_section * portal.fluence());
                    }
                    return 4 * pi * cross_section * scale *
                           environment_of(i, light.environment, light.layout).mean_radiance();
                } else if constexpr (std::is_same_v<L, SkyLight>) {
                    infinite_lights_.push_back(static_cast<Index>(i));
                    return 4 * pi * cross_section * double(light.scale) *
                           environment_of(i, light.environment, EnvironmentLayout::equirectangular)
                               .mean_radiance();
                } else if constexpr (std::is_same_v<L, SunLight>) {
                    infinite_lights_.push_back(static_cast<Index>(i));
                    const double above =
                        std::asin(std::clamp(double(dot(light.disc.centre, light.up)), -1.0, 1.0));
                    return cross_section * double(light.scale) * mean(light.spectrum) *
                           light.disc.solid_angle() *
                           part_above_horizon(above, std::sqrt(2 * double(light.disc.versine)));
                } else {
                    double flux = double(light.scale) * mean(light.spectrum);
                    if constexpr (std::is_same_v<L, UniformInfiniteLight>) {
                        infinite_lights_.push_back(static_cast<Index>(i));
                        if (light.portal)
                            return flux * std::min(pi * light.portal->area(), 2 * pi * cross_section);
                        return 4 * pi * cross_section * flux;
                    } else if constexpr (std::is_same_v<L, DistantLight>) {
                        return cross_section * flux;
                    } else if constexpr (std::is_same_v<L, SpotLight>) {
                        return 2 * pi * flux *
                               ((1 - double(light.cos_falloff_start)) +
                                0.5 * (double(light.cos_falloff_start) - double(light.cos_total_width)));
                    } else {
                        return 4 * pi * flux;
                    }
                }
            },
            scene.lights[i]);
        powers.push_back(std::isfinite(power) && power > 0 ? power : 0);
    }
    if (!powers.empty()) by_power_.emplace(std::span<const double>(powers));
}

} // namespace montelux
