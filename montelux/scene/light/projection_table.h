// ProjectionTable: the directions of a light that projects a picture, and their density.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "montelux/image/image.h"
#include "montelux/mc/dist/piecewise_2d.h"
#include "montelux/scene/light/picture_lookup.h"

namespace montelux {

// What is even about the light of a white picture.
enum class ProjectionProfile : std::uint8_t {
    intensity, // the same in all directions, as in pbrt-v4; the colour is that of the nearest texel
    // The same all over a plane across the axis, as in Mitsuba 3: the intensity is divided by the cubed cosine to the
    // axis. Colours are those of a PictureLookup.
    irradiance,
};

// The picture fills a rectangle of the plane z = 1 around the z axis; `fov` is the angle of its shorter side,
// in degrees. Its columns go along x and its rows along y, so that its top row is towards -y.
class ProjectionScreen {
  public:
    ProjectionScreen(int width, int height, float fov);

    // Position on the picture, in texels; empty beside it. `w` need not be of unit length.
    std::optional<Vec2f> locate(Vec3f w) const;
    // A unit vector.
    Vec3f direction(Vec2f texels) const;
    // Solid angle per area in texels, along a unit vector of that z.
    float solid_angle(float z) const { return texel_area_ * z * z * z; }
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    int width_, height_;
    Vec2f half_; // half the sides of the rectangle
    float texel_area_;
};

// Intensity over the colour of the picture, along a unit vector of that z in the light's space.
constexpr float intensity_of_white(ProjectionProfile profile, float z) {
    return profile == ProjectionProfile::irradiance ? 1 / (z * z * z) : 1;
}

// Samples texels in proportion to the mean of their colours times their solid angle and intensity_of_white; where colours
// are interpolated, of the texels around, too.
class ProjectionTable {
  public:
    struct Sample {
        Vec2f texels;
        Vec3f w;       // unit
        float pdf = 0; // per solid angle
    };

    // The picture has the channels R, G and B; negative values count as 0.
    ProjectionTable(const Image& picture, float fov, ProjectionProfile profile = ProjectionProfile::intensity,
                    PictureLookup lookup = PictureLookup::bilinear);

    const ProjectionScreen& screen() const { return screen_; }
    std::optional<Sample> sample(Vec2f u) const;
    float pdf(Vec3f w) const;
    // Integral of the mean of the colours times intensity_of_white over all directions, sr.
    double flux() const { return density_.integral(); }

    // Memory of the table.
    std::size_t bytes() const { return density_.bytes(); }

  private:
    ProjectionScreen screen_;
    PiecewiseConstant2D density_;
};

// Integral of a weighted sum of the channels over all directions, each texel by the solid angle at its centre.
double projected_flux(const Image& picture, float fov, Vec3d weights);

} // namespace montelux
