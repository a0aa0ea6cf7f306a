// MixMaterial: one of two materials at each point.
#pragma once

#include <bit>
#include <cstdint>

#include "montelux/mc/random/hash.h"
#include "montelux/mc/random/uniform_bits.h"
#include "montelux/scene/bsdf/bsdf_list.h"
#include "montelux/scene/material/surface_detail.h"

namespace montelux {

// A point has the second material with probability `amount`, decided by a hash of the point and the direction:
// the mean over a small area is the mixture, and a path does not depend on who follows it. make_bsdf makes
// the BSDF of the chosen material.
struct MixMaterial {
    static constexpr const char* name = "Mix";
    static constexpr const char* doc = "One of two materials at each point, at random.";

    MixedMaterials materials{};
    FloatParameter amount{0.5f};
    SurfaceDetail detail{}; // without effect: the chosen material has its own

    template <typename Self, typename Visit>
    static void visit_parameters(Self& m, Visit&& visit) {
        visit({.name = "materials"}, m.materials);
        visit({.name = "amount", .doc = "Share of the second material, 0 to 1.", .least = 0, .most = 1},
              m.amount);
    }

    // `salt` differs between the mixes of a scene, so that nested ones choose independently.
    Index choose(float share, Vec3f p, Vec3f wo, Index salt) const {
        std::uint64_t key = salt;
        for (const Vec3f v : {p, wo})
            for (int axis = 0; axis < 3; ++axis) key = hash_key(key, std::bit_cast<std::uint32_t>(v[axis]));
        return unit_double(hash_key(key)) < static_cast<double>(share) ? materials.second.index
                                                                       : materials.first.index;
    }

    // For the concept: no path asks for it.
    DiffuseBsdf bsdf(const ParameterEvaluator&) const;
};

} // namespace montelux
