#include "montelux/film/film.h"

#include <algorithm>
#include <cmath>

#include "montelux/film/pixel_warnings.h"
#include "montelux/mc/math/error.h"

namespace montelux {

double share_of_replicate(const SkewMoments<3>& replicates, Vec3d replicate) {
    if (replicates.count() < 2) return 0;
    double own = 0, all = 0;
    for (int c = 0; c < 3; ++c) {
        const double deviation = replicate[c] - replicates.mean(c),
                     w = luminance_weight[c] * luminance_weight[c];
        own += w * deviation * deviation;
        all += w * replicates.variance(c) * static_cast<double>(replicates.count() - 1);
    }
    return all > 0 ? own / all : 0;
}

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
    if (const auto& spectral = settings.spectral) {
        if (!(spectral->lambda_min >= lambda_min && spectral->lambda_min < spectral->lambda_max &&
              spectral->lambda_max <= lambda_max))
            throw Error("film", "the wavelengths of a spectral film must lie between 360 nm and 830 nm");
        if (spectral->buckets < 1 || spectral->buckets > SpectralSettings::most_buckets)
            throw Error("film", "a spectral film has 1 to " + std::to_string(SpectralSettings::most_buckets) +
                                    " buckets");
        buckets_.resize(pixels_.size() * static_cast<std::size_t>(spectral->buckets));
    }
}

void Film::copy_row(const Film& from, int x, int y, int width) {
    std::copy_n(&from.pixel(x, y), width, &pixel(x, y));
    const std::size_t n = buckets_per_pixel();
    if (n > 0)
        std::copy_n(&from.buckets_[index(x, y) * n], static_cast<std::size_t>(width) * n,
                    &buckets_[index(x, y) * n]);
}

void Film::end_bucket_replicates(std::uint32_t points) {
    const std::size_t n = buckets_per_pixel();
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const std::uint32_t samples = pixels_[i].open_samples();
        const bool drops = pixels_[i].drops_last(points);
        for (BucketMoments& b : std::span(buckets_).subspan(i * n, n)) {
            if (samples > 0 && !drops) b.end_replicate(samples, pixels_[i].replicates().count() + 1);
            b.open = 0;
        }
    }
}

std::vector<std::string> film_layers(bool of_slice) {
    std::vector<std::string> layers{"R",          "G",          "B",          "stderr.R",   "stderr.G",
                                    "stderr.B",   "skewness.R", "skewness.G", "skewness.B", "samples",
                                    "replicates", "outlier",    "warning",    "albedo.R",   "albedo.G",
                                    "albedo.B",   "N.X",        "N.Y",        "N.Z",        "depth.Z"};
    if (of_slice) layers.insert(layers.end(), {"brightest.R", "brightest.G", "brightest.B"});
    return layers;
}

Image Film::develop(bool as_slice) const {
    Image image(bounds().width(), bounds().height(), film_layers(as_slice));
    auto out = image.f32().begin();
    auto put = [&](double v) { *out++ = static_cast<float>(v); };
    const std::vector<PixelWarning> warnings = pixel_warnings(*this);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Pixel& p = pixels_[i];
        const SkewMoments<3>& replicates = p.replicates();
        for (int c = 0; c < 3; ++c) put(replicates.mean(c));
        for (int c = 0; c < 3; ++c) put(replicates.standard_error(c));
        for (int c = 0; c < 3; ++c) put(replicates.skewness_of_mean(c));
        put(p.samples());
        put(static_cast<double>(replicates.count()));
        put(p.largest_share());
        put(static_cast<double>(warnings[i]));
        for (int c = 0; c < 3; ++c) put(double(p.albedo()[c]));
        for (int c = 0; c < 3; ++c) put(double(p.normal()[c]));
        put(double(p.depth()));
        if (as_slice)
            for (int c = 0; c < 3; ++c) put(p.brightest()[c]);
    }
    if (!buckets_.empty()) append_spectral_layers(image, *this);
    return image;
}

} // namespace montelux
