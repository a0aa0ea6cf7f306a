// Affine and projective maps of space as 4x4 matrices that carry their inverse.
#pragma once

#include <array>
#include <optional>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Row-major; points are columns: p' = M p.
struct Matrix4 {
    std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

    bool operator==(const Matrix4&) const = default;
    friend Matrix4 operator*(const Matrix4& a, const Matrix4& b);
    Matrix4 transposed() const;
    // Empty when the matrix is singular or not finite.
    std::optional<Matrix4> inverse() const;
    // Determinant of the upper-left 3x3 block; negative when handedness is swapped.
    double linear_determinant() const;
};

class Transform {
  public:
    Transform() = default;
    Transform(const Matrix4& matrix, const Matrix4& inverse) : m_(matrix), inv_(inverse) {}
    // Empty when the matrix has no inverse.
    static std::optional<Transform> from_matrix(const Matrix4& matrix);
    static Transform translate(Vec3d d);
    static Transform scale(Vec3d s); // every component must be non-zero
    static Transform rotate(double degrees, Vec3d axis);
    // World to camera: the camera at `eye` looks along +z, `up` is near +y, +x to the right
    // in a left-handed space. Empty when the arguments do not span a frame.
    static std::optional<Transform> look_at(Vec3d eye, Vec3d target, Vec3d up);

    const Matrix4& matrix() const { return m_; }
    const Matrix4& inverse_matrix() const { return inv_; }
    Transform inverse() const { return {inv_, m_}; }
    bool swaps_handedness() const { return m_.linear_determinant() < 0; }
    bool operator==(const Transform&) const = default;
    friend Transform operator*(const Transform& a, const Transform& b) {
        return {a.m_ * b.m_, b.inv_ * a.inv_};
    }

    // Points are divided by their homogeneous coordinate when it is not 1.
    Vec3d point(Vec3d p) const { return apply_point(m_, p); }
    Vec3d vector(Vec3d v) const { return apply_vector(m_, v); }
    // Normals go by the inverse transpose; the length is not kept.
    Vec3d normal(Vec3d n) const;
    // By the inverse, without making it.
    Vec3d inverse_point(Vec3d p) const { return apply_point(inv_, p); }
    Vec3d inverse_vector(Vec3d v) const { return apply_vector(inv_, v); }
    Point3f point(Point3f p) const { return Vec3f(point(Vec3d(p))); }
    Vec3f vector(Vec3f v) const { return Vec3f(vector(Vec3d(v))); }
    Vec3f normal(Vec3f n) const { return Vec3f(normal(Vec3d(n))); }

  private:
    static Vec3d apply_point(const Matrix4& matrix, Vec3d p);
    static Vec3d apply_vector(const Matrix4& matrix, Vec3d v);

    Matrix4 m_, inv_;
};

inline Vec3d Transform::apply_point(const Matrix4& matrix, Vec3d p) {
    const auto& a = matrix.m;
    Vec3d r{a[0][0] * p.x + a[0][1] * p.y + a[0][2] * p.z + a[0][3],
            a[1][0] * p.x + a[1][1] * p.y + a[1][2] * p.z + a[1][3],
            a[2][0] * p.x + a[2][1] * p.y + a[2][2] * p.z + a[2][3]};
    double w = a[3][0] * p.x + a[3][1] * p.y + a[3][2] * p.z + a[3][3];
    return w == 1 ? r : r / w;
}

inline Vec3d Transform::apply_vector(const Matrix4& matrix, Vec3d v) {
    const auto& a = matrix.m;
    return {a[0][0] * v.x + a[0][1] * v.y + a[0][2] * v.z, a[1][0] * v.x + a[1][1] * v.y + a[1][2] * v.z,
            a[2][0] * v.x + a[2][1] * v.y + a[2][2] * v.z};
}

} // namespace montelux
