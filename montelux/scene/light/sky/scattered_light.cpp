#include "montelux/scene/light/sky/scattered_light.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/quadrature.h"
#include "montelux/mc/parallel/parallel_for.h"

namespace montelux {

namespace {

constexpr int most_scatterings = 200;
constexpr float convergence = 1e-4f;
// Below this zenith angle of the sun (radians) light varies slowly with it.
constexpr double high_sun = 75 * pi / 180;

double air_phase(double mu, double) { return rayleigh_phase(mu); }

// 1 - e^-a, and the weights of a linear source at the far and the near end of a path of optical thickness a,
// as seen from the near end.
struct Passage {
    Bands transmittance, far, near;

    explicit Passage(Bands a = {}) {
        transmittance = exp(-1.0f * a);
        for (std::size_t i = 0; i < Bands::vectors; ++i) {
            const Float4 t = a.v[i], e = transmittance.v[i];
            const Float4 mean = (1.0f - e) / max(t, broadcast(1e-30f));
            const Int4 thin = t < broadcast(0.03f);
            far.v[i] = select(thin, t * (0.5f - t * (1.0f / 3 - t * 0.125f)), mean - e);
            near.v[i] = select(thin, t * (0.5f - t * (1.0f / 6 - t * (1.0f / 24))), 1.0f - mean);
        }
    }
};

} // namespace

// Tables common to all columns.
struct ScatteredLight::Layers {
    std::vector<QuadratureNode> cosines;
    std::vector<std::vector<double>> up, down; // harmonics of the streams
    std::vector<Passage> passages;             // [layer][stream]
    std::vector<Bands> air, aerosol;           // share of scattering in the extinction at each level

