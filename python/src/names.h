// Enumerators by name; errors suggest the nearest one.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "montelux/mc/math/error.h"
#include "montelux/mc/math/nearest_name.h"
#include "montelux/mc/random/point_set.h"

namespace montelux::python {

// "there is no set 'sobl' (did you mean 'sobol'?); expected one of ...".
inline std::string unknown_name(std::string_view name, std::string_view what,
                                std::span<const std::string_view> known) {
    std::string text = "there is no " + std::string(what) + " '" + std::string(name) + "'" +
                       did_you_mean(name, known) + "; expected one of";
    for (std::size_t i = 0; i < known.size(); ++i) text += (i == 0 ? " " : ", ") + std::string(known[i]);
    return text;
}

template <typename Enum, std::size_t n>
struct Names {
    std::string_view what; // the argument
    std::array<std::pair<std::string_view, Enum>, n> entries;

    // Throws Error for an unknown name.
    Enum value(std::string_view name) const {
        std::vector<std::string_view> known;
        for (const auto& [text, value] : entries) {
            if (text == name) return value;
            known.push_back(text);
        }
        throw Error(what, unknown_name(name, "choice", known));
    }
    std::string_view name(Enum value) const {
        for (const auto& [text, v] : entries)
            if (v == value) return text;
        return {};
    }
};

inline constexpr Names<PointSetKind, 6> point_sets{"point set",
                                                   {{{"independent", PointSetKind::independent},
                                                     {"halton", PointSetKind::halton},
                                                     {"hammersley", PointSetKind::hammersley},
                                                     {"sobol", PointSetKind::sobol},
                                                     {"golden_ratio", PointSetKind::golden_ratio},
                                                     {"weyl", PointSetKind::weyl}}}};
inline constexpr Names<Randomisation, 4> randomisations{
    "randomisation",
    {{{"none", Randomisation::none},
      {"shift", Randomisation::shift},
      {"digit_permutation", Randomisation::digit_permutation},
      {"scramble", Randomisation::scramble}}}};

} // namespace montelux::python
