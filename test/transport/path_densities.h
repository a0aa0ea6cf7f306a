// Rooms of all kinds of surfaces and lights, and the densities of a path computed from nothing but its vertices.
#pragma once

#include "test/render/mixed_scene.h"
#include <algorithm>
#include <array>
#include <cmath>

#include "montelux/mc/random/sample_stream.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/transport/found_path.h"
#include "montelux/transport/light_end.h"

namespace montelux::testing {

inline constexpr int film_width = 16;

// Point, spot and distant lights, a thin lens, dispersion and a smooth mirror besides.
inline SceneBuilder room_of_all(bool with_lens) {
    SceneBuilder b = mixed_scene(1, film_width, film_width);
    const auto ball = [&](Vec3d at, double radius, const Material& material) {
        const Transform t = Transform::translate(at) * Transform::scale({radius, radius, radius});
        b.add_quadric(Sphere{.world_from_object = t}, b.add(material));
    };
    const Spectrum flint(PiecewiseLinear::from_pairs(std::array{360.0f, 1.7f, 830.0f, 1.5f}));
    ball({0.6, 0.5, 0.3}, 0.25, DielectricMaterial{add_spectrum(b.scene, flint), alpha_of(0.2f)});
    ball({-0.1, -0.5, -0.75}, 0.2,
         ConductorMaterial{.metal = {.eta = gray(0.2f), .k = gray(3)}, .roughness = alpha_of(0)});
    const SceneSpectrum white = white_light(b.scene);
    b.scene.lights.push_back(PointLight{white, 2 * white_scale(), {0, -0.4f, 0.6f}});
    b.scene.lights.push_back(DistantLight{white, white_scale(), normalize(Vec3f(0.2f, -1, 0.4f))});
    if (with_lens)
        b.scene.camera.model = PerspectiveCamera{.fov = 36, .lens_radius = 0.1f, .focal_distance = 3.6f};
    b.description.integrator.method = IntegratorKind::bidirectional;
    return b;
}
// The same in coloured fog, which no infinite light gets through.
inline SceneBuilder foggy_room(bool with_lens) {
    SceneBuilder b = room_of_all(with_lens);
    const auto line = [&](float at_360, float at_830) {
        return add_spectrum(
            b.scene, Spectrum(PiecewiseLinear::from_pairs(std::array{360.0f, at_360, 830.0f, at_830})));
    };
    HomogeneousMedium fog{.sigma_a = line(0.3f, 0.02f), .sigma_s = line(0.3f, 1.2f)};
    fog.phase = HenyeyGreenstein{0.4f};
    b.scene.media.push_back(fog);
    b.scene.camera.medium = 0;
    return b;
}

// Recomputes what PathDensities holds from nothing but the vertices.
class Recomputed {
  public:
    Recomputed(const SceneView& scene, const Camera& camera, const FoundPath& path)
        : scene_(scene), path_(path), n_(path.s + path.t) {
        d.reset(n_);
        // Where a subpath has gone on by a delta; not where two of them are joined or merged.
        for (std::size_t i = 1; i + 1 < n_; ++i) {
            const bool is_joint = i == path.s || (path.merged == nullptr && i + 1 == path.s);
            d.delta[i] = !is_joint && vertex(i).delta ? 1 : 0;
        }
        d.light_paths = path.densities.light_paths;
        const LightEnd& end = path.end;
        const LightContext context{scene, end.light, 0};
        const SubpathVertex& v1 = vertex(1);
        const Vec3f to_light = direction_to_light();
        LightHit hit = end.hit;
        hit.wi = to_light;
        const EmissionPdf le = pdf_le(context, hit, -to_light);
        const float choice = scene.emitting_lights->probability({}, end.light, hit.part);
        const bool far = end.at_infinity();
        d.from_light[0] = choice * (end.is_delta() ? 1 : far ? le.direction : le.position);
        d.from_light[1] =
            double(far ? le.position : le.direction) * v1.cosine(to_light) / (far ? 1 : distance2(0));
        d.from_camera[0] =
            end.invisible ? 0 : double(end.of_light(pdf(1, true), -to_light, float(distance2(0))));
        for (std::size_t i = 1; i + 2 < n_; ++i) {
            d.from_light[i + 1] = per_area(i + 1, i, pdf(i, false));
            d.from_camera[i] = per_area(i, i + 1, pdf(i + 1, true));
        }
        const Vec3f from_lens = vertex(n_ - 2).s.p - path.lens;
        const float distance = length(from_lens);
        d.from_camera[n_ - 2] = double(camera.density(from_lens / distance, distance, 0)) *
                                vertex(n_ - 2).cosine(from_lens / distance);
        const ReferencePoint here = v1.reference(local(1, direction(1, 2)));
        const float li = scene.light_sampler->probability(here, end.light, hit.part);
        d.next_event =
            end.is_delta()
                ? double(li)
                : double(end.of_light(li * pdf_li(context, here, hit), -to_light, float(distance2(0))));
        if (scene.camera_medium != no_index) compute_media_factors();
    }

