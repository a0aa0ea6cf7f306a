#include "montelux/spectrum/piecewise_linear.h"

#include <cmath>
#include <limits>
#include <string>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

void check_knots(std::span<const float> lambda, std::span<const float> values) {
    if (lambda.empty())
        throw Error("a spectrum needs at least one pair of wavelength and value; none was given");
    if (lambda.size() != values.size())
        throw Error("a spectrum needs one value for each wavelength; there are " +
                    std::to_string(lambda.size()) + " wavelengths and " + std::to_string(values.size()) +
                    " values");
    for (std::size_t i = 0; i < lambda.size(); ++i) {
        if (!(std::abs(lambda[i]) < 1e9f) || !std::isfinite(values[i]))
            throw Error("the wavelengths and values of a spectrum must be finite (and the wavelengths below "
                        "1e9 nm); pair " +
                        std::to_string(i + 1) + " is (" + std::to_string(lambda[i]) + ", " +
                        std::to_string(values[i]) + ")");
        if (i > 0 && !(lambda[i] > lambda[i - 1]))
            throw Error("the wavelengths of a spectrum must ascend; pair " + std::to_string(i + 1) +
                        " is at " + std::to_string(lambda[i]) + " nm, after " +
                        std::to_string(lambda[i - 1]) + " nm");
    }
}

} // namespace

PiecewiseLinear::PiecewiseLinear(std::span<const float> lambda, std::span<const float> values,
                                 SpectrumEnds ends) {
    check_knots(lambda, values);
    constexpr float before_all = -1e30f;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    bool extend = ends == SpectrumEnds::constant;
    knots_.reserve(lambda.size() + 5);
    knots_.push_back({before_all, 0, 0});
    if (extend && lambda.front() > lambda_min) knots_.push_back({lambda_min - 1, values.front(), 0});
    for (std::size_t i = 0; i < lambda.size(); ++i) knots_.push_back({lambda[i], values[i], 0});
    if (extend && lambda.back() < lambda_max) knots_.push_back({lambda_max + 1, values.back(), 0});
    for (std::size_t i = 1; i + 1 < knots_.size(); ++i)
        knots_[i].slope = (knots_[i + 1].value - knots_[i].value) / (knots_[i + 1].lambda - knots_[i].lambda);
    knots_.push_back({std::nextafter(knots_.back().lambda, infinity), 0, 0});
    knots_.push_back({infinity, 0, 0});

    std::uint32_t k = 0;
    for (int cell = 0; cell < cell_count; ++cell) {
        float start = lambda_min + static_cast<float>(cell);
        while (knots_[k + 1].lambda <= start) ++k;
        first_in_cell_[cell] = k;
    }
}

PiecewiseLinear PiecewiseLinear::from_pairs(std::span<const float> pairs, SpectrumEnds ends) {
    if (pairs.size() % 2 != 0)
        throw Error("a spectrum is a list of pairs of wavelength and value; " + std::to_string(pairs.size()) +
                    " numbers are an odd count");
    std::vector<float> lambda(pairs.size() / 2), values(pairs.size() / 2);
    for (std::size_t i = 0; i < lambda.size(); ++i) {
        lambda[i] = pairs[2 * i];
        values[i] = pairs[2 * i + 1];
    }
    return {lambda, values, ends};
}

float PiecewiseLinear::max_value() const {
    float m = std::max((*this)(lambda_min), (*this)(lambda_max));
    for (const Knot& k : knots_)
        if (k.lambda >= lambda_min && k.lambda <= lambda_max) m = std::max(m, k.value);
    return m;
}

void PiecewiseLinear::scale(float factor) {
    for (Knot& k : knots_) {
        k.value *= factor;
        k.slope *= factor;
    }
}

} // namespace montelux
