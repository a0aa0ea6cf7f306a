#include "montelux/scene/light/environment/structured_environment.h"

#include <limits>

#include "montelux/mc/math/compensated.h"

namespace montelux {

namespace {

constexpr std::size_t most_cells = std::size_t{1} << 17;
constexpr double omega_0 = 0.01; // steradians

// The map in blocks of texels, each with its light, solid angle and central direction.
struct Cells {
    std::size_t columns, rows;
    std::vector<double> light, solid_angle;
    std::vector<float> x, y, z;

    Cells(const EnvironmentGrid& grid, const std::vector<float>& texels, std::size_t block,
          std::size_t columns_, std::size_t rows_)
        : columns(columns_), rows(rows_), light(columns_ * rows_), solid_angle(columns_ * rows_) {
        const auto width = static_cast<std::size_t>(grid.width()),
                   height = static_cast<std::size_t>(grid.height());
        for (std::size_t j = 0; j < height; ++j)
            for (std::size_t i = 0; i < width; ++i) {
                const std::size_t cell = j / block * columns + i / block;
                light[cell] += static_cast<double>(texels[j * width + i]);
                solid_angle[cell] += grid.solid_angle(static_cast<int>(j));
            }
        for (std::size_t j = 0; j < rows; ++j)
            for (std::size_t i = 0; i < columns; ++i) {
                auto middle = [block](std::size_t k, std::size_t n) {
                    return 0.5f * static_cast<float>(k * block + std::min((k + 1) * block, n));
                };
                const Vec3f w = grid.direction({middle(i, width), middle(j, height)});
                x.push_back(w.x);
                y.push_back(w.y);
                z.push_back(w.z);
            }
    }
    std::size_t size() const { return light.size(); }
    double radiance(std::size_t cell) const { return light[cell] / solid_angle[cell]; }
};

// A connected part above a threshold, without the parts above the next one.
struct Part {
    int level = 0;
    std::uint32_t below = 0; // the part of the next lower level that it lies in
    double light = 0, solid_angle = 0;
    std::uint32_t strata = 0;
    std::vector<std::uint32_t> cells;
    double importance() const { return light * std::pow(std::min(solid_angle, omega_0), 0.25); }
};

} // namespace

class StratumBuilder {
  public:
    StratumBuilder(StructuredEnvironment& e, const std::vector<float>& light, int strata)
        : e_(e), cells_(*e.grid_, light, e.block_, e.columns_, e.rows_) {
        find_parts();
        share_out(strata);
        e_.stratum_of_.assign(cells_.size(), StructuredEnvironment::no_stratum);
        centre_of_part_.resize(parts_.size());
        // From the brightest level down, so that the centres of inner parts are known.
        for (std::size_t p = parts_.size(); p-- > 0;) stratify(p);
        list_cells();
    }

