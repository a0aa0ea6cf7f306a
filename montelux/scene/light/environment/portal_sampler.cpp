#include "montelux/scene/light/environment/portal_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light/environment/environment_density.h"

namespace montelux {

namespace {

// Cells along each side: half a texel, unless the map is very fine.
std::uint32_t cells_for(const EnvironmentGrid& grid) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(2 * pi / grid.texel_angle()), 64.0, 2048.0));
}

} // namespace

PortalSampler::PortalSampler(const Image& map, EnvironmentLayout layout, const Transform& world_from_light,
                             const Portal& portal, EnvironmentLookup lookup)
    : grid_(layout, map.width(), map.height()), portal_(portal),
      table_(tabulate(map, world_from_light, lookup)) {}

WindowedPiecewise2D PortalSampler::tabulate(const Image& map, const Transform& world_from_light,
                                            EnvironmentLookup lookup) {
    const std::uint32_t n = cells_for(grid_);
    const double side = pi / n, spacing = grid_.texel_angle() / 4;
    auto radiance = [&](Vec3d local) {
        const Vec3d w = world_from_light.inverse_vector(portal_.to_world(local));
        const Vec2f place = grid_.locate(Vec3f(normalize(w)));
        if (lookup == EnvironmentLookup::nearest) return texel_radiance(map, grid_.texel(place));
        const EnvironmentGrid::Blend blend = grid_.blend(place);
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k)
            sum += static_cast<double>(blend.share[k]) * texel_radiance(map, blend.texel[k]);
        return sum;
    };
    auto centre = [&](std::int64_t k) { return -pi / 2 + side * (static_cast<double>(k) + 0.5); };
    // Angular size of a cell's sides: smaller near the horizon, larger near the corners.
    auto steps = [&](std::int64_t i, std::int64_t j) {
        const double cx = std::cos(centre(i)), cy = std::cos(centre(j));
        const double n2 = cx * cx + (1 - cx * cx) * cy * cy;
        return Vec2d{side * cy / n2, side * cx / n2};
    };
    // Enough points that no texel lies between them, except at the very corners.
    auto points_for = [&](double step) {
        return static_cast<int>(std::clamp(std::ceil(step / spacing), 2.0, 32.0));
    };
    // Cells within two spacings, so that a texel's corner between points is detected by its neighbours.
    auto cells_around = [&](double step) {
        return static_cast<std::int64_t>(std::clamp(std::ceil(2 * spacing / step), 1.0, 16.0));
    };

    struct Row {
        double light = 0, solid_angle = 0, irradiance = 0;
    };
    std::vector<Row> of_rows(n);
    std::vector<double> light(std::size_t{n} * n), solid_angle(std::size_t{n} * n);
    std::vector<float> brightest(std::size_t{n} * n);
    parallel_for(n, [&](std::int64_t j) {
        Row row;
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2d corner{-pi / 2 + side * static_cast<double>(i),
                               -pi / 2 + side * static_cast<double>(j)};
            const Vec2d step = steps(static_cast<std::int64_t>(i), j);
            const int nx = points_for(step.x), ny = points_for(step.y);
            double most = 0, sum = 0, angle = 0;
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x) {
                    const Vec2d at = corner + Vec2d{side * (x + 0.5) / nx, side * (y + 0.5) / ny};
                    const Vec3d local = Portal::local_direction(at);
                    const double dw = Portal::solid_angle_density(local) * side * side / (nx * ny);
                    const double l = radiance(local);
                    most = std::max(most, l);
                    sum += l * dw;
                    angle += dw;
                    row.irradiance += l * dw * local.z;
                }
            const std::size_t cell = static_cast<std::size_t>(j) * n + i;
            light[cell] = sum;
            solid_angle[cell] = angle;
            brightest[cell] = static_cast<float>(most);
            row.light += sum;
            row.solid_angle += angle;
        }
        of_rows[static_cast<std::size_t>(j)] = row;
    });
    CompensatedSum fluence, irradiance, whole;
    for (const Row& row : of_rows) {
        fluence.add(row.light);
        irradiance.add(row.irradiance);
        whole.add(row.solid_angle);
    }
    fluence_ = fluence.value();
    irradiance_ = irradiance.value();

    const double floor = 0.001 * fluence_ / whole.value();
    parallel_for(n, [&](std::int64_t j) {
        for (std::int64_t i = 0; i < n; ++i) {
            const Vec2d step = steps(i, j);
            const std::int64_t rx = cells_around(step.x), ry = cells_around(step.y), last = n - 1;
            float most = 0;
            for (std::int64_t y = std::max<std::int64_t>(0, j - ry); y <= std::min(last, j + ry); ++y)
                for (std::int64_t x = std::max<std::int64_t>(0, i - rx); x <= std::min(last, i + rx); ++x)
                    most = std::max(most, brightest[static_cast<std::size_t>(y * n + x)]);
            const auto cell = static_cast<std::size_t>(j * n + i);
            light[cell] =
                std::max(light[cell], std::max(static_cast<double>(most) / 16, floor) * solid_angle[cell]);
        }
    });
    return WindowedPiecewise2D(light, n, n, Portal::hemisphere());
}

std::optional<PortalSampler::Sample> PortalSampler::sample(const Window2D& window, Vec2f u) const {
    const auto s = table_.sample(Vec2d(u), window);
    if (!s) return std::nullopt;
    const Vec3d local = Portal::local_direction(s->p);
    if (!(local.z > 0)) return std::nullopt;
    return Sample{Vec3f(portal_.to_world(local)),
                  static_cast<float>(s->pdf / Portal::solid_angle_density(local))};
}

std::optional<PortalSampler::Sample> PortalSampler::sample(Point3f p, Vec2f u) const {
    const auto window = portal_.window(p);
    if (!window) return std::nullopt;
    return sample(*window, u);
}

float PortalSampler::pdf(const Window2D& window, Vec3f wi) const {
    const auto at = portal_.angles(Vec3d(wi));
    if (!at) return 0;
    return static_cast<float>(table_.pdf(*at, window) /
                              Portal::solid_angle_density(portal_.to_local(Vec3d(wi))));
}

float PortalSampler::pdf(Point3f p, Vec3f wi) const {
    const auto window = portal_.window(p);
    return window ? pdf(*window, wi) : 0;
}

std::string PortalSampler::description() const {
    char text[160];
    std::snprintf(text, sizeof text, "portal, %u x %u cells; %d x %d texels, %s, %.1f MiB", table_.columns(),
                  table_.rows(), grid_.width(), grid_.height(), name_of(grid_.layout()).data(),
                  static_cast<double>(table_.bytes()) / (1 << 20));
    return text;
}

} // namespace montelux
