#include "montelux/scene/bsdf/bsdf.h"

#include "montelux/scene/bsdf/narrow_lobes.h"

namespace montelux {

bool is_specular(const Bsdf& bsdf) {
    return std::visit([](const auto& b) { return b.is_specular(); }, bsdf);
}

bool is_glossy(const Bsdf& bsdf) {
    return std::visit([](const auto& b) { return is_glossy(b); }, bsdf);
}

float least_alpha(const Bsdf& bsdf) {
    return std::visit([](const auto& b) { return least_alpha(b); }, bsdf);
}

SampledSpectrum albedo(const Bsdf& bsdf, Vec3f wo) {
    return std::visit([&](const auto& b) { return b.albedo(wo); }, bsdf);
}

bool is_opaque(const Bsdf& bsdf) {
    return std::visit(
        []<typename B>(const B& b) {
            if constexpr (std::same_as<B, TiltedBsdf>)
                return std::visit([](const auto& base) { return !base.traits.transmits; }, b.base);
            else
                return !B::traits.transmits;
        },
        bsdf);
}

} // namespace montelux
