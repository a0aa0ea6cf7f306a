#include "montelux/scene/camera/lens_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "montelux/mc/math/error.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

namespace {

constexpr int pupil_count = 64, pupil_grid = 256;

// Unit vectors; n on the side of -d. Empty for total reflection. eta: index behind over index before.
std::optional<Vec3d> refracted(Vec3d d, Vec3d n, double eta) {
    const double cosine = -dot(d, n), sine2 = (1 - cosine * cosine) / (eta * eta);
    if (!(sine2 < 1)) return std::nullopt;
    return normalize(d / eta + n * (cosine / eta - std::sqrt(1 - sine2)));
}

} // namespace

LensSystem::LensSystem(const RealisticCamera& camera)
    : aperture_(camera.aperture), surfaces_(camera.surfaces), z_(surfaces_.size()),
      half_diagonal_(camera.film_diagonal / 2) {
    if (surfaces_.empty()) throw Error("camera", "the lens has no surfaces");
    for (LensSurface& s : surfaces_) {
        const bool finite = std::isfinite(s.radius) && std::isfinite(s.thickness) && std::isfinite(s.eta);
        if (!finite || !(s.aperture_radius > 0) || !std::isfinite(s.aperture_radius))
            throw Error("camera", "a surface of the lens has no aperture, or numbers that are not finite");
        if (!(s.eta > 0)) s.eta = 1; // air
    }
    if (!(half_diagonal_ > 0)) throw Error("camera", "the film's diagonal must be positive");
    place(surfaces_.back().thickness);
    focus(camera.focus_distance);

    pupils_.resize(pupil_count);
    parallel_for(pupil_count, [&](std::int64_t i) {
        const float step = half_diagonal_ / pupil_count;
        pupils_[static_cast<std::size_t>(i)] =
            pupil_of(static_cast<float>(i) * step, static_cast<float>(i + 1) * step);
    });
    if (std::all_of(pupils_.begin(), pupils_.end(), [](const PupilBounds& b) { return !(b.x1 > b.x0); }))
        throw Error("camera", "the lens lets no light through to the film");
}

// Distances from the film to the vertices, with the last one `film_distance` away.
void LensSystem::place(float film_distance) {
    surfaces_.back().thickness = film_distance;
    double z = 0;
    for (std::size_t i = surfaces_.size(); i-- > 0;) {
        z += static_cast<double>(surfaces_[i].thickness);
        z_[i] = static_cast<float>(z);
    }
}

std::optional<Ray> LensSystem::trace(Ray ray, bool from_film, float* transmittance) const {
    Vec3d o(ray.o), d = normalize(Vec3d(ray.d));
    const std::size_t n = surfaces_.size();
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = from_film ? n - 1 - k : k;
        const LensSurface& s = surfaces_[i];
        const double vertex = static_cast<double>(z_[i]);
        if (!(d.z != 0)) return std::nullopt;
        double t = (vertex - o.z) / d.z;
        const double radius = static_cast<double>(s.radius);
        Vec3d normal{0, 0, 1};
        if (radius != 0) {
            // In files a positive radius has its centre on the film's side.
            const Vec3d centre{0, 0, vertex - radius};
            const Vec3d c = o - centre;
            const double half_b = dot(c, d), discriminant = half_b * half_b - (dot(c, c) - radius * radius);
            if (!(discriminant >= 0)) return std::nullopt;
            const double root = std::sqrt(discriminant);
            // Of the two hits the one on the vertex's side of the centre.
            const bool nearer = (d.z < 0) == (radius > 0);
            t = nearer ? -half_b - root : -half_b + root;
            normal = (o + d * t - centre) / radius;
        }
        if (!(t >= 0)) return std::nullopt;
        o = o + d * t;
        double aperture = static_cast<double>(s.aperture_radius);
        if (radius == 0 && aperture_) {
            if (transmittance != nullptr) *transmittance *= aperture_->at(o.x / aperture, o.y / aperture);
            aperture *= std::sqrt(2.0); // around the corners of the picture
        }
        if (!(o.x * o.x + o.y * o.y <= aperture * aperture)) return std::nullopt;
        // `eta` is that of the space between a surface and the next one towards the film.
        const double before = i == 0 ? 1.0 : static_cast<double>(surfaces_[i - 1].eta);
        const double behind = static_cast<double>(s.eta);
        if (radius != 0 && before != behind) { // a stop does not refract
            if (dot(normal, d) > 0) normal = -normal;
            const std::optional<Vec3d> through =
                refracted(d, normal, from_film ? before / behind : behind / before);
            if (!through) return std::nullopt;
            d = *through;
        }
    }
    ray.o = Vec3f(o);
    ray.d = Vec3f(d);
    return ray;
}

std::optional<Ray> LensSystem::trace_from_film(const Ray& ray) const { return trace(ray, true); }
std::optional<Ray> LensSystem::trace_from_scene(const Ray& ray) const { return trace(ray, false); }