  private:
    void find_parts() {
        CompensatedSum sum, squares;
        double lit = 0;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            sum.add(cells_.light[i]);
            squares.add(cells_.light[i] * cells_.radiance(i));
            lit += cells_.light[i] > 0;
        }
        const double mean = sum.value() / (4 * pi);
        const double sigma = std::sqrt(std::max(0.0, squares.value() / (4 * pi) - mean * mean));
        // A black map is one part as well.
        const bool black = lit == 0;
        Part whole;
        part_of_.assign(cells_.size(), none);
        for (std::size_t i = 0; i < cells_.size(); ++i)
            if (black || cells_.light[i] > 0) part_of_[i] = 0;
        parts_.push_back(whole);
        if (!(sigma > 1e-6 * mean)) return collect();
        for (int level = 1; level < StructuredEnvironment::thresholds; ++level)
            for (std::size_t i = 0; i < cells_.size(); ++i)
                if (part_of_[i] != none && parts_[part_of_[i]].level < level && bright(i, level * sigma))
                    flood(i, level, level * sigma);
        collect();
    }
    bool bright(std::size_t cell, double threshold) const { return cells_.radiance(cell) >= threshold; }
    void flood(std::size_t start, int level, double threshold) {
        const auto index = static_cast<std::uint32_t>(parts_.size());
        Part part;
        part.level = level;
        part.below = part_of_[start];
        parts_.push_back(std::move(part));
        std::vector<std::size_t> open{start};
        part_of_[start] = index;
        while (!open.empty()) {
            const std::size_t cell = open.back(), x = cell % cells_.columns, y = cell / cells_.columns;
            open.pop_back();
            auto visit = [&](std::size_t i) {
                if (part_of_[i] == none || parts_[part_of_[i]].level >= level || !bright(i, threshold))
                    return;
                part_of_[i] = index;
                open.push_back(i);
            };
            if (x > 0) visit(cell - 1);
            if (x + 1 < cells_.columns) visit(cell + 1);
            if (y > 0) visit(cell - cells_.columns);
            if (y + 1 < cells_.rows) visit(cell + cells_.columns);
        }
    }
    void collect() {
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            if (part_of_[i] == none) continue;
            Part& part = parts_[part_of_[i]];
            part.light += cells_.light[i];
            part.solid_angle += cells_.solid_angle[i];
            part.cells.push_back(static_cast<std::uint32_t>(i));
        }
    }

    void share_out(int strata) {
        double total = 0;
        for (const Part& p : parts_) total += p.importance();
        // Parts follow the parts that contain them.
        for (std::size_t i = parts_.size(); i-- > 1;) {
            Part &p = parts_[i], &below = parts_[p.below];
            if (p.cells.empty() || p.importance() * strata >= 0.5 * total) continue;
            below.light += p.light;
            below.solid_angle += p.solid_angle;
            below.cells.insert(below.cells.end(), p.cells.begin(), p.cells.end());
            p.cells.clear();
            p.light = p.solid_angle = 0;
        }
        total = 0;
        for (const Part& p : parts_) total += p.importance();
        for (Part& p : parts_) {
            if (p.cells.empty()) continue;
            const double share = total > 0 ? p.importance() / total : 1;
            p.strata = static_cast<std::uint32_t>(
                std::clamp(std::round(share * strata), 1.0, static_cast<double>(p.cells.size())));
        }
    }

    // Farthest-point strata of one part; its centres, and those within it, pass to the part below.
    void stratify(std::size_t index) {
        Part& part = parts_[index];
        std::sort(part.cells.begin(), part.cells.end());
        std::vector<std::uint32_t>& centres = centre_of_part_[index];
        const std::size_t n = part.cells.size();
        std::vector<float> x(n), y(n), z(n), nearest_any(n, std::numeric_limits<float>::max()),
            nearest = nearest_any;
        std::vector<std::uint32_t> owner(n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            x[i] = cells_.x[part.cells[i]];
            y[i] = cells_.y[part.cells[i]];
            z[i] = cells_.z[part.cells[i]];
        }
        auto distance = [&](std::size_t i, std::size_t cell) {
            const float dx = x[i] - cells_.x[cell], dy = y[i] - cells_.y[cell], dz = z[i] - cells_.z[cell];
            return dx * dx + dy * dy + dz * dz;
        };
        for (std::uint32_t cell : centres)
            for (std::size_t i = 0; i < n; ++i) nearest_any[i] = std::min(nearest_any[i], distance(i, cell));
        const auto first = static_cast<std::uint32_t>(stratum_count_);
        for (std::uint32_t s = 0; s < part.strata; ++s) {
            const auto far = static_cast<std::size_t>(
                std::max_element(nearest_any.begin(), nearest_any.end()) - nearest_any.begin());
            if (s > 0 && !(nearest_any[far] > 0)) { // every cell is a centre already
                part.strata = s;
                break;
            }
            const std::uint32_t centre = part.cells[far];
            centres.push_back(centre);
            e_.centre_.push_back(centre);
            e_.level_.push_back(static_cast<std::uint8_t>(part.level));
            for (std::size_t i = 0; i < n; ++i) {
                const float d = distance(i, centre);
                nearest_any[i] = std::min(nearest_any[i], d);
                const bool nearer = d < nearest[i];
                nearest[i] = nearer ? d : nearest[i];
                owner[i] = nearer ? s : owner[i];
            }
        }
        for (std::size_t i = 0; i < n; ++i) e_.stratum_of_[part.cells[i]] = first + owner[i];
        stratum_count_ += part.strata;
        if (index == 0) return;
        std::vector<std::uint32_t>& below = centre_of_part_[part.below];
        below.insert(below.end(), centres.begin(), centres.end());
        centres = {};
    }

    void list_cells() {
        const std::size_t n = stratum_count_;
        std::vector<double> solid_angle(n);
        e_.first_.assign(n + 1, 0);
        for (std::size_t i = 0; i < cells_.size(); ++i)
            if (const std::uint32_t s = e_.stratum_of_[i]; s != StructuredEnvironment::no_stratum) {
                ++e_.first_[s + 1];
                solid_angle[s] += cells_.solid_angle[i];
            }
        for (std::size_t s = 0; s < n; ++s) e_.first_[s + 1] += e_.first_[s];
        e_.cells_.resize(e_.first_[n]);
        e_.before_.resize(e_.first_[n]);
        std::vector<std::uint32_t> next(e_.first_.begin(), e_.first_.end() - 1);
        std::vector<double> before(n);
        for (std::size_t i = 0; i < cells_.size(); ++i)
            if (const std::uint32_t s = e_.stratum_of_[i]; s != StructuredEnvironment::no_stratum) {
                e_.cells_[next[s]] = static_cast<std::uint32_t>(i);
                e_.before_[next[s]++] = before[s] / solid_angle[s];
                before[s] += cells_.solid_angle[i];
            }
        for (std::size_t s = 0; s < n; ++s)
            e_.pdf_.push_back(static_cast<float>(1 / (static_cast<double>(n) * solid_angle[s])));
    }

    static constexpr std::uint32_t none = 0xffffffff;
    StructuredEnvironment& e_;
    Cells cells_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> part_of_;                     // of each cell
    std::vector<std::vector<std::uint32_t>> centre_of_part_; // centres so far, those of parts within first
    std::size_t stratum_count_ = 0;
};

