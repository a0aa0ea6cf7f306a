#include "montelux/bake/brdf_integrals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "montelux/mc/math/constants.h"

namespace montelux {
namespace {

// Half vectors at the polar angle theta about the normal: those with an azimuth from the view's below
// the limit reflect the view to above the horizon, where n.l = 2 (v.h) cos(theta) - n.v > 0.
// All azimuths do below theta_1 = (pi/2 - theta_v) / 2, none from theta_2 = (pi/2 + theta_v) / 2 on.
struct View {
    double cos_v, sin_v, theta_1, theta_2;

    explicit View(double n_dot_v) : cos_v(n_dot_v), sin_v(std::sqrt((1 - n_dot_v) * (1 + n_dot_v))) {
        const double theta_v = std::atan2(sin_v, cos_v);
        theta_1 = (pi / 2 - theta_v) / 2;
        theta_2 = (pi / 2 + theta_v) / 2;
    }
    double azimuth_limit(double sin_h, double cos_h) const {
        const double d = 2 * sin_v * sin_h * cos_h;
        if (!(d > 0)) return pi;
        return std::acos(std::clamp(-cos_v * (cos_h - sin_h) * (cos_h + sin_h) / d, -1.0, 1.0));
    }
};

double fifth_power(double x) {
    const double x2 = x * x;
    return x2 * x2 * x;
}

// Smith's Lambda of GGX for a direction of this cosine.
double ggx_lambda(double cosine, double alpha2) {
    return 0.5 * (std::sqrt(1 + alpha2 * (1 - cosine) * (1 + cosine) / (cosine * cosine)) - 1);
}

// Sums of the whole polar rule and of the one with every second node.
struct TwoRules {
    double fine[2] = {0, 0}, coarse[2] = {0, 0};

    void add(std::size_t node, double first, double second) {
        fine[0] += first;
        fine[1] += second;
        if (node % 2 == 0) return;
        coarse[0] += 2 * first;
        coarse[1] += 2 * second;
    }
    double error() const { return std::max(std::abs(fine[0] - coarse[0]), std::abs(fine[1] - coarse[1])); }
};

// Angle of the half vector in the plane where D is that of alpha = 1: tan(theta) = alpha tan(stretched).
double stretched(double theta, double alpha) { return std::atan2(std::sin(theta), alpha * std::cos(theta)); }

} // namespace

BrdfIntegrals::BrdfIntegrals()
    : polar_(double_exponential_rule(0.125, 2.8)), azimuth_(gauss_legendre_rule(24)),
      fine_polar_(double_exponential_rule(0.0625, 2.8)), fine_azimuth_(gauss_legendre_rule(48)) {}

SplitSumTerms BrdfIntegrals::ggx(double n_dot_v, double alpha) const {
    const View view(n_dot_v);
    const double alpha2 = alpha * alpha;
    const double lambda_v = ggx_lambda(view.cos_v, alpha2);
    const double w1 = stretched(view.theta_1, alpha);
    TwoRules sums;
    for (int panel = 0; panel < 2; ++panel) {
        const double theta_begin = panel == 0 ? 0 : view.theta_1;
        const double theta_end = panel == 0 ? view.theta_1 : view.theta_2;
        const double begin = panel == 0 ? 0 : w1, end = panel == 0 ? w1 : stretched(view.theta_2, alpha);
        // The difference of two angles that may be close to each other.
        const double length = std::atan2(alpha * std::sin(theta_end - theta_begin),
                                         alpha2 * std::cos(theta_begin) * std::cos(theta_end) +
                                             std::sin(theta_begin) * std::sin(theta_end));
        for (std::size_t i = 0; i < polar_.size(); ++i) {
            const QuadratureNode& node = polar_[i];
            const double w = node.x < 0.5 ? begin + length * node.x : end - length * node.to_end;
            const double sin_w = std::sin(w), cos_w = std::cos(w);
            if (!(cos_w > 0)) continue;
            const double scale = 1 / std::sqrt(alpha2 * sin_w * sin_w + cos_w * cos_w);
            const double sin_h = alpha * sin_w * scale, cos_h = cos_w * scale;
            const double limit = panel == 0 ? pi : view.azimuth_limit(sin_h, cos_h);
            double scale_sum = 0, bias_sum = 0;
            for (const QuadratureNode& across : azimuth_) {
                const double v_dot_h = view.sin_v * sin_h * std::cos(limit * across.x) + view.cos_v * cos_h;
                const double n_dot_l = 2 * v_dot_h * cos_h - view.cos_v;
                if (!(n_dot_l > 0)) continue;
                // f / F n.l dl = D G2 v.h / (n.v) dh
                const double g = across.weight * v_dot_h / (1 + lambda_v + ggx_lambda(n_dot_l, alpha2));
                const double fresnel = fifth_power(1 - v_dot_h);
                scale_sum += g * (1 - fresnel);
                bias_sum += g * fresnel;
            }
            // D cos sin dtheta dphi = sin(w) cos(w) / pi dw dphi, and both halves of the azimuth.
            const double weight =
                node.weight * length * sin_w * cos_w * 2 * inv_pi * limit / (view.cos_v * cos_h);
            sums.add(i, weight * scale_sum, weight * bias_sum);
        }
    }
    return {sums.fine[0], sums.fine[1], sums.error()};
}

AlbedoTerm BrdfIntegrals::ggx_average_albedo(double alpha) const {
    static const std::vector<QuadratureNode> cosines = double_exponential_rule(0.125, 2.2);
    TwoRules sums;
    double error = 0;
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        const SplitSumTerms terms = ggx(cosines[i].x, alpha);
        const double weight = 2 * cosines[i].weight * cosines[i].x;
        sums.add(i, weight * (terms.scale + terms.bias), 0);
        error += weight * terms.error;
    }
    return {sums.fine[0], sums.error() + error};
}

