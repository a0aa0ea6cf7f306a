// The density that adaptive integration samples from: uniform + boundary + product of maps + Gaussians.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "montelux/mc/integrate/adaptive/gaussian.h"
#include "montelux/mc/integrate/adaptive/monotone_map.h"
#include "montelux/mc/integrate/points.h"

namespace montelux {

// q(x) = sum over channels k of a_k q_k(x) on the unit cube. Channel 0 is uniform, and always has a share, so
// that every part of the cube is sampled (a defensive mixture: Owen and Zhou 2000, "Safe and effective
// importance sampling"); then boundary_density.h and the product of maps, if they are there; then the
// Gaussians, whose points outside the cube count as zeros. Each channel draws its own share of the points,
// from a point set of its own, and every point is weighted by the whole mixture (Veach's balance heuristic),
// so that channels may miss parts of the integrand.
class MixtureDensity {
  public:
    // Shares are multiples of 1 / units, so that every multiple of `units` points is divided exactly.
    static constexpr int units = 64;

    // Multiple of the mean of h / q above which only a new channel helps, not other shares.
    static constexpr double beyond_reach = 100;

    // Uniform.
    explicit MixtureDensity(int dimensions) : dimensions_(dimensions), shares_{units} {}
    // Shares are equal until set.
    MixtureDensity(int dimensions, std::vector<MonotoneMap> maps, std::vector<Gaussian> gaussians,
                   bool boundary = false);

    int dimensions() const { return dimensions_; }
    int channels() const { return static_cast<int>(shares_.size()); }
    std::span<const int> shares() const { return shares_; }
    // The same as numbers that sum to 1.
    double share(int channel) const {
        return static_cast<double>(shares_[static_cast<std::size_t>(channel)]) / units;
    }
    // One per channel, summing to `units`.
    void set_shares(std::vector<int> shares) { shares_ = std::move(shares); }
    bool has_boundary() const { return boundary_; }
    // The channels after the uniform one: the boundary's is before map_channel(), that of the maps before
    // first_gaussian().
    int map_channel() const { return boundary_ ? 2 : 1; }
    int first_gaussian() const { return map_channel() + (maps_.empty() ? 0 : 1); }
    std::span<const MonotoneMap> maps() const { return maps_; }
    std::span<const Gaussian> gaussians() const { return gaussians_; }

    // Multiples of this many points divide exactly: `units`, or fewer if the shares have a common factor.
    std::uint64_t balanced_points() const;
    // Number of points of a channel among the first n of the mixture.
    std::uint64_t channel_points(int channel, std::uint64_t n) const {
        return n * static_cast<std::uint64_t>(shares_[static_cast<std::size_t>(channel)]) / units;
    }
    // The points of a channel for uniform numbers u, outside the cube too.
    void place(int channel, const PointBatch& u, PointBuffer& x) const;
    // The same, those inside the cube one after the other, and q at each; `inside`, if given, gets their
    // indices in u.
    void sample(int channel, const PointBatch& u, PointBuffer& x, std::vector<double>& density,
                std::vector<std::size_t>* inside = nullptr) const;
    // q_k at each point, and q.
    void channel_pdf(int channel, const PointBatch& x, std::span<double> density) const;
    void pdf(const PointBatch& x, std::span<double> density) const;

    // Shares that make the second moment of h / q small, given points x drawn with density p and h there
    // (Kleiss and Pittau 1994, "Weight optimization in multichannel Monte Carlo"). The uniform channel keeps
    // `uniform_units` at least, that of the boundary one, and each of the last `newest` channels at least one
    // step, since its benefit is not known yet. Shares are multiples of `step` units, a power of two. The work
    // ends early where `stop` is true.
    void optimise_shares(const PointBatch& x, std::span<const double> h, std::span<const double> p,
                         int uniform_units, int step = 1, int newest = 0,
                         const std::function<bool()>& stop = {});
    // The same with all Gaussians wider.
    MixtureDensity widened(double factor) const;
    // Removes Gaussians that draw no points.
    void drop_idle();

    void save(StateWriter& state) const;
    static MixtureDensity load(StateReader& state, int dimensions);

  private:
    // x as place() has it; multiplies by the density of a channel that is no Gaussian.
    void draw(int channel, const PointBatch& u, PointBuffer& x, std::span<double> density) const;
    // Adds the shares of all channels but `except`.
    void add_pdf(const PointBatch& x, std::span<double> density, int except) const;
    const Gaussian& gaussian(int channel) const {
        return gaussians_[static_cast<std::size_t>(channel - first_gaussian())];
    }

    int dimensions_;
    bool boundary_ = false;
    std::vector<MonotoneMap> maps_; // one per dimension, or none
    std::vector<Gaussian> gaussians_;
    std::vector<int> shares_;
};

} // namespace montelux
