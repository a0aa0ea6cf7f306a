#include "montelux/scene/scene_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <tuple>

#include "montelux/mc/math/vector_bytes.h"
#include "montelux/mc/parallel/parallel_for.h"
#include "montelux/scene/light/light_sampling.h"
#include "montelux/scene/light/motion_bounds.h"
#include "montelux/scene/light/scene_disk.h"
#include "montelux/scene/material/material_model.h"

namespace montelux {

namespace {

using CoatingKey = std::tuple<float, float, float, int>;             // eta, alpha, thickness, max_depth
using PlasticKey = std::tuple<float, float, MicrofacetDistribution>; // eta, alpha

// Tables of one kind, one for each key.
template <typename Table, typename Key>
class TablesByKey {
  public:
    Index index_of(const Key& key) {
        const auto [found, inserted] = index_of_.try_emplace(key, static_cast<Index>(keys_.size()));
        if (inserted) keys_.push_back(key);
        return found->second;
    }
    std::vector<Table> tables() const {
        std::vector<std::optional<Table>> made(keys_.size());
        parallel_for(static_cast<std::int64_t>(keys_.size()), [&](std::int64_t i) {
            const auto n = static_cast<std::size_t>(i);
            std::apply([&](const auto&... values) { made[n].emplace(values...); }, keys_[n]);
        });
        std::vector<Table> result;
        result.reserve(made.size());
        for (auto& table : made) result.push_back(std::move(*table));
        return result;
    }

