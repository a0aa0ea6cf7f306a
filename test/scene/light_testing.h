// with_spectrum: a light of any kind with that spectrum, and defaults for the rest.
#pragma once

#include "montelux/scene/scene_spectrum.h"

namespace montelux::testing {

template <typename L>
L with_spectrum(SceneSpectrum spectrum) {
    L light;
    light.spectrum = spectrum;
    return light;
}

} // namespace montelux::testing
