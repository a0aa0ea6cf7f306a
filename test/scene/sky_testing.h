// Random walks through the spherical atmosphere from the eye: the oracle of the deterministic sky.
#pragma once

#include <cmath>

#include "montelux/mc/random/philox_stream.h"
#include "montelux/mc/stats/moments.h"
#include "montelux/scene/light/sky/atmosphere.h"

namespace montelux::testing {

// In one band, for sunlight of irradiance 1 outside. Distances by null collisions, next-event estimation to
// the sun's centre, absorption by weights, Russian roulette.
class SkyWalk {
  public:
    SkyWalk(const Atmosphere& atmosphere, int band, double ground_albedo, double elevation,
            std::uint64_t seed)
        : atmosphere_(atmosphere), stream_(seed), band_(band),
          ground_albedo_(ground_albedo), sun_{std::cos(elevation * pi / 180), 0,
                                              std::sin(elevation * pi / 180)},
          air_(double(atmosphere.air_scattering()[band])),
          aerosol_(double(atmosphere.aerosol_extinction()[band])),
          ozone_(double(atmosphere.ozone_absorption()[band])) {}

    RunningMoments radiance(Vec3d w, int walks) {
        RunningMoments moments;
        for (int i = 0; i < walks; ++i) moments.add(walk(w));
        return moments;
    }

  private:
    double next() { return stream_.next_double(); }
    double sunlight(double height, double mu) const {
        return double(atmosphere_.sunlight(height, mu)[band_]);
    }
    Vec3d turn(Vec3d w, double mu) {
        const double phi = 2 * pi * next(), s = std::sqrt(std::max(0.0, 1 - mu * mu));
        const Vec3d a = normalize(cross(w, std::abs(w.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0})),
                    b = cross(w, a);
        return normalize(w * mu + a * (s * std::cos(phi)) + b * (s * std::sin(phi)));
    }
    double air_deflection() {
        for (;;) {
            const double mu = 2 * next() - 1;
            if (next() * rayleigh_phase(1) < rayleigh_phase(mu)) return mu;
        }
    }
    // Henyey and Greenstein's phase function; times 1 + mu^2 it is that of Cornette and Shanks.
    double aerosol_deflection() {
        const double g = atmosphere_.settings().aerosol_g;
        for (;;) {
            const double x = (1 - g * g) / (1 - g + 2 * g * next()), mu = (1 + g * g - x * x) / (2 * g);
            if (2 * next() < 1 + mu * mu) return mu;
        }
    }
    double walk(Vec3d w) {
        const double g = atmosphere_.settings().aerosol_g, share = atmosphere_.settings().aerosol_albedo;
        const double majorant = 1.0001 * (air_ + aerosol_) + ozone_;
        Vec3d p{0, 0, earth_radius};
        double sum = 0, carried = 1;
        for (int depth = 0;; ++depth) {
            const double r = length(p), mu = dot(p, w) / r;
            const double below = r * r * (mu * mu - 1) + earth_radius * earth_radius;
            const bool ground = depth > 0 && mu < 0 && below >= 0;
            const double end =
                ground ? -r * mu - std::sqrt(below) : Atmosphere::distance_to_space(r - earth_radius, mu);
            double s = 0, extinction = 0;
            Constituents density;
            bool collided = false;
            while (!collided) {
                s -= std::log(1 - next()) / majorant;
                if (s >= end) break;
                density = atmosphere_.density(length(p + s * w) - earth_radius);
                extinction = density.air * air_ + density.aerosol * aerosol_ + density.ozone * ozone_;
                collided = next() * majorant < extinction;
            }
            if (!collided) {
                if (!ground) return sum;
                const Vec3d n = normalize(p + end * w);
                p = n * earth_radius;
                sum +=
                    carried * ground_albedo_ / pi * std::max(0.0, dot(n, sun_)) * sunlight(0, dot(n, sun_));
                carried *= ground_albedo_;
                w = turn(n, std::sqrt(next()));
            } else {
                p = p + s * w;
                const double air = density.air * air_, aerosol = share * density.aerosol * aerosol_;
                const double nu = dot(w, sun_);
                sum += carried / extinction * (air * rayleigh_phase(nu) + aerosol * aerosol_phase(nu, g)) *
                       sunlight(length(p) - earth_radius, dot(p, sun_) / length(p));
                carried *= (air + aerosol) / extinction;
                w = turn(w, next() * (air + aerosol) < air ? air_deflection() : aerosol_deflection());
            }
            if (carried < 0.1) {
                if (next() < 0.5) return sum;
                carried *= 2;
            }
        }
    }

    const Atmosphere& atmosphere_;
    PhiloxStream stream_;
    int band_;
    double ground_albedo_;
    Vec3d sun_;
    double air_, aerosol_, ozone_;
};

} // namespace montelux::testing
