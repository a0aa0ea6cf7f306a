// Small fixed-size vectors: Vec2 and Vec3 with the arithmetic that geometry needs.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "montelux/mc/math/number.h"

namespace montelux {

template <typename T>
struct Vec2 {
    T x{}, y{};

    constexpr Vec2() = default;
    constexpr Vec2(T x_, T y_) : x(x_), y(y_) {}
    template <typename U>
    requires(!std::same_as<U, T>) constexpr explicit Vec2(const Vec2<U>& v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)) {}

    constexpr T& operator[](int i) { return i == 0 ? x : y; }
    constexpr T operator[](int i) const { return i == 0 ? x : y; }
    bool operator==(const Vec2&) const = default; // constexpr where T allows it

    friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
    friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
    friend constexpr Vec2 operator*(Vec2 a, T s) { return {a.x * s, a.y * s}; }
    friend constexpr Vec2 operator*(T s, Vec2 a) { return {a.x * s, a.y * s}; }
    friend constexpr Vec2 operator/(Vec2 a, T s) { return {a.x / s, a.y / s}; }
    constexpr Vec2 operator-() const { return {-x, -y}; }
    constexpr Vec2& operator+=(Vec2 b) { return *this = *this + b; }
    constexpr Vec2& operator-=(Vec2 b) { return *this = *this - b; }
    constexpr Vec2& operator*=(T s) { return *this = *this * s; }
};

template <typename T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr Vec3() = default;
    constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    template <typename U>
    requires(!std::same_as<U, T>) constexpr explicit Vec3(const Vec3<U>& v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

    constexpr T& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
    constexpr T operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
    bool operator==(const Vec3&) const = default; // constexpr where T allows it

    friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(T s, Vec3 a) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    constexpr Vec3 operator-() const { return {-x, -y, -z}; }
    constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
    constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }
    constexpr Vec3& operator/=(T s) { return *this = *this / s; }
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec2i = Vec2<int>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Point2f = Vec2f;
using Point3f = Vec3f;
using Normal3f = Vec3f;

template <typename T>
constexpr T dot(Vec2<T> a, Vec2<T> b) {
    return a.x * b.x + a.y * b.y;
}
template <typename T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
constexpr T abs_dot(Vec3<T> a, Vec3<T> b) {
    T d = dot(a, b);
    return select(d < 0, -d, d);
}
template <typename T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
constexpr T length_squared(Vec2<T> a) {
    return dot(a, a);
}
template <typename T>
constexpr T length_squared(Vec3<T> a) {
    return dot(a, a);
}
template <typename T>
T length(Vec2<T> a) {
    using std::sqrt;
    return sqrt(dot(a, a));
}
template <typename T>
T length(Vec3<T> a) {
    using std::sqrt;
    return sqrt(dot(a, a));
}
// The zero vector has no direction: it gives NaN.
template <typename T>
Vec3<T> normalize(Vec3<T> a) {
    return a * (T(1) / length(a));
}
template <typename T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
    using std::min;
    return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
template <typename T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
    using std::max;
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
template <typename T>
constexpr Vec3<T> abs(Vec3<T> a) {
    return {select(a.x < 0, -a.x, a.x), select(a.y < 0, -a.y, a.y), select(a.z < 0, -a.z, a.z)};
}
template <typename T>
constexpr T max_component(Vec3<T> a) {
    using std::max;
    return max(a.x, max(a.y, a.z));
}
template <typename T>
constexpr Vec3<T> multiply(Vec3<T> a, Vec3<T> b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <LaneNumber T>
constexpr Vec3<T> select(MaskOf<T> condition, Vec3<T> a, Vec3<T> b) {
    return {select(condition, a.x, b.x), select(condition, a.y, b.y), select(condition, a.z, b.z)};
}
template <typename T>
bool is_finite(Vec3<T> a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

} // namespace montelux
