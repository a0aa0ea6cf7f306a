// Casters: the smooth surfaces and small lights that specular manifold sampling joins.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "montelux/mc/dist/alias_table.h"
#include "montelux/mc/random/philox_stream.h"
#include "montelux/scene/light/sampler/power_light_sampler.h"
#include "montelux/scene/shape/quadric.h"
#include "montelux/scene/view.h"

namespace montelux {

// Triangles of a mesh, chosen by area.
struct CasterMesh {
    Index mesh = no_index;
    AliasTable triangles;
};

// A shape that reflects or refracts without roughness, in the world and at rest.
struct Caster {
    Index shape = no_index;
    std::variant<CasterMesh, WorldSphere, WorldDisk> geometry;
    bool flipped = false; // Shape::flip_normal
    double area = 0;
    double eta = 0; // index of refraction below the normal over that above; 0: reflects alone
};

// A point of a caster with the derivatives of position and unit shading normal along two coordinates.
struct CasterPoint {
    Vec3d p{}, n{};
    Vec3d dpdu{}, dpdv{}, dndu{}, dndv{};
    Index primitive = 0;
    double b1 = 0, b2 = 0; // of triangles: the coordinates

    double area_element() const { return length(cross(dpdu, dpdv)); }
};

// Uniform over the area.
CasterPoint sample_point(const SceneView& scene, const Caster& caster, PhiloxStream& stream);
// Of a mesh. The coordinates may be outside the triangle.
CasterPoint mesh_point(const SceneView& scene, const Caster& caster, Index primitive, double b1, double b2);
// Of spheres and discs: the point nearest to p. The disc is continued beyond its edge.
CasterPoint quadric_point(const Caster& caster, Vec3d p);
// False beyond the edge of a disc.
bool contains(const Caster& caster, const CasterPoint& point);

class Casters {
  public:
    // Casters are all shapes in the world of smooth dielectrics and conductors on meshes, whole spheres and discs that
    // neither move nor have holes, bumps, a normal map or an index of refraction that depends on the wavelength.
    explicit Casters(const SceneView& scene);

    const std::vector<Caster>& all() const { return casters_; }
    // Without a pair of a caster and a light nothing can be sampled.
    bool empty() const { return casters_.empty() || !lights_; }

    bool has(Index shape) const { return is_caster_[shape] != 0; }
    // Whether its light is sampled: lights with a position, distant ones, the sun, and surfaces of the world that
    // neither move nor have holes.
    bool covers(Index light) const { return covered_[light] != 0; }

    struct Choice {
        const Caster* caster;
        double probability;
    };
    // Half of them in proportion to area, half all alike: neither a large surface far away nor one without effect keeps
    // others from being chosen.
    Choice choose_caster(double u) const {
        const auto chosen = choice_->sample(u);
        return {&casters_[chosen.index], chosen.probability};
    }
    // Among the parts of covered lights, half in proportion to power and half all alike.
    LightChoice choose_light(double u) const { return lights_->sample({}, u); }

  private:
    std::vector<Caster> casters_;
    std::vector<char> is_caster_, covered_; // of each shape, of each light: 0 or 1
    std::optional<AliasTable> choice_;      // of a caster
    std::optional<PowerLightSampler> lights_;
};

} // namespace montelux