  private:
    std::map<Key, Index> index_of_;
    std::vector<Key> keys_;
};

// The coating's parameters if CoatingTable's closed form applies: constant over the surface, isotropic, with
// a clear layer, no dispersion and no scattering between microfacets.
std::optional<CoatingKey> closed_form(const SceneView& scene, const Material& material,
                                      MicrofacetScattering microfacets) {
    const auto* m = std::get_if<CoatedDiffuseMaterial>(&material);
    if (m == nullptr) return std::nullopt;
    const CoatingParameters& c = m->coating;
    bool constant = c.roughness.u.is_constant() && c.roughness.v.is_constant() && c.thickness.is_constant() &&
                    c.albedo.is_constant() && scene.is_constant(c.eta);
    if (!constant || c.roughness.u.value != c.roughness.v.value ||
        scene.spectrum(c.albedo.value).max_value() > 0)
        return std::nullopt;
    float alpha = c.roughness.u.value;
    if (c.roughness.remap) alpha = Ggx::alpha_from_roughness(alpha);
    if (microfacets == MicrofacetScattering::multiple && !Ggx{alpha, alpha}.is_smooth()) return std::nullopt;
    float eta = scene.spectrum(c.eta)(550);
    if (!(eta > 0)) return std::nullopt;
    return CoatingKey{eta, alpha, std::max(c.thickness.value, 0.0f), c.max_depth};
}

// The sum over 2^32 parts is finite.
constexpr double most_power = 1e290;

// One part needs no choice. Two are chosen by their power, where a tree gains less than it costs, unless one alone is
// infinite: the power that it sends through the scene says nothing about the light at a point.
bool wants_tree(const LightParts& parts, const TreeLightSampler::BoundsOfRow& bounds) {
    if (parts.size() != 2) return parts.size() > 2;
    return bounds(0).has_value() != bounds(1).has_value();
}

std::vector<Index> part_counts(const SceneView& scene) {
    std::vector<Index> counts;
    for (Index i = 0; i < static_cast<Index>(scene.lights.size()); ++i)
        counts.push_back(part_count({scene, i}));
    return counts;
}

std::vector<double> part_powers(const SceneView& scene, std::span<const Index> counts,
                                const LightParts& parts) {
    std::vector<double> all(parts.size());
    for (Index i = 0; i < static_cast<Index>(counts.size()); ++i)
        if (counts[i] > 0) light_powers({scene, i}, std::span(all).subspan(parts.row(i, 0), counts[i]));
    // Estimates that overflow still choose the light; a NaN leaves it to scattering.
    for (double& power : all) power = power > 0 ? std::min(power, most_power) : 0;
    return all;
}

LightSampler make_light_sampler(const SceneView& scene, LightSampling sampling) {
    const std::vector<Index> counts = part_counts(scene);
    LightParts parts(counts);
    if (sampling == LightSampling::uniform) return LightSampler(UniformLightSampler(std::move(parts)));
    const std::vector<double> all = part_powers(scene, counts, parts);
    const auto bounds = [&](Index row) {
        const LightChoice at = parts.at(row);
        return motion_bounds({scene, at.light}, at.part);
    };
    if (sampling == LightSampling::tree && wants_tree(parts, bounds)) {
        const double area = SceneDisk(scene.light_tables.scene_bounds).area();
        if (std::any_of(all.begin(), all.end(), [](double power) { return power > 0; }))
            return LightSampler(TreeLightSampler(parts, all, bounds, area));
    }
    return LightSampler(PowerLightSampler(std::move(parts), all));
}

// Of lights with a position, if a medium scatters light on its way from them.
std::optional<PowerLightSampler> make_segment_lights(const SceneView& scene) {
    const bool scatters = std::ranges::any_of(scene.media, [](const Medium& medium) {
        const auto* m = std::get_if<HomogeneousMedium>(&medium);
        return m == nullptr || !m->is_body;
    });
    if (!scatters) return std::nullopt;
    const std::vector<Index> counts = part_counts(scene);
    LightParts parts(counts);
    // Maps at infinity take long to sum up, and are not wanted.
    std::vector<Index> with_position = counts;
    for (Index i = 0; i < static_cast<Index>(counts.size()); ++i)
        if (counts[i] > 0 && !light_bounds({scene, i}, 0)) with_position[i] = 0;
    const std::vector<double> powers = part_powers(scene, with_position, parts);
    if (std::ranges::none_of(powers, [](double power) { return power > 0; })) return std::nullopt;
    return PowerLightSampler(std::move(parts), powers);
}

} // namespace

SceneTables::SceneTables(const Scene& scene, const EnvironmentSettings& environments,
                         LightSampling light_sampling, const SurfaceSettings& surfaces, bool traces_light)
    : lights_(scene, environments) {
    add_mipmaps(scene);
    add_materials(scene);
    add_coatings(scene, surfaces.microfacets);
    add_media(scene);
    view_ = SceneView(scene);
    view_.multiple_scattering = surfaces.microfacets == MicrofacetScattering::multiple;
    view_.soft_terminator = surfaces.terminator == ShadingTerminator::soft;
    view_.textured = textured_;
    view_.follows_tangents = follows_tangents_;
    view_.coating_of_material = coating_of_material_;
    view_.coating_tables = coatings_;
    view_.plastic_tables = plastics_;
    view_.mipmaps = mipmaps_;
    view_.alpha_mipmap_of_image = alpha_mipmap_of_image_;
    view_.alpha_mipmaps = alpha_mipmaps_;
    view_.medium_tables = media_;
    view_.light_tables = lights_.view(scene);
    light_sampler_ = make_light_sampler(view_, light_sampling);
    view_.light_sampler = &light_sampler_;
    segment_lights_ = make_segment_lights(view_);
    if (segment_lights_) view_.segment_lights = &*segment_lights_;
    if (traces_light) {
        const std::vector<Index> counts = part_counts(view_);
        LightParts parts(counts);
        const std::vector<double> powers = part_powers(view_, counts, parts);
        emitting_lights_.emplace(std::move(parts), powers);
        view_.emitting_lights = &*emitting_lights_;
    }
}

void SceneTables::add_mipmaps(const Scene& scene) {
    std::vector<std::optional<MipMap>> mipmaps(scene.images.size());
    parallel_for(static_cast<std::int64_t>(scene.images.size()), [&](std::int64_t i) {
        const Image& image = scene.images[static_cast<std::size_t>(i)];
        if (!image.file()) mipmaps[static_cast<std::size_t>(i)].emplace(image);
    });
    // Those in a file are built by several threads each.
    for (std::size_t i = 0; i < mipmaps.size(); ++i)
        if (!mipmaps[i]) mipmaps[i].emplace(scene.images[i]);
    mipmaps_.reserve(mipmaps.size());
    for (auto& m : mipmaps) mipmaps_.push_back(std::move(*m));
    alpha_mipmap_of_image_.assign(scene.images.size(), no_index);
    for (const FloatTexture& texture : scene.float_textures)
        if (const auto* t = std::get_if<ImageTexture>(&texture))
            if (t->channels == ImageChannels::alpha && alpha_mipmap_of_image_[t->image] == no_index) {
                alpha_mipmap_of_image_[t->image] = static_cast<Index>(alpha_mipmaps_.size());
                alpha_mipmaps_.emplace_back(scene.images[t->image], ImageChannels::alpha);
            }
}

void SceneTables::add_media(const Scene& scene) {
    for (const Medium& medium : scene.media)
        media_.push_back(std::visit([&](const auto& m) { return m.table(scene); }, medium));
}

// The interior of a translucent body depends on the surface.
bool has_textured_body(const Scene& scene, const Material& material) {
    const auto* m = std::get_if<SubsurfaceMaterial>(&material);
    if (m == nullptr || !m->interior.is_given()) return false;
    const auto* body = std::get_if<HomogeneousMedium>(&scene.media[m->interior.index]);
    return body != nullptr && body->surface.is_given();
}

void SceneTables::add_materials(const Scene& scene) {
    for (const Material& material : scene.materials) {
        textured_.push_back(uses_coordinates(material) || has_textured_body(scene, material) ? 1 : 0);
        follows_tangents_.push_back(has_textured_bsdf(material) || is_anisotropic(material) ? 1 : 0);
    }
    // A surface shows its material's parts: as many rounds as they are nested.
    const auto add = [](std::vector<char>& flags, std::size_t i, Index part) {
        const bool news = flags[part] > flags[i];
        flags[i] = std::max(flags[i], flags[part]);
        return news;
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < scene.materials.size(); ++i)
            visit_parts(scene.materials[i], [&](Index part) {
                changed |= add(textured_, i, part);
                changed |= add(follows_tangents_, i, part);
            });
    }
}

