#include "montelux/scene/shape/motion_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

using Linear = MotionPath::Linear;

Linear linear_part(const Matrix4& m) {
    Linear a{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) a[i][j] = m.m[i][j];
    return a;
}

Matrix4 affine(const Linear& a, Vec3d translation) {
    Matrix4 m;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) m.m[i][j] = a[i][j];
        m.m[i][3] = translation[static_cast<int>(i)];
    }
    return m;
}

Linear product(const Linear& a, const Linear& b) { return linear_part(affine(a, {}) * affine(b, {})); }

using Quaternion = MotionPath::Quaternion;
using Parts = MotionPath::Parts;
double dot(const Quaternion& a, const Quaternion& b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

// Of a rotation. Shoemake 1991, "Quaternions": the largest component first, which is far from 0.
Quaternion quaternion_of(const Linear& r) {
    const double trace = r[0][0] + r[1][1] + r[2][2];
    if (trace > 0) {
        const double s = std::sqrt(trace + 1) * 2;
        return {(r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s, s / 4};
    }
    std::size_t i = 0;
    if (r[1][1] > r[0][0]) i = 1;
    if (r[2][2] > r[i][i]) i = 2;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = std::sqrt(r[i][i] - r[j][j] - r[k][k] + 1) * 2;
    std::array<double, 3> v{};
    v[i] = s / 4;
    v[j] = (r[j][i] + r[i][j]) / s;
    v[k] = (r[k][i] + r[i][k]) / s;
    return {v[0], v[1], v[2], (r[k][j] - r[j][k]) / s};
}

Linear rotation_of(const Quaternion& q) {
    return {{{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w), 2 * (q.x * q.z + q.y * q.w)},
             {2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.x * q.w)},
             {2 * (q.x * q.z - q.y * q.w), 2 * (q.y * q.z + q.x * q.w), 1 - 2 * (q.x * q.x + q.y * q.y)}}};
}

// Higham 1986, "Computing the Polar Decomposition - with Applications": the mean with the inverse transpose,
// repeated, converges quadratically to the orthogonal factor. Far from it a step halves the
// stretch or its inverse: no double is more than about 1100 steps away.
Parts take_apart(const Transform& t) {
    const Matrix4& m = t.matrix();
    Matrix4 orthogonal = affine(linear_part(m), {});
    for (int i = 0; i < 1200; ++i) {
        const std::optional<Matrix4> inverse = orthogonal.inverse();
        if (!inverse) throw Error("motion", "the transformation has no inverse");
        const Matrix4 other = inverse->transposed();
        double change = 0;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c) {
                const double mean = 0.5 * (orthogonal.m[r][c] + other.m[r][c]);
                change = std::max(change, std::abs(mean - orthogonal.m[r][c]));
                orthogonal.m[r][c] = mean;
            }
        if (change < 1e-15) break;
    }
    // A mirror goes into the stretch.
    if (orthogonal.linear_determinant() < 0)
        for (auto& row : orthogonal.m)
            for (std::size_t c = 0; c < 3; ++c) row[c] = -row[c];
    const Linear rotation = linear_part(orthogonal);
    return {{m.m[0][3], m.m[1][3], m.m[2][3]},
            quaternion_of(rotation),
            product(linear_part(orthogonal.transposed()), linear_part(m))};
}

} // namespace

double norm_of(const Matrix4& m) {
    double of_rows = 0, of_columns = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        double row = 0, column = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            row += std::abs(m.m[i][j]);
            column += std::abs(m.m[j][i]);
        }
        of_rows = std::max(of_rows, row);
        of_columns = std::max(of_columns, column);
    }
    return std::sqrt(of_rows * of_columns);
}

MotionPath::MotionPath(const Transform& start, const Transform& end) {
    if (start.swaps_handedness() != end.swaps_handedness())
        throw Error("motion",
                    "one end is mirrored and the other is not; between them the object would be flat");
    start_ = take_apart(start);
    end_ = take_apart(end);
    Quaternion& b = end_.rotation;
    const Quaternion& a = start_.rotation;
    if (dot(a, b) < 0) b = {-b.x, -b.y, -b.z, -b.w}; // the shorter way
    // The angle by the sine, because the cosine may be close to 1.
    const Quaternion difference{b.x - a.x, b.y - a.y, b.z - a.z, b.w - a.w};
    const double angle = 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(dot(difference, difference))));
    angle_ = angle > 1e-9 ? angle : 0;
}

double MotionPath::change_of_stretch(const Linear& from) const {
    Linear change{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) change[r][c] = end_.stretch[r][c] - start_.stretch[r][c];
    const std::optional<Matrix4> inverse = affine(from, {}).inverse();
    return inverse ? norm_of(affine(change, {}) * *inverse) : std::numeric_limits<double>::infinity();
}

int MotionPath::chords(double tolerance) const {
    const double turn = 2 * angle_; // space turns by twice the angle
    // The middle of the chord of a step that turns by w and changes the stretch by the share s of what it is, in the
    // direction in which that is largest, is off by w^2 / 8 and w s / 4.
    const double share = std::max(change_of_stretch(start_.stretch), change_of_stretch(end_.stretch));
    const double squared = (turn * turn / 8 + turn * std::min(share, 1e3) / 4) / tolerance;
    return static_cast<int>(std::clamp(std::ceil(std::sqrt(squared)), 1.0, 1e6));
}

Matrix4 MotionPath::at(double t) const {
    const auto& [p, a, s] = start_;
    const auto& [q, b, e] = end_;
    Quaternion rotation = a;
    if (angle_ > 0) {
        const double u = std::sin((1 - t) * angle_) / std::sin(angle_),
                     v = std::sin(t * angle_) / std::sin(angle_);
        rotation = {u * a.x + v * b.x, u * a.y + v * b.y, u * a.z + v * b.z, u * a.w + v * b.w};
    }
    Linear stretch{};
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) stretch[r][c] = (1 - t) * s[r][c] + t * e[r][c];
    return affine(product(rotation_of(rotation), stretch), (1 - t) * p + t * q);
}

} // namespace montelux
