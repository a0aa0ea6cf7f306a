// SceneSpectrum: a spectrum of a material, texture or light: a constant, or one of Scene::spectra.
#pragma once

#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "montelux/scene/index.h"
#include "montelux/spectrum/spectrum.h"

namespace montelux {

// Keeps what refers to it trivially copyable; a Spectrum may own a table.
struct SceneSpectrum {
    float constant = 0;     // ignored if there is an index
    Index index = no_index; // into Scene::spectra

    // Black.
    SceneSpectrum() = default;
    SceneSpectrum(float value) : constant(value) {}
    static SceneSpectrum at(Index index) {
        SceneSpectrum s;
        s.index = index;
        return s;
    }

    bool is_constant() const { return index == no_index; }
};
static_assert(std::is_trivially_copyable_v<SceneSpectrum>);

// Its value, for tables; samples use SceneView::sample, which copies no Spectrum.
inline Spectrum spectrum_of(SceneSpectrum s, std::span<const Spectrum> spectra) {
    return s.is_constant() ? Spectrum(s.constant) : spectra[s.index];
}

// Refers to a spectrum: a constant by its value, others as a new entry of `spectra`.
inline SceneSpectrum add_spectrum(std::vector<Spectrum>& spectra, Spectrum spectrum) {
    if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum.kind())) return constant->value;
    spectra.push_back(std::move(spectrum));
    return SceneSpectrum::at(static_cast<Index>(spectra.size() - 1));
}

} // namespace montelux
