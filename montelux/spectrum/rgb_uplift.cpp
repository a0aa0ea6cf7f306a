#include "montelux/spectrum/rgb_uplift.h"

#include <cmath>

#include "montelux/spectrum/rgb_uplift_solver.h"

namespace montelux {

namespace {

// Rises from 0 to 1, flat at both ends and a little flatter at 1, where spectra change fastest.
double grid_position(double u) { return 1 - std::pow(1 - u * u * (3 - 2 * u), 1.3); }

std::vector<float> uplift_grid(int resolution) {
    std::vector<float> grid(resolution);
    for (int i = 0; i < resolution; ++i)
        grid[i] = static_cast<float>(grid_position(i / static_cast<double>(resolution - 1)));
    return grid;
}

// Scale of the coefficients in the table.
float uplift_scale(float luminance) { return std::sqrt(std::max(luminance * (1 - luminance), 1e-12f)); }

// Scaled coefficients along one line of the table, where only the largest component changes.
class LineSolver {
  public:
    LineSolver(const RgbUpliftSolver& solver, Vec3d luminance_weights, Vec3d ratios)
        : solver_(solver), luminance_weights_(luminance_weights), ratios_(ratios) {}

    void restart() { solved_ = 0; }

    // Starts from the line through the two values before, which are close together and smooth.
    Vec3d solve(double largest) {
        Vec3d rgb = ratios_ * largest;
        double scale = static_cast<double>(uplift_scale(static_cast<float>(dot(rgb, luminance_weights_))));
        Vec3d guess;
        if (solved_ == 1) guess = last_;
        if (solved_ >= 2) guess = last_ + (last_ - before_) * ((largest - at_) / (at_ - at_before_));
        RgbUpliftSolver::Coefficients start{guess.x / scale, guess.y / scale, guess.z / scale};
        auto c = solver_.solve(rgb, start);
        if (solver_.difference(rgb, c) > 1e-3) {
            auto again = solver_.solve(rgb, {0, 0, 0});
            if (solver_.difference(rgb, again) < solver_.difference(rgb, c)) c = again;
        }
        before_ = last_;
        at_before_ = at_;
        last_ = Vec3d(c[0], c[1], c[2]) * scale;
        at_ = largest;
        ++solved_;
        return last_;
    }

  private:
    const RgbUpliftSolver& solver_;
    Vec3d luminance_weights_, ratios_;
    Vec3d last_, before_;
    double at_ = 0, at_before_ = 0;
    int solved_ = 0;
};

} // namespace

std::vector<Float4> RgbUpliftTable::compute(const RgbColorSpace& space, int resolution) {
    const RgbUpliftSolver solver(space);
    const std::vector<float> grid = uplift_grid(resolution);
    const int n = resolution;
    std::vector<Float4> nodes(std::size_t{3} * n * n * n);
    // At black the ratios do not matter, and only the reflectance 1 is white.
    const double darkest = 0.01 * static_cast<double>(grid[1]), lightest = 1 - 1e-7;
    for (int l = 0; l < 3; ++l)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                Vec3d ratios;
                ratios[l] = 1;
                ratios[(l + 1) % 3] = static_cast<double>(grid[i]);
                ratios[(l + 2) % 3] = static_cast<double>(grid[j]);
                LineSolver line(solver, space.luminance_weights(), ratios);
                auto solve = [&](int k) {
                    Vec3d c = line.solve(std::clamp(static_cast<double>(grid[k]), darkest, lightest));
                    nodes[((std::size_t{static_cast<unsigned>(l)} * n + k) * n + j) * n + i] =
                        Float4{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z), 0};
                };
                for (int k = n / 2; k < n; ++k) solve(k);
                line.restart();
                for (int k = n / 2; k >= 0; --k) solve(k);
            }
    return nodes;
}

RgbUpliftTable::RgbUpliftTable(const RgbColorSpace& space, int resolution, const Float4* nodes)
    : resolution_(resolution), luminance_weights_(space.luminance_weights()), nodes_(nodes),
      grid_(uplift_grid(resolution)), inverse_widths_(resolution - 1) {
    for (int i = 0; i + 1 < resolution; ++i) inverse_widths_[i] = 1 / (grid_[i + 1] - grid_[i]);
    int cell = 0;
    for (int bin = 0; bin <= bin_count; ++bin) {
        while (cell + 2 < resolution && grid_[cell + 1] * bin_count <= static_cast<float>(bin)) ++cell;
        cell_of_bin_[bin] = static_cast<std::uint8_t>(cell);
    }
}

RgbUpliftTable::Position RgbUpliftTable::locate(float v) const {
    int cell = cell_of_bin_[static_cast<int>(v * bin_count)];
    while (cell + 2 < resolution_ && grid_[cell + 1] <= v) ++cell;
    return {cell, (v - grid_[cell]) * inverse_widths_[cell]};
}

SigmoidPolynomial RgbUpliftTable::operator()(Vec3f rgb) const {
    // Comparisons in this order send NaN to 0.
    for (int k = 0; k < 3; ++k) rgb[k] = rgb[k] > 0 ? std::min(rgb[k], 1.0f) : 0.0f;
    if (rgb.x == rgb.y && rgb.y == rgb.z) return SigmoidPolynomial::constant(rgb.x);

    int l = rgb.x > rgb.y ? (rgb.x > rgb.z ? 0 : 2) : (rgb.y > rgb.z ? 1 : 2);
    // The inverse of a denormal number is infinite; min in this order sends the NaN that follows to 1.
    float largest = rgb[l], inverse = 1 / largest;
    Position z = locate(largest);
    Position y = locate(std::min(1.0f, rgb[(l + 2) % 3] * inverse));
    Position x = locate(std::min(1.0f, rgb[(l + 1) % 3] * inverse));

    const std::ptrdiff_t n = resolution_;
    const Float4* p = nodes_ + ((l * n + z.cell) * n + y.cell) * n + x.cell;
    auto along_x = [&](const Float4* q) { return q[0] + x.fraction * (q[1] - q[0]); };
    auto along_y = [&](const Float4* q) {
        Float4 low = along_x(q), high = along_x(q + n);
        return low + y.fraction * (high - low);
    };
    Float4 low = along_y(p), high = along_y(p + n * n);
    Float4 c = (low + z.fraction * (high - low)) / uplift_scale(dot(rgb, luminance_weights_));
    return {c[0], c[1], c[2]};
}

} // namespace montelux
