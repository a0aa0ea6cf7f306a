#include "montelux/formats/mitsuba/media.h"

namespace montelux::mitsuba {

Index MediumLibrary::of(const Plugin& medium) {
    const auto known = made_.find(medium.index());
    if (known != made_.end()) return known->second;
    return made_[medium.index()] = make(medium);
}

Index MediumLibrary::make(Plugin medium) { medium.refuse(); }

} // namespace montelux::mitsuba
