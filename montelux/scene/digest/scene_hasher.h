// SceneHasher: the hash of values of a scene, whatever containers they are in.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "montelux/mc/math/transform.h"
#include "montelux/scene/scene_spectrum.h"
#include "montelux/scene/value_hash.h"

namespace montelux {

class SceneHasher;

// hash_values adds all values of a struct to a hasher; the other headers of this folder have its overloads. Structured
// bindings list every member: a new one does not compile until it is hashed there.
template <typename T>
concept HashedStruct = std::is_class_v<T>;
template <HashedStruct T>
void hash_values(SceneHasher&, const T&) {
    static_assert(sizeof(T) == 0, "write an overload of hash_values that adds all values of this type");
}

class SceneHasher {
  public:
    explicit SceneHasher(std::span<const Spectrum> spectra = {}) : spectra_(spectra) {}

    // Values one after the other.
    template <typename... T>
    void all(const T&... values) {
        (add(values), ...);
    }
    ContentDigest value() const { return hash_.value(); }

  private:
    template <typename T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) { hash_.add(value); }

    // Containers: the length, the presence or the alternative before the values.
    template <typename T>
    void add(std::span<const T> values) {
        add(static_cast<std::uint64_t>(values.size()));
        if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, Vec2f> || std::is_same_v<T, Vec3f>)
            hash_.add_bytes(values.data(), values.size_bytes());
        else
            for (const T& v : values) add(v);
    }
    template <typename T>
    void add(const std::vector<T>& values) {
        add(std::span<const T>(values));
    }
    template <typename T, std::size_t n>
    void add(const std::array<T, n>& values) {
        add(std::span<const T>(values));
    }
    void add(std::string_view text) { add(std::span<const char>(text)); }
    template <typename T>
    void add(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add(*value);
    }
    template <typename... T>
    void add(const std::variant<T...>& value) {
        add(static_cast<std::uint64_t>(value.index()));
        std::visit([this](const auto& v) { add(v); }, value);
    }

    // Any other struct.
    template <HashedStruct T>
    void add(const T& value) {
        hash_values(*this, value);
    }

    // Numbers.
    template <typename T>
    void add(const Vec2<T>& v) {
        all(v.x, v.y);
    }
    template <typename T>
    void add(const Vec3<T>& v) {
        all(v.x, v.y, v.z);
    }
    void add(const Matrix4& matrix) {
        const auto& [rows] = matrix;
        add(rows);
    }
    void add(const Transform& t) { all(t.matrix(), t.inverse_matrix()); }

    // Spectra: by value, wherever they are in Scene::spectra.
    void add(SceneSpectrum s) { add(spectrum_of(s, spectra_)); }
    void add(const Spectrum& s) { add(s.kind()); }
    void add(const ConstantSpectrum& s) {
        const auto& [value] = s;
        add(value);
    }
    template <typename Data>
    void add(const SharedSpectrum<Data>& s) {
        add(s.data());
    }
    void add(const SpectrumTable& s) { add(s.values()); }
    void add(const PiecewiseLinear& s) { add(s.knots()); }
    void add(const PiecewiseLinear::Knot& knot) {
        const auto& [lambda, value, slope] = knot;
        all(lambda, value, slope);
    }
    void add(const BlackbodySpectrum& s) { add(s.temperature()); }
    void add(const SigmoidPolynomial& p) {
        const auto& [a, b, c] = p;
        all(a, b, c);
    }
    void add(const RgbAlbedoSpectrum& s) { add(s.polynomial()); }
    void add(const ScaledPolynomial& s) { all(s.scale(), s.polynomial()); }
    void add(const RgbUnboundedSpectrum& s) { add(static_cast<const ScaledPolynomial&>(s)); }
    void add(const RgbIlluminantSpectrum& s) { all(s.filter(), s.illuminant()); }
    void add(const RgbColorSpace* space) {
        all(space->red(), space->green(), space->blue(), space->illuminant());
    }

    std::span<const Spectrum> spectra_;
    ValueHash hash_;
};

} // namespace montelux
