// Directives: executes the directives of a pbrt scene file one by one.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "montelux/formats/pbrt/graphics_state.h"
#include "montelux/formats/pbrt/materials.h"
#include "montelux/formats/pbrt/media.h"
#include "montelux/formats/pbrt/settings.h"
#include "montelux/formats/pbrt/shapes.h"
#include "montelux/formats/pbrt/textures.h"
#include "montelux/scene/build/scene_builder.h"

namespace montelux::pbrt {

// Each function is one directive; `at` is its place. Geometry and lights are created at once; materials,
// textures and instances at the end of the file, since they may be named before they are declared.
class Directives {
  public:
    // `texel_file` becomes Scene::texel_file.
    Directives(Files& files, Diagnostics& diagnostics, std::shared_ptr<TexelFile> texel_file);

    // Blocks.
    void world_begin(Location at);
    void attribute_begin(Location at);
    void attribute_end(Location at);
    void object_begin(const std::string& name, Location at);
    void object_end(Location at);
    void object_instance(const std::string& name, Location at);
    // Changes by an imported file end with it: begin_import returns what end_import needs.
    struct Import {
        GraphicsState state;
        std::size_t outer_floor;
        std::size_t replaced_systems;
    };
    Import begin_import(Location at);
    void end_import(Import import);

    // Transformations.
    void concatenate(const Transform& t, Location at);
    void set_transform(const Transform& t, Location at);
    void active_transform(std::string_view which, Location at);
    void transform_times(double start, double end, Location at);
    void coordinate_system(const std::string& name);
    void coordinate_system_transform(const std::string& name, Location at);
    void reverse_orientation(Location at);

    // Before the world.
    void set_camera(Plugin plugin);
    void set_film(Plugin plugin);
    void set_filter(Plugin plugin) { set_option(filter_, std::move(plugin), "PixelFilter"); }
    void set_sampler(Plugin plugin) { set_option(sampler_, std::move(plugin), "Sampler"); }
    void set_integrator(Plugin plugin) { set_option(integrator_, std::move(plugin), "Integrator"); }
    void set_accelerator(const Plugin& plugin);
    void set_render_option(const Parameter& p);

    // Anywhere.
    void set_color_space(std::string_view name, Location at);
    const RgbColorSpace& color_space() const { return *state_.color_space; }
    void add_defaults(std::string_view target, std::vector<Parameter> parameters, Location at);

    void make_named_medium(const std::string& name, std::vector<Parameter> parameters, Location at);
    // Of following shapes; that of the camera is outside.
    void medium_interface(const std::string& inside, const std::string& outside);

    // In the world.
    void material(std::string type, std::vector<Parameter> parameters, Location at);
    void make_named_material(const std::string& name, std::vector<Parameter> parameters, Location at);
    void named_material(const std::string& name, Location at);
    void texture(const std::string& name, std::string_view type, std::string plugin,
                 std::vector<Parameter> parameters, Location at);
    void light_source(std::string name, std::vector<Parameter> parameters, Location at);
    void area_light_source(std::string name, std::vector<Parameter> parameters, Location at);
    void shape(const std::string& name, std::vector<Parameter> parameters, Location at);

    bool in_world() const { return in_world_; }
    // After the last file. `end` is the place of its end.
    SceneDescription finish(Location end);

  private:
    struct Block {
        enum class Kind : std::uint8_t { attribute, object } kind;
        Location at;
        GraphicsState state;
    };
    struct MaterialUse {
        Index shape;
        MaterialReference material;
        Location at;
    };
    struct MediaUse {
        Index shape;
        MediaReference media;
        Location at;
    };
    // The shape of curves that was read last, and what else curves must share to belong to it: a head of hair
    // in a file is one shape 'curve' for each hair.
    struct OpenCurves {
        Index shape;
        MaterialReference material;
        MediaReference media;
        Curves::Kind kind;
        bool flip_normal;
        float alpha;
        std::string name;

        bool operator==(const OpenCurves&) const = default;
    };
    struct AlphaUse {
        Index shape;
        ParameterList parameters;
        std::string plugin;
        Location at;
    };

    void require_world(std::string_view directive, Location at) const;
    void require_options(std::string_view directive, Location at) const;
    void set_option(std::optional<Plugin>& option, Plugin plugin, std::string_view directive);
    void push(Block::Kind kind, Location at);
    void pop(Block::Kind kind, std::string_view directive, Location at);
    bool is_moving() const;
    // The transformation of what cannot move, with a warning if the file moves it.
    const Transform& start_transform(std::string_view what, Location at) const;
    ParameterList with_defaults(std::vector<Parameter> own, PluginKind kind) const;
    void finish_options();
    void finish_materials();
    void finish_media();
    // The medium inside shapes with a material, or no_index; ambiguous if its parts have several.
    struct Interior {
        Index medium = no_index;
        bool ambiguous = false;
    };
    // Of all materials.
    std::vector<Interior> interiors() const;
    bool joins_open_curves(const Geometry& geometry, const ShapeSettings& settings, bool is_plain,
                           Location at);
    // `by` names the referrer in messages.
    Index material_index(const MaterialReference& reference, Location at,
                         std::string_view by = "this shape's ");

    Files& files_;
    Diagnostics& diagnostics_;
    SceneDescription result_;
    SceneBuilder builder_;
    SpectrumReader spectra_;
    TextureLibrary textures_;
    DisplacementReader displacements_;
    MeasuredBrdfLibrary measured_brdfs_;
    LightReader lights_;
    MediumReader media_;

    GraphicsState state_;
    std::vector<Block> blocks_;
    std::size_t block_floor_ = 0; // blocks below it belong to the file that imports this one
    bool in_world_ = false;
    std::map<std::string, std::shared_ptr<const TransformPair>> coordinate_systems_;
    // Previous values that the imported files being read have replaced; null if there was none.
    std::vector<std::pair<std::string, std::shared_ptr<const TransformPair>>> replaced_systems_;
    std::size_t open_imports_ = 0;
    std::optional<Plugin> camera_, film_, filter_, sampler_, integrator_;
    Location integrator_at_{};
    std::optional<std::uint64_t> seed_;
    double transform_start_ = 0, transform_end_ = 1;

    std::vector<MaterialDeclaration> materials_;
    std::vector<Index> material_indices_; // into Scene::materials, of each declaration
    std::vector<Index> open_materials_;   // declarations that are being made
    NameTable named_materials_{"material"};
    std::vector<MaterialUse> material_uses_;
    std::vector<AlphaUse> alpha_uses_;
    std::optional<OpenCurves> open_curves_;
    NameTable named_media_{"medium"};
    std::vector<MediaUse> media_uses_; // of shapes in or between media
    MediaUse camera_media_{no_index, {}, {}};
    SubdivisionBudget subdivision_; // of 'loopsubdiv' shapes
};

} // namespace montelux::pbrt