    Layers(const Atmosphere& atmosphere, const Bands& air_scattering, const Bands& aerosol_scattering)
        : cosines(gauss_legendre_rule(streams)) {
        for (const QuadratureNode& n : cosines) {
            up.push_back(normalised_legendre(n.x, first_order));
            down.push_back(normalised_legendre(-n.x, first_order));
        }
        const auto rule = gauss_legendre_rule(6);
        for (int level = 0; level < levels; ++level) {
            const double height = level_height(level);
            const Constituents density = atmosphere.density(height);
            const Bands extinction = atmosphere.extinction(density);
            air.push_back(static_cast<float>(density.air) * air_scattering / extinction);
            aerosol.push_back(static_cast<float>(density.aerosol) * aerosol_scattering / extinction);
            if (level + 1 == levels) break;
            const double thickness = level_height(level + 1) - height;
            Constituents column;
            for (const QuadratureNode& n : rule)
                column += n.weight * thickness * atmosphere.density(height + n.x * thickness);
            const Bands optical = atmosphere.extinction(column);
            for (const QuadratureNode& n : cosines)
                passages.emplace_back(static_cast<float>(1 / n.x) * optical);
        }
    }
    const Passage& passage(int layer, int stream) const {
        return passages[static_cast<std::size_t>(layer * streams + stream)];
    }
};

std::vector<double> ScatteredLight::phase_moments(double (*phase)(double mu, double g), double g, int order) {
    std::vector<double> moments(static_cast<std::size_t>(order) + 1);
    for (const QuadratureNode& n : gauss_legendre_rule(order + 80)) {
        const double mu = 2 * n.x - 1;
        double before = 0, p = 1;
        for (int l = 0; l <= order; ++l) {
            moments[static_cast<std::size_t>(l)] += 2 * n.weight * 2 * pi * phase(mu, g) * p;
            const double next = ((2 * l + 1) * mu * p - l * before) / (l + 1);
            before = p;
            p = next;
        }
    }
    return moments;
}

double ScatteredLight::level_height(int level) {
    const double x = level / (levels - 1.0);
    return atmosphere_height * x * x;
}

// Dense around the sun's angle at the eye.
double ScatteredLight::column_angle(int column) const {
    const double x = static_cast<double>(column - side_columns_) / side_columns_;
    return std::max(0.0, sun_zenith_ + range_ * x * std::abs(x));
}

ScatteredLight::ScatteredLight(const Atmosphere& atmosphere, const Bands& ground_albedo, double sun_zenith,
                               double range)
    : sun_zenith_(sun_zenith), range_(range), side_columns_(sun_zenith < high_sun ? 3 : most_side_columns),
      air_(atmosphere.air_scattering()),
      aerosol_(static_cast<float>(atmosphere.settings().aerosol_albedo) * atmosphere.aerosol_extinction()),
      air_moments_(phase_moments(air_phase, 0, first_order)),
      aerosol_moments_(phase_moments(aerosol_phase, atmosphere.settings().aerosol_g, first_order)),
      light_(static_cast<std::size_t>((2 * side_columns_ + 1) * levels) * sky_terms) {
    const Layers layers(atmosphere, air_, aerosol_);
    parallel_for(2 * side_columns_ + 1,
                 [&](std::int64_t c) { solve(layers, atmosphere, ground_albedo, static_cast<int>(c)); });
}

void ScatteredLight::solve(const Layers& layers, const Atmosphere& atmosphere, const Bands& ground_albedo,
                           int column) {
    const double angle = column_angle(column), mu_sun = std::cos(angle);
    const std::vector<double> to_sun = normalised_legendre(mu_sun, first_order);
    constexpr int sides = 2 * streams;
    auto harmonics_of = [&](int stream) -> const std::vector<double>& {
        return stream < streams ? layers.up[static_cast<std::size_t>(stream)]
                                : layers.down[static_cast<std::size_t>(stream - streams)];
    };

    // Sources over the extinction, [m][level][stream]; upward streams, then downward ones.
    constexpr std::size_t per_order = static_cast<std::size_t>(levels) * sides;
    std::vector<Bands> from_sun((sky_order + 1) * per_order);
    std::vector<Bands> sun(levels);
    for (int level = 0; level < levels; ++level)
        sun[static_cast<std::size_t>(level)] = atmosphere.sunlight(level_height(level), mu_sun);
    for (int stream = 0; stream < sides; ++stream) {
        const std::vector<double>& p = harmonics_of(stream);
        for (int m = 0; m <= sky_order; ++m) {
            double air = 0, aerosol = 0;
            for (int l = m; l <= first_order; ++l) {
                const double product = p[harmonic(l, m)] * to_sun[harmonic(l, m)];
                air += air_moments_[static_cast<std::size_t>(l)] * product;
                aerosol += aerosol_moments_[static_cast<std::size_t>(l)] * product;
            }
            for (int level = 0; level < levels; ++level) {
                const auto i = static_cast<std::size_t>(level);
                Bands b = static_cast<float>(air) * layers.air[i];
                b.add(static_cast<float>(aerosol), layers.aerosol[i]);
                from_sun[static_cast<std::size_t>(m) * per_order + i * sides +
                         static_cast<std::size_t>(stream)] = b * sun[i];
            }
        }
    }

    const Bands direct = static_cast<float>(std::max(0.0, mu_sun)) * sun[0];
    std::vector<Bands> source(per_order);
    // Azimuthal orders are independent.
    for (int m = 0; m <= sky_order; ++m) {
        Bands ground = static_cast<float>(inv_pi) * ground_albedo * direct;
        for (int scatterings = 0; scatterings < most_scatterings; ++scatterings) {
            // The present light is scattered ...
            for (int level = 0; level < levels; ++level) {
                const auto i = static_cast<std::size_t>(level);
                const Bands* held = light(column, level);
                Bands scattered[sky_order + 1];
                for (int l = m; l <= sky_order; ++l) {
                    Bands b = static_cast<float>(air_moments_[static_cast<std::size_t>(l)]) * layers.air[i];
                    b.add(static_cast<float>(aerosol_moments_[static_cast<std::size_t>(l)]),
                          layers.aerosol[i]);
                    scattered[l] = b * held[harmonic(l, m)];
                }
                for (int stream = 0; stream < sides; ++stream) {
                    const std::vector<double>& p = harmonics_of(stream);
                    const std::size_t at = i * sides + static_cast<std::size_t>(stream);
                    Bands b = from_sun[static_cast<std::size_t>(m) * per_order + at];
                    for (int l = m; l <= sky_order; ++l)
                        b.add(static_cast<float>(p[harmonic(l, m)]), scattered[l]);
                    source[at] = b;
                }
            }
            // ... and passes on to the other levels, where its harmonics are computed.
            std::vector<Bands> next(static_cast<std::size_t>(levels * (sky_order + 1)));
            const float circle = static_cast<float>(m == 0 ? 2 * pi : pi);
            Bands onto_ground;
            for (int stream = 0; stream < streams; ++stream) {
                const auto s = static_cast<std::size_t>(stream);
                const float weight = circle * static_cast<float>(layers.cosines[s].weight);
                auto keep = [&](int level, const Bands& radiance, const std::vector<double>& p) {
                    for (int l = m; l <= sky_order; ++l)
                        next[static_cast<std::size_t>(level * (sky_order + 1) + l)].add(
                            weight * static_cast<float>(p[harmonic(l, m)]), radiance);
                };
                auto pass = [&](Bands& radiance, int layer, std::size_t far, std::size_t near) {
                    const Passage& p = layers.passage(layer, stream);
                    for (std::size_t i = 0; i < Bands::vectors; ++i)
                        radiance.v[i] = radiance.v[i] * p.transmittance.v[i] + source[far].v[i] * p.far.v[i] +
                                        source[near].v[i] * p.near.v[i];
                };
                Bands radiance;
                for (int level = levels - 2; level >= 0; --level) {
                    const std::size_t at = static_cast<std::size_t>(level) * sides + s;
                    pass(radiance, level, at + sides, at);
                    keep(level, radiance, layers.up[s]);
                }
                onto_ground.add(weight * static_cast<float>(layers.cosines[s].x), radiance);
                radiance = m == 0 ? ground : Bands();
                keep(0, radiance, layers.down[s]);
                for (int level = 1; level < levels; ++level) {
                    const std::size_t at = static_cast<std::size_t>(level) * sides + streams + s;
                    pass(radiance, level - 1, at - sides, at);
                    keep(level, radiance, layers.down[s]);
                }
            }
            ground = static_cast<float>(inv_pi) * ground_albedo * (direct + onto_ground);
            // Relative change of the light by this order.
            Float4 change{};
            for (int level = 0; level < levels; ++level) {
                Bands* held = light(column, level);
                const Bands* now = &next[static_cast<std::size_t>(level * (sky_order + 1))];
                for (std::size_t i = 0; i < Bands::vectors; ++i) {
                    const Float4 all = max(m == 0 ? now[0].v[i] : held[0].v[i], broadcast(1e-30f));
                    const Float4 difference = now[m].v[i] - held[harmonic(m, m)].v[i];
                    change = max(change, max(difference, -difference) / all);
                }
                for (int l = m; l <= sky_order; ++l) held[harmonic(l, m)] = now[l];
            }
            if (!any(change > broadcast(convergence))) break;
        }
    }
}

ScatteredLight::Source::Source(const ScatteredLight& light, double height, double mu,
                               const Constituents& density)
    : light_(&light) {
    const double y = std::sqrt(std::clamp(height / atmosphere_height, 0.0, 1.0)) * (levels - 1);
    level_ = std::min(static_cast<int>(y), levels - 2);
    rise_ = static_cast<float>(std::clamp(y - level_, 0.0, 1.0));
    normalised_legendre(mu, sky_order, harmonics_.data());
    const Bands air = static_cast<float>(density.air) * light.air_;
    const Bands aerosol = static_cast<float>(density.aerosol) * light.aerosol_;
    for (std::size_t l = 0; l <= sky_order; ++l) {
        scattering_[l] = static_cast<float>(light.air_moments_[l]) * air;
        scattering_[l].add(static_cast<float>(light.aerosol_moments_[l]), aerosol);
    }
    place_.fill(-1);
}

const std::array<Bands, sky_order + 1>& ScatteredLight::Source::column(int column) {
    int& place = place_[static_cast<std::size_t>(column)];
    if (place < 0) {
        place = static_cast<int>(coefficients_.size());
        std::array<Bands, sky_order + 1>& of = coefficients_.emplace_back();
        const Bands *below = light_->light(column, level_), *above = light_->light(column, level_ + 1);
        for (int l = 0; l <= sky_order; ++l)
            for (int m = 0; m <= l; ++m) {
                const std::size_t i = harmonic(l, m);
                Bands held = (1 - rise_) * below[i];
                held.add(rise_, above[i]);
                held *= scattering_[static_cast<std::size_t>(l)];
                of[static_cast<std::size_t>(m)].add(static_cast<float>(harmonics_[i]), held);
            }
    }
    return coefficients_[static_cast<std::size_t>(place)];
}

Bands ScatteredLight::Source::operator()(double sun_zenith, double cos_azimuth) {
    const double offset = std::clamp((sun_zenith - light_->sun_zenith_) / light_->range_, -1.0, 1.0);
    const int side = light_->side_columns_;
    const double x = side * (1 + std::copysign(std::sqrt(std::abs(offset)), offset));
    const int c = std::min(static_cast<int>(x), 2 * side - 1);
    // Between columns light is interpolated linearly in the angle.
    const double from = light_->column_angle(c), to = light_->column_angle(c + 1);
    const auto across =
        static_cast<float>(to > from ? std::clamp((sun_zenith - from) / (to - from), 0.0, 1.0) : 0.0);
    Bands sum;
    for (int end = 0; end < 2; ++end) {
        const auto& coefficients = column(c + end);
        double before = cos_azimuth, cosine = 1; // of (m - 1) and m times the azimuth
        for (const Bands& b : coefficients) {
            sum.add(static_cast<float>(cosine) * (end == 0 ? 1 - across : across), b);
            const double next = 2 * cos_azimuth * cosine - before;
            before = cosine;
            cosine = next;
        }
    }
    return sum;
}

} // namespace montelux