    PathDensities d;

  private:
    // Of the homogeneous medium around the camera: free flights along all edges but the joined one.
    void compute_media_factors() {
        SampledWavelengths lambda = vertex(1).lambda;
        for (std::size_t i = 1; i + 1 < n_; ++i)
            if (vertex(i).lambda.secondary_terminated()) lambda = vertex(i).lambda;
        const MediumPoint m =
            std::get<HomogeneousMedium>(scene_.media[0]).at(scene_, 0, lambda).coefficients({});
        d.media.assign(n_, 0);
        for (std::size_t s = 0; s < n_; ++s)
            for (int k = 0; k < (lambda.secondary_terminated() ? 1 : 4); ++k) {
                double depth = 0, scattering = 1;
                for (std::size_t i = 0; i + 1 < n_; ++i)
                    if (s != i + 1)
                        depth +=
                            double(m.sigma_a[k] + m.sigma_s[k]) * double(length(point(i) - point(i + 1)));
                for (std::size_t i = 1; i + 1 < n_; ++i)
                    if (vertex(i).phase != nullptr) scattering *= double(m.sigma_s[k]);
                d.media[s] += scattering * std::exp(-depth);
            }
    }
    const SubpathVertex& vertex(std::size_t i) const {
        return i < path_.s ? path_.light[i - 1] : path_.camera[n_ - 2 - i];
    }
    Point3f point(std::size_t i) const {
        if (i == n_ - 1) return path_.lens;
        if (i > 0) return vertex(i).s.p;
        if (const auto* light = std::get_if<PointLight>(&scene_.lights[path_.end.light]))
            return light->position;
        return path_.end.hit.p;
    }
    Vec3f direction_to_light() const {
        return path_.end.at_infinity() ? path_.end.hit.wi : normalize(point(0) - point(1));
    }
    Vec3f direction(std::size_t from, std::size_t to) const {
        return to == 0 ? direction_to_light() : normalize(point(to) - point(from));
    }
    double distance2(std::size_t i) const { return double(length_squared(point(i) - point(i + 1))); }
    Vec3f local(std::size_t i, Vec3f w) const { return vertex(i).surface.frame.to_local(w); }
    // Of vertex i scattering towards the light or away from it, per solid angle.
    float pdf(std::size_t i, bool to_light) const {
        if (d.delta[i] != 0) return 1;
        const Vec3f light = local(i, direction(i, i - 1)), lens = local(i, direction(i, i + 1));
        SampleStream stream({.seed = 1}, 0, 0, 0);
        return to_light ? vertex(i).evaluate(lens, light, TransportMode::radiance, stream).pdf
                        : vertex(i).evaluate(light, lens, TransportMode::importance, stream).pdf;
    }
    double per_area(std::size_t i, std::size_t from, float pdf) const {
        return double(pdf) * double(vertex(i).cosine(direction(from, i))) / distance2(std::min(i, from));
    }

    const SceneView& scene_;
    const FoundPath& path_;
    std::size_t n_;
};

} // namespace montelux::testing
