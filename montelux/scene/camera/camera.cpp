#include "montelux/scene/camera/camera.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/warp/disk.h"
#include "montelux/mc/warp/equal_area_square.h"

namespace montelux {

ScreenWindow window_of(const std::optional<ScreenWindow>& window, std::optional<float> aspect, int width,
                       int height) {
    if (window) return *window;
    float a = aspect.value_or(static_cast<float>(width) / static_cast<float>(height));
    if (a > 1) return {-a, a, -1, 1};
    return {-1, 1, -1 / a, 1 / a};
}

Camera::Placement::Placement(const Transform& world_from_camera)
    : origin(world_from_camera.point(Vec3d{0, 0, 0})) {
    for (int i = 0; i < 3; ++i) {
        const Vec3d axis{i == 0 ? 1.0 : 0, i == 1 ? 1.0 : 0, i == 2 ? 1.0 : 0};
        axes[i] = Vec3f(world_from_camera.vector(axis));
    }
}

Camera::Camera(const CameraSettings& settings, int width, int height)
    : world_from_camera_(settings.world_from_camera), placed_(world_from_camera_), motion_(settings.motion),
      shutter_open_(settings.shutter_open), shutter_close_(settings.shutter_close) {
    auto use_window = [&](const ScreenWindow& w, double scale) {
        x0_ = static_cast<float>(double(w.x_min) * scale);
        dx_ = static_cast<float>((double(w.x_max) - double(w.x_min)) * scale / width);
        y0_ = static_cast<float>(double(w.y_max) * scale);
        dy_ = static_cast<float>((double(w.y_min) - double(w.y_max)) * scale / height);
        pixel_ = std::min(std::abs(dx_), std::abs(dy_));
    };
    auto use_lens = [&](float radius, float distance) {
        if (!(radius >= 0) || !std::isfinite(radius))
            throw Error("camera", "the lens radius must not be negative");
        if (radius > 0 && !(distance > 0)) throw Error("camera", "the focal distance must be positive");
        lens_radius_ = radius;
        focal_distance_ = distance;
    };
    if (const auto* c = std::get_if<PerspectiveCamera>(&settings.model)) {
        if (!(c->fov > 0 && c->fov < 180))
            throw Error("camera", "the field of view must lie between 0 and 180 degrees");
        use_window(window_of(c->screen_window, c->frame_aspect_ratio, width, height),
                   std::tan(double(c->fov) * pi / 360));
        use_lens(c->lens_radius, c->focal_distance);
    } else if (const auto* o = std::get_if<OrthographicCamera>(&settings.model)) {
        kind_ = Kind::orthographic;
        use_window(window_of(o->screen_window, o->frame_aspect_ratio, width, height), o->scale);
        use_lens(o->lens_radius, o->focal_distance);
    } else if (const auto* r = std::get_if<RealisticCamera>(&settings.model)) {
        kind_ = Kind::realistic;
        lens_.emplace(*r);
        // The lens turns the picture around: film points are mirrored here.
        const double aspect = double(height) / width;
        const double x = double(r->film_diagonal) / std::sqrt(1 + aspect * aspect), y = aspect * x;
        use_window({static_cast<float>(x / 2), static_cast<float>(-x / 2), static_cast<float>(-y / 2),
                    static_cast<float>(y / 2)},
                   1);
        y0_ = -y0_;
        dy_ = -dy_;
        pixel_ /= lens_->focal_length();
    } else {
        const auto& s = std::get<SphericalCamera>(settings.model);
        kind_ = s.mapping == SphericalCamera::Mapping::equal_area ? Kind::equal_area : Kind::equirectangular;
        dx_ = 1.0f / static_cast<float>(width);
        dy_ = 1.0f / static_cast<float>(height);
        pixel_ = static_cast<float>(std::sqrt(4 * pi / (double(width) * height)));
    }
}

CameraRay Camera::generate_ray(Point2f film, Point2f lens, float time) const {
    Point3f o{0, 0, 0};
    Vec3f d;
    CameraRay ray;
    ray.time = time;
    switch (kind_) {
    case Kind::perspective:
        d = {x0_ + film.x * dx_, y0_ + film.y * dy_, 1};
        break;
    case Kind::orthographic:
        o = {x0_ + film.x * dx_, y0_ + film.y * dy_, 0};
        d = {0, 0, 1};
        break;
    case Kind::equal_area: {
        // The square's z axis is the camera's up.
        Point2f square = wrap_equal_area_square(Point2f{film.x * dx_, film.y * dy_});
        square = {std::clamp(square.x, 0.0f, 1.0f), std::clamp(square.y, 0.0f, 1.0f)};
        Vec3f w = equal_area_square_to_sphere(square);
        d = {w.x, w.z, w.y};
        break;
    }
    case Kind::equirectangular: {
        float theta = pi_f * film.y * dy_, phi = two_pi_f * film.x * dx_;
        d = {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
        break;
    }
    case Kind::realistic: {
        const auto sample = lens_->sample({x0_ + film.x * dx_, y0_ + film.y * dy_}, lens);
        ray.weight = sample ? sample->weight : 0;
        o = sample ? sample->ray.o : o;
        d = sample ? sample->ray.d : Vec3f{0, 0, 1};
        break;
    }
    }
    if (lens_radius_ > 0) {
        Point3f focus = o + d * (focal_distance_ / d.z);
        Point2f on_lens = lens_radius_ * sample_uniform_disk_concentric(lens);
        o = {on_lens.x, on_lens.y, 0};
        d = focus - o;
    }
    const auto place = [&](const Placement& placed) {
        ray.o = placed.point(o);
        ray.d = normalize(placed.vector(d));
    };
    if (motion_)
        place(Placement(motion_->at(time)));
    else
        place(placed_);
    return ray;
}

// A pixel is an area `a` of the plane z = 1. Of camera space: 1 / (a cos^3) per solid angle, with or without a lens, as
// rays through one point of the lens spread over the focal plane. A linear map that takes unit vectors v to M v
// divides densities by |det M| / |M v|^3.
float Camera::direction_pdf(const Placement& placed, Vec3f d) const {
    float area = std::abs(dx_ * dy_);
    if (is_parallel()) return length(placed.axes[2]) / (area * std::abs(placed.determinant()));
    const float z = placed.in_camera(d).z;
    if (!(z > 0)) return 0;
    if (kind_ == Kind::orthographic) area /= focal_distance_ * focal_distance_;
    return 1 / (area * z * z * z * std::abs(placed.determinant()));
}

float Camera::pdf_we(Vec3f d, float time) const { return direction_pdf(placement(time), d); }

std::optional<CameraConnection> Camera::sample_wi(Point3f p, Point2f lens, float time) const {
    const Placement placed = placement(time);
    CameraConnection c;
    if (is_parallel()) {
        const Vec3f at = placed.in_camera(p - placed.origin);
        if (!(at.z > 0)) return std::nullopt;
        c.film = {(at.x - x0_) / dx_, (at.y - y0_) / dy_};
        c.lens = placed.point({at.x, at.y, 0});
        c.wi = -normalize(placed.axes[2]);
        c.density = direction_pdf(placed, -c.wi);
        return c;
    }
    Vec3f o;
    if (lens_radius_ > 0) {
        const Point2f on_lens = lens_radius_ * sample_uniform_disk_concentric(lens);
        o = {on_lens.x, on_lens.y, 0};
    }
    c.lens = placed.point(o);
    const Vec3f to_p = p - c.lens;
    const Vec3f w = placed.in_camera(to_p);
    if (!(w.z > 0)) return std::nullopt;
    // On the plane z = 1 without a lens, else on the focal plane.
    Vec3f at = w / w.z;
    if (lens_radius_ > 0) {
        at = o + at * focal_distance_;
        if (kind_ == Kind::perspective) at = at / focal_distance_;
    }
    c.film = {(at.x - x0_) / dx_, (at.y - y0_) / dy_};
    const float distance2 = length_squared(to_p);
    c.wi = -to_p / std::sqrt(distance2);
    c.density = direction_pdf(placed, -c.wi) / distance2;
    return c;
}

std::optional<Vec2d> Camera::project(Vec3d p) const {
    const Vec2d step{double(dx_), double(dy_)}, start{double(x0_), double(y0_)};
    const auto on_film = [&](double x, double y) {
        return Vec2d{(x - start.x) / step.x, (y - start.y) / step.y};
    };
    switch (kind_) {
    case Kind::perspective:
        if (!(p.z > 0)) return std::nullopt;
        return on_film(p.x / p.z, p.y / p.z);
    case Kind::orthographic:
        return on_film(p.x, p.y);
    case Kind::realistic: {
        if (!(p.z > 0)) return std::nullopt;
        const double f = double(lens_->focal_length());
        return on_film(-p.x / p.z * f, -p.y / p.z * f);
    }
    case Kind::equal_area:
    case Kind::equirectangular:
        break;
    }
    const double distance = length(p);
    if (!(distance > 0)) return std::nullopt;
    const Vec3d w = p / distance;
    if (kind_ == Kind::equal_area) {
        const Vec2d square = equal_area_sphere_to_square(Vec3d{w.x, w.z, w.y});
        return on_film(square.x, square.y);
    }
    const double phi = std::atan2(w.z, w.x);
    return on_film((phi < 0 ? phi + 2 * pi : phi) / (2 * pi), std::acos(std::clamp(w.y, -1.0, 1.0)) / pi);
}

Vec2d Camera::film_step(Vec2d from, Vec2d to) const {
    Vec2d step{to.x - from.x, to.y - from.y};
    if (kind_ == Kind::equirectangular) {
        const double width = 1 / double(dx_);
        step.x -= width * std::round(step.x / width);
    }
    return step;
}

Camera::Footprint Camera::footprint(Point3f p, Normal3f n, float scale) const {
    Vec3f axis = kind_ == Kind::orthographic ? normalize(placed_.axes[2]) : p - placed_.origin;
    float distance = kind_ == Kind::orthographic ? 1 : length(axis);
    if (!(distance > 0)) return {};
    Vec3f w = axis / distance;
    float width = pixel_ * scale * (kind_ == Kind::orthographic ? length(placed_.axes[0]) : distance);
    Frame frame = Frame::from_normal_and_tangent(w, placed_.axes[0]);
    // A step across the line of sight, projected along it onto the tangent plane. At grazing angles it would
    // be infinite: the stretch is bounded.
    float cosine = dot(w, n);
    cosine = std::copysign(std::max(std::abs(cosine), 1e-3f), cosine);
    auto slide = [&](Vec3f step) { return step - w * (dot(step, n) / cosine); };
    return {slide(frame.s * width), slide(frame.t * width)};
}

} // namespace montelux
