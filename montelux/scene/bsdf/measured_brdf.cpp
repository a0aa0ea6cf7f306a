#include "montelux/scene/bsdf/measured_brdf.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "montelux/mc/dist/search.h"
#include "montelux/mc/math/constants.h"
#include "montelux/mc/math/error.h"
#include "montelux/mc/math/vector_bytes.h"

namespace montelux {
namespace {

const char* const where_brdf = "measured BRDF";

void check_knots_of_brdf(const char* what, const std::vector<float>& knots) {
    const bool finite = std::all_of(knots.begin(), knots.end(), [](float x) { return std::isfinite(x); });
    const bool increases = std::adjacent_find(knots.begin(), knots.end(),
                                              [](float a, float b) { return !(a < b); }) == knots.end();
    if (knots.empty() || !finite || !increases)
        throw Error(where_brdf, std::string(what) + ": expected finite numbers that increase");
}

void check_brdf_tables(const char* what, const BrdfTables& t, std::size_t count, bool negative_too = false) {
    if (t.columns < 2 || t.rows < 2 || t.values.size() / t.columns / t.rows != count ||
        t.values.size() % (std::size_t{t.columns} * t.rows) != 0)
        throw Error(where_brdf,
                    std::string(what) + ": the size does not fit the numbers of directions and wavelengths");
    if (!std::all_of(t.values.begin(), t.values.end(),
                     [&](float x) { return std::isfinite(x) && (negative_too || x >= 0); }))
        throw Error(where_brdf, std::string(what) + ": a value is " + (negative_too ? "" : "negative or ") +
                                    "not finite");
}

// Checked before the distributions are made of them.
MeasuredBrdfData checked_brdf_data(MeasuredBrdfData d) {
    check_knots_of_brdf("theta_i", d.theta);
    check_knots_of_brdf("phi_i", d.phi);
    check_knots_of_brdf("wavelengths", d.wavelengths);
    if (d.phi.size() > 2 && std::abs(d.phi.back() - d.phi.front() - two_pi_f) > 0.01f)
        throw Error(where_brdf, "phi_i covers a part of the circle; only isotropic surfaces may");
    const std::size_t directions = d.theta.size() * d.phi.size();
    check_brdf_tables("ndf", d.ndf, 1);
    check_brdf_tables("sigma", d.sigma, 1);
    check_brdf_tables("vndf", d.visible_normals, directions);
    check_brdf_tables("luminance", d.luminance, directions);
    check_brdf_tables("spectra", d.spectra, directions * d.wavelengths.size(), true); // noise
    return d;
}

InterpolatedBilinear2D distribution(const MeasuredBrdfData& d, const BrdfTables& t) {
    return {d.theta.size() * d.phi.size(), t.columns, t.rows, t.values};
}

float look_up(const BrdfTables& t, std::size_t table, Vec2f u) {
    const auto cell = [](float x, std::uint32_t n) {
        const float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(n - 1);
        const std::uint32_t i = std::min(static_cast<std::uint32_t>(scaled), n - 2);
        return std::pair(i, scaled - static_cast<float>(i));
    };
    const auto [i, x] = cell(u.x, t.columns);
    const auto [j, y] = cell(u.y, t.rows);
    const float* low = &t.values[(table * t.rows + j) * t.columns + i];
    const float* high = low + t.columns;
    return (1 - y) * ((1 - x) * low[0] + x * low[1]) + y * ((1 - x) * high[0] + x * high[1]);
}

float theta_of(Vec3f w) { return std::atan2(std::hypot(w.x, w.y), w.z); }
float column_of_theta(float theta) { return std::sqrt(theta * (2 / pi_f)); }

// Solid angle of a normal over the area of the unit square.
float normal_jacobian(float column, float sin_theta) {
    return std::max(2 * pi_f * pi_f * column * sin_theta, 1e-6f);
}

} // namespace

// What depends on wo alone, on the upper side.
struct MeasuredBrdf::Outgoing {
    Vec3f wo;
    float phi;
    InterpolationWeights at;
    float sigma;
};

MeasuredBrdf::MeasuredBrdf(MeasuredBrdfData data)
    : data_(checked_brdf_data(std::move(data))), visible_normals_(distribution(data_, data_.visible_normals)),
      luminance_(distribution(data_, data_.luminance)) {}

MeasuredBrdf::Outgoing MeasuredBrdf::outgoing(Vec3f wo) const {
    const float theta = theta_of(wo);
    float phi = std::atan2(wo.y, wo.x);
    const float row = phi * (0.5f / pi_f) + 0.5f;
    const float sigma = look_up(data_.sigma, 0, {column_of_theta(theta), row});
    const float turned = phi < data_.phi.front() ? phi + two_pi_f : phi;
    return {wo, phi, interpolation_weights(data_.phi, data_.theta, turned, theta), sigma};
}

SampledSpectrum MeasuredBrdf::spectrum(const Outgoing& o, Vec2f u, Float4 lambda) const {
    const std::vector<float>& knots = data_.wavelengths;
    SampledSpectrum result(0);
    for (int c = 0; c < 4; ++c) {
        const float x = std::clamp(lambda[c], knots.front(), knots.back());
        const std::size_t n = knots.size();
        const std::size_t i = n == 1 ? 0 : find_last_not_above(knots.data(), n - 1, x);
        const float t = n == 1 ? 0 : (x - knots[i]) / (knots[i + 1] - knots[i]);
        float sum = 0;
        for (std::size_t k = 0; k < o.at.count; ++k) {
            const std::size_t table = o.at.entry[k] * n + i;
            float value = (1 - t) * look_up(data_.spectra, table, u);
            if (t > 0) value += t * look_up(data_.spectra, table + 1, u);
            sum += o.at.weight[k] * value;
        }
        result.values[c] = std::max(sum, 0.0f);
    }
    return result;
}

BsdfEvaluation MeasuredBrdf::evaluate(Vec3f wo, Vec3f wi, Float4 lambda) const {
    if (!same_hemisphere(wo, wi)) return {};
    if (wo.z < 0) {
        wo = -wo;
        wi = -wi;
    }
    const Vec3f wm = normalize(wo + wi);
    const Outgoing o = outgoing(wo);
    const float column = column_of_theta(theta_of(wm));
    float row = (std::atan2(wm.y, wm.x) - (is_isotropic() ? o.phi : 0)) * (0.5f / pi_f) + 0.5f;
    row -= std::floor(row);
    const Vec2f normal{column, row};
    const InterpolatedBilinear2D::Sample square = visible_normals_.invert(o.at, normal);
    if (!(o.sigma > 0)) return {};
    BsdfEvaluation e;
    e.f = spectrum(o, square.p, lambda) * (look_up(data_.ndf, 0, normal) / (4 * o.sigma));
    e.pdf = square.pdf * luminance_.pdf(o.at, square.p) /
            (4 * dot(wo, wm) * normal_jacobian(column, std::hypot(wm.x, wm.y)));
    return e;
}

std::optional<BsdfSample> MeasuredBrdf::sample(Vec3f wo, Float4 lambda, Vec2f u) const {
    const bool below = wo.z < 0;
    if (below) wo = -wo;
    const Outgoing o = outgoing(wo);
    if (!(o.sigma > 0)) return {};
    const InterpolatedBilinear2D::Sample square = luminance_.sample(o.at, u);
    const InterpolatedBilinear2D::Sample normal = visible_normals_.sample(o.at, square.p);
    const float theta = normal.p.x * normal.p.x * (pi_f / 2);
    const float phi = (2 * normal.p.y - 1) * pi_f + (is_isotropic() ? o.phi : 0);
    const float sin_theta = std::sin(theta);
    const Vec3f wm{sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::cos(theta)};
    const float cosine = dot(wo, wm);
    const Vec3f wi = 2 * cosine * wm - wo;
    if (!(cosine > 0) || !(wi.z > 0)) return {};
    const float pdf = square.pdf * normal.pdf / (4 * cosine * normal_jacobian(normal.p.x, sin_theta));
    if (!(pdf > 0)) return {};
    BsdfSample s;
    s.weight = spectrum(o, square.p, lambda) * (look_up(data_.ndf, 0, normal.p) / (4 * o.sigma * pdf));
    s.wi = below ? -wi : wi;
    s.pdf = pdf;
    return s;
}

std::size_t MeasuredBrdf::bytes() const {
    return vector_bytes(data_.theta, data_.phi, data_.wavelengths, data_.ndf.values, data_.sigma.values,
                        data_.visible_normals.values, data_.luminance.values, data_.spectra.values) +
           visible_normals_.bytes() + luminance_.bytes();
}

SampledSpectrum MeasuredBrdf::albedo(Vec3f wo, Float4 lambda) const {
    constexpr int n = 4;
    SampledSpectrum sum(0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            if (auto s = sample(wo, lambda,
                                {(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n}))
                sum += s->weight;
    return clamp(sum / static_cast<float>(n * n), 0, 1);
}

} // namespace montelux
