// Camera: maps points on film and lens to rays, and gives the size of a pixel in the scene.
#pragma once

#include <algorithm>
#include <optional>

#include "montelux/mc/math/frame.h"
#include "montelux/scene/camera/camera_settings.h"
#include "montelux/scene/camera/lens_system.h"
#include "montelux/scene/shape/ray.h"

namespace montelux {

// A ray of the camera, and the factor of its radiance on the way to the film: 0 where the lens blocks it.
struct CameraRay : Ray {
    float weight = 1;
};

// A point of the scene seen through a point of the lens.
struct CameraConnection {
    Point2f film;      // where it appears, in pixels; may lie outside of the film
    Point3f lens;      // of an orthographic camera without a lens: on its film plane
    Vec3f wi;          // unit, from the scene's point to the lens
    float density = 0; // Camera::density there
};

// The screen window of a film of that size, in pixels, of a camera that may give a window or an aspect ratio.
ScreenWindow window_of(const std::optional<ScreenWindow>& window, std::optional<float> aspect, int width,
                       int height);

class Camera {
  public:
    // width, height: the full resolution in pixels. Throws Error for an invalid lens or field of view.
    Camera(const CameraSettings& settings, int width, int height);

    // film: pixels from the top left corner; lens: uniform in [0,1)^2; time: of motions. The direction has unit
    // length.
    CameraRay generate_ray(Point2f film, Point2f lens, float time = 0) const;
    // The time at a fraction u of the exposure.
    float time_at(float u) const {
        return std::clamp(shutter_open_ + u * (shutter_close_ - shutter_open_), 0.0f, 1.0f);
    }
    bool has_lens() const { return lens_radius_ > 0 || lens_; }

    // Methods that trace light to the camera need the three functions below, which perspective and orthographic cameras
    // have. Rays of these have weight 1, so their importance (Veach 1997, section 8.3.2) is the density of their rays
    // where film points have density 1 per square pixel, on the film and beyond it, and lens points are uniform.
    bool has_importance() const { return kind_ == Kind::perspective || kind_ == Kind::orthographic; }
    // Density of the direction of a ray (unit) given its point of the lens, per solid angle; of an orthographic camera
    // without a lens, whose rays are parallel: density of rays per area across them.
    float pdf_we(Vec3f d, float time) const;
    // Density of rays given their point of the lens, per area across them at that distance.
    float density(Vec3f d, float distance, float time) const {
        const float pdf = pdf_we(d, time);
        return is_parallel() ? pdf : pdf / (distance * distance);
    }
    // The ray of generate_ray that passes through p with that `lens`; empty if p is not in front of the camera.
    std::optional<CameraConnection> sample_wi(Point3f p, Point2f lens, float time) const;

    const Transform& world_from_camera() const { return world_from_camera_; }
    // At a time of motions.
    Transform camera_from_world(float time) const {
        return (motion_ ? motion_->at(time) : world_from_camera_).inverse();
    }
    // Where points of camera space appear on the film through the centre of the lens, in pixels; empty behind the
    // camera. A realistic camera counts as a pinhole at its focal length.
    std::optional<Vec2d> project(Vec3d p) const;
    // The step on the film from one projection to another; the shorter way around a latitude-longitude map.
    Vec2d film_step(Vec2d from, Vec2d to) const;

    // Steps on the tangent plane at p (normal n) that correspond to one pixel to the right and one down, as
    // seen directly from the camera; `scale` shrinks the pixel. Accurate enough to choose a level of detail.
    struct Footprint {
        Vec3f dpdx, dpdy;
    };
    Footprint footprint(Point3f p, Normal3f n, float scale) const;

  private:
    enum class Kind : std::uint8_t { perspective, orthographic, equal_area, equirectangular, realistic };

    // Camera space in the world.
    struct Placement {
        explicit Placement(const Transform& world_from_camera);
        Point3f point(Point3f p) const { return origin + vector(p); }
        Vec3f vector(Vec3f v) const { return v.x * axes[0] + v.y * axes[1] + v.z * axes[2]; }
        float determinant() const { return dot(axes[0], cross(axes[1], axes[2])); }
        // Of a vector of the world.
        Vec3f in_camera(Vec3f w) const {
            return Vec3f{dot(cross(axes[1], axes[2]), w), dot(cross(axes[2], axes[0]), w),
                         dot(cross(axes[0], axes[1]), w)} /
                   determinant();
        }

        Vec3f axes[3];
        Point3f origin;
    };
    Placement placement(float time) const { return motion_ ? Placement(motion_->at(time)) : placed_; }
    // All rays have one direction.
    bool is_parallel() const { return kind_ == Kind::orthographic && !(lens_radius_ > 0); }
    float direction_pdf(const Placement& placed, Vec3f d) const;

    Kind kind_ = Kind::perspective;
    Transform world_from_camera_;
    Placement placed_;
    std::optional<Motion> motion_;
    float shutter_open_ = 0, shutter_close_ = 1;
    // Film coordinates to the screen: x = x0 + film.x dx, y = y0 + film.y dy.
    float x0_ = 0, dx_ = 0, y0_ = 0, dy_ = 0;
    float lens_radius_ = 0, focal_distance_ = 0;
    std::optional<LensSystem> lens_;
    float pixel_ = 0; // tangent of a pixel's angle, or its width for an orthographic camera
};

} // namespace montelux
