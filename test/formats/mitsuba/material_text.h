// Texts of Mitsuba's BSDFs, and the materials that they become.
#pragma once

#include "test/formats/mitsuba/looks.h"
#include <gtest/gtest.h>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "montelux/scene/material/sided_material.h"

namespace montelux::mitsuba_materials_test {
using test::expect_says;
using test::look_error;
using test::Looks;

inline std::string bsdf(const std::string& type, const std::string& content = "") {
    return "<bsdf type=\"" + type + "\">" + content + "</bsdf>";
}
inline std::string number(const std::string& name, const std::string& value) {
    return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
}
inline std::string text(const std::string& name, const std::string& value) {
    return "<string name=\"" + name + "\" value=\"" + value + "\"/>";
}
inline std::string rgb(const std::string& name, const std::string& value) {
    return "<rgb name=\"" + name + "\" value=\"" + value + "\"/>";
}
inline std::string four_colors(const std::string& name, const std::string& more = "") {
    return "<texture type=\"bitmap\" name=\"" + name + "\">" + text("filename", "four.pfm") + more +
           "</texture>";
}
inline std::string material_error(const std::string& content) {
    return look_error(content, [](Looks& looks) { looks.look(); });
}

// The material of the only BSDF that was made, of the front where it has one side. No warnings.
template <typename M>
struct One {
    Looks looks;
    mitsuba::SurfaceLook look;
    bool one_sided = false;

    explicit One(const std::string& content, std::map<std::string, std::vector<std::uint8_t>> files = {})
        : looks(content, std::move(files)), look(looks.look()) {
        for (const std::string& w : looks.warnings.messages()) ADD_FAILURE() << w;
        EXPECT_EQ(looks.look().material, look.material); // made once
        const auto* sided = std::get_if<SidedMaterial>(&looks.scene.materials.at(look.material));
        if (sided != nullptr && !sided->back.is_given()) {
            one_sided = true;
            look.material = sided->front.index;
        }
        looks.builder.finish({}, false);
    }
    const M& material() const { return looks.material<M>(look.material); }
    const M* operator->() const { return &material(); }
};

inline double value_at(const Looks& looks, SceneSpectrum s, float lambda) {
    return spectrum_of(s, looks.scene.spectra)(lambda);
}

} // namespace montelux::mitsuba_materials_test
