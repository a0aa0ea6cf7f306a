#include "montelux/scene/light/sampler/light_cone.h"

#include <algorithm>
#include <cmath>

#include "montelux/mc/math/constants.h"

namespace montelux {

namespace {

double angle_of(float cosine) { return std::acos(std::clamp(double(cosine), -1.0, 1.0)); }

} // namespace

void LightCone::add(const LightCone& other) {
    cos_theta_e = std::min(cos_theta_e, other.cos_theta_e);
    two_sided = two_sided || other.two_sided;
    const Vec3d a(axis);
    Vec3d b(other.axis);
    if (two_sided && dot(a, b) < 0) b = -b;
    const double theta_a = angle_of(cos_theta_o), theta_b = angle_of(other.cos_theta_o);
    const double between = std::atan2(length(cross(a, b)), dot(a, b));
    if (between + theta_b <= theta_a || theta_a >= pi) return;
    if (between + theta_a <= theta_b || theta_b >= pi) {
        axis = Vec3f(b);
        cos_theta_o = other.cos_theta_o;
        return;
    }
    const double theta = 0.5 * (theta_a + between + theta_b);
    const double sine = std::sin(between);
    if (theta >= pi || !(sine > 1e-9)) {
        cos_theta_o = -1;
        return;
    }
    const double turn = theta - theta_a;
    axis = Vec3f(normalize(std::sin(between - turn) / sine * a + std::sin(turn) / sine * b));
    cos_theta_o = static_cast<float>(std::cos(theta));
}

double LightCone::measure() const {
    const double o = angle_of(cos_theta_o), w = std::min(o + angle_of(cos_theta_e), pi);
    const double one_side = 2 * pi * (1 - std::cos(o)) +
                            0.5 * pi * (2 * (w - o) * std::sin(o) - std::cos(2 * w - o) + std::cos(o));
    return two_sided ? std::min(2 * one_side, 4 * pi) : one_side;
}

} // namespace montelux
