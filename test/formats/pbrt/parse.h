// Fixtures of the pbrt tests: scenes from text, their values, and the error message of a broken one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "montelux/formats/pbrt/load_pbrt.h"
#include "montelux/mc/math/error.h"

namespace montelux::test {

inline SceneDescription parse(std::string_view text, Warnings* warnings = nullptr) {
    Warnings ignored;
    return parse_pbrt(text, "scene", ".", warnings ? *warnings : ignored);
}

// The scene with `world` after WorldBegin, which is on line 1.
inline SceneDescription parse_world(std::string_view world, Warnings* warnings = nullptr) {
    return parse("WorldBegin\n" + std::string(world), warnings);
}

// The quadric with that index.
inline const Sphere& sphere(const SceneDescription& d, std::size_t i = 0) {
    return std::get<Sphere>(d.scene.quadrics.at(i));
}

// A material or light of type T, with the spectra of its scene.
template <typename T>
struct WithSpectra : T {
    std::vector<Spectrum> spectra;

    Spectrum of(SceneSpectrum s) const { return spectrum_of(s, spectra); }
};

// The parser's error message; empty if there is none.
inline std::string error_of(std::string_view text) {
    try {
        parse(text);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}
inline std::string world_error(std::string_view world) {
    return error_of("WorldBegin\n" + std::string(world));
}

} // namespace montelux::test
