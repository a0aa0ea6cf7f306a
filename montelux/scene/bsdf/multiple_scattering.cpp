#include "montelux/scene/bsdf/multiple_scattering.h"

namespace montelux {

namespace {

template <typename B>
B multiscatter(const B& b) {
    return b;
}
UntiltedBsdf multiscatter(const ConductorBsdf& b) {
    if (b.is_specular()) return b;
    return MultiscatterConductorBsdf{b};
}
UntiltedBsdf multiscatter(const DielectricBsdf& b) {
    if (b.is_specular()) return b;
    return MultiscatterDielectricBsdf{b};
}

DiffuseBsdf multiscatter_base(const DiffuseBsdf& base) { return base; }
MultiscatterConductorBsdf multiscatter_base(const ConductorBsdf& base) { return {base}; }

template <typename Base>
UntiltedBsdf multiscatter(const LayeredBsdf<Base>& b) {
    if (b.coat.is_specular() && (b.base.is_specular() || std::same_as<Base, DiffuseBsdf>)) return b;
    const auto base = multiscatter_base(b.base);
    LayeredBsdf<std::remove_const_t<decltype(base)>, MultiscatterDielectricBsdf> layers;
    layers.coat = {b.coat};
    layers.base = base;
    layers.proxy = b.proxy;
    layers.medium_albedo = b.medium_albedo;
    layers.g = b.g;
    layers.thickness = b.thickness;
    layers.max_depth = b.max_depth;
    layers.sample_count = b.sample_count;
    return layers;
}

} // namespace

Bsdf with_multiple_scattering(const Bsdf& bsdf) {
    return std::visit(
        []<typename B>(const B& b) -> Bsdf {
            if constexpr (std::same_as<B, TiltedBsdf>)
                return TiltedBsdf{
                    std::visit([](const auto& base) { return UntiltedBsdf(multiscatter(base)); }, b.base),
                    b.geometric_normal, b.shadowing};
            else
                return std::visit([](const auto& made) { return Bsdf(made); }, UntiltedBsdf(multiscatter(b)));
        },
        bsdf);
}

} // namespace montelux
