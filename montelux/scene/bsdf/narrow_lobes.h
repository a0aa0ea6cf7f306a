// least_alpha, is_glossy: how narrow the lobes of a BSDF are.
#pragma once

#include <algorithm>
#include <cmath>

#include "montelux/scene/bsdf/bsdf_model.h"

namespace montelux {

// The smallest roughness alpha among the microfacet lobes that are no deltas, the geometric mean of both axes; 1
// without such a lobe. A lobe about a direction covers a solid angle in proportion to its square.
template <BsdfModel B>
float least_alpha(const B& bsdf) {
    float least = 1;
    bsdf.visit_fields([&]<typename F>(const char*, const F& field) {
        static_assert(BsdfModel<F> || !requires { F::traits; }); // it would be taken for a number
        if constexpr (BsdfModel<F>) {
            least = std::min(least, least_alpha(field));
        } else if constexpr (requires { field.alpha_x; }) {
            if (!field.is_smooth()) least = std::min(least, std::sqrt(field.alpha_x * field.alpha_y));
        }
    });
    return least;
}

// Whether all that a BSDF scatters goes into narrow lobes, so that it depends much on wo: no diffuse lobe
// and no microfacets rougher than alpha = 0.4. Deltas, hair and measured BRDFs count as narrow.
template <BsdfModel B>
bool is_glossy(const B& bsdf) {
    constexpr float most_alpha = 0.4f;
    if (bsdf.has_diffuse()) return false;
    bool narrow = true;
    bsdf.visit_fields([&]<typename F>(const char*, const F& field) {
        static_assert(BsdfModel<F> || !requires { F::traits; }); // it would be taken for a number
        if constexpr (BsdfModel<F>)
            narrow = narrow && is_glossy(field);
        else if constexpr (requires { field.alpha_x; })
            narrow = narrow && field.alpha_x * field.alpha_y <= most_alpha * most_alpha;
    });
    return narrow;
}

} // namespace montelux
