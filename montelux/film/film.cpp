#include "montelux/film/film.h"

#include <cmath>

#include "montelux/mc/math/compensated.h"
#include "montelux/mc/math/error.h"

namespace montelux {

namespace {

// Of linear sRGB (IEC 61966-2-1).
constexpr double luminance_weight[3] = {0.2126, 0.7152, 0.0722};

} // namespace

Film::Film(const FilmSettings& settings) : settings_(settings) {
    const PixelBounds& c = settings.crop;
    if (settings.width < 1 || settings.height < 1 || settings.width > Image::max_dimension ||
        settings.height > Image::max_dimension)
        throw Error("film", "the resolution " + std::to_string(settings.width) + "x" +
                                std::to_string(settings.height) + " must be between 1 and " +
                                std::to_string(Image::max_dimension) + " pixels each way");
    if (c.x0 < 0 || c.y0 < 0 || c.x1 > settings.width || c.y1 > settings.height || c.width() < 1 ||
        c.height() < 1)
        throw Error("film", "the crop window holds no pixel of the film");
    pixels_.resize(static_cast<std::size_t>(c.width()) * static_cast<std::size_t>(c.height()));
}

FilmError Film::error() const {
    CompensatedSum variance, luminance, samples;
    for (const Pixel& p : pixels_) {
        for (int c = 0; c < 3; ++c) luminance.add(luminance_weight[c] * p.units().mean(c));
        // Channels of a pixel rise and fall together: the bound by the triangle inequality is close.
        double error = 0;
        for (int c = 0; c < 3; ++c) error += luminance_weight[c] * p.units().standard_error(c);
        variance.add(error * error);
        samples.add(p.samples());
    }
    auto n = static_cast<double>(pixels_.size());
    // The compensation of a sum with infinite terms, the errors of single units, is not a number.
    const double infinity = std::numeric_limits<double>::infinity();
    double total = std::isnan(variance.value()) ? infinity : variance.value();
    FilmError e;
    e.mean_luminance = luminance.value() / n;
    e.mean_samples = samples.value() / n;
    e.relative = std::sqrt(total / n) / e.mean_luminance;
    if (!(e.mean_luminance > 0)) e.relative = total > 0 ? infinity : 0;
    return e;
}

Image Film::develop() const {
    Image image(bounds().width(), bounds().height(),
                {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B", "skewness.R", "skewness.G", "skewness.B",
                 "samples", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "depth.Z"});
    auto out = image.f32().begin();
    auto put = [&](double v) { *out++ = static_cast<float>(v); };
    for (const Pixel& p : pixels_) {
        const SkewMoments<3>& units = p.units();
        for (int c = 0; c < 3; ++c) put(units.mean(c));
        for (int c = 0; c < 3; ++c) put(units.standard_error(c));
        for (int c = 0; c < 3; ++c) put(units.skewness_of_mean(c));
        put(p.samples());
        for (int c = 0; c < 3; ++c) put(double(p.albedo()[c]));
        for (int c = 0; c < 3; ++c) put(double(p.normal()[c]));
        put(double(p.depth()));
    }
    return image;
}

} // namespace montelux
