#include "montelux/scene/light/turned_map.h"

#include "montelux/mc/warp/sphere.h"

namespace montelux {

std::optional<TurnedMap::Sample> TurnedMap::sample_everywhere(Vec2f u) const {
    if (!map.compensated()) return sample(u);
    if (u.x < 0.5f) {
        const Vec3f wi = sample_uniform_sphere(Vec2f{2 * u.x, u.y});
        return Sample{wi, place(wi), pdf_everywhere(wi)};
    }
    auto s = sample({2 * u.x - 1, u.y});
    if (s) s->pdf = 0.5f * (s->pdf + inv_four_pi_f);
    return s;
}

float TurnedMap::pdf_everywhere(Vec3f wi) const {
    return map.compensated() ? 0.5f * (pdf(wi) + inv_four_pi_f) : pdf(wi);
}

} // namespace montelux
