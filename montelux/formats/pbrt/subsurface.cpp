#include "montelux/formats/pbrt/subsurface.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "montelux/mc/math/nearest_name.h"
#include "montelux/scene/medium/medium_presets.h"
#include "montelux/scene/medium/semi_infinite_albedo.h"
#include "montelux/spectrum/rgb_colorspace.h"

namespace montelux::pbrt {
namespace {

std::optional<Spectrum> interior_spectrum(ParameterReader& r, SpectrumReader& spectra, std::string_view name,
                                          RgbMeaning meaning) {
    if (const Parameter* p =
            r.any(name, {ParameterType::rgb, ParameterType::spectrum, ParameterType::texture});
        p != nullptr && p->type != ParameterType::texture) {
        const Spectrum s = spectra.read(*p, meaning);
        for (float lambda = lambda_min; lambda <= lambda_max; ++lambda)
            if (!(s(lambda) >= 0) || !std::isfinite(s(lambda)))
                r.error(name, "parameter " + in_quotes(name) + " is negative or not finite at " +
                                  std::to_string(static_cast<int>(lambda)) + " nm");
        return s;
    }
    return std::nullopt;
}

bool is_texture(ParameterReader& r, std::string_view name) {
    const Parameter* p = r.any(name, {ParameterType::rgb, ParameterType::spectrum, ParameterType::texture});
    return p != nullptr && p->type == ParameterType::texture;
}

// At each nanometre.
template <typename F>
Spectrum tabulated(const F& f) {
    std::vector<float> pairs;
    for (float lambda = lambda_min; lambda <= lambda_max; ++lambda) {
        pairs.push_back(lambda);
        pairs.push_back(f(lambda));
    }
    return Spectrum(PiecewiseLinear::from_pairs(pairs));
}

const MediumPreset& body_preset(ParameterReader& r, const std::string& name) {
    std::vector<std::string_view> names;
    for (const MediumPreset& preset : medium_presets()) {
        if (preset.name == name) return preset;
        names.push_back(preset.name);
    }
    r.error("name", "there is no medium preset " + in_quotes(name) + did_you_mean(name, names));
}

} // namespace

HomogeneousMedium read_subsurface(ParameterReader& r, SceneBuilder& builder, SpectrumReader& spectra,
                                  TextureLibrary& textures, float eta) {
    HomogeneousMedium m;
    m.is_body = true;
    float g = r.number("g", 0);
    if (!(std::abs(g) < 1)) r.error("g", "parameter 'g' is not between -1 and 1");
    m.scale = r.number("scale", 1);
    if (!(m.scale > 0)) r.error("scale", "parameter 'scale' is not positive");

    const auto from_rgb = [&](Vec3f sigma_a, Vec3f sigma_s) {
        m.sigma_a = builder.add_spectrum(RgbUnboundedSpectrum(RgbColorSpace::srgb(), sigma_a));
        m.sigma_s = builder.add_spectrum(RgbUnboundedSpectrum(RgbColorSpace::srgb(), sigma_s));
    };
    const std::optional<std::string> name = r.string("name");
    const auto sigma_a = interior_spectrum(r, spectra, "sigma_a", RgbMeaning::unbounded);
    const auto sigma_s = interior_spectrum(r, spectra, "sigma_s", RgbMeaning::unbounded);
    const auto reflectance = interior_spectrum(r, spectra, "reflectance", RgbMeaning::albedo);
    const auto mfp = interior_spectrum(r, spectra, "mfp", RgbMeaning::unbounded);
    const bool vary = is_texture(r, "sigma_a") || is_texture(r, "sigma_s"),
               reflects = is_texture(r, "reflectance") || (reflectance && is_texture(r, "mfp"));
    const bool has_a = sigma_a || is_texture(r, "sigma_a"), has_s = sigma_s || is_texture(r, "sigma_s");
    if (has_a != has_s)
        r.error(has_a ? "sigma_a" : "sigma_s", "'sigma_a' and 'sigma_s' must be given together");
    const bool named = name && !name->empty();
    if ((named ? 1 : 0) + (has_a ? 1 : 0) + (reflectance || reflects ? 1 : 0) > 1)
        r.diagnostics().warn(r.at(),
                             std::string("'subsurface' has several of 'name', 'sigma_a' with 'sigma_s', and "
                                         "'reflectance'; '") +
                                 (named ? "name" : "sigma_a") + "' is used");
    if (named) {
        const MediumPreset& preset = body_preset(r, *name);
        if (g != 0)
            r.diagnostics().warn(r.at("g"), "'g' is ignored: the coefficients of 'name' are reduced ones");
        g = 0;
        from_rgb(preset.sigma_a, preset.sigma_s);
    } else if (vary) {
        m.surface = {.kind = BodySurface::Kind::coefficients,
                     .first = textures.spectrum_or(r, "sigma_a", RgbMeaning::unbounded, 0),
                     .second = textures.spectrum_or(r, "sigma_s", RgbMeaning::unbounded, 0),
                     .scale = m.scale};
    } else if (has_a) {
        m.sigma_a = builder.add_spectrum(*sigma_a);
        m.sigma_s = builder.add_spectrum(*sigma_s);
    } else if (reflects) {
        m.surface = {.kind = BodySurface::Kind::reflectance,
                     .first = textures.spectrum_or(r, "reflectance", RgbMeaning::albedo, 0),
                     .second = textures.spectrum_or(r, "mfp", RgbMeaning::unbounded, 1),
                     .scale = m.scale,
                     .eta = eta,
                     .g = g};
    } else if (reflectance) {
        if (mfp)
            for (float lambda = lambda_min; lambda <= lambda_max; ++lambda)
                if (!((*mfp)(lambda) > 0)) r.error("mfp", "parameter 'mfp' is 0 at a visible wavelength");
        // `scale` is that of the mean free path here.
        const auto albedo = [&](float lambda) { return body_albedo((*reflectance)(lambda), eta, g); };
        const auto extinction = [&](float lambda) { return 1 / (m.scale * (mfp ? (*mfp)(lambda) : 1.0f)); };
        m.sigma_s = builder.add_spectrum(tabulated([&](float l) { return albedo(l) * extinction(l); }));
        m.sigma_a = builder.add_spectrum(tabulated([&](float l) { return (1 - albedo(l)) * extinction(l); }));
        m.scale = 1;
    } else {
        from_rgb({0.0011f, 0.0024f, 0.014f}, {2.55f, 3.21f, 3.77f}); // per millimetre
    }
    m.phase = HenyeyGreenstein{g};
    return m;
}

} // namespace montelux::pbrt
