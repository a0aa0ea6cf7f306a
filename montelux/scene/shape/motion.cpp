#include "montelux/scene/shape/motion.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// Chords leave the path by at most this share of the distance from the axis.
constexpr double chord_tolerance = 1.2e-4;
constexpr int most_steps = 128; // of Embree's

using Linear = std::array<std::array<double, 3>, 3>;

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

struct Quaternion {
    double x = 0, y = 0, z = 0, w = 1;
};
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

struct Parts {
    Vec3d translation;
    Quaternion rotation;
    Linear stretch;
};

// Higham 1986, "Computing the Polar Decomposition - with Applications": the mean with the inverse transpose,
// repeated, converges quadratically to the orthogonal factor.
Parts take_apart(const Transform& t) {
    const Matrix4& m = t.matrix();
    Matrix4 orthogonal = affine(linear_part(m), {});
    for (int i = 0; i < 100; ++i) {
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

// Of a step that turns by w and stretches by the factor 1 + s, the middle of the chord is off by w^2 / 8 and w s / 4.
int steps_of(double turn, const Linear& a, const Linear& b) {
    double change = 0, size = 0;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) {
            change = std::max(change, std::abs(b[r][c] - a[r][c]));
            size = std::max(size, std::min(std::abs(a[r][c]), std::abs(b[r][c])));
        }
    const double squared =
        (turn * turn / 8 + turn * std::min(change / std::max(size, 1e-300), 1e3) / 4) / chord_tolerance;
    return std::clamp(static_cast<int>(std::ceil(std::sqrt(squared))), 1, most_steps);
}

Matrix4 rounded_to_float(Matrix4 m) {
    for (auto& row : m.m)
        for (double& v : row) v = static_cast<double>(static_cast<float>(v));
    return m;
}

} // namespace

Motion::Motion(const Transform& start, const Transform& end) : start_(start), end_(end) {
    if (start.swaps_handedness() != end.swaps_handedness())
        throw Error("motion",
                    "one end is mirrored and the other is not; between them the object would be flat");
    const Parts a = take_apart(start);
    Parts b = take_apart(end);
    if (dot(a.rotation, b.rotation) < 0) // the shorter way
        b.rotation = {-b.rotation.x, -b.rotation.y, -b.rotation.z, -b.rotation.w};
    // The angle by the sine, because the cosine may be close to 1.
    const Quaternion difference{b.rotation.x - a.rotation.x, b.rotation.y - a.rotation.y,
                                b.rotation.z - a.rotation.z, b.rotation.w - a.rotation.w};
    const double angle = 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(dot(difference, difference))));
    const bool turns = angle > 1e-9;
    const int steps = steps_of(turns ? 2 * angle : 0, a.stretch, b.stretch); // space turns by twice the angle
    for (int i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        Quaternion q = a.rotation;
        if (turns) {
            const double u = std::sin((1 - t) * angle) / std::sin(angle),
                         v = std::sin(t * angle) / std::sin(angle);
            q = {u * a.rotation.x + v * b.rotation.x, u * a.rotation.y + v * b.rotation.y,
                 u * a.rotation.z + v * b.rotation.z, u * a.rotation.w + v * b.rotation.w};
        }
        Linear stretch{};
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c)
                stretch[r][c] = (1 - t) * a.stretch[r][c] + t * b.stretch[r][c];
        Matrix4 key = rounded_to_float(
            affine(product(rotation_of(q), stretch), (1 - t) * a.translation + t * b.translation));
        if (i == 0) key = rounded_to_float(start.matrix());
        if (i == steps) key = rounded_to_float(end.matrix());
        if (!key.inverse()) throw Error("motion", "on its way the object would be flat");
        for (std::size_t r = 0; r < 3; ++r) reach_ = std::max(reach_, std::abs(key.m[r][3]));
        keys_.push_back(key);
    }
}

Transform Motion::at(float time) const {
    const auto last = static_cast<float>(keys_.size() - 1);
    const float place = std::clamp(time, 0.0f, 1.0f) * last;
    const auto i = std::min(static_cast<std::size_t>(place), keys_.size() - 2);
    const double f = static_cast<double>(place - static_cast<float>(i));
    Matrix4 m;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) m.m[r][c] = (1 - f) * keys_[i].m[r][c] + f * keys_[i + 1].m[r][c];
    // Between two keys that hardly differ the matrix is invertible; between two far apart only a collapse would
    // prevent it.
    if (const std::optional<Transform> t = Transform::from_matrix(m)) return *t;
    return start_;
}

} // namespace montelux
