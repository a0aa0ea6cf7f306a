#include "montelux/scene/light/sky/sky_model.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/quadrature.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light/sky/line_of_sight.h"
#include "montelux/scene/light/sky/sky_data.h"
#include "montelux/spectrum/cie.h"

namespace montelux {

namespace {

void check(const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    char text[160];
    std::snprintf(text, sizeof text, "%s is %g; expected a number from %g to %g", name, value, low, high);
    throw Error("sky", text);
}

// Interpolates between the bands around a wavelength.
struct BandPlace {
    std::size_t i;
    float f;

    explicit BandPlace(float lambda) {
        const float x = std::clamp((lambda - lambda_min) / Bands::step, 0.0f, Bands::count - 1.0f);
        i = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(Bands::count - 2));
        f = x - static_cast<float>(i);
    }
    float of(const Bands& b) const {
        return (1 - f) * b[static_cast<int>(i)] + f * b[static_cast<int>(i) + 1];
    }
};

// Integrals against f of sunlight through the bands, as weights of the bands.
template <typename F>
Bands integral_weights(const F& f) {
    std::array<double, Bands::count> weights{};
    for (std::size_t i = 0; i < visible_samples; ++i) {
        const BandPlace at(lambda_min + static_cast<float>(i));
        const double value = static_cast<double>(solar_irradiance[i]) * f(i);
        weights[at.i] += value * static_cast<double>(1 - at.f);
        weights[at.i + 1] += value * static_cast<double>(at.f);
    }
    Bands b;
    for (int i = 0; i < Bands::count; ++i) b.set(i, static_cast<float>(weights[static_cast<std::size_t>(i)]));
    return b;
}

double dot(const Bands& a, const Bands& b) {
    const Bands product = a * b;
    double sum = 0;
    for (const Float4& v : product.v) sum += static_cast<double>(montelux::sum(v));
    return sum;
}

// Row of a direction relative to the horizon: rows are dense there, where the sky changes fastest.
float row_of(float elevation) { return std::sqrt(std::max(elevation, 0.0f) * static_cast<float>(2 / pi)); }

} // namespace

SkyModel::SkyModel(const SkySettings& settings)
    : settings_(settings), solar_(SpectrumTable::from([](float lambda) {
          return solar_irradiance[static_cast<std::size_t>(lambda - lambda_min + 0.5f)];
      })) {
    const AtmosphereSettings& a = settings.atmosphere;
    check("elevation of the sun (degrees)", settings.elevation, lowest_sun, highest_sun);
    check("azimuth of the sun (degrees)", settings.azimuth, -1e6, 1e6);
    check("turbidity", a.turbidity, least_turbidity, most_turbidity);
    check("Angstrom exponent", a.angstrom_exponent, -1, 4);
    check("albedo of the aerosol", a.aerosol_albedo, 0, 1);
    check("asymmetry of the aerosol", a.aerosol_g, -0.9, 0.9);
    check("ozone (Dobson units)", a.ozone, 0, 1000);
    const Bands albedo = Bands::from([&](float lambda) { return settings.ground_albedo(lambda); });
    for (int i = 0; i < Bands::count; ++i)
        check("albedo of the ground", static_cast<double>(albedo[i]), 0, 1);

    const double elevation = settings.elevation * pi / 180, azimuth = settings.azimuth * pi / 180;
    const double zenith = pi / 2 - elevation;
    sun_side_ = Vec2f(Vec2d(std::cos(azimuth), std::sin(azimuth)));
    sun_ = Vec3f(Vec3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                       std::sin(elevation)));

    mean_weights_ = integral_weights([](std::size_t) { return 1.0 / visible_samples; });
    cie_weights_ = {integral_weights([](std::size_t i) { return static_cast<double>(cie_x[i]); }),
                    integral_weights([](std::size_t i) { return static_cast<double>(cie_y[i]); }),
                    integral_weights([](std::size_t i) { return static_cast<double>(cie_z[i]); })};

    const Atmosphere atmosphere(a);
    // How far around the earth a line of sight extends before it leaves the atmosphere.
    const double range = std::acos(earth_radius / atmosphere_radius);
    const ScatteredLight scattered(atmosphere, albedo, zenith, range);
    smooth_.resize(static_cast<std::size_t>(rows) * columns);
    aureole_.resize(smooth_.size());
    std::vector<double> cos_azimuths;
    for (int column = 0; column < columns; ++column)
        cos_azimuths.push_back(std::cos(pi * column / (columns - 1)));
    parallel_for(rows, [&](std::int64_t row) {
        const double x = static_cast<double>(row) / (rows - 1);
        const auto seen = look(atmosphere, scattered, zenith, std::sin(pi / 2 * x * x), cos_azimuths);
        for (std::size_t column = 0; column < columns; ++column) {
            const std::size_t i = static_cast<std::size_t>(row) * columns + column;
            smooth_[i] = seen[column].smooth;
            aureole_[i] = seen[column].aureole;
        }
    });

    // Of the disc above the horizon.
    const double mu_sun = std::cos(zenith);
    const double part = Atmosphere::visible_part_of_sun(0, mu_sun);
    const Bands passing = atmosphere.transmittance(atmosphere.path_to_space(0, mu_sun));
    const double disc = SunDisc::of_radius(sun_, sun_angular_radius).solid_angle();
    sun_radiance_ = in_sunlight(part > 0 ? static_cast<float>(1 / disc) * passing : Bands());
    const double sines =
        elevation > sun_angular_radius ? mu_sun : height_above_horizon(elevation, sun_angular_radius);
    sun_irradiance_ = static_cast<float>(sines) * passing;

    for (const QuadratureNode& n : gauss_legendre_rule(48))
        for (const QuadratureNode& m : gauss_legendre_rule(32)) {
            const double z = n.x * n.x, side = std::sqrt(1 - z * z), phi = azimuth + pi * m.x;
            const Vec3d w{side * std::cos(phi), side * std::sin(phi), z};
            sky_irradiance_.add(static_cast<float>(2 * pi * m.weight * n.weight * 2 * n.x * z),
                                scattering(Vec3f(w)));
        }
    ground_ = static_cast<float>(inv_pi) * albedo * (sky_irradiance_ + sun_irradiance_);
}

