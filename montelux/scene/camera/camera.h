// Camera: maps points on film and lens to rays, and gives the size of a pixel in the scene.
#pragma once

#include "montelux/mc/math/frame.h"
#include "montelux/scene/camera/camera_settings.h"
#include "montelux/scene/shape/ray.h"

namespace montelux {

class Camera {
  public:
    // width, height: the full resolution in pixels. Throws Error for an invalid lens or field of view.
    Camera(const CameraSettings& settings, int width, int height);

    // film: pixels from the top left corner; lens: uniform in [0,1)^2. The direction has unit length.
    Ray generate_ray(Point2f film, Point2f lens) const;
    bool has_lens() const { return lens_radius_ > 0; }
    const Transform& world_from_camera() const { return world_from_camera_; }

    // Steps on the tangent plane at p (normal n) that correspond to one pixel to the right and one down, as
    // seen directly from the camera; `scale` shrinks the pixel. Accurate enough to choose a level of detail.
    struct Footprint {
        Vec3f dpdx, dpdy;
    };
    Footprint footprint(Point3f p, Normal3f n, float scale) const;

  private:
    enum class Kind : std::uint8_t { perspective, orthographic, equal_area, equirectangular };

    Point3f world_point(Point3f p) const;
    Vec3f world_vector(Vec3f v) const;

    Kind kind_ = Kind::perspective;
    Transform world_from_camera_;
    Vec3f axes_[3];
    Point3f origin_;
    // Film coordinates to the screen: x = x0 + film.x dx, y = y0 + film.y dy.
    float x0_ = 0, dx_ = 0, y0_ = 0, dy_ = 0;
    float lens_radius_ = 0, focal_distance_ = 0;
    float pixel_ = 0; // tangent of a pixel's angle, or its width for an orthographic camera
};

} // namespace montelux