AlbedoTerm BrdfIntegrals::charlie_sheen(double n_dot_v, double alpha) const {
    const View view(n_dot_v);
    // D over the cosine c is (1 - c^2)^exponent: beyond `reach` it is negligible.
    const double exponent = 0.5 / alpha;
    const double lowest = std::cos(view.theta_2), middle = std::cos(view.theta_1);
    auto reach = [&](double from) { return std::min(1.0, std::sqrt(from * from + 40 / exponent)); };
    const double normalisation = (2 + 1 / alpha) * inv_two_pi;
    TwoRules sums;
    for (int panel = 0; panel < 2; ++panel) {
        const double begin = panel == 0 ? lowest : middle;
        const double end = panel == 0 ? std::min(middle, reach(lowest)) : reach(middle);
        for (std::size_t i = 0; i < fine_polar_.size(); ++i) {
            const QuadratureNode& node = fine_polar_[i];
            const double c =
                node.x < 0.5 ? begin + (end - begin) * node.x : end - (end - begin) * node.to_end;
            const double sine2 =
                end == 1 && node.x >= 0.5 ? (end - begin) * node.to_end * (1 + c) : (1 - c) * (1 + c);
            const double s = std::sqrt(sine2);
            const double limit = panel == 1 ? pi : view.azimuth_limit(s, c);
            double sum = 0;
            for (const QuadratureNode& across : fine_azimuth_) {
                const double v_dot_h = view.sin_v * s * std::cos(limit * across.x) + view.cos_v * c;
                const double n_dot_l = 2 * v_dot_h * c - view.cos_v;
                if (!(n_dot_l > 0)) continue;
                sum += across.weight * v_dot_h * n_dot_l / (n_dot_l + view.cos_v - n_dot_l * view.cos_v);
            }
            const double d = normalisation * std::exp(exponent * std::log(sine2));
            sums.add(i, node.weight * (end - begin) * d * 2 * limit * sum, 0);
        }
    }
    return {sums.fine[0], sums.error()};
}

} // namespace montelux
