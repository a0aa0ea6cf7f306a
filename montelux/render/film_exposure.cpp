#include "montelux/render/film_exposure.h"

#include <cmath>
#include <variant>

namespace montelux {
namespace {

// The reason to leave a sample out, if any.
std::optional<BadSample::Kind> badness(Vec3f rgb, SampledSpectrum radiance) {
    // The radiance first: with infinite light RGB contains differences of infinities.
    if (has_nan(radiance)) return BadSample::Kind::nan;
    if (!all_finite(radiance)) return BadSample::Kind::infinite;
    if (std::isnan(rgb.x + rgb.y + rgb.z)) return BadSample::Kind::nan;
    if (!is_finite(rgb)) return BadSample::Kind::infinite;
    // RGB may be negative for colours outside the gamut; the spectrum may not.
    if (has_negative(radiance)) return BadSample::Kind::negative;
    return std::nullopt;
}

} // namespace

FilmExposure::FilmExposure(const SceneDescription& description)
    : max_component_value_(description.film.max_component_value),
      sensor_(RgbColorSpace::srgb(), {description.film.exposure_time, description.film.iso,
                                      description.film.white_balance, description.film.sensor}),
      background_(description.integrator.background),
      signed_filter_(std::holds_alternative<MitchellFilter>(description.film.filter) ||
                     std::holds_alternative<LanczosFilter>(description.film.filter)) {}

FilmExposure::Exposed FilmExposure::operator()(const FilmContribution& path, float ray_weight,
                                               float filter_weight) const {
    Exposed e;
    e.sensor_rgb = sensor_.to_rgb(path.radiance * ray_weight, path.lambda);
    const float largest = max_component(e.sensor_rgb);
    e.clamp = largest > max_component_value_ ? max_component_value_ / largest : 1;
    e.rgb = e.sensor_rgb * e.clamp * filter_weight;
    if (background_) [[unlikely]] {
        // Weights differ from 1 by the filter's table: a constant need not get its noise.
        e.background = *background_ * (path.transparency * (signed_filter_ ? filter_weight : 1.0f));
        e.rgb += e.background;
    }
    e.bad = badness(e.rgb, path.radiance);
    return e;
}

} // namespace montelux
