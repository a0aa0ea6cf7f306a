#include "montelux/transport/texture_footprint.h"

#include <cmath>

namespace montelux {

namespace {

// Finds (x, y) such that a = x dpdu + y dpdv in the least-squares sense; zero for degenerate tangents.
class TangentSolver {
  public:
    TangentSolver(Vec3f dpdu, Vec3f dpdv)
        : dpdu_(dpdu), dpdv_(dpdv), uu_(dot(dpdu, dpdu)), uv_(dot(dpdu, dpdv)), vv_(dot(dpdv, dpdv)) {
        const float determinant = uu_ * vv_ - uv_ * uv_;
        inverse_ = std::abs(determinant) > 0 ? 1 / determinant : 0;
    }

    Vec2f operator()(Vec3f a) const {
        const float au = dot(a, dpdu_), av = dot(a, dpdv_);
        const Vec2f d{(vv_ * au - uv_ * av) * inverse_, (uu_ * av - uv_ * au) * inverse_};
        return std::isfinite(d.x) && std::isfinite(d.y) ? d : Vec2f{0, 0};
    }

  private:
    Vec3f dpdu_, dpdv_;
    float uu_, uv_, vv_, inverse_;
};

} // namespace

TextureContext texture_context(const Camera& camera, float scale, const SurfacePoint& s) {
    const Camera::Footprint footprint = camera.footprint(s.p, s.ng, scale);
    const TangentSolver in_tangents(s.dpdu, s.dpdv);
    TextureContext context{.p = s.p,
                           .n = s.ns,
                           .uv = s.uv,
                           .dpdx = footprint.dpdx,
                           .dpdy = footprint.dpdy,
                           .duvdx = in_tangents(footprint.dpdx),
                           .duvdy = in_tangents(footprint.dpdy),
                           .vertex_color = s.vertex_color,
                           .vertex_opacity = s.vertex_opacity};
    if (length_squared(s.second_dpdu) > 0) {
        const TangentSolver in_second(s.second_dpdu, s.second_dpdv);
        context.second_uv = s.second_uv;
        context.second_duvdx = in_second(footprint.dpdx);
        context.second_duvdy = in_second(footprint.dpdy);
    }
    return context;
}

} // namespace montelux
