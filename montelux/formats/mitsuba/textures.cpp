#include "montelux/formats/mitsuba/textures.h"

namespace montelux::mitsuba {

FloatParameter TextureLibrary::number(Plugin& owner, std::string_view name, float otherwise) {
    return {static_cast<float>(owner.number(name, static_cast<double>(otherwise)))};
}

SpectrumParameter TextureLibrary::spectrum(Plugin& owner, std::string_view name, float otherwise,
                                           SpectrumUse use) {
    const Property* property = owner.find(name);
    if (property == nullptr) return {builder_.add_spectrum(Spectrum(otherwise))};
    return {builder_.add_spectrum(spectrum_of(*property, use, owner.graph()))};
}

} // namespace montelux::mitsuba
