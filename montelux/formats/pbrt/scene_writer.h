// SceneWriter: turns the values of a scene into directives, one file of functions for each kind.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/pbrt/directive_text.h"
#include "montelux/formats/pbrt/side_files.h"
#include "montelux/formats/warnings.h"
#include "montelux/mc/io/file.h"
#include "montelux/scene/material/parameter.h"
#include "montelux/scene/render_settings.h"

namespace montelux::pbrt {

// A vector that `unit` brings to exactly `wanted`, which is of unit length; `wanted` itself where there is none near.
template <typename Unit>
Vec3f direction_giving(Vec3f wanted, const Unit& unit) {
    for (int k = 0; k < 4096; ++k)
        if (const Vec3f v = wanted * (1 + static_cast<float>(k) / 1024); unit(v) == wanted) return v;
    return wanted;
}

class SceneWriter {
  public:
    // All must outlive it; the directives go to `out`.
    SceneWriter(const SceneDescription& description, SideFiles& files, Warnings& warnings, AtomicFile& out)
        : description_(description), scene_(description.scene), files_(files), warnings_(warnings),
          out_(out) {}

    void write();

  private:
    void put(std::string_view text) { out_.write(text.data(), text.size()); }
    // Between AttributeBegin and AttributeEnd.
    void put_block(std::string_view text);
    void warn(const std::string& what, const std::string& sentence) { warnings_.add(what, sentence); }

    // scene_writer.cpp: spectra and pictures.
    // Of a parameter whose RGB colours have that meaning; `what` is for warnings.
    void spectrum(DirectiveText& d, std::string_view name, SceneSpectrum s, RgbMeaning meaning,
                  const std::string& what);
    void spectrum(DirectiveText& d, std::string_view name, const Spectrum& s, RgbMeaning meaning,
                  const std::string& what);
    void tabulated(DirectiveText& d, std::string_view name, const Spectrum& s, const std::string& what);
    // Of Scene::images; writes it at the first call.
    std::string image_file(Index image);
    // The parameter 'encoding' that the picture needs, unless it is the file's own.
    std::optional<std::string> encoding_of(Index image) const;
    std::string environment_file(Index environment);

    // settings_writer.cpp
    void camera();
    void perspective(DirectiveText& d, float lens_radius, float focal_distance, std::optional<float> aspect,
                     const std::optional<ScreenWindow>& window);
    void realistic(DirectiveText& d, const RealisticCamera& camera);
    void film();
    void filter();
    void sampler();
    void integrator();

    // texture_writer.cpp: names of textures; each is written at the first call.
    std::string float_texture(Index i);
    std::string spectrum_texture(Index i, RgbMeaning meaning);
    // Of Scene::normal_maps: whether pbrt-v4 says the same with the picture alone.
    bool is_plain_normal_map(Index i) const;
    std::string normal_map_texture(Index i);
    template <typename Parameter>
    void texture(const TextureNode<Parameter>& node, const std::string& name, RgbMeaning meaning);
    void mapping(DirectiveText& d, std::string& transform, const TextureMapping& m);
    void image_texture(DirectiveText& d, std::string& transform, const ImageTexture& t, bool is_float);
    void parameter(DirectiveText& d, std::string_view name, const FloatParameter& p, float otherwise,
                   RgbMeaning = RgbMeaning::albedo);
    void parameter(DirectiveText& d, std::string_view name, const SpectrumParameter& p, float otherwise,
                   RgbMeaning meaning);

    // material_writer.cpp
    void materials();
    void material(Index i);
    std::string measured_file(Index brdf);
    void subsurface(DirectiveText& d, Index medium, float eta);
    friend class MaterialParameters;

    // medium_writer.cpp
    void media();
    void medium(Index i);
    void sparse_grid(DirectiveText& d, std::string& transform, const SparseGridMedium& m,
                     const std::string& what);
    void emission(DirectiveText& d, SceneSpectrum le, float scale, const std::string& what);
    std::string interface_text(const MediumInterface& media) const;

    // light_writer.cpp
    // Those before `end` that are not written yet.
    void lights_before(std::size_t end);
    void light(std::size_t i);
    void source(DirectiveText& d, std::string_view name, SceneSpectrum s, float scale,
                const std::string& what, std::string_view second = {}, float per_unit = 0);
    void map_scale(DirectiveText& d, float scale, float unit, const std::string& what, double flux,
                   std::string_view second);
    bool is_sun_of(std::size_t sun, std::size_t sky) const;
    void sky(std::size_t i, const SkyLight& light, const std::string& transform);
    std::string area_light(Index i, bool is_quadric, float area);
    void group(DirectiveText& d, std::size_t light) const;

    // shape_writer.cpp
    void shapes();
    void instances_before(std::size_t end);
    void instance(std::size_t i);
    void shape(Index i, const Instance* moving);
    std::string shape_text(Index i, bool reverse);
    std::string mesh_text(Index i, const TriangleMesh& mesh, bool reverse);
    void curves_text(std::vector<std::string>& texts, const Curves& curves) const;
    void shape_attributes(DirectiveText& d, Index i);

    const SceneDescription& description_;
    const Scene& scene_;
    SideFiles& files_;
    Warnings& warnings_;
    AtomicFile& out_;

    std::map<Index, std::string> image_files_, environment_files_, measured_files_;
    std::set<Index> float_textures_, spectrum_textures_, normal_maps_; // written
    std::vector<std::string> material_names_;
    std::size_t lights_ = 0, instances_ = 0; // written
    std::vector<std::string> object_names_;
};

} // namespace montelux::pbrt
