// LensSystem: a photographic lens of spherical surfaces, by tracing rays through all of them.
#pragma once

#include <optional>
#include <vector>

#include "montelux/scene/camera/camera_settings.h"
#include "montelux/scene/shape/ray.h"

namespace montelux {

// Kolb, Mitchell, Hanrahan 1995, "A Realistic Camera Model for Computer Graphics". Camera space: the film lies in
// z = 0, the lens in front of it (z > 0), all lengths in metres. Wavelengths do not matter: glass has one index.
class LensSystem {
  public:
    // Moves the lens along the axis until points at `camera.focus_distance` from the film are sharp, in the
    // approximation of a thick lens; then finds the exit pupil for each distance from the film's centre. Throws Error
    // if the surfaces form no lens, cannot focus there, or let no light through.
    explicit LensSystem(const RealisticCamera& camera);

    // A ray from the scene's side of the lens that continues one from `film` (a point of the plane z = 0) through a
    // point of the exit pupil chosen by `lens`, uniform in [0,1)^2. Its weight is the measure of solid angle times
    // cosine at the film that the sample stands for, so that the mean of weight times radiance is the irradiance.
    struct Sample {
        Ray ray; // the direction has unit length
        float weight = 0;
    };
    std::optional<Sample> sample(Point2f film, Vec2f lens) const;

    // From the film to the scene, or empty if a stop or a surface blocks it. A picture of the stop counts as the round
    // one around it.
    std::optional<Ray> trace_from_film(const Ray& ray) const;
    // From the scene to the film; the ray points towards the film.
    std::optional<Ray> trace_from_scene(const Ray& ray) const;

    float focal_length() const { return focal_length_; }
    // Distance of the last surface from the film.
    float rear_z() const { return z_.back(); }
    // Area of the bounds from which `sample` draws at a distance from the film's centre.
    float pupil_area(float distance) const;

  private:
    // A square of the plane z = rear_z, for film points on the positive x axis.
    struct PupilBounds {
        float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    };

    // Multiplies `transmittance`, if given, by what pictures of stops let through.
    std::optional<Ray> trace(Ray ray, bool from_film, float* transmittance = nullptr) const;
    void place(float film_distance);
    // Positions of the focal and the principal plane of parallel light that leaves the lens on one side.
    struct Cardinal {
        double focal = 0, principal = 0;
    };
    Cardinal cardinal_points(bool towards_film) const;
    void focus(float distance);
    PupilBounds pupil_of(float from, float to) const;
    const PupilBounds& pupil_at(float distance) const;

    std::optional<AperturePicture> aperture_;
    std::vector<LensSurface> surfaces_; // from the scene to the film
    std::vector<float> z_;              // of each surface's vertex
    float half_diagonal_;
    float focal_length_ = 0;
    std::vector<PupilBounds> pupils_; // at equal steps of the distance from the film's centre
};

} // namespace montelux
