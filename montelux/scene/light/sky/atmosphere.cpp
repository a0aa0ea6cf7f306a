#include "montelux/scene/light/sky/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/quadrature.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light/sky/sky_data.h"

namespace montelux {

namespace {

constexpr double aerosol_scale_height = 1.2;
constexpr double ozone_column = 15;          // km at the largest density
constexpr double dobson_unit = 2.687e20;     // molecules per m^2
constexpr double reference_wavelength = 550; // nm, of turbidity

double ozone_density(double height) {
    return std::max(0.0, height < 25 ? (height - 10) / 15 : (40 - height) / 15);
}

// Distances along a path are clustered at its start, where the air is dense: s = d t^3.
const std::vector<QuadratureNode>& path_rule() {
    static const std::vector<QuadratureNode> rule = gauss_legendre_rule(128);
    return rule;
}

} // namespace

double rayleigh_optical_thickness(double lambda) {
    const double l2 = lambda * lambda * 1e-6;
    return 0.0021520 * (1.0455996 - 341.29061 / l2 - 0.90230850 * l2) /
           (1 + 0.0027059889 / l2 - 85.968563 * l2);
}

double rayleigh_phase(double mu) {
    constexpr double depolarisation = 0.0279, gamma = depolarisation / (2 - depolarisation);
    return 3 / (16 * pi * (1 + 2 * gamma)) * ((1 + 3 * gamma) + (1 - gamma) * mu * mu);
}

double aerosol_phase(double mu, double g) {
    const double d = 1 + g * g - 2 * g * mu;
    return 3 / (8 * pi) * (1 - g * g) / (2 + g * g) * (1 + mu * mu) / (d * std::sqrt(d));
}

double standard_air_density(double height) {
    // Bases of the layers in geopotential km, K per km in them.
    constexpr int layers = 7;
    constexpr double base[layers] = {0, 11, 20, 32, 47, 51, 71};
    constexpr double lapse[layers] = {-6.5, 0, 1, 2.8, 0, -2.8, -2};
    constexpr double sea_level_temperature = 288.15;
    constexpr double hydrostatic = 34.1632; // g M / R, K per km
    const double h = 6356.766 * height / (6356.766 + height);
    double temperature = sea_level_temperature, pressure = 1;
    for (int i = 0; i < layers; ++i) {
        const double top = i + 1 < layers && h > base[i + 1] ? base[i + 1] : h;
        const double rise = top - base[i];
        if (lapse[i] == 0) {
            pressure *= std::exp(-hydrostatic * rise / temperature);
        } else {
            const double next = temperature + lapse[i] * rise;
            pressure *= std::pow(temperature / next, hydrostatic / lapse[i]);
            temperature = next;
        }
        if (top == h) break;
    }
    return pressure * sea_level_temperature / temperature;
}

Atmosphere::Atmosphere(const AtmosphereSettings& settings) : settings_(settings) {
    const int steps = static_cast<int>(std::ceil(atmosphere_height / density_step)) + 1;
    for (int i = 0; i <= steps; ++i) {
        const double height = i * density_step;
        density_.push_back(
            {standard_air_density(height), std::exp(-height / aerosol_scale_height), ozone_density(height)});
    }
    // The vertical path of air and the densities above are one.
    const double air_column = integrate_to_space(0, 1).air;
    const double aerosol_thickness =
        (settings.turbidity - 1) * rayleigh_optical_thickness(reference_wavelength);
    air_ =
        Bands::from([&](float l) { return rayleigh_optical_thickness(static_cast<double>(l)) / air_column; });
    aerosol_ = Bands::from([&](float l) {
        return aerosol_thickness / aerosol_scale_height *
               std::pow(static_cast<double>(l) / reference_wavelength, -settings.angstrom_exponent);
    });
    for (int i = 0; i < Bands::count; ++i)
        ozone_.set(i,
                   static_cast<float>(static_cast<double>(ozone_cross_section[static_cast<std::size_t>(i)]) *
                                      1e-24 * settings.ozone * dobson_unit / ozone_column));

    paths_.resize(static_cast<std::size_t>(heights) * cosines);
    parallel_for(heights, [&](std::int64_t row) {
        const double height = height_of_row(static_cast<int>(row));
        for (int column = 0; column < cosines; ++column)
            paths_[static_cast<std::size_t>(row * cosines + column)] =
                integrate_to_space(height, cosine_of_column(height, column));
    });
}

// Rows are dense near the ground.
double Atmosphere::height_of_row(int row) {
    const double x = row / (heights - 1.0);
    return atmosphere_height * x * x;
}

// Columns are uniform in the distance to space, which determines most paths (Bruneton and Neyret 2008,
// "Precomputed Atmospheric Scattering"), from the zenith to the horizon.
double Atmosphere::cosine_of_column(double height, int column) {
    const double r = earth_radius + height;
    const double shortest = atmosphere_height - height;
    const double longest = distance_to_space(height, horizon_cosine(height));
    const double d = shortest + (longest - shortest) * (column / (cosines - 1.0));
    if (!(d > 0)) return 1;
    const double mu = (atmosphere_radius * atmosphere_radius - r * r - d * d) / (2 * r * d);
    return std::clamp(mu, horizon_cosine(height), 1.0);
}

Constituents Atmosphere::integrate_to_space(double height, double mu) const {
    const double r = earth_radius + height;
    // From a distance along the path on, away from its lowest point.
    auto rising = [&](double lowest, double cosine) {
        const double length = distance_to_space(lowest, cosine), r0 = earth_radius + lowest;
        Constituents sum;
        for (const QuadratureNode& n : path_rule()) {
            const double s = length * n.x * n.x * n.x;
            const double at = std::sqrt(r0 * r0 + s * s + 2 * r0 * s * cosine) - earth_radius;
            sum += length * 3 * n.x * n.x * n.weight * density(at);
        }
        return sum;
    };
    if (mu >= 0) return rising(height, mu);
    // Down to the lowest point and up again: twice the path from there, less the part beyond the start.
    const double tangent = std::max(0.0, r * std::sqrt(std::max(0.0, 1 - mu * mu)) - earth_radius);
    return 2 * rising(tangent, 0) + -1 * rising(height, -mu);
}

Constituents Atmosphere::path_to_space(double height, double mu) const {
    height = std::clamp(height, 0.0, atmosphere_height);
    const double y = std::sqrt(height / atmosphere_height) * (heights - 1);
    const auto row = static_cast<std::size_t>(std::min(y, heights - 1.000001));
    const double fy = y - static_cast<double>(row);
    // Each row has its own horizon, so the column is found at this height.
    const double shortest = atmosphere_height - height;
    const double longest = distance_to_space(height, horizon_cosine(height));
    const double d = distance_to_space(height, std::clamp(mu, horizon_cosine(height), 1.0));
    const double share = longest > shortest ? std::clamp((d - shortest) / (longest - shortest), 0.0, 1.0) : 0;
    const double x = share * (cosines - 1);
    const auto column = static_cast<std::size_t>(std::min(x, cosines - 1.000001));
    const double fx = x - static_cast<double>(column);
    const Constituents* p = &paths_[row * cosines + column];
    return (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[cosines] + fx * p[cosines + 1]);
}

double Atmosphere::visible_part_of_sun(double height, double mu) {
    const double above =
        std::acos(std::clamp(horizon_cosine(height), -1.0, 1.0)) - std::acos(std::clamp(mu, -1.0, 1.0));
    return part_above_horizon(above, sun_angular_radius);
}

Bands Atmosphere::sunlight(double height, double mu) const {
    const double part = visible_part_of_sun(height, mu);
    if (!(part > 0)) return {};
    return static_cast<float>(part) * transmittance(path_to_space(height, mu));
}

} // namespace montelux
