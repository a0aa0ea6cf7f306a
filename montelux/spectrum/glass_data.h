// Dispersion formulas of optical glasses.
#pragma once

#include <array>
#include <string_view>

namespace montelux::measured {

// n^2 = 1 + sum_i b[i] l^2 / (l^2 - c[i]) with l the wavelength in micrometres (Sellmeier 1871). Coefficients
// from the optical glass data sheets of Schott AG, through refractiveindex.info (CC0).
struct SellmeierGlass {
    std::string_view name;
    // Where pbrt-v4 tabulates the formula: it computes n at first + i step (nm) and files it under the whole
    // nanometre below. Its pictures, and so ours, show that table and not the formula.
    double first, step;
    std::array<double, 3> b, c;
};

inline constexpr std::array<SellmeierGlass, 7> glasses{{
    {"BK7", 300, 22, {1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}},
    {"BAF10", 350, 21.5, {1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}},
    {"FK51A", 290, 22.1, {0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}},
    {"LASF9", 370, 21.3, {2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}},
    {"SF5", 370, 21.3, {1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}},
    {"SF10", 380, 21.2, {1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}},
    {"SF11", 370, 21.3, {1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}},
}};

} // namespace montelux::measured
