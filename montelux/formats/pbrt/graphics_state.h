// GraphicsState: the current transformation, material, area light and defaults of a pbrt scene file.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/formats/pbrt/lights.h"
#include "montelux/formats/pbrt/parameter.h"
#include "montelux/mc/math/transform.h"

namespace montelux::pbrt {

// The current transformation at the start and at the end of the shutter's time.
struct TransformPair {
    Transform start, end;
};

// A material by its declaration, or by a name that may be declared later.
struct MaterialReference {
    bool by_name = false;
    Index index = 0; // of the declaration, or a reference of the table of names

    bool operator==(const MaterialReference&) const = default;
};

// The media of a MediumInterface: references of the table of names, or no_index for vacuum.
struct MediaReference {
    Index inside = no_index, outside = no_index;

    bool operator==(const MediaReference&) const = default;
};

// Small, since each AttributeBegin copies it: large parts are shared and replaced, never changed.
struct GraphicsState {
    std::shared_ptr<const TransformPair> ctm = std::make_shared<TransformPair>();
    bool start_active = true, end_active = true;
    bool reverse_orientation = false;
    const RgbColorSpace* color_space = nullptr;
    MaterialReference material;
    MediaReference media;
    std::shared_ptr<const Emission> emission; // null: shapes emit no light
    // From Attribute directives, by PluginKind.
    std::array<Defaults, plugin_kind_names.size()> defaults;
};

} // namespace montelux::pbrt
