// Running means and covariances of several quantities that are sampled together, mergeable in any grouping.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace montelux {

// Moments of `components` quantities; covariances between all of them, or (to keep memory linear) the
// variances alone. Merging by Chan, Golub and LeVeque 1983. Values must be finite.
class CovarianceMoments {
  public:
    CovarianceMoments() = default;
    explicit CovarianceMoments(int components, bool full = true)
        : full_(full), mean_(static_cast<std::size_t>(components)),
          products_(mean_.size() * (full ? mean_.size() : 1)) {}

    void add(std::span<const double> x) {
        ++count_;
        const double inv_n = 1 / static_cast<double>(count_), share = 1 - inv_n;
        // Deviations from the old mean, weighted (n - 1) / n, make the products symmetric.
        if (full_) {
            for (std::size_t a = 0; a < mean_.size(); ++a) {
                const double da = x[a] - mean_[a];
                for (std::size_t b = 0; b <= a; ++b)
                    products_[a * mean_.size() + b] += share * da * (x[b] - mean_[b]);
            }
        } else {
            for (std::size_t a = 0; a < mean_.size(); ++a) {
                const double da = x[a] - mean_[a];
                products_[a] += share * da * da;
            }
        }
        for (std::size_t a = 0; a < mean_.size(); ++a) mean_[a] += (x[a] - mean_[a]) * inv_n;
    }
    void merge(const CovarianceMoments& other) {
        if (other.count_ == 0) return;
        if (count_ == 0) {
            *this = other;
            return;
        }
        const double na = static_cast<double>(count_), nb = static_cast<double>(other.count_);
        const double share = nb / (na + nb), weight = na * share;
        const std::size_t m = mean_.size();
        for (std::size_t a = 0; a < m; ++a) {
            const double da = other.mean_[a] - mean_[a];
            if (full_)
                for (std::size_t b = 0; b <= a; ++b)
                    products_[a * m + b] +=
                        other.products_[a * m + b] + weight * da * (other.mean_[b] - mean_[b]);
            else
                products_[a] += other.products_[a] + weight * da * da;
        }
        for (std::size_t a = 0; a < m; ++a) mean_[a] += share * (other.mean_[a] - mean_[a]);
        count_ += other.count_;
    }
    // Adds n values of one quantity at once, by their mean and squared deviations; one component only.
    void merge(std::uint64_t n, double mean, double squared_deviations) {
        CovarianceMoments other(1, full_);
        other.count_ = n;
        other.mean_[0] = mean;
        other.products_[0] = squared_deviations;
        merge(other);
    }

    int components() const { return static_cast<int>(mean_.size()); }
    bool full() const { return full_; }
    std::uint64_t count() const { return count_; }
    const std::vector<double>& means() const { return mean_; }
    double mean(int c = 0) const { return mean_[static_cast<std::size_t>(c)]; }
    // Unbiased covariance of one sample's quantities; infinite below two samples. Off the diagonal only if
    // `full`.
    double covariance(int a, int b) const {
        if (count_ < 2) return std::numeric_limits<double>::infinity();
        const auto i = static_cast<std::size_t>(a > b ? a : b), j = static_cast<std::size_t>(a > b ? b : a);
        return products_[full_ ? i * mean_.size() + j : i] / static_cast<double>(count_ - 1);
    }
    double variance(int c = 0) const { return covariance(c, c); }

    // The state, for archives: count, means, and lower triangle (or diagonal) of the sums of products.
    const std::vector<double>& products() const { return products_; }
    void restore(std::uint64_t count, std::vector<double> means, std::vector<double> products) {
        count_ = count;
        mean_ = std::move(means);
        products_ = std::move(products);
    }

  private:
    std::uint64_t count_ = 0;
    bool full_ = true;
    std::vector<double> mean_, products_;
};

} // namespace montelux
