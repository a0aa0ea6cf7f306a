#include "montelux/spectrum/rgb_uplift_solver.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

constexpr int max_iterations = 40;
// Squared CIELAB difference at which a colour counts as matched; 1 is a just noticeable difference.
constexpr double matched =
    1e-8; // Colours at the boundary of the reachable ones would drive the coefficients to infinity.
constexpr double largest_coefficient = 1e5;

// f of CIELAB (CIE 015:2018, equations 8.3 to 8.11) and its derivative.
constexpr double lab_delta = 6.0 / 29;
double lab_f(double t) {
    return t > lab_delta * lab_delta * lab_delta ? std::cbrt(t) : t / (3 * lab_delta * lab_delta) + 4.0 / 29;
}
double lab_f_derivative(double t) {
    if (t > lab_delta * lab_delta * lab_delta) return 1 / (3 * std::cbrt(t * t));
    return 1 / (3 * lab_delta * lab_delta);
}

double squared(Vec3d v) { return dot(v, v); }

} // namespace

RgbUpliftSolver::RgbUpliftSolver(const RgbColorSpace& space)
    : xyz_from_rgb_(space.xyz_from_rgb()), rgb_from_xyz_(space.rgb_from_xyz()) {
    const auto& light = space.illuminant().values();
    for (int i = 0; i < visible_samples; ++i) {
        double power = static_cast<double>(light[i]) / cie_y_integral;
        weights_[0][i] = static_cast<double>(cie_x[i]) * power;
        weights_[1][i] = static_cast<double>(cie_y[i]) * power;
        weights_[2][i] = static_cast<double>(cie_z[i]) * power;
        white_ += Vec3d(weights_[0][i], weights_[1][i], weights_[2][i]);
    }
}

Vec3d RgbUpliftSolver::lab(Vec3d xyz) const {
    double fx = lab_f(xyz.x / white_.x), fy = lab_f(xyz.y / white_.y), fz = lab_f(xyz.z / white_.z);
    return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

// Derivatives of f(X/Xn), f(Y/Yn), f(Z/Zn) with respect to X, Y, Z.
Vec3d RgbUpliftSolver::lab_derivative_scale(Vec3d xyz) const {
    return {lab_f_derivative(xyz.x / white_.x) / white_.x, lab_f_derivative(xyz.y / white_.y) / white_.y,
            lab_f_derivative(xyz.z / white_.z) / white_.z};
}

Vec3d RgbUpliftSolver::rgb(const Coefficients& c) const {
    Vec3d xyz;
    for (int i = 0; i < visible_samples; ++i) {
        double t = i / (visible_samples - 1.0);
        double x = (c[0] * t + c[1]) * t + c[2];
        double s = 0.5 + 0.5 * x / std::sqrt(1 + x * x);
        xyz += Vec3d(weights_[0][i], weights_[1][i], weights_[2][i]) * s;
    }
    return rgb_from_xyz_ * xyz;
}

double RgbUpliftSolver::difference(Vec3d target, const Coefficients& c) const {
    return length(lab(xyz_from_rgb_ * rgb(c)) - lab(xyz_from_rgb_ * target));
}

RgbUpliftSolver::Residual RgbUpliftSolver::evaluate(const Coefficients& c, Vec3d target_lab) const {
    // S and S' t^k for every wavelength first, so that the compiler can use vector instructions.
    std::array<std::array<double, visible_samples>, 4> f;
    for (int i = 0; i < visible_samples; ++i) {
        double t = i * (1 / (visible_samples - 1.0));
        double x = (c[0] * t + c[1]) * t + c[2];
        double inverse_root = 1 / std::sqrt(1 + x * x);
        double slope = 0.5 * inverse_root * inverse_root * inverse_root;
        f[0][i] = 0.5 + 0.5 * x * inverse_root;
        f[1][i] = slope * t * t;
        f[2][i] = slope * t;
        f[3][i] = slope;
    }
    // Sums in four lanes, in a fixed order.
    std::array<Vec3d, 4> xyz;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 3; ++j) {
            double lanes[4] = {0, 0, 0, 0};
            constexpr int whole = visible_samples / 4 * 4;
            for (int i = 0; i < whole; i += 4)
                for (int l = 0; l < 4; ++l) lanes[l] += f[k][i + l] * weights_[j][i + l];
            for (int i = whole; i < visible_samples; ++i) lanes[0] += f[k][i] * weights_[j][i];
            xyz[k][j] = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
        }
    Residual r;
    r.lab = lab(xyz[0]) - target_lab;
    Vec3d scale = lab_derivative_scale(xyz[0]);
    for (int k = 0; k < 3; ++k) {
        Vec3d d = multiply(scale, xyz[k + 1]);
        r.derivative[k] = {116 * d.y, 500 * (d.x - d.y), 200 * (d.y - d.z)};
    }
    return r;
}

RgbUpliftSolver::Coefficients RgbUpliftSolver::solve(Vec3d rgb, Coefficients c) const {
    Vec3d target = lab(xyz_from_rgb_ * rgb);
    Residual r = evaluate(c, target);
    // Levenberg's damping keeps the step within reach where the Jacobian is nearly singular.
    double damping = 1e-6;
    int stalls = 0;
    for (int i = 0; i < max_iterations && squared(r.lab) > matched; ++i) {
        const auto& j = r.derivative;
        Matrix3 normal{{{{dot(j[0], j[0]), dot(j[0], j[1]), dot(j[0], j[2])},
                         {dot(j[1], j[0]), dot(j[1], j[1]), dot(j[1], j[2])},
                         {dot(j[2], j[0]), dot(j[2], j[1]), dot(j[2], j[2])}}}};
        for (int k = 0; k < 3; ++k) normal.rows[k][k] *= 1 + damping;
        Vec3d gradient{dot(j[0], r.lab), dot(j[1], r.lab), dot(j[2], r.lab)};
        if (!(normal.determinant() > 0)) break;
        Vec3d step = normal.inverse() * gradient;
        Coefficients next{c[0] - step.x, c[1] - step.y, c[2] - step.z};
        Residual next_r = evaluate(next, target);
        double largest = std::max({std::abs(next[0]), std::abs(next[1]), std::abs(next[2])});
        if (largest <= largest_coefficient && squared(next_r.lab) < squared(r.lab)) {
            // A colour that no reflectance reaches is approached ever more slowly.
            bool stalled = squared(next_r.lab) > 0.98 * squared(r.lab);
            stalls = stalled ? stalls + 1 : 0;
            c = next;
            r = next_r;
            damping = std::max(damping * 0.1, 1e-12);
            if (stalls == 3) break;
        } else {
            if (damping > 1e8) break;
            damping = std::max(damping * 10, 1e-8);
        }
    }
    return c;
}

} // namespace montelux