SpectrumTable SkyModel::in_sunlight(const Bands& share) {
    return SpectrumTable::from([&](float lambda) {
        return solar_irradiance[static_cast<std::size_t>(lambda - lambda_min + 0.5f)] *
               BandPlace(lambda).of(share);
    });
}

SkyModel::Place SkyModel::place(Vec3f w) const {
    const float along = w.x * sun_side_.x + w.y * sun_side_.y, across = w.x * sun_side_.y - w.y * sun_side_.x;
    const float y = row_of(std::atan2(w.z, std::sqrt(along * along + across * across))) * (rows - 1);
    const float x = std::atan2(std::abs(across), along) * static_cast<float>((columns - 1) / pi);
    Place p;
    // NaN maps to the first row.
    const std::size_t row = y >= 0 ? std::min<std::size_t>(static_cast<std::size_t>(y), rows - 2) : 0;
    const std::size_t column = x >= 0 ? std::min<std::size_t>(static_cast<std::size_t>(x), columns - 2) : 0;
    p.first = row * columns + column;
    const float v = y - static_cast<float>(row), u = x - static_cast<float>(column);
    p.share = {(1 - v) * (1 - u), (1 - v) * u, v * (1 - u), v * u};
    p.aerosol_phase = static_cast<float>(aerosol_phase(
        static_cast<double>(std::clamp(dot(w, sun_), -1.0f, 1.0f)), settings_.atmosphere.aerosol_g));
    return p;
}

SampledSpectrum SkyModel::radiance(Vec3f w, const SampledWavelengths& lambda) const {
    SampledSpectrum share;
    if (w.z < 0) {
        for (int i = 0; i < spectrum_samples; ++i) share.set(i, BandPlace(lambda.lambda[i]).of(ground_));
    } else {
        const Place p = place(w);
        for (int s = 0; s < spectrum_samples; ++s) {
            const BandPlace at(lambda.lambda[s]);
            auto of = [&](const std::vector<Bands>& t) {
                float sum = 0;
                for (std::size_t k = 0; k < 4; ++k) sum += p.share[k] * at.of(t[p.first + corners[k]]);
                return sum;
            };
            share.set(s, of(smooth_) + p.aerosol_phase * of(aureole_));
        }
    }
    return share * solar_.sample(lambda);
}

Bands SkyModel::scattering(Vec3f w) const {
    if (w.z < 0) return ground_;
    const Place p = place(w);
    Bands sum;
    for (std::size_t k = 0; k < 4; ++k) {
        sum.add(p.share[k], smooth_[p.first + corners[k]]);
        sum.add(p.share[k] * p.aerosol_phase, aureole_[p.first + corners[k]]);
    }
    return sum;
}

SpectrumTable SkyModel::radiance(Vec3f w) const { return in_sunlight(scattering(w)); }

double SkyModel::mean_radiance(Vec3f w) const { return dot(mean_weights_, scattering(w)); }

Vec3d SkyModel::tristimulus(Vec3f w) const {
    const Bands share = scattering(w);
    return {dot(cie_weights_[0], share), dot(cie_weights_[1], share), dot(cie_weights_[2], share)};
}

float SkyModel::radiance(Vec3f w, float lambda) const {
    return BandPlace(lambda).of(scattering(w)) * solar_(lambda);
}

} // namespace montelux
