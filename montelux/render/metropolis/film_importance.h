// FilmImportance: how densely a chain samples the parts of a picture, relative to their brightness.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "montelux/mc/math/vec.h"

namespace montelux {

// A factor of the chains' target density, constant in each cell of a grid over the film. Any positive factor leaves the
// picture unbiased; one that falls where the picture is bright moves samples into the dark. Hoberock, Hart 2010,
// "Arbitrary Importance Functions for Metropolis Light Transport".
class FilmImportance {
  public:
    // 1 everywhere.
    FilmImportance() = default;
    FilmImportance(Point2f begin, Vec2f size, int columns, int rows, std::vector<float> values)
        : begin_(begin), cells_per_unit_{static_cast<float>(columns) / size.x,
                                         static_cast<float>(rows) / size.y},
          columns_(columns), rows_(rows), values_(std::move(values)) {}

    double at(Point2f film) const {
        if (values_.empty()) return 1;
        return double(values_[cell(film)]);
    }
    std::size_t cell(Point2f film) const {
        const int x = std::clamp(static_cast<int>((film.x - begin_.x) * cells_per_unit_.x), 0, columns_ - 1);
        const int y = std::clamp(static_cast<int>((film.y - begin_.y) * cells_per_unit_.y), 0, rows_ - 1);
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }
    std::vector<float>& values() { return values_; }

  private:
    Point2f begin_{};
    Vec2f cells_per_unit_{};
    int columns_ = 0, rows_ = 0;
    std::vector<float> values_;
};

} // namespace montelux