void SceneTables::add_coatings(const Scene& scene, MicrofacetScattering microfacets) {
    TablesByKey<CoatingTable, CoatingKey> coatings;
    TablesByKey<PlasticTable, PlasticKey> plastics;
    for (const Material& material : scene.materials) {
        Index table = no_index;
        if (const auto key = closed_form(SceneView(scene), material, microfacets))
            table = coatings.index_of(*key);
        else if (const auto* m = std::get_if<PlasticMaterial>(&material))
            table = plastics.index_of({m->eta, m->alpha, m->distribution});
        coating_of_material_.push_back(table);
    }
    coatings_ = coatings.tables();
    plastics_ = plastics.tables();
}

std::vector<MemoryUse> SceneTables::memory_use() const {
    std::size_t pyramids = vector_bytes(mipmaps_, alpha_mipmaps_, alpha_mipmap_of_image_),
                coatings = vector_bytes(coatings_, plastics_), media = vector_bytes(media_);
    for (const MipMap& m : mipmaps_) pyramids += m.bytes();
    for (const MipMap& m : alpha_mipmaps_) pyramids += m.bytes();
    for (const CoatingTable& c : coatings_) coatings += c.bytes();
    for (const PlasticTable& p : plastics_) coatings += p.bytes();
    for (const MediumTable& m : media_) media += vector_bytes(m.majorants.values);
    std::vector<MemoryUse> table;
    const auto add = [&](std::string_view kind, std::size_t bytes, std::size_t count, std::string_view unit) {
        if (count > 0) table.push_back({kind, bytes, count, unit});
    };
    add("pyramids of images", pyramids, mipmaps_.size() + alpha_mipmaps_.size(), "pyramids");
    add("tables of coatings", coatings, coatings_.size() + plastics_.size(), "tables");
    add("bounds of media", media, media_.size(), "media");
    add("tables of lights", lights_.bytes(), view_.lights.size(), "lights");
    add("choice of lights", light_sampler_.bytes(), light_sampler_.size(), "parts of lights");
    return table;
}

} // namespace montelux
