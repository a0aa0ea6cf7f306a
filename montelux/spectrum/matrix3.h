// 3x3 matrices for conversions between colour spaces.
#pragma once

#include <array>

#include "montelux/mc/math/vec.h"

namespace montelux {

// Rows of a matrix that acts on columns.
struct Matrix3 {
    std::array<Vec3d, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

    static constexpr Matrix3 diagonal(Vec3d d) { return {{{{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}}}; }

    friend constexpr Vec3d operator*(const Matrix3& m, Vec3d v) {
        return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
    }
    friend constexpr Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
        Matrix3 t = b.transposed();
        return {{{t * a.rows[0], t * a.rows[1], t * a.rows[2]}}};
    }
    constexpr Matrix3 transposed() const {
        return {{{{rows[0].x, rows[1].x, rows[2].x},
                  {rows[0].y, rows[1].y, rows[2].y},
                  {rows[0].z, rows[1].z, rows[2].z}}}};
    }
    constexpr double determinant() const { return dot(rows[0], cross(rows[1], rows[2])); }
    // The determinant must not be 0.
    constexpr Matrix3 inverse() const {
        double s = 1 / determinant();
        return Matrix3{
            {{cross(rows[1], rows[2]) * s, cross(rows[2], rows[0]) * s, cross(rows[0], rows[1]) * s}}}
            .transposed();
    }
};

} // namespace montelux
