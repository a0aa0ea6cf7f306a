// Sampling of an environment map through a portal: the part of it that a point sees, and no more.
#pragma once

#include <optional>
#include <string>

#include "montelux/image/image.h"
#include "montelux/mc/dist/windowed_2d.h"
#include "montelux/mc/math/transform.h"
#include "montelux/scene/light/environment/environment_grid.h"
#include "montelux/scene/light/environment/environment_settings.h"
#include "montelux/scene/light/portal.h"

namespace montelux {

// The map's light is tabulated over the portal's plane of angles (see Portal), and directions are drawn from
// the window under which a point sees the portal (Bitterli, Novak, Jarosz 2015). Radiance is looked up in the
// map itself and not in the table; so the density follows it up to the size of cells, and is exact as a
// density. A cell has the mean light of the points in it, no less than a sixteenth of the brightest radiance
// found in and around it, so that the tip of a bright texel is not drawn too seldom, and no less than a
// thousandth of the mean, so that nothing is left out.
class PortalSampler {
  public:
    // The map as EnvironmentSampler has it.
    PortalSampler(const Image& map, EnvironmentLayout layout, const Transform& world_from_light,
                  const Portal& portal, EnvironmentLookup lookup = EnvironmentLookup::nearest);

    struct Sample {
        Vec3f wi; // unit, in world space
        float pdf = 0;
    };
    // Empty where no light reaches `p`.
    std::optional<Sample> sample(Point3f p, Vec2f u) const;
    // Over solid angle at `p`.
    float pdf(Point3f p, Vec3f wi) const;
    // A direction to the light, whatever point of the portal it is seen through, and its density over solid
    // angle.
    std::optional<Sample> sample_direction(Vec2f u) const { return sample(Portal::hemisphere(), u); }
    float direction_pdf(Vec3f wi) const { return pdf(Portal::hemisphere(), wi); }

    const EnvironmentGrid& grid() const { return grid_; }
    // Mean of R, G and B that falls on each unit of the portal's area, and that without the cosine.
    double irradiance() const { return irradiance_; }
    double fluence() const { return fluence_; }
    // For people: "portal, 1024 x 1024 cells; 1024 x 512 texels, equirectangular, 8.0 MiB".
    std::string description() const;

  private:
    std::optional<Sample> sample(const Window2D& window, Vec2f u) const;
    float pdf(const Window2D& window, Vec3f wi) const;
    WindowedPiecewise2D tabulate(const Image& map, const Transform& world_from_light,
                                 EnvironmentLookup lookup);

    EnvironmentGrid grid_;
    Portal portal_;
    double irradiance_ = 0, fluence_ = 0;
    WindowedPiecewise2D table_; // over the hemisphere of angles
};

} // namespace montelux
