#include "montelux/mc/math/transform.h"

#include <cmath>
#include <utility>

#include "montelux/mc/math/constants.h"

namespace montelux {

Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
    Matrix4 r;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k) sum += a.m[i][k] * b.m[k][j];
            r.m[i][j] = sum;
        }
    return r;
}

Matrix4 Matrix4::transposed() const {
    Matrix4 r;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) r.m[i][j] = m[j][i];
    return r;
}

// Gauss-Jordan elimination with partial pivoting.
std::optional<Matrix4> Matrix4::inverse() const {
    auto a = m;
    Matrix4 identity;
    auto& b = identity.m;
    for (std::size_t column = 0; column < 4; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column + 1; row < 4; ++row)
            if (std::abs(a[row][column]) > std::abs(a[pivot][column])) pivot = row;
        double p = a[pivot][column];
        if (!std::isfinite(p) || p == 0) return std::nullopt;
        std::swap(a[pivot], a[column]);
        std::swap(b[pivot], b[column]);
        for (std::size_t j = 0; j < 4; ++j) {
            a[column][j] /= p;
            b[column][j] /= p;
        }
        for (std::size_t row = 0; row < 4; ++row) {
            if (row == column) continue;
            double f = a[row][column];
            for (std::size_t j = 0; j < 4; ++j) {
                a[row][j] -= f * a[column][j];
                b[row][j] -= f * b[column][j];
            }
        }
    }
    for (const auto& row : b)
        for (double v : row)
            if (!std::isfinite(v)) return std::nullopt;
    return identity;
}

double Matrix4::linear_determinant() const {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

std::optional<Transform> Transform::from_matrix(const Matrix4& matrix) {
    auto inverse = matrix.inverse();
    if (!inverse) return std::nullopt;
    return Transform(matrix, *inverse);
}

Transform Transform::translate(Vec3d d) {
    Transform t;
    for (std::size_t i = 0; i < 3; ++i) {
        t.m_.m[i][3] = d[static_cast<int>(i)];
        t.inv_.m[i][3] = -d[static_cast<int>(i)];
    }
    return t;
}

Transform Transform::scale(Vec3d s) {
    Transform t;
    for (std::size_t i = 0; i < 3; ++i) {
        t.m_.m[i][i] = s[static_cast<int>(i)];
        t.inv_.m[i][i] = 1 / s[static_cast<int>(i)];
    }
    return t;
}

Transform Transform::rotate(double degrees, Vec3d axis) {
    Vec3d a = normalize(axis);
    double radians = degrees * pi / 180;
    double s = std::sin(radians), c = std::cos(radians), d = 1 - c;
    Matrix4 r;
    r.m = {{{a.x * a.x * d + c, a.x * a.y * d - a.z * s, a.x * a.z * d + a.y * s, 0},
            {a.x * a.y * d + a.z * s, a.y * a.y * d + c, a.y * a.z * d - a.x * s, 0},
            {a.x * a.z * d - a.y * s, a.y * a.z * d + a.x * s, a.z * a.z * d + c, 0},
            {0, 0, 0, 1}}};
    return {r, r.transposed()};
}

std::optional<Transform> Transform::look_at(Vec3d eye, Vec3d target, Vec3d up) {
    Vec3d direction = normalize(target - eye);
    Vec3d right = cross(normalize(up), direction);
    if (!(length(right) > 0)) return std::nullopt;
    right = normalize(right);
    Vec3d new_up = cross(direction, right);
    Matrix4 camera_to_world;
    for (std::size_t i = 0; i < 3; ++i) {
        int k = static_cast<int>(i);
        camera_to_world.m[i] = {right[k], new_up[k], direction[k], eye[k]};
    }
    auto world_to_camera = camera_to_world.inverse();
    if (!world_to_camera) return std::nullopt;
    return Transform(*world_to_camera, camera_to_world);
}

Vec3d Transform::normal(Vec3d n) const {
    const auto& a = inv_.m;
    return {a[0][0] * n.x + a[1][0] * n.y + a[2][0] * n.z, a[0][1] * n.x + a[1][1] * n.y + a[2][1] * n.z,
            a[0][2] * n.x + a[1][2] * n.y + a[2][2] * n.z};
}

} // namespace montelux
