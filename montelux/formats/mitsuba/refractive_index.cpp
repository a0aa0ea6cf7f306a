#include "montelux/formats/mitsuba/refractive_index.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::mitsuba {
namespace {

// At about 589 nm and 0 to 20 degrees Celsius: Hecht, "Optics", 4th edition, and data sheets; the names are Mitsuba's.
constexpr auto substances = std::to_array<std::pair<std::string_view, double>>({
    {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.5750},      {"diamond", 2.419},
});

double index_of(std::string_view name, const SceneGraph& graph, SourceLocation at) {
    std::string lower(name);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto found = std::ranges::find(substances, lower, &std::pair<std::string_view, double>::first);
    if (found != substances.end()) return found->second;
    std::vector<std::string_view> names;
    for (const auto& [known, index] : substances) names.push_back(known);
    graph.diagnostics.error(at, "the index of refraction of " + in_quotes(name) + " is not known" +
                                    did_you_mean(lower, names));
}

double refractive_index(Plugin& bsdf, std::string_view name, std::string_view otherwise) {
    const Property* property = bsdf.find(name);
    if (property == nullptr) return index_of(otherwise, bsdf.graph(), bsdf.at());
    if (const auto* text = std::get_if<std::string>(&property->value))
        return index_of(*text, bsdf.graph(), property->at);
    constexpr double least = 0.01, most = 100;
    return bsdf.number(name, 1, least, most);
}

} // namespace

double relative_index(Plugin& bsdf, std::string_view inside) {
    const double interior = refractive_index(bsdf, "int_ior", inside);
    return interior / refractive_index(bsdf, "ext_ior", "air");
}

double index_of_interface(Plugin& bsdf, std::string_view inside) {
    const double eta = relative_index(bsdf, inside);
    if (eta == 1) bsdf.error("'int_ior' equals 'ext_ior'; expected two different indices of refraction");
    return eta;
}

} // namespace montelux::mitsuba