// By a ray close to the axis and parallel to it: it crosses the axis at the focal point, and its extension meets the
// incoming ray in the principal plane.
LensSystem::Cardinal LensSystem::cardinal_points(bool towards_film) const {
    const float x = 0.001f * 2 * half_diagonal_;
    const Ray in =
        towards_film ? Ray{{x, 0, z_.front() + 1}, {0, 0, -1}} : Ray{{x, 0, z_.back() - 1}, {0, 0, 1}};
    const std::optional<Ray> out = trace(in, !towards_film);
    if (!out) throw Error("camera", "no light passes along the axis of the lens");
    const double slope = static_cast<double>(out->d.x);
    if (!(std::abs(slope) > 1e-12))
        throw Error("camera", "the lens has no focal point: light stays parallel");
    const auto z_at = [&](double at) {
        return static_cast<double>(out->o.z) +
               (at - static_cast<double>(out->o.x)) / slope * static_cast<double>(out->d.z);
    };
    return {z_at(0), z_at(static_cast<double>(x))};
}

// The lens equation from the principal planes: moving the lens by `shift` away from the film.
void LensSystem::focus(float distance) {
    const Cardinal film = cardinal_points(true), scene = cardinal_points(false);
    const double f = film.principal - film.focal;
    if (!(f > 0)) throw Error("camera", "the lens does not converge light towards the film");
    focal_length_ = static_cast<float>(f);
    // u + v = span, 1 / u + 1 / v = 1 / f, with v between the film and the principal plane on its side.
    const double span = static_cast<double>(distance) - (scene.principal - film.principal);
    const double c = span * (span - 4 * f);
    if (!(c >= 0))
        throw Error("camera", "the lens cannot focus at " + std::to_string(distance) +
                                  " m; its focal length is " + std::to_string(f * 1000) + " mm");
    const double v = 0.5 * (span - std::sqrt(c));
    place(static_cast<float>(static_cast<double>(z_.back()) + v - film.principal));
}

LensSystem::PupilBounds LensSystem::pupil_of(float from, float to) const {
    const float reach = 1.5f * surfaces_.back().aperture_radius, rear = z_.back();
    constexpr float none = std::numeric_limits<float>::infinity();
    PupilBounds b{none, none, -none, -none};
    for (int j = 0; j < pupil_grid; ++j)
        for (int i = 0; i < pupil_grid; ++i) {
            const Vec2f u{(static_cast<float>(i) + 0.5f) / pupil_grid,
                          (static_cast<float>(j) + 0.5f) / pupil_grid};
            const Point3f p{reach * (2 * u.x - 1), reach * (2 * u.y - 1), rear};
            if (p.x >= b.x0 && p.x <= b.x1 && p.y >= b.y0 && p.y <= b.y1) continue;
            // Film points spread over the interval.
            const float along = static_cast<float>((i * 37 + j * 101) % 256) / 255;
            const Point3f film{from + along * (to - from), 0, 0};
            if (!trace_from_film({film, p - film})) continue;
            b = {std::min(b.x0, p.x), std::min(b.y0, p.y), std::max(b.x1, p.x), std::max(b.y1, p.y)};
        }
    if (!(b.x1 >= b.x0)) return {};
    const float margin = 4 * reach / pupil_grid; // twice the distance between points
    return {b.x0 - margin, b.y0 - margin, b.x1 + margin, b.y1 + margin};
}

const LensSystem::PupilBounds& LensSystem::pupil_at(float distance) const {
    const float place = distance / half_diagonal_ * pupil_count;
    return pupils_[std::min(static_cast<std::size_t>(place), std::size_t{pupil_count - 1})];
}

float LensSystem::pupil_area(float distance) const {
    const PupilBounds& b = pupil_at(distance);
    return (b.x1 - b.x0) * (b.y1 - b.y0);
}

std::optional<LensSystem::Sample> LensSystem::sample(Point2f film, Vec2f lens) const {
    const float distance = std::sqrt(film.x * film.x + film.y * film.y);
    const PupilBounds& b = pupil_at(distance);
    const float area = (b.x1 - b.x0) * (b.y1 - b.y0);
    if (!(area > 0)) return std::nullopt;
    const Point2f at{b.x0 + lens.x * (b.x1 - b.x0), b.y0 + lens.y * (b.y1 - b.y0)};
    // Turned to the film point's side.
    const float cosine = distance > 0 ? film.x / distance : 1, sine = distance > 0 ? film.y / distance : 0;
    const Point3f pupil{cosine * at.x - sine * at.y, sine * at.x + cosine * at.y, z_.back()};
    const Vec3f d = pupil - Point3f{film.x, film.y, 0};
    float through = 1;
    const std::optional<Ray> ray = trace({{film.x, film.y, 0}, d}, true, &through);
    if (!ray || !(through > 0)) return std::nullopt;
    const float r2 = length_squared(d), cos2 = d.z * d.z / r2;
    return Sample{*ray, cos2 / r2 * area * through};
}

} // namespace montelux
