// A density on the unit interval by its inverse distribution function, a monotone rational-quadratic spline.
#pragma once

#include <span>
#include <vector>

#include "montelux/mc/integrate/state_archive.h"

namespace montelux {

// Bins of given probability; between bin edges the quantile function x(u) is a quotient of quadratics
// (Gregory, Delbourgo 1982, "Piecewise rational quadratic interpolation to monotonic data"), which is
// increasing, has its inverse in closed form, and joins the bins with a continuous slope. So the density is
// continuous too, and an integrand divided by it stays as smooth as low-discrepancy points like it. Between
// bins whose densities differ by more than a factor of five the slope may jump, as some integrands do.
class MonotoneMap {
  public:
    static constexpr double jump_ratio =
        5; // of the densities of neighbouring bins, above which the slope is not joined

    // The identity.
    MonotoneMap() : MonotoneMap({0, 1}, {1}) {}
    // Bin k is [edges[k], edges[k + 1]], strictly increasing from 0 to 1; masses are positive and are
    // normalised here. In the first bin the density is proportional to x^(power - 1): below 1, the integrand
    // has a singularity at 0.
    MonotoneMap(std::vector<double> edges, std::vector<double> masses, double power = 1);

    // One bin: u in [u0, u0 + du] to x in [x0, x0 + dx], slopes dx/du at its ends.
    struct Bin {
        double u0, du, x0, dx, slope0, slope1;
    };
    std::span<const Bin> table() const { return bins_; }
    double power() const { return power_; }
    int bins() const { return static_cast<int>(masses_.size()); }
    // x = quantile(u) at each u, and density[i] *= p(x).
    void sample(std::span<const double> u, std::span<double> x, std::span<double> density) const;
    // density[i] *= p(x[i]).
    void multiply_pdf(std::span<const double> x, std::span<double> density) const;
    double quantile(double u) const;
    double pdf(double x) const;

    void save(StateWriter& state) const;
    static MonotoneMap load(StateReader& state);

  private:
    double quantile(double u, double& density) const;
    const Bin& bin_of(const std::vector<double>& starts, double at) const;

    double power_;
    std::vector<double> edges_, masses_, u_starts_, x_starts_;
    std::vector<Bin> bins_;
};

struct MapFit {
    int bins = 16;
    int points_per_bin = 24; // at least
};

// The map whose density follows weighted points of the unit interval: bins are split where that raises the
// likelihood most. If the weights vanish beyond some place, the last bin keeps a margin of a few points, the
// uncertainty of that place.
MonotoneMap fit_monotone_map(std::span<const double> positions, std::span<const double> weights,
                             const MapFit& settings = {});

} // namespace montelux
