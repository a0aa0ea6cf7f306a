#include "montelux/formats/mitsuba/materials.h"

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "montelux/scene/material/diffuse_material.h"
#include "montelux/scene/material/interface_material.h"
#include "montelux/scene/material/mix_material.h"
#include "montelux/scene/material/sided_material.h"

namespace montelux::mitsuba {
namespace {

bool is_one(const FloatParameter& p) { return p.is_constant() && p.value == 1; }
bool is_same(const FloatParameter& a, const FloatParameter& b) {
    return a.texture == b.texture && (!a.is_constant() || a.value == b.value);
}

// Mitsuba's two rules for tilted normals go together here; without its shadowing ours hold.
void read_tilt(Plugin& bsdf, SurfaceDetail& detail) {
    detail.shadowed = bsdf.flag("use_shadowing_function", true);
    bsdf.skip("flip_invalid_normals");
}

} // namespace

SurfaceLook MaterialLibrary::of(const Plugin& bsdf) {
    const Part p = part(bsdf, {});
    if (p.material != no_index) return {sided(p), p.alpha};
    if (interface_ == no_index) interface_ = add(InterfaceMaterial(), {});
    return {interface_};
}

SurfaceLook MaterialLibrary::standard() {
    if (standard_ == no_index) standard_ = sided({.material = add(DiffuseMaterial(), {}), .one_sided = true});
    return {standard_};
}

Index MaterialLibrary::add(const Material& material, const std::string& name) {
    Scene& scene = builder_.scene();
    scene.materials.push_back(material);
    if (!name.empty()) {
        scene.material_names.resize(scene.materials.size());
        scene.material_names.back() = name;
    }
    return static_cast<Index>(scene.materials.size() - 1);
}

Index MaterialLibrary::sided(const Part& part) {
    if (!part.one_sided) return part.material;
    if (const auto known = sided_.find(part.material); known != sided_.end()) return known->second;
    const std::vector<std::string>& names = builder_.scene().material_names;
    const std::string name = part.material < names.size() ? names[part.material] : std::string();
    SidedMaterial m;
    m.front.index = part.material;
    return sided_[part.material] = add(m, name);
}

MaterialLibrary::Part MaterialLibrary::part(const Plugin& bsdf, const SurfaceDetail& detail) {
    const auto key =
        std::tuple(bsdf.index(), detail.displacement.texture, detail.normal_map.map, detail.shadowed);
    if (const auto known = parts_.find(key); known != parts_.end()) return known->second;
    return parts_[key] = make(bsdf, detail);
}

MaterialLibrary::Part MaterialLibrary::make(Plugin bsdf, const SurfaceDetail& detail) {
    const auto made = [&]() -> Part {
        if (bsdf.type() == "null") return {};
        if (bsdf.type() == "blendbsdf") return blend(bsdf, detail);
        if (bsdf.type() == "mask") return masked(bsdf, detail);
        if (bsdf.type() == "twosided") return two_sided(bsdf, detail);
        if (bsdf.type() == "bumpmap") return bumpy(bsdf, detail);
        if (bsdf.type() == "normalmap") return normal_mapped(bsdf, detail);
        return basic(bsdf, detail);
    }();
    bsdf.finish();
    return made;
}

MaterialLibrary::Part MaterialLibrary::basic(Plugin& bsdf, const SurfaceDetail& detail) {
    constexpr std::array families{read_diffuse_base, read_conductor, read_dielectric, read_principled,
                                  read_measured};
    for (const auto& read : families) {
        std::optional<BasicMaterial> m = read(bsdf, context_);
        if (!m) continue;
        std::visit([&](auto& material) { material.detail = detail; }, m->material);
        return {.material = add(m->material, bsdf.id()), .one_sided = m->one_sided};
    }
    bsdf.refuse();
}

MaterialLibrary::Part MaterialLibrary::inner(Plugin& bsdf, const SurfaceDetail& detail) {
    const std::optional<Plugin> within = bsdf.child("bsdf");
    if (!within) bsdf.error(bsdf.describe() + " needs a BSDF within it");
    return part(*within, detail);
}

// A blend of "null" and another BSDF is a mask.
MaterialLibrary::Part MaterialLibrary::blend(Plugin& bsdf, const SurfaceDetail& detail) {
    const std::vector<Plugin> within = bsdf.children("bsdf");
    if (within.size() != 2)
        bsdf.error(bsdf.describe() + " has " + std::to_string(within.size()) +
                   " BSDFs within it; expected two");
    if (!bsdf.has("weight")) bsdf.error(bsdf.describe() + " needs the property 'weight'");
    const FloatParameter weight = textures_.number(bsdf, "weight", 0, unit_range);
    Part first = part(within[0], detail), second = part(within[1], detail);
    if (first.material == no_index && second.material == no_index) return {};
    if (first.material == no_index) {
        second.alpha = textures_.product(second.alpha, weight);
        return second;
    }
    if (second.material == no_index) {
        first.alpha = textures_.product(first.alpha, textures_.complement(weight));
        return first;
    }
    MixMaterial m;
    m.amount = weight;
    Part made{.alpha = first.alpha};
    if (!is_same(first.alpha, second.alpha)) {
        if (!first.alpha.is_constant() || !second.alpha.is_constant() || !weight.is_constant())
            bsdf.error("a blend of BSDFs with different masks is not supported where textures are involved");
        // Of what is not let through, the share of the second.
        made.alpha = {(1 - weight.value) * first.alpha.value + weight.value * second.alpha.value};
        if (made.alpha.value > 0) m.amount = {weight.value * second.alpha.value / made.alpha.value};
    }
    made.one_sided = first.one_sided && second.one_sided;
    m.materials.first.index = made.one_sided ? first.material : sided(first);
    m.materials.second.index = made.one_sided ? second.material : sided(second);
    made.material = add(m, bsdf.id());
    return made;
}

MaterialLibrary::Part MaterialLibrary::masked(Plugin& bsdf, const SurfaceDetail& detail) {
    Part made = inner(bsdf, detail);
    made.alpha = textures_.product(made.alpha, textures_.number(bsdf, "opacity", 0.5f, unit_range));
    return made;
}

MaterialLibrary::Part MaterialLibrary::two_sided(Plugin& bsdf, const SurfaceDetail& detail) {
    const std::vector<Plugin> within = bsdf.children("bsdf");
    if (within.empty() || within.size() > 2)
        bsdf.error(bsdf.describe() + " has " + std::to_string(within.size()) +
                   " BSDFs within it; expected one or two");
    const bool may_transmit = bsdf.flag("allow_transmission", false);
    std::vector<Part> sides;
    for (const Plugin& side : within) {
        sides.push_back(part(side, detail));
        if (sides.back().material == no_index || !is_one(sides.back().alpha))
            side.error(side.describe() + " lets light through; expected an opaque BSDF in 'twosided'");
        if (!sides.back().one_sided && !may_transmit)
            side.error(side.describe() + " has two sides already; expected a BSDF of one side in 'twosided'");
    }
    if (sides.size() == 1) return {.material = sides[0].material};
    SidedMaterial m;
    m.front.index = sides[0].material;
    m.back.index = sides[1].material;
    return {.material = add(m, bsdf.id())};
}

MaterialLibrary::Part MaterialLibrary::bumpy(Plugin& bsdf, SurfaceDetail detail) {
    if (!detail.displacement.is_constant()) bsdf.error("bump maps within one another are not supported");
    const std::optional<Plugin> texture = bsdf.child("texture");
    if (!texture) bsdf.error(bsdf.describe() + " needs a texture within it");
    const float scale = static_cast<float>(bsdf.number("scale", 1));
    read_tilt(bsdf, detail);
    detail.displacement = textures_.product({scale}, textures_.number(*texture));
    return inner(bsdf, detail);
}

MaterialLibrary::Part MaterialLibrary::normal_mapped(Plugin& bsdf, SurfaceDetail detail) {
    if (detail.normal_map.is_given()) bsdf.error("normal maps within one another are not supported");
    const std::optional<Plugin> map = bsdf.object("normalmap");
    if (!map || map->kind() != "texture") bsdf.error(bsdf.describe() + " needs a texture 'normalmap'");
    read_tilt(bsdf, detail);
    detail.normal_map.map = textures_.pictures().normal_map(*map);
    return inner(bsdf, detail);
}

} // namespace montelux::mitsuba
