#include "montelux/spectrum/named_spectra.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "montelux/spectrum/glass_data.h"
#include "montelux/spectrum/illuminants.h"
#include "montelux/spectrum/measured_data.h"

namespace montelux {

namespace {

using Catalogue = std::map<std::string, Spectrum, std::less<>>;

PiecewiseLinear lines(const measured::EvenSamples& s) {
    std::vector<float> lambda(s.values.size());
    for (std::size_t i = 0; i < lambda.size(); ++i) lambda[i] = s.first + static_cast<float>(i) * s.step;
    return {lambda, s.values, SpectrumEnds::constant};
}

// A relative illuminant at unit luminance.
template <typename T>
Spectrum illuminant(T s) {
    s.scale(static_cast<float>(cie_y_integral / integrate_luminance(s)));
    return Spectrum(std::move(s));
}

Spectrum glass(const measured::SellmeierGlass& g) {
    std::vector<float> lambda, eta;
    for (int i = 0; g.first + i * g.step < 920; ++i) {
        double micrometres = (g.first + i * g.step) * 1e-3, l2 = micrometres * micrometres;
        double n2 = 1;
        for (int k = 0; k < 3; ++k) n2 += g.b[k] * l2 / (l2 - g.c[k]);
        lambda.push_back(static_cast<float>(std::floor(g.first + i * g.step)));
        eta.push_back(static_cast<float>(std::sqrt(n2)));
    }
    return Spectrum(PiecewiseLinear(lambda, eta, SpectrumEnds::constant));
}

void add_illuminants(Catalogue& c) {
    c.emplace("stdillum-A", illuminant(SpectrumTable::from([](float lambda) {
                  return static_cast<float>(illuminant_a(static_cast<double>(lambda)));
              })));
    c.emplace("stdillum-D50", illuminant(daylight(5000, true)));
    c.emplace("stdillum-D65", illuminant(lines(measured::illuminant_d65)));
    c.emplace("illum-acesD60", illuminant(illuminant_aces_d60()));
    for (std::size_t i = 0; i < measured::fluorescent_lamps.size(); ++i)
        c.emplace("stdillum-F" + std::to_string(i + 1), illuminant(lines(measured::fluorescent_lamps[i])));
}

void add_metals(Catalogue& c) {
    constexpr std::array<std::string_view, 4> symbols{"Ag", "Al", "Au", "Cu"};
    for (std::size_t i = 0; i < symbols.size(); ++i) {
        std::string name = "metal-" + std::string(symbols[i]);
        const auto& eta = measured::metals_at_photon_energies[2 * i];
        const auto& k = measured::metals_at_photon_energies[2 * i + 1];
        c.emplace(name + "-eta", PiecewiseLinear(eta.lambda, eta.values, SpectrumEnds::constant));
        c.emplace(name + "-k", PiecewiseLinear(k.lambda, k.values, SpectrumEnds::constant));
    }
    c.emplace("metal-CuZn-eta", lines(measured::brass_eta));
    c.emplace("metal-CuZn-k", lines(measured::brass_k));
    auto pairs = [](std::span<const float> p) {
        return Spectrum(PiecewiseLinear::from_pairs(p, SpectrumEnds::constant));
    };
    c.emplace("metal-MgO-eta", pairs(measured::magnesium_oxide_eta));
    c.emplace("metal-MgO-k", pairs(measured::magnesium_oxide_k));
    c.emplace("metal-TiO2-eta", pairs(measured::titanium_dioxide_eta));
    c.emplace("metal-TiO2-k", pairs(measured::titanium_dioxide_k));
}

void add_glasses(Catalogue& c) {
    for (const auto& g : measured::glasses) {
        c.emplace("glass-" + std::string(g.name), glass(g));
        // pbrt-v4's documentation writes F for the flints whose name is SF.
        if (g.name.starts_with("SF")) c.emplace("glass-" + std::string(g.name.substr(1)), glass(g));
    }
}

const Catalogue& catalogue() {
    static const Catalogue instance = [] {
        Catalogue c;
        add_illuminants(c);
        add_metals(c);
        add_glasses(c);
        return c;
    }();
    return instance;
}

// Number of insertions, deletions and substitutions between two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            std::size_t substitute = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({substitute, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::optional<Spectrum> find_named_spectrum(std::string_view name) {
    auto found = catalogue().find(name);
    if (found == catalogue().end()) return std::nullopt;
    return found->second;
}

const std::vector<std::string_view>& named_spectrum_names() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> n;
        for (const auto& [name, spectrum] : catalogue()) n.push_back(name);
        return n;
    }();
    return names;
}

std::string_view nearest_spectrum_name(std::string_view name) {
    // Words longer than any name are not compared.
    name = name.substr(0, 40);
    return *std::ranges::min_element(named_spectrum_names(), {},
                                     [&](std::string_view n) { return edit_distance(name, n); });
}

} // namespace montelux
