#include "montelux/scene/light/light_tables_view.h"

#include <algorithm>
#include <cmath>

namespace montelux {

ScaledPolynomial LightTablesView::texel_spectrum(const Image& map, std::size_t texel) {
    const std::size_t i = texel * static_cast<std::size_t>(map.channels());
    Vec3f rgb{map.value_at(i), map.value_at(i + 1), map.value_at(i + 2)};
    return RgbUnboundedSpectrum(map_color_space(), max(rgb, Vec3f{0, 0, 0}));
}

SampledSpectrum LightTablesView::texel_factor(Index map, std::size_t texel,
                                              const SampledWavelengths& lambda) const {
    const auto& spectra = map_spectra[map];
    if (!spectra.empty()) return spectra[texel].sample(lambda);
    return texel_spectrum(maps[map], texel).sample(lambda);
}

float LightTablesView::map_value(Index map, const EnvironmentGrid& grid, Vec2f place) const {
    const Image& image = maps[map];
    const auto texel = [&](std::size_t i) {
        return image.value_at(i * static_cast<std::size_t>(image.channels()));
    };
    if (lookup == EnvironmentLookup::nearest) return texel(grid.texel(place));
    const EnvironmentGrid::Blend blend = grid.blend(place);
    float sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += texel(blend.texel[k]) * blend.share[k];
    return sum;
}

SampledSpectrum LightTablesView::picture_color(Index map, Point2f uv, PictureLookup by,
                                               const SampledWavelengths& lambda) const {
    const int width = maps[map].width(), height = maps[map].height();
    const auto place = [](float t, int n) { // not a number: 0
        return std::max(0.0f, std::min(t, 1.0f)) * static_cast<float>(n) - 0.5f;
    };
    const float x = place(uv.x, width), y = place(1 - uv.y, height);
    const auto texel = [&](int column, int row) {
        const auto within = [&](int i, int n) {
            return static_cast<std::size_t>(by == PictureLookup::repeating ? (i + n) % n
                                                                           : std::clamp(i, 0, n - 1));
        };
        return texel_factor(
            map, within(row, height) * static_cast<std::size_t>(width) + within(column, width), lambda);
    };
    if (by == PictureLookup::nearest)
        return texel(static_cast<int>(std::floor(x + 0.5f)), static_cast<int>(std::floor(y + 0.5f)));
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    SampledSpectrum sum;
    for (int k = 0; k < 4; ++k) {
        const int dx = k & 1, dy = k >> 1;
        const float share =
            std::abs(static_cast<float>(x0 + 1 - dx) - x) * std::abs(static_cast<float>(y0 + 1 - dy) - y);
        sum += texel(x0 + dx, y0 + dy) * share;
    }
    return sum;
}

SampledSpectrum LightTablesView::map_radiance(const ImageInfiniteLight& light, const EnvironmentGrid& grid,
                                              Vec2f place, const SampledWavelengths& lambda) const {
    SampledSpectrum white = map_color_space().illuminant().sample(lambda);
    if (lookup == EnvironmentLookup::nearest)
        return texel_factor(light.environment, grid.texel(place), lambda) * white;
    const EnvironmentGrid::Blend blend = grid.blend(place);
    SampledSpectrum sum;
    for (std::size_t k = 0; k < 4; ++k)
        sum += texel_factor(light.environment, blend.texel[k], lambda) * blend.share[k];
    return sum * white;
}

} // namespace montelux
