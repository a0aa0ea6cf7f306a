// Materials from MTL files (Wavefront, "Material Library File (.mtl)"), with the statements for physically based ones
// that Clara.io proposed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "montelux/formats/warnings.h"
#include "montelux/mc/math/vec.h"

namespace montelux {

// A picture with its options; empty `file`: none.
struct MtlMap {
    std::string file;
    std::size_t line = 1;
    Vec2f scale{1, 1}, offset; // -s, -o: texture coordinates are scaled, then moved
    bool clamp = false;        // -clamp on
    float bumps = 1;           // -bm
};

// Statements that are missing leave their defaults.
struct MtlMaterial {
    std::string name;
    std::size_t line = 1;
    std::optional<Vec3f> diffuse, specular, emission; // Kd, Ks, Ke; linear sRGB
    std::optional<float> exponent;                    // Ns, of Phong's lobe
    std::optional<float> ior;                         // Ni
    float opacity = 1;                                // d, or 1 - Tr
    std::optional<int> illumination;                  // illum
    std::optional<float> roughness, metallic, sheen;  // Pr, Pm, Ps
    float coat = 0, coat_roughness = 0;               // Pc, Pcr
    float anisotropy = 0, anisotropy_turns = 0;       // aniso, anisor
    MtlMap diffuse_map, opacity_map, bump_map, normal_map;
    MtlMap roughness_map, metallic_map, sheen_map; // map_Pr, map_Pm, map_Ps

    // Whether any of the statements for physically based materials is there.
    bool is_physically_based() const {
        return roughness || metallic || sheen || coat > 0 || anisotropy != 0 || !roughness_map.file.empty() ||
               !metallic_map.file.empty() || !sheen_map.file.empty();
    }
};

// Ka, Tf, sharpness and maps of other statements have no effect. Warns once of each statement that is not
// read. Throws Error "name:line: sentence" for numbers that cannot be read or are out of range.
std::vector<MtlMaterial> parse_mtl(std::span<const std::uint8_t> bytes, std::string_view name,
                                   Warnings& warnings);

} // namespace montelux
