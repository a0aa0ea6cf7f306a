// PortalSampler: samples the part of an environment map that a point sees through a portal.
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

// The map's light is tabulated over the portal's plane of angles (see Portal), and directions are sampled
// from the window in which a point sees the portal (Bitterli, Novak, Jarosz 2015). Radiance is looked up in
// the map itself, not in the table; the density follows it up to the size of cells, and is exact as a
// density. A cell has the mean light of its points, at least a sixteenth of the brightest radiance found in
// and around it, so that corners of bright texels are not undersampled, and at least a thousandth of the
// mean, so that no direction is omitted.
class PortalSampler {
  public:
    // The map as in EnvironmentSampler.
    PortalSampler(const Image& map, EnvironmentLayout layout, const Transform& world_from_light,
                  const Portal& portal, EnvironmentLookup lookup = EnvironmentLookup::nearest);

    struct Sample {
        Vec3f wi; // unit, in world space
        float pdf = 0;
    };
    // Empty where no light reaches `p`.
    std::optional<Sample> sample(Point3f p, Vec2f u) const;
    // Per solid angle at `p`.
    float pdf(Point3f p, Vec3f wi) const;
    // A direction to the light, independent of the point of the portal, and its density per solid angle.
    std::optional<Sample> sample_direction(Vec2f u) const { return sample(Portal::hemisphere(), u); }
    float direction_pdf(Vec3f wi) const { return pdf(Portal::hemisphere(), wi); }

    const EnvironmentGrid& grid() const { return grid_; }
    // Mean of R, G and B per area of the portal, with and without the cosine.
    double irradiance() const { return irradiance_; }
    double fluence() const { return fluence_; }
    // For messages: "portal, 1024 x 1024 cells; 1024 x 512 texels, equirectangular, 8.0 MiB".
    std::string description() const;

    // Memory of the table.
    std::size_t bytes() const { return table_.bytes(); }

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
