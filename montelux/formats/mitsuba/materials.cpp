#include "montelux/formats/mitsuba/materials.h"

#include "montelux/scene/material/diffuse_material.h"

namespace montelux::mitsuba {

SurfaceLook MaterialLibrary::of(const Plugin& bsdf) {
    const auto known = made_.find(bsdf.index());
    if (known != made_.end()) return known->second;
    return made_[bsdf.index()] = make(bsdf);
}

SurfaceLook MaterialLibrary::standard() {
    std::vector<Material>& all = builder_.scene().materials;
    all.emplace_back(DiffuseMaterial{.reflectance = {0.5f}});
    return {static_cast<Index>(all.size() - 1)};
}

SurfaceLook MaterialLibrary::make(Plugin bsdf) {
    if (bsdf.type() != "diffuse") bsdf.refuse();
    DiffuseMaterial material;
    material.reflectance = textures_.spectrum(bsdf, "reflectance", 0.5f, SpectrumUse::reflectance);
    bsdf.finish();
    std::vector<Material>& all = builder_.scene().materials;
    all.emplace_back(material);
    return {static_cast<Index>(all.size() - 1)};
}

} // namespace montelux::mitsuba
