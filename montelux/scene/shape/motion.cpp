#include "montelux/scene/shape/motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "montelux/mc/math/error.h"
#include "montelux/scene/shape/motion_path.h"

namespace montelux {

namespace {

// Chords leave the path by at most this share of the distance from the axis.
constexpr double chord_tolerance = 1.2e-4;
constexpr int most_steps = 128; // of Embree's

Matrix4 rounded_to_float(Matrix4 m) {
    for (auto& row : m.m)
        for (double& v : row) v = static_cast<double>(static_cast<float>(v));
    return m;
}

// The product without the translation of `outer`, whose path is a line: its translation is then the vector from
// the axis.
Matrix4 about_axis(const MotionPath& outer, const MotionPath& inner, double t) {
    Matrix4 turned = outer.at(t);
    for (std::size_t r = 0; r < 3; ++r) turned.m[r][3] = 0;
    return turned * inner.at(t);
}

Vec3d translation_of(const Matrix4& m) { return {m.m[0][3], m.m[1][3], m.m[2][3]}; }

// How far the middles of that many chords leave the path of the product: the inner axis as a share of its largest
// distance from the outer one, and other points as a share of their distance from the inner axis.
double deviation(const MotionPath& outer, const MotionPath& inner, int chords) {
    double of_points = 0, of_axis = 0, reach = 1e-300;
    Matrix4 before = about_axis(outer, inner, 0);
    for (int i = 0; i < chords; ++i) {
        const Matrix4 middle = about_axis(outer, inner, (i + 0.5) / chords),
                      after = about_axis(outer, inner, (i + 1.0) / chords);
        Matrix4 off, linear = middle;
        for (std::size_t r = 0; r < 3; ++r) {
            linear.m[r][3] = 0;
            for (std::size_t c = 0; c < 4; ++c)
                off.m[r][c] = 0.5 * (before.m[r][c] + after.m[r][c]) - middle.m[r][c];
        }
        of_axis = std::max(of_axis, length(translation_of(off)));
        reach = std::max({reach, length(translation_of(before)), length(translation_of(middle)),
                          length(translation_of(after))});
        if (const std::optional<Matrix4> inverse = linear.inverse())
            of_points = std::max(of_points, norm_of(off * *inverse));
        before = after;
    }
    return std::max(of_points, of_axis / reach);
}

int chords_of_product(const MotionPath& outer, const MotionPath& inner) {
    int n = std::min(std::max(outer.chords(chord_tolerance), inner.chords(chord_tolerance)), most_steps);
    while (n < most_steps) {
        const double off = deviation(outer, inner, n);
        if (!(off > chord_tolerance)) break;
        // It falls as 1 / n^2.
        const double wanted = std::ceil(n * std::sqrt(off / chord_tolerance));
        n = static_cast<int>(std::min(std::max(wanted, n + 1.0), double{most_steps}));
    }
    return n;
}

} // namespace

template <typename F>
void Motion::add_keys(int count, const F& of_time) {
    for (int i = 0; i <= count; ++i) {
        Matrix4 key;
        if (i == 0)
            key = start_.matrix();
        else if (i == count)
            key = end_.matrix();
        else
            key = of_time(static_cast<double>(i) / count);
        key = rounded_to_float(key);
        if (!key.inverse()) throw Error("motion", "on its way the object would be flat");
        for (std::size_t r = 0; r < 3; ++r) reach_ = std::max(reach_, std::abs(key.m[r][3]));
        keys_.push_back(key);
    }
}

Motion::Motion(const Transform& start, const Transform& end) : start_(start), end_(end) {
    const MotionPath path(start, end);
    add_keys(std::min(path.chords(chord_tolerance), most_steps), [&](double t) { return path.at(t); });
}

Motion Motion::product(const Transform& outer, const Motion& inner) {
    Motion motion;
    motion.start_ = outer * inner.start_;
    motion.end_ = outer * inner.end_;
    motion.is_product_ = true;
    const MotionPath path(inner.start_, inner.end_);
    motion.add_keys(static_cast<int>(inner.keys_.size()) - 1,
                    [&](double t) { return outer.matrix() * path.at(t); });
    return motion;
}

Motion Motion::product(const Motion& outer, const Motion& inner) {
    Motion motion;
    motion.start_ = outer.start_ * inner.start_;
    motion.end_ = outer.end_ * inner.end_;
    motion.is_product_ = true;
    const MotionPath a(outer.start_, outer.end_), b(inner.start_, inner.end_);
    motion.add_keys(chords_of_product(a, b), [&](double t) { return a.at(t) * b.at(t); });
    return motion;
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
