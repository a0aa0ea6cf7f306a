#include "montelux/mc/integrate/metropolis/student_mixture.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/integrate/metropolis/metropolis_chain.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr double freedom = 4;
constexpr double uniform_part = 0.1;

} // namespace

std::vector<double> cholesky_factor(std::vector<double> a, std::size_t n) {
    double trace = 0;
    for (std::size_t i = 0; i < n; ++i) trace += a[i * n + i];
    const double least = trace > 0 ? 1e-12 * trace / static_cast<double>(n) : 1e-12;
    for (std::size_t j = 0; j < n; ++j) {
        double diagonal = a[j * n + j];
        for (std::size_t k = 0; k < j; ++k) diagonal -= a[j * n + k] * a[j * n + k];
        const double root = std::sqrt(std::max(diagonal, least));
        a[j * n + j] = root;
        for (std::size_t i = j + 1; i < n; ++i) {
            double sum = a[i * n + j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
            a[i * n + j] = sum / root;
            a[j * n + i] = 0;
        }
    }
    return a;
}

StudentMixture::StudentMixture(const CovarianceMoments& moments) : mean_(moments.means()) {
    const int n = moments.components();
    std::vector<double> covariance;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) covariance.push_back(moments.covariance(i, j));
    factor_ = cholesky_factor(std::move(covariance), mean_.size());
    normalise();
}

void StudentMixture::normalise() {
    const double d = static_cast<double>(mean_.size());
    log_constant_ =
        std::lgamma(0.5 * (freedom + d)) - std::lgamma(0.5 * freedom) - 0.5 * d * std::log(freedom * pi);
    for (std::size_t i = 0; i < mean_.size(); ++i) log_constant_ -= std::log(factor_[i * mean_.size() + i]);
}

bool StudentMixture::sample(PhiloxStream& numbers, std::span<double> x) const {
    const std::size_t n = x.size();
    const double choice = numbers.next_double();
    if (choice < uniform_part) {
        for (double& at : x) at = std::max(numbers.next_double(), 0x1p-54);
        return true;
    }
    // Normal over the root of chi-squared / 4; with 4 degrees of freedom that is -2 log of two numbers.
    const double u = 1 - numbers.next_double();
    const double v = 1 - numbers.next_double();
    const double scale = std::sqrt(freedom / (-2 * std::log(u * v)));
    for (std::size_t d = 0; d < n; d += 2) {
        const Vec2d z = detail::draw_normals(numbers);
        x[d] = scale * z.x;
        if (d + 1 < n) x[d + 1] = scale * z.y;
    }
    bool inside = true;
    for (std::size_t i = n; i-- > 0;) { // from the last, for L needs the first ones unchanged
        double sum = mean_[i];
        for (std::size_t k = 0; k <= i; ++k) sum += factor_[i * n + k] * x[k];
        x[i] = sum;
        inside = inside && sum > 0 && sum < 1;
    }
    return inside;
}

double StudentMixture::density(std::span<const double> x) const {
    const std::size_t n = x.size();
    // Solve L z = x - mean.
    thread_local std::vector<double> z;
    z.resize(n);
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double sum = x[i] - mean_[i];
        for (std::size_t k = 0; k < i; ++k) sum -= factor_[i * n + k] * z[k];
        z[i] = sum / factor_[i * n + i];
        square += z[i] * z[i];
    }
    const double d = static_cast<double>(n);
    const double student = std::exp(log_constant_ - 0.5 * (freedom + d) * std::log1p(square / freedom));
    return uniform_part + (1 - uniform_part) * student;
}

void StudentMixture::save(StateWriter& state) const {
    state.put(mean_);
    state.put(factor_);
}

void StudentMixture::load(StateReader& state) {
    mean_ = state.get_doubles();
    factor_ = state.get_doubles();
    if (factor_.size() != mean_.size() * mean_.size())
        throw Error("the saved importance density has no possible shape");
    normalise();
}

} // namespace montelux
