#include "montelux/render/merging_bias.h"

#include <algorithm>
#include <cmath>

#include "montelux/film/film_error.h"

namespace montelux {

namespace {

int cells_across(int pixels) { return (pixels + MergingBias::cell - 1) / MergingBias::cell; }

// Of the mean of the passes.
double variance_of_mean(const MergingBias::Cell& c, double passes) {
    const double mean = c.sum / passes;
    return std::max(0.0, (c.squares / passes - mean * mean) / (passes - 1));
}

} // namespace

MergingBias::MergingBias(const PixelBounds& crop)
    : crop_(crop), columns_(cells_across(crop.width())), open_({0, 0, columns_, cells_across(crop.height())}),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(cells_across(crop.height())) + 1) {
}

void MergingBias::add(int x, int y, Vec3d narrower) {
    open_.add((x - crop_.x0) / cell, (y - crop_.y0) / cell, narrower);
}

double MergingBias::pixels_in(std::size_t i) const {
    const int x = static_cast<int>(i) % columns_ * cell, y = static_cast<int>(i) / columns_ * cell;
    return double(std::min(cell, crop_.width() - x)) * double(std::min(cell, crop_.height() - y));
}

void MergingBias::close_pass(double samples) {
    if (samples > 0) {
        double whole = 0;
        const auto add = [](Cell& to, double bias) {
            to.sum += bias;
            to.squares += bias * bias;
        };
        for (std::size_t i = 0; i + 1 < cells_.size(); ++i) {
            const int x = static_cast<int>(i) % columns_, y = static_cast<int>(i) / columns_;
            const double sum = -2 * dot(open_.sum(x, y), luminance_weight) / samples;
            whole += sum;
            add(cells_[i], sum / pixels_in(i));
        }
        add(cells_.back(), whole / (double(crop_.width()) * double(crop_.height())));
        ++passes_;
    }
    open_.clear();
}

MergingBias::Estimate MergingBias::estimate() const {
    if (passes_ < 2) return {};
    const auto passes = static_cast<double>(passes_);
    double squares = 0, pixels = 0;
    for (std::size_t i = 0; i + 1 < cells_.size(); ++i) {
        const double mean = cells_[i].sum / passes, weight = pixels_in(i);
        squares += weight * (mean * mean - variance_of_mean(cells_[i], passes));
        pixels += weight;
    }
    return {cells_.back().sum / passes, std::sqrt(variance_of_mean(cells_.back(), passes)),
            std::sqrt(std::max(0.0, squares / pixels))};
}

void MergingBias::restore(std::span<const Cell> cells, std::uint64_t passes) {
    cells_.assign(cells.begin(), cells.end());
    passes_ = passes;
}

} // namespace montelux
