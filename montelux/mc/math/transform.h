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
    Vec3d point(Vec3d p) const;
    Vec3d vector(Vec3d v) const;
    // Normals go by the inverse transpose; the length is not kept.
    Vec3d normal(Vec3d n) const;
    Point3f point(Point3f p) const { return Vec3f(point(Vec3d(p))); }
    Vec3f vector(Vec3f v) const { return Vec3f(vector(Vec3d(v))); }
    Vec3f normal(Vec3f n) const { return Vec3f(normal(Vec3d(n))); }

  private:
    Matrix4 m_, inv_;
};

} // namespace montelux
