// SceneBuilder: assembles a scene from the values of any format: shapes with their lights, objects, maps.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/scene/build/build_messages.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/build/geometry.h"
#include "montelux/scene/build/name_table.h"
#include "montelux/scene/content_digest.h"
#include "montelux/scene/scene.h"
#include "montelux/scene/shape/bounds.h"

namespace montelux {

// The attributes of a shape beside its geometry.
struct ShapeSettings {
    Index material = no_index; // must be set before the end
    FloatParameter alpha{1};
    bool flip_normal = false;           // Shape::flip_normal
    const Emission* emission = nullptr; // null: no emission
    MediumInterface media{};
    std::string name{}; // in the layer of shapes (scene_names.h); may be empty
};

// A reader calls it for each object in the file; `at` is its place, for messages. The builder checks what the
// renderer relies on in any format: indices, numbers, sizes. The syntax and its meaning are the reader's.
class SceneBuilder {
  public:
    // Both must outlive it. The scene need not be empty.
    SceneBuilder(Scene& scene, BuildMessages& messages) : scene_(scene), messages_(messages) {}

    Scene& scene() { return scene_; }

    // Adds a shape to the world, or to the open object. Errors as in check_geometry. What is refused, here and below,
    // leaves nothing in the scene.
    Index add_shape(Geometry geometry, const ShapeSettings& settings, SourceLocation at = {});

    // Adds a shape that moves: `geometry` is in its own space. In an open object the transformations lead into the
    // object's space, which may move as well, and it emits no light, with a warning.
    Index add_moving_shape(Geometry geometry, const ShapeSettings& settings, const Transform& start,
                           const Transform& end, SourceLocation at = {});

    // Shapes between these two calls form a group that instances refer to by name.
    void begin_object(const std::string& name, SourceLocation at = {});
    void end_object();
    bool in_object() const { return open_object_ != no_index; }
    // The object may be declared later.
    void add_instance(const std::string& object, const Transform& world_from_object, SourceLocation at = {});
    // An instance that moves.
    void add_instance(const std::string& object, const Transform& world_from_object_at_start,
                      const Transform& world_from_object_at_end, SourceLocation at = {});

    // `group`: of lights that share a layer (light_groups.h); may be empty.
    Index add_light(const Light& light, SourceLocation at = {}, const std::string& group = {});
    // A light that moves: `light` is in its own space (MovableLight). Errors: the light of a shape, which moves with the
    // shape, and an environment map with a portal.
    Index add_moving_light(const Light& light, const Transform& start, const Transform& end,
                           SourceLocation at = {}, const std::string& group = {});
    // A clear sky and, if requested and above the horizon, its sun. Luminances are multiplied by `scale` and the factor
    // of each, of which 0 means none; a positive illuminance replaces that of both on the ground.
    struct SkyLights {
        SkySettings settings;
        bool sun = true;
        float scale = 1, illuminance = 0;
        Transform world_from_light;                         // at the start
        std::string group{};                                // as of add_light
        std::optional<Transform> world_from_light_at_end{}; // of a sky that moves
        float sun_factor = 1, sky_factor = 1;
    };
    void add_sky(const SkyLights& sky, SourceLocation at = {});

    // Equal spectra share an entry of Scene::spectra.
    SceneSpectrum add_spectrum(const Spectrum& spectrum);
    // A picture for image textures. Non-finite values become 0, with a warning. Errors: neither RGB nor grey.
    // A large one is moved to Scene::texel_file, if there is one.
    // Messages call it `name`.
    Index add_image(Image picture, const std::string& name, SourceLocation at = {});
    // A picture as the map of an infinite light; R, G and B are linear. Negative values become 0, with a
    // warning. Errors: neither RGB nor grey, a shape of no EnvironmentLayout, non-finite values.
    Index add_environment(const Image& picture, const std::string& name, SourceLocation at = {});
    // The same of any size, for lights that project a picture.
    Index add_light_picture(const Image& picture, const std::string& name, SourceLocation at = {});

    // Resolves the instances and makes the remaining checks. `end` is the end of the file. Warns of a scene without
    // lights, unless they do not matter.
    void finish(SourceLocation end = {}, bool lights_matter = true);

  private:
    struct InstanceUse {
        Index object; // a reference of objects_
        Transform world_from_object;
        Index motion; // into motions_
        SourceLocation at;
    };
    // Shapes of an object with the same motion in its space.
    struct MovingPart {
        Index object; // of these shapes, into Scene::objects
        Motion motion;
    };
    // Both ends of its motion.
    using MotionKey = std::array<Matrix4, 2>;
    struct MotionOrder {
        bool operator()(const MotionKey& a, const MotionKey& b) const;
    };

    // Adds nothing to the scene.
    void check_shape(const Geometry& geometry, SourceLocation at) const;
    // Of the next shape; none where it does not emit. `dark`: why it cannot emit light; empty if it can. Adds nothing to
    // the scene.
    std::optional<AreaLight> area_light(const ShapeSettings& settings, const Geometry& geometry,
                                        std::string_view dark, SourceLocation at);
    // `new_shapes`: how many are added with it.
    void check_new_light(const Light& light, std::size_t new_shapes, SourceLocation at) const;
    // After the checks. `object`: into Scene::objects; no_index: to the world.
    Index add_shape_to(Index object, Geometry geometry, const ShapeSettings& settings,
                       const std::optional<AreaLight>& light, SourceLocation at);
    Motion motion(const Transform& start, const Transform& end, SourceLocation at) const;
    // None for an instance that stands still.
    std::optional<Motion> motion_of_instance(const Transform& start, const Transform& end,
                                             SourceLocation at) const;
    void use_object(const std::string& object, const Transform& at_start, std::optional<Motion> motion,
                    SourceLocation at);
    // The part of the open object with that motion.
    Index moving_part(const Transform& start, const Transform& end, SourceLocation at);
    void place_instance(const InstanceUse& use, Index object, const Transform& at_start,
                        std::optional<Motion> motion, const Bounds3& bounds);
    void check_part_count();
    void place_instances();

    Scene& scene_;
    BuildMessages& messages_;
    NameTable objects_{"object"};
    Index open_object_ = no_index;
    std::map<MotionKey, Index, MotionOrder> open_parts_; // of the open object: MovingPart::object
    std::map<Index, std::vector<MovingPart>> parts_;     // of objects
    std::vector<InstanceUse> instances_;
    std::vector<Motion> motions_;                    // of instances_
    std::map<ContentDigest, SceneSpectrum> spectra_; // added so far
    std::size_t emissive_primitives_ = 0;
};

// The linear channels R, G, B of a picture, or three times its Y; empty where it has neither.
Image rgb_map(const Image& picture);

} // namespace montelux
