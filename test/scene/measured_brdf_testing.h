// Measured BRDFs for tests: tables of a GGX reflector as a gonio-photometer would fill them, and files of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/math/constants.h"
#include "montelux/scene/bsdf/ggx.h"
#include "montelux/scene/bsdf/measured_brdf.h"

namespace montelux::testing {

// The BRDF is D G R(lambda) / (4 cos cos), R = lambda / 1000 nm.
struct MeasuredGgx {
    Ggx ggx;

    float value(Vec3f wo, Vec3f wi, float lambda) const {
        return ggx.d(normalize(wo + wi)) * ggx.g(wo, wi) * lambda / 1000 / (4 * wo.z * wi.z);
    }
};

inline Vec3f direction_at(float column, float row) {
    const float theta = column * column * pi_f / 2, phi = (2 * row - 1) * pi_f;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

inline MeasuredBrdfData measured_ggx(const MeasuredGgx& m, std::uint32_t n = 48) {
    const bool isotropic = m.ggx.alpha_x == m.ggx.alpha_y;
    const auto knots = [](std::size_t count, float from, float to) {
        std::vector<float> x(count);
        for (std::size_t i = 0; i < count; ++i)
            x[i] = count == 1 ? from
                              : from + (to - from) * static_cast<float>(i) / static_cast<float>(count - 1);
        return x;
    };
    MeasuredBrdfData d;
    d.theta = knots(isotropic ? 24 : 12, 0, pi_f / 2 - 0.01f);
    d.phi = isotropic ? std::vector<float>{0} : knots(17, -pi_f, pi_f);
    d.wavelengths = {360, 830};
    // Calls put(column, row) for each knot, row by row.
    const auto fill = [&](BrdfTables& t, std::uint32_t columns, std::uint32_t rows, const auto& value) {
        t.columns = columns;
        t.rows = rows;
        for (std::uint32_t j = 0; j < rows; ++j)
            for (std::uint32_t i = 0; i < columns; ++i)
                t.values.push_back(value(static_cast<float>(i) / static_cast<float>(columns - 1),
                                         static_cast<float>(j) / static_cast<float>(rows - 1)));
    };
    fill(d.ndf, 256, isotropic ? 2 : 129, [&](float x, float y) { return m.ggx.d(direction_at(x, y)); });
    fill(d.sigma, 128, isotropic ? 2 : 129, [&](float x, float y) {
        const Vec3f w = direction_at(std::min(x, 0.999f), y);
        return w.z / m.ggx.g1(w);
    });
    const auto for_each_outgoing = [&](const auto& f) {
        for (float phi : d.phi)
            for (float theta : d.theta)
                f(phi,
                  Vec3f{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    };
    // The normal at a place of the square.
    const auto normal = [&](float phi, float x, float y) {
        return isotropic ? direction_at(x, y + phi / two_pi_f) : direction_at(x, y);
    };
    for_each_outgoing([&](float phi, Vec3f wo) {
        fill(d.visible_normals, n, n, [&](float x, float y) {
            const Vec3f wm = normal(phi, x, y);
            return m.ggx.d(wm) * std::max(dot(wo, wm), 0.0f) * 2 * pi_f * pi_f * x * std::hypot(wm.x, wm.y);
        });
    });
    const InterpolatedBilinear2D normals(d.phi.size() * d.theta.size(), n, n, d.visible_normals.values);
    InterpolationWeights at{{0}, {1.0f}, 1};
    for_each_outgoing([&](float phi, Vec3f wo) {
        // Of the microfacets that the square leads to: 4 f cos(theta_i) sigma / D = R G / G1.
        const auto visible = [&](float x, float y) {
            const Vec2f p = normals.sample(at, {x, y}).p;
            const Vec3f wm = normal(phi, p.x, p.y);
            const Vec3f wi = 2 * dot(wo, wm) * wm - wo;
            return wi.z > 0 && dot(wo, wm) > 0 ? m.ggx.g(wo, wi) / m.ggx.g1(wo) : 0.0f;
        };
        fill(d.luminance, 32, 32, visible);
        for (float lambda : d.wavelengths)
            fill(d.spectra, 32, 32, [&](float x, float y) { return visible(x, y) * lambda / 1000; });
        ++at.entry[0];
    });
    return d;
}

// Made once: it takes a second under sanitizers.
inline const MeasuredBrdf& measured_case(float alpha_x, float alpha_y) {
    static std::map<std::pair<float, float>, MeasuredBrdf> known;
    const auto found = known.find({alpha_x, alpha_y});
    if (found != known.end()) return found->second;
    return known.try_emplace({alpha_x, alpha_y}, measured_ggx({{alpha_x, alpha_y}}, 24)).first->second;
}

// The bytes of a file, with fields as in Dupuy and Jakob's database.
class TensorFileWriter {
  public:
    void add(const std::string& name, const std::vector<std::uint64_t>& shape,
             const std::vector<float>& values) {
        std::string bytes(values.size() * sizeof(float), '\0');
        std::memcpy(bytes.data(), values.data(), bytes.size());
        fields_.push_back({name, 10, shape, bytes});
    }
    void add_text(const std::string& name, const std::string& text) {
        fields_.push_back({name, 1, {text.size()}, text});
    }
    std::vector<std::uint8_t> bytes() const {
        std::string head("tensor_file\0\1\0", 14), data;
        std::size_t offset = 18;
        for (const Field& f : fields_) offset += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
        put(head, static_cast<std::uint32_t>(fields_.size()));
        for (const Field& f : fields_) {
            put(head, static_cast<std::uint16_t>(f.name.size()));
            head += f.name;
            put(head, static_cast<std::uint16_t>(f.shape.size()));
            put(head, f.type);
            put(head, static_cast<std::uint64_t>(offset + data.size()));
            for (std::uint64_t n : f.shape) put(head, n);
            data += f.data;
        }
        head += data;
        return {head.begin(), head.end()};
    }

  private:
    struct Field {
        std::string name;
        std::uint8_t type;
        std::vector<std::uint64_t> shape;
        std::string data;
    };
    template <typename T>
    static void put(std::string& to, T value) {
        to.append(reinterpret_cast<const char*>(&value), sizeof value);
    }

    std::vector<Field> fields_;
};

inline TensorFileWriter measured_brdf_file(const MeasuredBrdfData& d) {
    TensorFileWriter w;
    const std::uint64_t phis = d.phi.size(), thetas = d.theta.size(), lambdas = d.wavelengths.size();
    w.add_text("description", "GGX");
    w.add_text("jacobian", "\1");
    w.add("phi_i", {phis}, d.phi);
    w.add("theta_i", {thetas}, d.theta);
    w.add("wavelengths", {lambdas}, d.wavelengths);
    w.add("ndf", {d.ndf.rows, d.ndf.columns}, d.ndf.values);
    w.add("sigma", {d.sigma.rows, d.sigma.columns}, d.sigma.values);
    w.add("vndf", {phis, thetas, d.visible_normals.rows, d.visible_normals.columns},
          d.visible_normals.values);
    w.add("luminance", {phis, thetas, d.luminance.rows, d.luminance.columns}, d.luminance.values);
    w.add("spectra", {phis, thetas, lambdas, d.spectra.rows, d.spectra.columns}, d.spectra.values);
    return w;
}

} // namespace montelux::testing
