// SceneBuilder: puts a scene together from the values of any format: shapes with their lights, objects, maps.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "montelux/scene/build/build_messages.h"
#include "montelux/scene/build/emission.h"
#include "montelux/scene/build/geometry.h"
#include "montelux/scene/build/name_table.h"
#include "montelux/scene/scene.h"

namespace montelux {

// What a shape is beside its geometry.
struct ShapeSettings {
    Index material = no_index; // to be set until the end
    FloatParameter alpha{1};
    bool flip_normal = false;           // Shape::flip_normal
    const Emission* emission = nullptr; // null: it does not shine
};

// A reader calls it for each thing that it finds; `at` is where the file has it, for messages. It checks what
// the renderer relies on, whatever the format: indices, numbers, sizes. What a file may say and how it is
// meant is the reader's.
class SceneBuilder {
  public:
    // Both outlive it. The scene may hold values already.
    SceneBuilder(Scene& scene, BuildMessages& messages) : scene_(scene), messages_(messages) {}

    Scene& scene() { return scene_; }

    // A shape in the world, or in the object that is open. Errors as check_geometry says.
    Index add_shape(Geometry geometry, const ShapeSettings& settings, SourceLocation at = {});

    // Shapes between these two are a group, which instances place by its name.
    void begin_object(const std::string& name, SourceLocation at = {});
    void end_object() { open_object_ = no_index; }
    bool in_object() const { return open_object_ != no_index; }
    // The object may be declared later.
    void add_instance(const std::string& object, const Transform& world_from_object, SourceLocation at = {});

    Index add_light(Light light, SourceLocation at = {});
    // A clear sky and, if asked for and above the horizon, its sun. Luminances are multiplied by `scale`; an
    // illuminance above zero is what both together give to the ground instead.
    struct SkyLights {
        SkySettings settings;
        bool sun = true;
        float scale = 1, illuminance = 0;
        Transform world_from_light;
    };
    void add_sky(const SkyLights& sky, SourceLocation at = {});

    // A picture for image textures. Values that are not finite become 0, with a warning. Errors: it is neither
    // RGB nor grey. `name` is what messages call it.
    Index add_image(Image picture, const std::string& name, SourceLocation at = {});
    // A picture as the map of an infinite light, R, G and B linear. Negative values become 0, with a warning.
    // Errors: neither RGB nor grey, a shape of no EnvironmentLayout, values that are not finite.
    Index add_environment(const Image& picture, const std::string& name, SourceLocation at = {});

    // Places the instances and checks what could not be checked before. `end` is where the file ends.
    void finish(SourceLocation end = {});

  private:
    struct InstanceUse {
        Index object; // a reference of objects_
        Transform world_from_object;
        SourceLocation at;
    };
    void add_area_light(Index shape, const Emission& emission, const Geometry& geometry, SourceLocation at);
    void place_instances();

    Scene& scene_;
    BuildMessages& messages_;
    NameTable objects_{"object"};
    Index open_object_ = no_index;
    std::vector<InstanceUse> instances_;
    std::size_t emissive_primitives_ = 0;
};

// The linear channels R, G, B of a picture, or three times its Y; empty where it has neither.
Image rgb_map(const Image& picture);

} // namespace montelux