StructuredEnvironment::StructuredEnvironment(const EnvironmentGrid& grid, const std::vector<float>& light,
                                             int strata)
    : grid_(&grid), block_(1) {
    const auto width = static_cast<std::size_t>(grid.width()),
               height = static_cast<std::size_t>(grid.height());
    auto blocks = [this](std::size_t n) { return (n + block_ - 1) / block_; };
    while (blocks(width) * blocks(height) > most_cells) ++block_;
    columns_ = blocks(width);
    rows_ = blocks(height);
    StratumBuilder(*this, light, strata);
}

Vec2f StructuredEnvironment::centre_of(std::size_t stratum) const {
    auto middle = [this](std::size_t k, int n) {
        return 0.5f *
               static_cast<float>(k * block_ + std::min((k + 1) * block_, static_cast<std::size_t>(n)));
    };
    return {middle(centre_[stratum] % columns_, grid_->width()),
            middle(centre_[stratum] / columns_, grid_->height())};
}

Vec2f StructuredEnvironment::place(std::uint32_t cell, float u, double v) const {
    auto side = [this](std::size_t k, int n) {
        return std::pair(static_cast<float>(k * block_),
                         static_cast<float>(std::min((k + 1) * block_, static_cast<std::size_t>(n))));
    };
    const auto [x0, x1] = side(cell % columns_, grid_->width());
    const auto [y0, y1] = side(cell / columns_, grid_->height());
    const double above = grid_->share_above(double(y0)), share = grid_->share_above(double(y1)) - above;
    return {
        std::clamp(x0 + u * (x1 - x0), x0, std::nextafter(x1, 0.0f)),
        std::clamp(static_cast<float>(grid_->line_below(above + v * share)), y0, std::nextafter(y1, 0.0f))};
}

} // namespace montelux
